from pathlib import Path

import numpy as np
import pytest
from mesh_shapes import contact_zone, edge_radius, sphere_and_cone

import meshes

DATA = Path(__file__).parent / "data"
CUBE = meshes.Zone(np.zeros(3), np.eye(3), np.full(3, -0.5e-3), np.full(3, 0.5e-3))

# What stands in `data`: small meshes whose rebuilding shows any change of a builder.
KEPT = {
    "rod_edge_radius": lambda: (
        meshes.rod(
            edge_radius(count=100), 0.04, 6, zones=[contact_zone(edge_radius(count=100), half=1e-3)] * 2
        ).mesh
    ),
    "rod_sphere_and_cone": lambda: meshes.rod(sphere_and_cone(count=100), 0.04).mesh,
    "block": lambda: meshes.block((-6e-3, 0.0, -6e-3), (6e-3, 6e-3, 0.0), 2e-3, [CUBE] * 2),
    "sphere": lambda: meshes.sphere(5e-3, 8, [CUBE]),
}


@pytest.mark.parametrize("name", sorted(KEPT))
def test_rebuilt_meshes_equal_the_kept_ones(name):
    mesh, kept = KEPT[name](), meshes.read(DATA / f"{name}.vtu")
    assert (mesh.cells == kept.cells).all()
    assert (mesh.level == kept.cell_data["level"]).all()
    assert np.abs(mesh.points - kept.points).max() < 1e-12


@pytest.mark.parametrize("ending", [".vtu", ".msh"])
def test_round_trip_keeps_every_bit_and_positive_volume(tmp_path, ending):
    mesh = KEPT["rod_edge_radius"]()
    path = tmp_path / f"rod{ending}"
    stress = np.random.default_rng(1).normal(size=len(mesh.cells))
    meshes.write(path, mesh, {"displacement": 2.0 * mesh.points}, {"mises": stress})
    back = meshes.read(path)
    assert (back.points == mesh.points).all()
    assert (back.cells == mesh.cells).all()
    assert (back.point_data["displacement"] == 2.0 * mesh.points).all()
    assert (back.cell_data["mises"] == stress).all()
    assert (back.cell_data["level"] == mesh.level).all()
    x = back.points[back.cells]
    triple = np.einsum("mi,mi->m", np.cross(x[:, 1] - x[:, 0], x[:, 3] - x[:, 0]), x[:, 4] - x[:, 0])
    assert triple.min() > 0.0
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_failed_write_leaves_the_old_file_and_no_rubbish(tmp_path, monkeypatch):
    import meshio

    mesh = KEPT["sphere"]()
    path = tmp_path / "ball.vtu"
    meshes.write(path, mesh)
    before = path.read_bytes()

    def broken(at, *_, **__):
        Path(at).write_bytes(b"half")
        raise OSError("disk full")

    monkeypatch.setattr(meshio, "write", broken)
    with pytest.raises(OSError, match="disk full"):
        meshes.write(path, mesh)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["ball.vtu"]


def test_unusable_files_are_refused_by_name(tmp_path):
    mesh = KEPT["sphere"]()
    with pytest.raises(meshes.MeshError, match=r"ending '.stl' is unknown"):
        meshes.write(tmp_path / "ball.stl", mesh)
    with pytest.raises(meshes.MeshError, match="'u' has 3 rows"):
        meshes.write(tmp_path / "ball.vtu", mesh, {"u": np.zeros(3)})
    with pytest.raises(meshes.MeshError, match="'p' has 3 rows"):
        meshes.write(tmp_path / "ball.vtu", mesh, None, {"p": np.zeros(3)})
    with pytest.raises(meshes.MeshError, match="no such file"):
        meshes.read(tmp_path / "none.vtu")
    broken = tmp_path / "broken.vtu"
    broken.write_text("<VTKFile")
    with pytest.raises(meshes.MeshError, match=r"broken\.vtu: not a readable vtu"):
        meshes.read(broken)
