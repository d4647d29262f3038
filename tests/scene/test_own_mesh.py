"""A scene whose projectile is a mesh of the user's own: read, checked, written, refused."""

from dataclasses import replace
from math import pi, sqrt

import meshio
import numpy as np
import pytest
from own_bodies import box, chamfered, taper, write

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import texts
from fem_impact.physics.beam import bending_period, stretching_period
from fem_impact.scene.impact import Impact
from fem_impact.scene.own_mesh import OwnMesh
from fem_impact.scene.read import read_dict, read_toml
from fem_impact.scene.types import digest, to_dict, to_toml

SCENE = """
id = "own"
projectile = { mesh = "bar.vtu", mesh_unit = "mm", material = "aluminium-6061-t6" }
barrier = { material = "plate-steel" }
surface = { state = "custom", friction = 0.2, source = "assumed" }
impact = { angle = "30 deg", speed = "2 m/s" }
"""


@pytest.fixture
def scene(tmp_path):
    points, cells = taper(width=10e-3, length=0.1, end=1.0, cells=(6, 3, 30))
    write(tmp_path / "bar.vtu", 1e3 * points, cells)
    (tmp_path / "own.toml").write_text(SCENE)
    return read_toml(tmp_path / "own.toml")


def stated(path, **projectile):
    rod = {"mesh": str(path), "material": "aluminium-6061-t6", **projectile}
    rod = {key: value for key, value in rod.items() if value is not None}
    return read_dict(
        {
            "id": "own",
            "projectile": rod,
            "barrier": {"material": "plate-steel"},
            "effects": ["vibration", "barrier-rigid"],
            "impact": {"angle": "30 deg", "v_n": "-1 m/s", "v_t": "0 m/s"},
        }
    )


@pytest.mark.parametrize("fidelity", ["rigid", "modal", "solid"])
def test_a_body_that_is_taken_as_a_half_unasked_is_a_limitation(scene, tmp_path, fidelity):
    """A flat bar that stands on y = 0 may be a whole body, of half the mass."""
    told = [one for one in Case(scene, fidelity).limitations if "is taken as a half of the body" in one.text]
    assert [one.kind for one in told] == ["input"]
    assert 'State mesh_symmetry = "half", or "whole"' in told[0].text
    for symmetry in ("half", "whole"):
        sure = stated(tmp_path / "bar.vtu", mesh_unit="mm", mesh_symmetry=symmetry)
        assert "is taken as" not in " ".join(texts(Case(sure, fidelity).limitations))


def test_sets_that_differ_in_case_are_told_apart(tmp_path):
    points, cells = taper(end=1.0)
    marks = np.where(points[cells][:, :, 2].mean(axis=1) > 30e-3, 1, 2)
    mesh = meshio.Mesh(
        points,
        [("hexahedron", cells)],
        cell_data={"gmsh:physical": [marks], "gmsh:geometrical": [marks]},
        field_data={"CORE": np.array([1, 3]), "Core": np.array([2, 3])},
    )
    meshio.write(tmp_path / "bar.msh", mesh, file_format="gmsh22", binary=False)
    with pytest.raises(SceneError, match=r"projectile\.mesh_materials\.core: .*Name one of CORE and Core"):
        stated(tmp_path / "bar.msh", mesh_materials={"core": "lead"})
    heavy = stated(tmp_path / "bar.msh", mesh_materials={"CORE": "lead"}).projectile.rigid_body
    assert heavy.z_c > 33e-3 > stated(tmp_path / "bar.msh").projectile.rigid_body.z_c


def test_a_mesh_is_shown_as_seen_from_the_scene(scene, tmp_path):
    assert 'mesh = "bar.vtu"\n' in to_toml(scene, tmp_path)
    assert str(tmp_path / "bar.vtu") in to_toml(scene)


def test_mass_inertia_arms_and_periods_of_a_bar_are_those_of_closed_forms(scene):
    body, rod = scene.projectile.rigid_body, scene.projectile
    assert (rod.length, rod.diameter) == (pytest.approx(0.1), pytest.approx(0.01))
    assert body.mass == pytest.approx(rod.material.rho * 1e-5, rel=1e-9)
    assert body.k2 == pytest.approx((0.1**2 + 0.01**2) / 12, rel=1e-9)
    d_c, d_d = Case(scene).contact.arms
    assert d_c == pytest.approx(0.05 * 0.5 - 0.005 * sqrt(0.75), rel=1e-9)
    assert d_d == pytest.approx(0.05 * sqrt(0.75) + 0.005 * 0.5, rel=1e-9)
    c0 = sqrt(rod.material.E / rod.material.rho)
    assert stretching_period(scene.projectile) == pytest.approx(0.2 / c0, rel=2e-3)
    slender = 2 * pi / (4.730041**2 / 0.1**2 * c0 * 0.01 / sqrt(12))
    # a beam of a tenth of its length in depth is 4 % slower by shear and rotatory inertia
    assert bending_period(scene.projectile) == pytest.approx(1.037 * slender, rel=0.01)


def test_a_flat_mesh_bends_as_a_plate(tmp_path):
    """Along its 40 mm, not along its thickness of 3 mm: it rings for four contacts, and is hardly damped."""
    write(tmp_path / "flat.vtu", *box(8, 6, 2, (-20e-3, -15e-3, 0.0), (20e-3, 15e-3, 3e-3)))
    flat = stated(tmp_path / "flat.vtu", mesh_tip="-z", mesh_symmetry="whole", material="rod-steel")
    metal = flat.projectile.material
    free_beam = 2 * pi / (4.730041**2 / 0.04**2 * sqrt(metal.E / metal.rho / 12) * 3e-3)
    assert bending_period(flat.projectile) == pytest.approx(free_beam, rel=0.05)
    damping = next(one for one in Case(flat).choices if one.name == "material-damping")
    assert damping.number is not None and damping.number < 0.02


def test_a_written_scene_reads_back_equal_and_from_anywhere(scene, tmp_path, monkeypatch):
    other = tmp_path / "elsewhere"
    other.mkdir()
    monkeypatch.chdir(other)
    (other / "copy.toml").write_text(to_toml(scene))
    assert read_toml(other / "copy.toml") == scene
    assert to_dict(scene)["projectile"]["mesh"] == str(tmp_path / "bar.vtu")


def test_other_content_is_another_scene_and_a_stated_content_holds(scene, tmp_path):
    text, before = to_toml(scene), digest(scene)
    points, cells = taper(width=10e-3, length=0.11, end=1.0, cells=(6, 3, 30))
    write(tmp_path / "bar.vtu", 1e3 * points, cells)
    changed = read_toml(tmp_path / "own.toml")
    assert digest(changed) != before
    assert changed.projectile.length == pytest.approx(0.11)
    (tmp_path / "kept.toml").write_text(text)
    with pytest.raises(SceneError, match=r"projectile.mesh = .*: has changed: its SHA-256"):
        read_toml(tmp_path / "kept.toml")


@pytest.mark.parametrize(
    ("unit", "reason"),
    [
        (None, r"projectile.mesh = .*: has a length of 1e\+05 mm\. Is its unit m\? State the unit"),
        ("um", r"projectile.mesh = .*: has a length of 0.1 mm\. Is its unit um\?"),
        ("ell", r'projectile.mesh_unit = "ell": is not a choice\. Use "m", "mm"'),
    ],
)
def test_an_unlikely_unit_is_refused(scene, tmp_path, unit, reason):
    with pytest.raises(SceneError, match=reason):
        stated(tmp_path / "bar.vtu", mesh_unit=unit)


def with_folded_cells(path, unit):
    """Write a bar of 100 mm in a unit, m, of which a node is pulled through the cells beside it."""
    points, cells = taper(width=10e-3, length=0.1, end=1.0, cells=(6, 3, 30))
    points[cells[40, 6]] += [0.0, 0.0, 0.02]
    return write(path, points / unit, cells)


@pytest.mark.parametrize(
    ("unit", "said", "length"), [(1e-3, "m", r"1e\+05 mm"), (1.0, "mm", "0.1 mm"), (1e-3, None, r"1e\+05 mm")]
)
def test_a_wrong_unit_is_named_before_folded_cells(tmp_path, unit, said, length):
    path = with_folded_cells(tmp_path / "bar.vtu", unit)
    with pytest.raises(SceneError, match=rf"has a length of {length}\. Is its unit {said or 'm'}\?"):
        stated(path, mesh_unit=said)


def test_folded_cells_are_refused_with_what_mends_them(tmp_path):
    path = with_folded_cells(tmp_path / "bar.vtu", 1e-3)
    with pytest.raises(SceneError, match=r"of 540 cells that are folded .* Mend them in the mesher: smooth"):
        stated(path, mesh_unit="mm")


def test_missing_files_garbage_and_what_does_not_fit_are_refused(scene, tmp_path):
    with pytest.raises(SceneError, match=r"projectile.mesh = .*: cannot be read: there is no such file"):
        stated(tmp_path / "none.vtu")
    (tmp_path / "bad.msh").write_text("no mesh")
    with pytest.raises(SceneError, match=r"projectile.mesh = .*: is not readable \(ansys"):
        stated(tmp_path / "bad.msh")
    with pytest.raises(SceneError, match=r"projectile.bore: stands beside a mesh"):
        stated(tmp_path / "bar.vtu", mesh_unit="mm", bore=[["0 mm", "1 mm"], ["10 mm", "1 mm"]])
    with pytest.raises(SceneError, match=r"tip"):
        stated(tmp_path / "bar.vtu", mesh_unit="mm", tip="A")


def test_segments_end_between_cells_and_weigh_what_they_are_of(scene, tmp_path):
    def of(joint):
        ends = (joint, "100 mm")
        parts = [
            {"to": to, "material": name}
            for to, name in zip(ends, ("aluminium-6061-t6", "rod-steel"), strict=True)
        ]
        return stated(tmp_path / "bar.vtu", mesh_unit="mm", material=None, segments=parts)

    body = of("60 mm").projectile.rigid_body
    light, heavy = (part.material.rho for part in of("60 mm").projectile.segments)
    assert body.mass == pytest.approx(1e-4 * (0.06 * light + 0.04 * heavy), rel=1e-9)
    with pytest.raises(
        SceneError, match=r"segments\[1\].to = \"58 mm\": lies within 18 cells .* 56.6667 mm|60 mm"
    ):
        of("58 mm")


@pytest.mark.parametrize(("bent", "remedy"), [(0.05, "rows are at 50 mm"), (1.0, "Leave out segments")])
def test_the_remedy_of_a_joint_within_bent_rows_works(tmp_path, bent, remedy):
    """Rows that are bent up to a height, m, hold no joint, though some of their nodes lie at it."""
    points, cells = taper(width=10e-3, length=0.1, end=1.0, cells=(6, 3, 30))
    points[:, 2] += 20.0 * points[:, 0] ** 2 * np.clip(1.0 - points[:, 2] / bent, 0.0, 1.0)
    write(tmp_path / "bent.vtu", points, cells)

    def of(joint):
        segments = [{"to": joint, "material": "aluminium-6061-t6"}, {"material": "rod-steel"}]
        return stated(tmp_path / "bent.vtu", mesh_symmetry="half", material=None, segments=segments)

    with pytest.raises(SceneError, match=f'20 mm": lies within .* {remedy}'):
        of("20 mm")
    if bent < 1.0:
        of("50 mm")


def test_only_what_the_model_holds_is_planned(scene):
    with pytest.raises(SceneError, match="side along"):
        Case.of(replace(scene, impact=Impact(1.5707, -2.0, 0.0)))
    assert Case.of(scene, "rigid").fidelity == "rigid"
    assert any("flat facets" in sentence for sentence in texts(Case.of(scene).limitations, "model"))


def test_masses_without_volume_are_told_in_grams_or_refused(tmp_path):
    points, cells = taper(width=10.0, length=100.0, end=1.0, cells=(2, 1, 6))  # 27 g of aluminium
    lines = [f"GRID,{n},,{x!r},{y!r},{z!r}" for n, (x, y, z) in enumerate(points.tolist(), 1)]
    for n, cell in enumerate((cells + 1).astype(str).tolist(), 1):
        lines += [f"CHEXA,{n},7,{','.join(cell[:6])}", f",{','.join(cell[6:])}"]

    def deck(mass):
        (tmp_path / "m.bdf").write_text("\n".join([*lines, f"CONM2,99,2,,{mass}"]))
        return stated(tmp_path / "m.bdf", mesh_unit="mm", mesh_symmetry="half")

    told = texts(Case.of(deck("2.-7")).limitations, "model")  # in t, mm, N and s
    where = ", ".join(f"{x:.4g}" for x in points[1])
    assert any(
        f"left out of the body: 1 CONM2 of 0.2 g (2e-07 in the file), the first at ({where}) mm" in one
        for one in told
    )
    with pytest.raises(
        SceneError, match=r"the body of 27 g would lack: 1 CONM2 of 0.3 g .* \(mesh_materials\)"
    ):
        deck("3.-7")


def test_a_thin_cell_is_told_with_its_place(tmp_path):
    points, cells = box(4, 2, 20, (-5e-3, 0, 0), (5e-3, 5e-3, 80e-3))
    layer = np.isclose(points[:, 2], 40e-3)
    points[layer, 2] -= 3.9e-3
    scene = stated(write(tmp_path / "thin.vtu", points, cells))
    (told,) = [sentence for sentence in texts(Case.of(scene).limitations) if "thinnest" in sentence]
    assert "100 um" in told
    assert "36.05" in told
    assert "8 cells are thinner" in told


def test_the_same_mesh_is_read_once_and_found_by_its_content(scene, tmp_path):
    mesh = OwnMesh.of(str(tmp_path / "bar.vtu"), "mm")
    assert mesh == scene.projectile.own_mesh
    assert mesh.half() is scene.projectile.own_mesh.half()


def test_a_chamfer_is_accepted_however_fine_its_cells(tmp_path):
    """Nodes along a chamfer do not lie on the barrier, though they are low."""
    estimates = []
    for steps in (1, 4, 12):
        scene = stated(write(tmp_path / f"bar{steps}.vtu", *chamfered(steps)))
        bodies = Case.of(scene).bodies
        estimates.append((bodies.estimate.depth, bodies.estimate.a_t, bodies.estimate.a_b))
    assert estimates[1] == pytest.approx(estimates[0], rel=1e-6)
    assert estimates[2] == pytest.approx(estimates[0], rel=1e-6)


def test_a_body_on_two_feet_is_planned_with_its_feet_in_the_fine_zone(tmp_path):
    points, cells = taper(end=1.0, cells=(2, 1, 5))
    points[(points[:, 1] == 0.0) & (points[:, 2] == 0.0), 2] = 2e-4
    case = Case.of(stated(write(tmp_path / "feet.vtu", points, cells)))
    assert case.zones.half[1] > 6e-3
    assert case.zones.rod_base == pytest.approx(8e-3, rel=0.1)


def test_an_oblique_body_is_stated_by_a_direction_or_found_and_told(tmp_path):
    """A bar that lies along (1, 2, 3) of its file is the bar that stands along z."""
    points, cells = taper(width=10e-3, length=0.1, end=0.8, cells=(6, 3, 10), whole=True)
    axis = np.array([1.0, 2.0, 3.0]) / sqrt(14)
    x = np.cross([0.0, 1.0, 0.0], axis) / np.linalg.norm(np.cross([0.0, 1.0, 0.0], axis))
    laid = points @ np.array([x, np.cross(axis, x), axis])
    plain = stated(write(tmp_path / "plain.vtu", points, cells)).projectile.rigid_body
    path = write(tmp_path / "laid.vtu", laid, cells)
    for tip in ("-axis", [-1, -2, -3], [-0.5, -1, -1.5]):
        scene = stated(path, mesh_tip=tip)
        body = scene.projectile.rigid_body
        assert (body.mass, body.k2, body.z_c) == pytest.approx((plain.mass, plain.k2, plain.z_c), rel=1e-9)
        assert "its tip points along (-0.2673, -0.5345, -0.8018)" in scene.projectile.own_mesh.body().told[0]
        assert read_toml_text(to_toml(scene), tmp_path) == scene
    for wrong, reason in (("axis", "a direction such as"), ([0, 0, 0], "is no direction"), ([1, 0], "three")):
        with pytest.raises(SceneError, match=reason):
            stated(path, mesh_tip=wrong)


def read_toml_text(text, place):
    (place / "written.toml").write_text(text)
    return read_toml(place / "written.toml")
