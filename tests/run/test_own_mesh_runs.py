"""Runs of a user's own mesh: the program's rod from a file, a tapered bar that yields, free modes."""

from dataclasses import replace

import numpy as np
import pytest
from own_bodies import box, taper, write

import meshes
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.fem.body import MeshedBodies
from fem_impact.physics.stepped_beam import beam_modes
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict

BUILT = {
    "tip": "B",
    "length": "60 mm",
    "diameter": "19 mm",
    "tip_radius": "3 mm",
    "material": "rod-steel",
}


def scene(projectile, effects, **accuracy):
    return read_dict(
        {
            "id": "own",
            "projectile": projectile,
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "machined"},
            "impact": {"angle": "30 deg", "v_n": "-1.73 m/s", "v_t": "-1 m/s"},
            "effects": effects,
            "accuracy": {"tip_size": "1.5 mm", "across": 12, "unresolved": "report", **accuracy},
            "save": {"frames": 0},
        }
    )


@pytest.mark.long
@pytest.mark.parametrize(
    "ending", [".inp", *(pytest.param(ending, marks=pytest.mark.slow) for ending in (".vtu", ".msh"))]
)
def test_the_programs_own_rod_from_a_file_gives_its_run_again(tmp_path, ending):
    effects = ["vibration", "friction", "barrier-rigid"]
    built = scene(BUILT, effects)
    mesh = MeshedBodies(Case.of(built)).geometry.rod.mesh
    assert mesh.level.max() == 0
    path = write(tmp_path / f"rod{ending}", mesh.points, mesh.cells)
    own = scene({"mesh": str(path), "material": "rod-steel"}, effects)
    first, again = simulate(built), simulate(own)
    assert own.projectile.rigid_body.mass == pytest.approx(built.projectile.rigid_body.mass, rel=3e-3)
    assert again.energy.vibration == pytest.approx(first.energy.vibration, rel=0.01)
    assert again.restitution.impulse.e == pytest.approx(first.restitution.impulse.e, abs=2e-3)
    assert again.restitution.mu == pytest.approx(first.restitution.mu, abs=2e-3)
    assert again.motion.Omega == pytest.approx(first.motion.Omega, rel=0.02)
    assert abs(again.energy.residual) < 1e-6


@pytest.mark.long
def test_a_tapered_bar_that_yields_on_a_barrier_that_yields_is_balanced(tmp_path):
    points, cells = taper(cells=(4, 2, 20))
    path = write(tmp_path / "taper.inp", 1e3 * points, cells)
    own = {"mesh": str(path), "mesh_unit": "mm", "material": "rod-steel"}
    split = scene(own, ["auto", "vibration"], tip_size="0.8 mm", max_time="0.15 ms", across=8)
    outcome = simulate(split)
    energy = outcome.energy
    assert abs(energy.residual) < 1e-4
    assert energy.plastic_rod > 0.01
    assert energy.plastic_barrier > 0.0
    made = MeshedBodies(Case.of(split))
    assert made.geometry.rod.mesh.level.max() == 1
    assert made.true_rod.yields.any()
    assert made.mass[made.free_nodes[:, 0]].sum() * 2 == pytest.approx(
        split.projectile.rigid_body.mass, rel=1e-9
    )


def test_a_mesh_that_is_fine_already_is_used_as_it_is(tmp_path):
    points, cells = taper(cells=(8, 4, 40))
    path = write(tmp_path / "fine.vtu", points, cells)
    own = {"mesh": str(path), "material": "rod-steel"}
    made = MeshedBodies(Case.of(scene(own, ["auto", "vibration"], tip_size="0.9 mm", across=8)))
    geometry, half = made.geometry, meshes.read_own(path).half
    assert len(geometry.rod.mesh.cells) == len(half.cells)
    yields, touching = geometry.may_yield["rod"], geometry.touching
    middle = half.points[half.cells].mean(axis=1)
    away = np.linalg.norm(middle - [3e-3, 0.0, 0.0], axis=1)
    assert 0 < yields.sum() < len(half.cells) / 4
    assert yields[away.argmin()]
    assert touching[yields].any()
    assert not touching[half.points[half.cells, 2].min(axis=1) > 20e-3].any()


def test_free_modes_of_a_tapered_bar_are_those_of_its_beam(tmp_path):
    points, cells = taper(width=10e-3, length=0.2, cells=(6, 3, 60))
    path = write(tmp_path / "taper.vtu", points, cells)
    made = MeshedBodies(
        Case.of(scene({"mesh": str(path), "material": "rod-steel"}, ["vibration", "barrier-rigid"]))
    )
    theory, found = beam_modes(made.scene.projectile), made.rod_modes().frequency
    for wanted in (*theory.bent[:2], theory.stretched[0]):
        assert np.abs(found / (wanted / (2 * np.pi)) - 1).min() < 0.01


@pytest.mark.long
def test_a_rod_from_a_file_that_cannot_vibrate_gives_the_run_of_the_built_in_one(tmp_path):
    """The noses are of the same length, the rest of both moves as one rigid body."""
    effects = ["friction", "barrier-elastic"]
    mesh = MeshedBodies(Case.of(scene(BUILT, ["vibration", "barrier-rigid"]))).geometry.rod.mesh
    path = write(tmp_path / "rod.vtu", mesh.points, mesh.cells)
    built, own = (
        scene(rod, effects, tip_size="0.8 mm")
        for rod in (BUILT, {"mesh": str(path), "material": "rod-steel"})
    )
    first, again = simulate(built), simulate(own)
    assert again.restitution.impulse.e == pytest.approx(first.restitution.impulse.e, abs=5e-3)
    assert again.restitution.mu == pytest.approx(first.restitution.mu, abs=5e-3)
    assert again.motion.Omega == pytest.approx(first.motion.Omega, rel=0.03)
    assert abs(again.energy.residual) < 1e-6
    vibrating = simulate(replace(own, effects=("vibration", *effects)))
    assert vibrating.restitution.impulse.e < again.restitution.impulse.e - 0.03  # the rest does not vibrate


def test_the_rest_of_a_users_body_keeps_its_mass_centre_and_inertia(tmp_path):
    """A bar whose upper half is shifted along x: the rest moves about a centre beside the axis."""
    points, cells = taper(width=12e-3, length=80e-3, end=1.0, cells=(4, 2, 40))
    points[:, 0] += 0.1 * points[:, 2]
    path = write(tmp_path / "sheared.vtu", points, cells)
    own = scene(
        {"mesh": str(path), "material": "rod-steel"}, ["friction", "barrier-elastic"], tip_size="1 mm"
    )
    made, whole = MeshedBodies(Case.of(own)), own.projectile.rigid_body
    assert 2 * made.mass[made.free_nodes[:, 0]].sum() == pytest.approx(whole.mass, rel=1e-9)
    start = made.geometry.rod.body_start
    assert 12e-3 / 3 <= start < 30e-3
    mass, x, z, k2 = whole.moments_behind(start)
    low = np.ceil(start / 2e-3 - 1e-9) * 2e-3  # the next row of cells
    length = 80e-3 - low
    assert mass == pytest.approx(own.projectile.material.rho * 12e-3**2 * length, rel=1e-9)
    assert z == pytest.approx(low + length / 2, rel=1e-9)
    assert x == pytest.approx(0.1 * (z - 40e-3), rel=1e-6)
    assert k2 == pytest.approx((1.01 * length**2 + 12e-3**2) / 12, rel=1e-6)
    places = made.geometry.rod.mesh.points[-2:]
    assert places.mean(axis=0) == pytest.approx([x, 0.0, z], abs=1e-12)
    assert np.linalg.norm(places[1] - places[0]) / 2 == pytest.approx(np.sqrt(k2), rel=1e-12)


def test_a_body_that_is_all_nose_is_refused_without_vibration(tmp_path):
    points, cells = taper(width=12e-3, length=14e-3, end=1.0, cells=(4, 2, 1))
    own = {"mesh": str(write(tmp_path / "stub.vtu", points, cells)), "material": "rod-steel"}
    with pytest.raises(SceneError, match="deforms as a whole: the fine zone"):
        Case.of(scene(own, ["friction", "barrier-elastic"], tip_size="0.5 mm"))
    assert Case.of(scene(own, ["vibration", "barrier-elastic"], tip_size="0.5 mm")).slots.vibrating


def test_a_meshed_plate_always_vibrates(tmp_path):
    """Unless it is told not to: then it is refused with its reason."""
    points, cells = box(8, 4, 3, (-20e-3, 0, 0), (20e-3, 20e-3, 4e-3))
    path = write(tmp_path / "plate.vtu", points, cells)
    own = {"mesh": str(path), "mesh_tip": "-z", "material": "rod-steel"}
    case = Case.of(scene(own, ["auto", "barrier-elastic"]))
    assert case.slots.vibrating
    assert next(choice.number for choice in case.choices if choice.name == "vibration") is None
    with pytest.raises(SceneError, match=r"deforms as a whole.* A body that vibrates is computed: effects"):
        Case.of(scene(own, ["auto", "-vibration", "barrier-elastic"]))


def test_a_quarter_a_half_and_all_of_a_bar_give_one_outcome(tmp_path):
    """The same cells, given as three files, in the same order: equal to the last bits."""
    outcomes = []
    for part, low in (("whole", (-6e-3, -6e-3)), ("half", (-6e-3, 0.0)), ("quarter", (0.0, 0.0))):
        counts = [2 if side < 0 else 1 for side in low]
        points, cells = box(*counts, 6, (*low, 0.0), (6e-3, 6e-3, 48e-3))
        path = write(tmp_path / f"{part}.vtu", points, cells)
        own = {"mesh": str(path), "mesh_symmetry": part, "material": "rod-steel"}
        stated = scene(own, ["vibration", "friction", "barrier-rigid"], tip_size="3 mm")
        outcomes.append(simulate(stated))
    first = outcomes[0]
    for again in outcomes[1:]:
        assert again.restitution.impulse.e == pytest.approx(first.restitution.impulse.e, rel=1e-12)
        assert again.restitution.mu == pytest.approx(first.restitution.mu, rel=1e-12)
        assert again.motion.Omega == pytest.approx(first.motion.Omega, rel=1e-8)
        assert again.energy.vibration == pytest.approx(first.energy.vibration, rel=1e-7)
