"""Whole runs on coarse meshes, held to reference problems, balances and closed forms."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
import solid_scenes as scenes
from threadpoolctl import threadpool_info, threadpool_limits

from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.errors import RunError
from fem_impact.fem import body
from fem_impact.fem.flight import rigid_motion
from fem_impact.fem.geometry import to_barrier_frame
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.run.simulate import simulate
from fem_impact.run.solid import reduce
from fem_impact.scene.shipped import load
from fem_impact.solid.build import build
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.march import advance, evaluate, march
from fem_impact.solid.run import solve
from meshes import SKIN

PLANE = ("vibration", "barrier-rigid")
SLIDE = ("vibration", "friction", "barrier-elastic")
YIELD = ("vibration", "friction", "rod-plasticity", "barrier-elastoplastic", "radiation", "large-rotation")


@pytest.fixture(scope="module")
def elastic():
    return scenes.run(*PLANE, "large-rotation", tip=0.3e-3, across=8)


@pytest.fixture(scope="module")
def yielding():
    return scenes.run(*YIELD, length=0.08, v_n=-2.1, v_t=-2.1)


def _outcome(result):
    return reduce(result)


@pytest.mark.long
def test_elastic_frictionless_long_rod_touches_twice_and_grazes_between(elastic):
    """Reference: e .826, .0134 N s in the graze (modes, Hertz); without it e .851, E_vib .060 (CalculiX)."""
    found = _outcome(elastic)
    assert elastic.finished
    assert found.restitution.edge.e == pytest.approx(0.826, abs=0.02)
    assert 0.060 < found.energy.vibration < 0.075
    first, graze, second = found.contact.intervals
    assert first.end == pytest.approx(125e-6, abs=15e-6)
    assert second.start == pytest.approx(348e-6, abs=15e-6)
    assert first.impulse_n == pytest.approx(0.37, abs=0.03)
    assert graze.impulse_n == pytest.approx(0.0134, abs=0.01)
    assert second.impulse_n == pytest.approx(0.26, abs=0.03)


def test_rigid_and_vibrating_parts_are_all_the_energy(elastic):
    found = _outcome(elastic)
    parts = (
        "E_r",
        "E_vib_check",
        "W_contact_dissipation",
        "E_locked_rod",
        "E_locked_barrier",
        "W_radiated",
        "residual",
    )
    assert sum(found.to_dict()[f"{part}_over_E_0"] for part in parts) == pytest.approx(1, abs=1e-10)
    assert found.restitution.mu == pytest.approx(0.0, abs=1e-7)
    assert abs(found.energy.locked_rod) < 3e-4


@pytest.mark.parametrize("which", ["elastic", "yielding"])
def test_ledger_closes(which, request):
    result = request.getfixturevalue(which)
    assert result.worst < (1e-6 if which == "elastic" else 1e-4) * result.E_0
    a = result.accounts
    whole = sum(v for k, v in a.items() if k != "residual")
    assert whole == pytest.approx(result.E_0, rel=1e-4)


def test_energies_are_those_of_the_whole_rod(elastic):
    rod, impact = elastic.case.scene.projectile.rigid_body, elastic.case.scene.impact
    assert elastic.motion.mass == pytest.approx(rod.mass, rel=1e-9)
    assert elastic.E_0 == pytest.approx(0.5 * rod.mass * (impact.v_n**2 + impact.v_t**2), rel=1e-6)
    gained = elastic.motion.V_n - impact.v_n
    book = elastic.model.book
    assert 2 * book.impulse[1] == pytest.approx(rod.mass * gained, rel=1e-6)
    # faint touches belong to no interval
    assert sum(i.impulse_n for i in book.intervals) == pytest.approx(rod.mass * gained, rel=5e-5)
    inertia = rod.mass * rod.k2
    assert elastic.motion.inertia == pytest.approx(inertia, rel=5e-3)


def test_moment_of_the_contact_is_the_angular_momentum(yielding):
    """The book's moment about the origin, against the turning and the flight of the mass centre."""
    m, book = yielding.motion, yielding.model.book
    start = yielding.model.start[0][yielding.view.places]
    centre = yielding.view.mass @ start / yielding.view.mass.sum()
    impact = yielding.case.scene.impact
    before = m.mass * (centre[2] * impact.v_t - centre[0] * impact.v_n)
    after = m.inertia * m.Omega + m.mass * (m.centre[2] * m.V_t - m.centre[0] * m.V_n)
    assert after - before == pytest.approx(-2 * book.impulse[2], rel=2e-3)


@pytest.mark.parametrize(("which", "most"), [("elastic", 2e-5), ("yielding", 2e-4)])
def test_modes_hold_all_but_little_of_the_vibration(which, most, request):
    """The check knows no modes: it holds what they do, and what lies above the highest of them."""
    found = _outcome(request.getfixturevalue(which))
    above = found.energy.vibration_check - found.energy.vibration
    assert -1e-6 * found.energy.vibration < above < most


def test_vibration_above_the_modes_is_told_where_it_is_not_small(elastic):
    assert not [words for words in texts(_outcome(elastic).validity.limitations) if "E_vib lacks" in words]
    kinetic, strain = elastic.vibration_check
    ringing = replace(elastic, vibration_check=(kinetic + 8e-3 * elastic.E_0, strain))
    (words,) = (words for words in texts(_outcome(ringing).validity.limitations) if "E_vib lacks" in words)
    assert "lacks 8.0e-03 of E_0 that vibrates above its 40 modes" in words


def test_locked_in_stress_is_not_vibration(yielding):
    found = _outcome(yielding)
    assert found.energy.locked_rod > 1.5 * found.energy.vibration > 0
    assert found.energy.vibration < 0.01


def test_yielding_rod_and_plate(yielding):
    found = _outcome(yielding)
    assert 0.25 < found.restitution.edge.e < 0.45
    assert 0.45 < found.restitution.mu < 0.62
    assert found.energy.plastic_barrier > found.energy.plastic_rod > 0.03
    assert found.energy.friction > 0.1
    assert 0 < found.energy.radiated < 0.01
    assert abs(found.energy.contact_dissipation) < 1e-3
    lost = 1 - found.energy.rigid - found.energy.vibration_check
    parts = [
        "W_friction",
        "E_plastic_rod",
        "E_plastic_barrier",
        "E_locked_rod",
        "E_locked_barrier",
        "W_radiated",
        "W_contact_dissipation",
    ]
    assert sum(found.to_dict()[f"{p}_over_E_0"] for p in parts) == pytest.approx(lost, abs=1e-5)


@pytest.mark.parametrize("f", [0.1, 0.3])
def test_sliding_rod_has_the_impulse_ratio_of_its_friction(f):
    result = scenes.run(*SLIDE, length=0.08, v_n=-1.0, v_t=-8.0, f=f)
    found = _outcome(result)
    assert found.restitution.mu == pytest.approx(f, rel=0.01)
    worked = found.energy.friction * result.E_0
    slide = [-result.case.scene.impact.v_t, -result.motion.V_t]
    assert 0 < worked < f * result.model.book.impulse[1] * 2 * max(slide) * 1.5
    assert result.worst < 1e-6 * result.E_0


def test_same_run_twice_is_the_same_to_the_last_bit(yielding):
    again = solve(yielding.case)
    assert again.steps == yielding.steps
    assert again.accounts == yielding.accounts
    assert again.motion.V_n == yielding.motion.V_n
    assert np.array_equal(again.motion.centre, yielding.motion.centre)
    assert np.array_equal(again.flight.a, yielding.flight.a)
    assert [vars_of(i) for i in again.model.book.intervals] == [
        vars_of(i) for i in yielding.model.book.intervals
    ]


def vars_of(interval):
    return interval.start, interval.end, interval.impulse_n, interval.impulse_t


@pytest.mark.parametrize("angle", [pi / 6, pi / 3])
def test_stiff_short_rod_is_rigid_theory(angle):
    result = scenes.run(*PLANE, "large-rotation", length=0.03, v_n=-0.5, v_t=-0.4, angle=angle)
    rod = result.case.scene.projectile.rigid_body
    assert rod.gamma < 10
    found = _outcome(result)
    d_c, k2 = found.restitution.impulse.d_c, found.motion.k_squared
    assert found.restitution.impulse.e == pytest.approx(1.0, abs=3e-3)
    assert d_c == pytest.approx(float(rod.arms(angle)[0]), abs=4e-4)  # half a cell
    assert found.motion.Omega == pytest.approx(2 * 0.5 * d_c / (k2 + d_c**2), rel=3e-3)
    assert found.motion.V_t == pytest.approx(-0.4, abs=1e-9)
    assert found.energy.rigid == pytest.approx(1.0, abs=2e-3)


def test_spin_before_the_impact_enters_with_its_sign():
    """A rod that turns so that its tip moves away from the plane is struck less hard."""
    pushes = [
        scenes.run(*PLANE, "large-rotation", length=0.03, v_n=-0.5, v_t=0.0, omega=omega).model.book.impulse[
            1
        ]
        for omega in (-20.0, 20.0)
    ]
    scene = scenes.scene(*PLANE, length=0.03)
    rod = scene.projectile.rigid_body
    d_c, m = float(rod.arms(pi / 4)[0]), rod.mass / (1 + float(rod.arms(pi / 4)[0]) ** 2 / rod.k2)
    exact = [2 * m * (0.5 - omega * d_c) / 2 for omega in (-20.0, 20.0)]
    assert pushes == pytest.approx(exact, rel=2e-2)


@pytest.mark.long
@pytest.mark.parametrize(
    ("barrier", "angle"),
    [("barrier-rigid", pi / 4), ("barrier-elastic", pi / 4), ("barrier-elastoplastic", pi / 3)],
)
def test_first_contact_comes_at_gap_over_speed(barrier, angle):
    """The lowest point lies on the symmetry plane: a search that drops those nodes comes late."""
    gap = 2e-6
    stated = scenes.scene("vibration", "friction", barrier, length=0.08, v_n=-1.0, v_t=0.0, angle=angle)
    model = build(Case.of(stated), gap)
    state = model.initial_state()
    assert model.geometry.rod_points[np.argmin(model.geometry.rod_points[:, 2]), 1] == 0.0
    assert model.contact.clearance(state.x) == pytest.approx(gap, rel=1e-6)
    while not model.book.intervals:
        evaluate(model, state)
        advance(model, state)
        assert state.time < 2 * gap
    assert model.book.intervals[0].start == pytest.approx(gap, abs=1.01 * model.step)


@pytest.mark.parametrize("barrier", ["barrier-elastic", "barrier-elastoplastic"])
def test_nodes_on_the_symmetry_plane_stay_on_the_barrier(barrier):
    """Near the peak no rod node of the patch lies below the block's surface, on the plane b = 0 above all."""
    model = scenes.model("vibration", "friction", barrier, length=0.08, v_n=-2.0, v_t=-2.0)
    state, contact = model.initial_state(), model.contact
    while state.time < 30e-6:
        evaluate(model, state)
        advance(model, state)
    x = state.x
    on_plane = contact.rod.mirrored
    low = x[contact.rod.places[on_plane]]
    line = x[contact.barrier.places[contact.barrier.mirrored]]
    line = line[np.argsort(line[:, 0])]
    depth = np.interp(low[:, 0], line[:, 0], line[:, 2]) - low[:, 2]
    assert line[:, 2].min() < -3e-6  # the block gives way
    assert depth.max() < 0.02 * model.geometry.tip_size
    assert model.book.touching


def _spun(*effects):
    """Turn a free rod for 4 ms at -45 rad/s: shares of strain and residual, stretch, spin at the end."""
    model = scenes.model(*effects, length=0.08, v_n=-1e-3, v_t=0.0, tip=2e-3, omega=-45.0).coasting()
    state, ledger, most = model.initial_state(), model.ledger(), 0.0

    class Until:
        every = 500

        def observe(self, state):
            nonlocal most
            most = max(most, ledger.sample(state)["strain_rod"] / ledger.start)
            return state.time >= 4e-3

    march(model, state, [Until()])
    places = model.layout.rod[~model.geometry.rod.mesh.is_hanging]
    ends = places[[np.argmin(state.x[places[:, 2]]), np.argmax(state.x[places[:, 2]])]]
    now, start = (float(np.linalg.norm(np.diff(x[ends], axis=0))) for x in (state.x, model.start[0]))
    spin = rigid_motion(state.x[places], state.v[places], model.mass[places[:, 0]]).Omega
    return most, now / start - 1, ledger.worst / ledger.start, spin


def test_a_free_spin_costs_nothing_and_keeps_lengths():
    strain, stretch, residual, spin = _spun(*PLANE, "large-rotation")
    assert strain < 1e-6
    assert abs(stretch) < 1e-6
    assert residual < 1e-6
    assert spin == pytest.approx(-45.0, rel=1e-6)


@pytest.mark.long
def test_small_rotations_let_a_spinning_rod_grow():
    """Nodes fly on straight lines: no strain energy, but a length that grows by theta^2 / 2."""
    _, stretch, _, spin = _spun(*PLANE)
    assert stretch == pytest.approx(np.sqrt(1 + 0.18**2) - 1, rel=0.05)
    assert spin == pytest.approx(-45.0 / (1 + 0.18**2), rel=0.01)


def test_body_and_tip_operators_are_the_assembled_rod():
    """Slices, nose and yielding tip together push like the rod's stiffness matrix."""
    model = scenes.model("vibration", "rod-plasticity", "barrier-rigid", length=0.08)
    state, n = model.initial_state(), model.layout.rod_size
    u = 1e-13 * np.random.default_rng(1).normal(size=n)
    u[model.inverse_mass[:n] == 0] = 0.0
    full = np.zeros_like(state.x)
    full[:n] = u
    model.hanging.expand(full)
    state.x += full
    state.v[:] = full / 1e-8
    state.dt = 1e-8
    evaluate(model, state)
    exact = model.rod_stiffness @ u
    assert abs(state.force[:n] + exact).max() < 2e-4 * abs(exact).max()
    assert model.zones[0].count > 100


def _between(share):
    """Make meshes whose lowest point stands a share of a cell beside the middle of a cell."""
    real = body.build_geometry

    def made(bodies, zones, gap, meshed, vibrating, rod=None):
        scene, h = bodies.scene, zones.tip_size
        angle = scene.impact.angle
        turn = share * h / scene.projectile.tip_radius
        # the middle of a cell is the lowest point of a rod that stands a little steeper
        steeper = replace(scene, impact=replace(scene.impact, angle=angle + turn))
        geometry = real(Bodies(steeper, bodies.effects), zones, gap, meshed)
        rho, z = scene.projectile.rigid_body.contact_point(angle)
        lowest = np.array([float(rho), 0.0, float(z)])
        points = (geometry.rod.mesh.points - lowest) @ to_barrier_frame(angle).T
        points[:, 2] += gap - points[:, 2].min()
        nearest = points[np.argmin(points[:, 2]), 0]
        assert abs(nearest) == pytest.approx((0.5 - share) * h, abs=0.04 * h)
        return replace(geometry, rod_points=points)

    return made


@pytest.mark.long
def test_a_contact_in_the_middle_of_a_cell_is_nearest_to_that_of_finer_cells(monkeypatch):
    stated = {"length": 0.08, "v_n": -2.1, "v_t": -2.1}
    finer = _outcome(scenes.run(*PLANE, "friction", **stated, tip=0.4e-3))
    middle = _outcome(scenes.run(*PLANE, "friction", **stated))
    monkeypatch.setattr(body, "build_geometry", _between(0.48))
    on_node = _outcome(solve(Case.of(scenes.scene(*PLANE, "friction", **stated))))
    near, far = (abs(run.restitution.edge.e - finer.restitution.edge.e) for run in (middle, on_node))
    assert near < 0.02 < far
    near, far = (abs(run.restitution.mu - finer.restitution.mu) for run in (middle, on_node))
    assert near < 0.01 < far


def test_gravity_is_an_account_of_its_own():
    off = scenes.run(*PLANE, length=0.08, v_n=-0.3, v_t=-0.3)
    on = scenes.run(*PLANE, "gravity", length=0.08, v_n=-0.3, v_t=-0.3)
    assert on.worst < 2e-6 * on.E_0
    assert on.accounts["gravity"] != 0.0
    assert off.accounts["gravity"] == 0.0
    # the potential gained is the weight times the height the centre has risen, from the start
    start = on.model.start[0][on.view.places]
    risen = on.motion.centre - on.view.mass @ start / on.view.mass.sum()
    weight = on.motion.mass * 9.80665
    height = risen[2] * np.cos(pi / 4) + risen[0] * np.sin(pi / 4)
    assert on.accounts["gravity"] == pytest.approx(weight * height, rel=1e-6)
    a, b = _outcome(off), _outcome(on)
    assert b.motion.V_n == pytest.approx(a.motion.V_n, abs=5e-3)
    assert b.motion.V_t == pytest.approx(-0.3, abs=1e-4)


def test_a_run_out_of_time_says_so():
    result = solve(Case.of(scenes.scene(*PLANE, length=0.08, max_time=2e-5)))
    assert not result.finished
    assert "max_time" in result.reason
    found = _outcome(result)
    assert isinstance(found.energy.vibration_check, Unknown)
    assert found.energy.vibration_check.reason
    assert replace(result, finished=True).finished


def test_rigid_barrier_has_plane_contact_over_the_whole_skin():
    model = scenes.model(*PLANE, length=0.08)
    contact = model.contact
    assert isinstance(contact, PlaneContact)
    assert len(model.impulses) == 1


@pytest.mark.long
def test_a_flat_strike_does_not_turn_the_rod_or_is_called_doubtful():
    """The whole face lands: skin beyond the fine zone must touch too, or the run must say it does not."""
    result = scenes.run(*SLIDE, "large-rotation", length=0.08, v_n=-1.0, v_t=0.0, angle=0.0)
    assert abs(result.motion.Omega) < 0.2 or result.limitations


def test_nothing_but_the_fine_zone_comes_down_to_the_barrier(yielding):
    """Only patch nodes are contact candidates, so all other skin nodes must stay above the surface."""
    model = build(yielding.case)
    mesh = model.geometry.rod.mesh
    skin = np.unique(mesh.faces_with(SKIN))
    heights = model.layout.rod[skin, 2]
    others = heights[~np.isin(heights, model.contact.rod.places[:, 2])]
    state, lowest = model.initial_state(), 1.0
    while state.time < 120e-6:
        evaluate(model, state)
        advance(model, state)
        if state.step % 100 == 0:
            lowest = min(lowest, state.x[others].min())
    assert lowest > 0.0


def test_a_run_takes_one_thread_of_linear_algebra(monkeypatch):
    """Whatever the program that calls it has set: further ones wait for each other on a busy machine."""
    found = []

    def solved(plan, options):
        found.extend(one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas")
        raise RunError("stopped here")

    monkeypatch.setattr("fem_impact.solid.run.solve", solved)
    with threadpool_limits(2, "blas"), pytest.raises(RunError, match="stopped here"):
        simulate(load("quick"), "solid")
    assert found and set(found) == {1}
