"""Faces of a mesh with a surface of their own: where they touch, their friction counts, and nowhere else."""

import numpy as np
import pytest
from own_bodies import box

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import replace
from fem_impact.scene.types import to_dict
from fem_impact.solid.build import Builder

GREASED = {"state": "custom", "friction": 0.1, "source": "greased"}


def bar(folder):
    """Write half a bar of 12 x 12 x 60 mm as a deck with a set of its lowest cells and one of the others."""
    points, hexes = box(4, 2, 10, (-6, 0, 0), (6, 6, 60))
    low = points[hexes][:, :, 2].mean(axis=1) < 6
    lines = ["*NODE", *(f"{n}, {a!r}, {b!r}, {c!r}" for n, (a, b, c) in enumerate(points.tolist(), 1))]
    lines += ["*ELEMENT, TYPE=C3D8", *(f"{n}, " + ", ".join(map(str, c)) for n, c in enumerate(hexes + 1, 1))]
    lines += ["*ELSET, ELSET=FOOT", *map(str, np.flatnonzero(low) + 1)]
    lines += ["*ELSET, ELSET=SHANK", *map(str, np.flatnonzero(~low) + 1)]
    (folder / "bar.inp").write_text("\n".join(lines))
    return folder / "bar.inp"


def scene(path, faces, friction=0.6, barrier="barrier-rigid", angle="30 deg", **more):
    rod = {"mesh": str(path), "mesh_unit": "mm", "material": "rod-steel"}
    return read_dict(
        {
            "id": "faces",
            "projectile": rod | ({"mesh_surfaces": faces} if faces else {}),
            "barrier": {"material": "plate-steel", **more},
            "surface": {"state": "custom", "friction": friction, "source": "dry"},
            "impact": {"angle": angle, "v_n": "-1 m/s", "v_t": "-0.8 m/s"},
            "effects": ["vibration", "friction", barrier],
            "accuracy": {"unresolved": "report", "tip_size": "0.8 mm", "max_time": "0.2 ms", "levels": 1},
            "save": {"frames": 0},
        }
    )


@pytest.mark.long
@pytest.mark.parametrize(
    ("barrier", "more"), [("barrier-rigid", {}), ("barrier-elastic", {}), ("barrier-rigid", {"mass": "5 kg"})]
)
def test_the_face_that_touches_gives_the_friction(tmp_path, barrier, more):
    path = bar(tmp_path)
    greased, of_foot, of_shank, dry = (
        simulate(scene(path, faces, friction, barrier, **more)).restitution.mu
        for faces, friction in (
            ({}, 0.1),
            ({"FOOT": GREASED}, 0.6),
            ({"SHANK": GREASED}, 0.6),
            ({}, 0.6),
        )
    )
    assert of_foot == pytest.approx(greased, rel=1e-12)
    assert of_shank == pytest.approx(dry, rel=1e-12)
    assert dry > 1.5 * greased


def test_rigid_theory_takes_the_face_that_touches_first(tmp_path):
    path = bar(tmp_path)
    lying = scene(path, {"FOOT": GREASED}, angle="90 deg")
    standing = scene(path, {"FOOT": GREASED})
    assert Case.of(standing, "rigid").contact.f == 0.1
    assert Case(lying, "rigid").bodies.friction in (0.1, 0.6)
    assert (
        simulate(standing, "rigid").restitution.mu == simulate(scene(path, {}, 0.1), "rigid").restitution.mu
    )


def test_an_edge_has_the_friction_of_the_faces_on_both_sides_of_it(tmp_path):
    """The sides square to it meet it at its end alone, where finite elements have one dry node."""
    path = bar(tmp_path)
    numbers = np.arange(1, 81).reshape(4, 2, 10)
    sole, front = numbers[:, :, 0].ravel(), numbers[-1].ravel()
    for name, cells, side in (("SOLE", sole, "S1"), ("FRONT", front, "S4")):
        faces = "\n".join(f"{n}, {side}" for n in cells)
        path.write_text(f"{path.read_text()}\n*SURFACE, NAME={name}\n{faces}")
    assert Case.of(scene(path, {"SOLE": GREASED, "FRONT": GREASED}), "rigid").contact.f == 0.1
    assert Case.of(scene(path, {"SOLE": GREASED}), "rigid").contact.f == 0.6
    level = scene(path, {"SOLE": GREASED}, angle="0 deg")
    assert Case.of(level, "solid").contact.f == 0.1, "the sides beside a face that lies flat do not touch"
    assert Case.of(scene(path, {"FRONT": GREASED}), "rigid").contact.f == 0.6


def test_nodes_between_two_faces_have_the_larger_friction(tmp_path):
    builder = Builder(Case.of(scene(bar(tmp_path), {"FOOT": GREASED})), 1e-6)
    mesh = builder.meshed.geometry.rod.mesh
    skin = mesh.free_skin
    height, f = mesh.points[skin, 2], builder.friction[skin]
    foot = height < 6e-3 - 1e-9
    assert (f[foot] == 0.1).all()
    assert (f[~foot] == 0.6).all()
    assert foot.sum() > 10


def test_a_set_of_faces_leaves_the_other_faces_of_its_cells_as_they_are(tmp_path):
    """The end of the bar alone is greased, on cells that the zone at the contact splits."""
    path = bar(tmp_path)
    number = np.arange(1, 81).reshape(4, 2, 10)[:, :, 0].ravel()
    path.write_text(path.read_text() + "\n*SURFACE, NAME=SOLE\n" + "\n".join(f"{n}, S1" for n in number))
    stated = scene(path, {"SOLE": GREASED})
    builder = Builder(Case.of(stated), 1e-6)
    mesh = builder.meshed.geometry.rod.mesh
    x, y, z = mesh.points[mesh.free_skin].T
    sole = (z == 0.0) & (np.abs(x) < 6e-3 - 1e-9) & (y < 6e-3 - 1e-9)
    assert sole.sum() > 30
    assert (builder.friction[mesh.free_skin][sole] == 0.1).all()
    assert (builder.friction[mesh.free_skin][~sole] == 0.6).all()
    with pytest.raises(SceneError, match=r"mesh_surfaces\.FOOT: holds 8 faces that another set holds too"):
        Case.of(scene(path, {"SOLE": GREASED, "FOOT": {"state": "machined"}}), "rigid")


def test_a_scene_with_faces_is_written_and_read_back(tmp_path):
    stated = scene(bar(tmp_path), {"FOOT": {"state": "machined"}, "SHANK": GREASED})
    assert read_dict(to_dict(stated)) == stated
    assert stated.projectile.faces[0].surface.friction == 0.57
    with pytest.raises(
        SceneError,
        match=r"^scene: projectile\.mesh_surfaces\.HEEL: is no set of cells, faces or nodes of the mesh",
    ):
        Case.of(scene(tmp_path / "bar.inp", {"HEEL": GREASED}), "rigid")
    with pytest.raises(SceneError, match=r"mesh_surfaces\.FOOT\.state: is the state of the scene's surface"):
        scene(tmp_path / "bar.inp", {"FOOT": {"state": "pair"}})


def test_a_body_with_faces_of_its_own_is_not_followed(tmp_path):
    """Later strikes would keep the friction of the place that touches first."""
    stated = replace(scene(bar(tmp_path), {"FOOT": GREASED}), "impact.until", "3 strikes")
    for fidelity in ("rigid", "modal"):
        with pytest.raises(SceneError, match=r'mesh_surfaces\.FOOT.*Leave mesh_surfaces out.*"first"'):
            simulate(stated, fidelity)
