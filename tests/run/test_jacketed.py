"""A body of several materials side by side: sets of a mesh, by closed forms and by the same body built in."""

from dataclasses import replace

import numpy as np
import pytest
from own_bodies import box

import meshes
from fem_impact.case.case import Case
from fem_impact.case.effects import damping
from fem_impact.errors import SceneError
from fem_impact.fem.body import MeshedBodies
from fem_impact.physics.beam import bending_period, stretching_period
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict
from fem_impact.scene.types import to_dict

LENGTH, WIDTH = 0.2, 10e-3


def jacketed(folder, cells=(6, 3, 120), core=1 / 3):
    """Write a square bar of 10 x 10 x 200 mm with a square core, a share of its width, as an Abaqus deck."""
    points, hexes = box(*cells, (-WIDTH / 2, 0, 0), (WIDTH / 2, WIDTH / 2, LENGTH))
    x, y, _ = points[hexes].mean(axis=1).T
    inside = (np.abs(x) < core * WIDTH / 2) & (y < core * WIDTH / 2)
    lines = ["*NODE", *(f"{n}, {a!r}, {b!r}, {c!r}" for n, (a, b, c) in enumerate(points.tolist(), 1))]
    lines += ["*ELEMENT, TYPE=C3D8", *(f"{n}, " + ", ".join(map(str, c)) for n, c in enumerate(hexes + 1, 1))]
    numbers = np.flatnonzero(inside) + 1
    lines += ["*ELSET, ELSET=Core", *map(str, numbers)]
    (folder / "bar.inp").write_text("\n".join(lines))
    return folder / "bar.inp"


def scene(path, materials, effects=("vibration", "barrier-rigid"), tip_size="1.2 mm", **more):
    return read_dict(
        {
            "id": "jacketed",
            "projectile": {"mesh": str(path), "material": "copper", "mesh_materials": materials} | more,
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "custom", "friction": 0.2, "source": "assumed"},
            "impact": {"angle": "30 deg", "v_n": "-1 m/s", "v_t": "0 m/s"},
            "effects": list(effects),
            "accuracy": {"unresolved": "report", "tip_size": tip_size},
            "save": {"frames": 0},
        }
    )


def closed_form(stated):
    """Mass, kg; first bending frequency of a slender beam and first stretching frequency of a bar, Hz."""
    jacket = stated.projectile.material
    (core,) = (region.material for region in stated.projectile.regions)
    area, inner = WIDTH**2, WIDTH**2 / 9
    second, of_core = WIDTH**4 / 12, (WIDTH / 3) ** 4 / 12
    line = jacket.rho * (area - inner) + core.rho * inner
    bend = jacket.E * (second - of_core) + core.E * of_core
    pull = jacket.E * (area - inner) + core.E * inner
    bending = 4.730041**2 / (2 * np.pi * LENGTH**2) * np.sqrt(bend / line)
    return line * LENGTH, bending, np.sqrt(pull / line) / (2 * LENGTH)


def test_a_core_that_states_a_loss_factor_damps_the_bar(tmp_path):
    """It was damped as iron: only segments and the material that touches were asked."""
    core = {"name": "viscous", "E": "70 GPa", "nu": 0.3, "rho": "2700 kg/m3", "loss_factor": 0.1}
    bodies = Case.of(scene(jacketed(tmp_path, (6, 3, 20)), {"CORE": core}), "rigid").bodies
    assert damping.states_loss(bodies) and damping.loss_factor(bodies) == 0.1


@pytest.mark.long
def test_mass_and_frequencies_of_a_jacketed_bar_are_those_of_a_compound_beam(tmp_path):
    stated = scene(jacketed(tmp_path), {"CORE": "tungsten-heavy-alloy"})
    mass, bending, stretching = closed_form(stated)
    assert stated.projectile.rigid_body.mass == pytest.approx(mass, rel=1e-9)
    assert 1 / stretching_period(stated.projectile) == pytest.approx(stretching, rel=2e-3)
    # a beam of a twentieth of its length in depth is 1 % slower by shear and rotatory inertia
    assert 1 / bending_period(stated.projectile) == pytest.approx(0.99 * bending, rel=5e-3)
    made = MeshedBodies(Case.of(stated))
    assert 2 * made.mass[made.free_nodes[:, 0]].sum() == pytest.approx(mass, rel=1e-9)
    found = made.rod_modes().frequency
    for wanted in (0.99 * bending, stretching):
        assert np.abs(found / wanted - 1).min() < 3e-3
    alone = replace(stated.projectile, regions=())
    assert abs(stretching_period(alone) * stretching - 1) > 0.01  # the core is seen


def test_sets_across_the_bar_give_the_run_of_segments(tmp_path):
    """Two materials one behind the other: by segments of the scene and by a set of the file."""
    path = jacketed(tmp_path, cells=(4, 2, 30))
    text = path.read_text().partition("*ELSET")[0]
    points, hexes = box(4, 2, 30, (-WIDTH / 2, 0, 0), (WIDTH / 2, WIDTH / 2, LENGTH))
    behind = np.flatnonzero(points[hexes][:, :, 2].mean(axis=1) > 0.06) + 1
    path.write_text(text + "*ELSET, ELSET=TAIL\n" + "\n".join(map(str, behind)))
    by_set = scene(path, {"TAIL": "rod-steel"}, ["vibration", "friction", "barrier-rigid"])
    parts = [{"to": "60 mm", "material": "copper"}, {"to": "200 mm", "material": "rod-steel"}]
    table = to_dict(by_set)
    table["projectile"] = {"mesh": str(path), "segments": parts}
    by_segment = read_dict(table)
    assert by_set.projectile.rigid_body.k2 == pytest.approx(by_segment.projectile.rigid_body.k2, rel=1e-12)
    first, again = simulate(by_segment), simulate(by_set)
    assert again.restitution.impulse.e == pytest.approx(first.restitution.impulse.e, rel=1e-8)
    assert again.motion.Omega == pytest.approx(first.motion.Omega, rel=1e-8)
    assert again.energy.vibration == pytest.approx(first.energy.vibration, rel=1e-7)


def test_cells_that_are_split_keep_their_material(tmp_path):
    path = jacketed(tmp_path, cells=(6, 3, 20))
    stated = scene(path, {"CORE": "tungsten-heavy-alloy"}, ["auto", "vibration"], tip_size="0.8 mm")
    made = MeshedBodies(Case.of(stated))
    mesh, body = made.geometry.rod.mesh, made.true_rod
    assert mesh.level.max() > 0
    x, y, _ = mesh.points[mesh.cells].mean(axis=1).T
    inside = (np.abs(x) < WIDTH / 6) & (y < WIDTH / 6)
    ((_, of_core),) = body.others
    assert (of_core == inside).all()
    assert 2 * body.mass.sum() == pytest.approx(stated.projectile.rigid_body.mass, rel=1e-9)
    assert body.yields.any()
    assert not body.yields[inside].any()


def test_what_sets_cannot_say_is_refused(tmp_path):
    path = jacketed(tmp_path)
    with pytest.raises(
        SceneError, match=r"mesh_materials.SHELL: is no set of cells of the mesh\. It has CORE"
    ):
        scene(path, {"SHELL": "lead"})
    with pytest.raises(SceneError, match=r"mesh_materials.core: holds 240 cells that another set holds too"):
        scene(path, {"CORE": "lead", "core": "lead"})
    with pytest.raises(SceneError, match=r"mesh_materials = .lead.: must be a table"):
        scene(path, "lead")
    text = path.read_text().partition("*ELSET")[0]
    path.write_text(text + "*ELSET, ELSET=ALL, GENERATE\n1, 2160, 1\n")
    with pytest.raises(SceneError, match="touches the barrier first"):
        Case.of(scene(path, {"ALL": "lead"}))


def test_a_set_on_one_side_of_the_plane_of_symmetry_is_refused(tmp_path):
    """It would be mirrored, and the body be another."""
    points, hexes = box(2, 2, 10, (-5, -5, 0), (5, 5, 60))
    upper = np.flatnonzero(points[hexes][:, :, 1].mean(axis=1) > 0) + 1
    lines = ["*NODE", *(f"{n}, {a!r}, {b!r}, {c!r}" for n, (a, b, c) in enumerate(points.tolist(), 1))]
    lines += ["*ELEMENT, TYPE=C3D8", *(f"{n}, " + ", ".join(map(str, c)) for n, c in enumerate(hexes + 1, 1))]
    (tmp_path / "bar.inp").write_text("\n".join([*lines, "*ELSET, ELSET=UPPER", *map(str, upper)]))
    with pytest.raises(SceneError, match=r"mesh_materials\.UPPER: lies on one side of the plane of symmetry"):
        scene(tmp_path / "bar.inp", {"UPPER": "lead"}, mesh_unit="mm")


def test_a_written_scene_reads_back_equal(tmp_path):
    stated = scene(jacketed(tmp_path), {"CORE": "tungsten-heavy-alloy"}, mesh_symmetry="half")
    assert read_dict(to_dict(stated)) == stated
    assert meshes.volume(stated.projectile.own_mesh.half()) == pytest.approx(LENGTH * WIDTH**2 / 2)
