"""A free barrier that turns, in the explicit model: closed forms, both momenta, its limits."""

import numpy as np
import pytest
from light_barrier import DEPTH, OFFSET, TURNING, J, M

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.outcome.keys import known
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.ground import Ground
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.rodview import FieldSampler, RodState
from fem_impact.solid.turning import TurningDashpots

MESH = {"accuracy.unresolved": "report", "accuracy.max_time": "0.5 ms", "save.frames": 0}
ROD = MESH | {"accuracy.tip_size": "1 mm", "accuracy.across": 6, "projectile.length": "60 mm"}
BALL = MESH | {
    "projectile": {"shape": "ball", "diameter": "20 mm", "material": "rod-steel"},
    "impact.angle": "0 deg",
    "impact.v_n": "-1 m/s",
    "impact.v_t": "0 m/s",
    "accuracy.tip_size": "0.15 mm",
    "accuracy.across": 10,
}
RUBS = {"impact.v_t": "-4 m/s"}
PLANE = ["vibration", "friction", "barrier-rigid", "large-rotation"]
BLOCK = ["vibration", "friction", "barrier-elastic", "radiation", "large-rotation"]
YIELDING = ["friction", "rod-plasticity", "barrier-elastoplastic", "radiation", "large-rotation"]
BARRIERS = pytest.mark.parametrize(
    "barrier", ["barrier-rigid", pytest.param("barrier-elastic", marks=pytest.mark.long)]
)


def run(*changes, fidelity="solid"):
    whole = {key: value for change in changes for key, value in change.items()}
    return simulate(replace_all(load("t5b"), whole), fidelity)


@BARRIERS
def test_an_elastic_ball_strikes_a_free_block_off_its_centre(barrier):
    """Without friction 2 m* v is exchanged, 1 / m* = 1 / m + 1 / M + offset^2 / J (Goldsmith 1960, 2.2)."""
    outcome = run(BALL, TURNING, {"effects": [barrier]})
    m, b = outcome.motion.mass, outcome.barrier
    impulse = 2.0 / (1 / m + 1 / M + OFFSET**2 / J)
    assert m * (outcome.motion.V_n + 1) == pytest.approx(impulse, rel=2e-4)
    assert b.V_bn == pytest.approx(-impulse / M, rel=2e-4)
    assert known(b.Omega_b) == pytest.approx(-impulse * OFFSET / J, rel=2e-4)
    spun = 0.5 * J * known(b.Omega_b) ** 2 + 0.5 * M * (b.V_bn**2 + b.V_bt**2)
    assert outcome.energy.barrier == pytest.approx(spun / outcome.energy.E_0, rel=1e-12)
    assert abs(outcome.energy.residual) < 1e-8 and outcome.validity.finished


@BARRIERS
def test_a_ball_that_rubs_turns_the_block_as_brach_says_and_as_the_reduced_model(barrier):
    """Sliding all the way: Brach's equations of two bodies with e of the points that touch, and mu."""
    scene = BALL, TURNING, RUBS, {"effects": ["friction", barrier, "large-rotation"]}
    solid, modal = run(*scene), run(*scene, fidelity="modal")
    m, mu, d_d = solid.motion, known(solid.restitution.mu), 0.01
    assert mu == pytest.approx(m.friction, rel=5e-3)
    per_impulse = 1 / m.mass - 0.0 * mu + 1 / M + OFFSET * (OFFSET + mu * DEPTH) / J
    P_n = -(1 + known(solid.restitution.edge.e)) * m.v_n / per_impulse
    assert m.mass * (m.V_n - m.v_n) == pytest.approx(P_n, rel=5e-3)
    assert known(solid.barrier.Omega_b) == pytest.approx(-P_n * (OFFSET + mu * DEPTH) / J, rel=5e-3)
    assert m.Omega == pytest.approx(-mu * P_n * d_d / (m.mass * m.k_squared), rel=0.03)
    assert known(solid.barrier.Omega_b) == pytest.approx(known(modal.barrier.Omega_b), rel=5e-3)
    assert solid.energy.barrier == pytest.approx(modal.energy.barrier, rel=5e-3)


def test_on_a_plane_both_momenta_are_kept_to_round_off():
    outcome = run(ROD, TURNING, {"effects": PLANE})
    assert known(outcome.barrier.momentum_error) < 1e-13
    assert known(outcome.barrier.angular_momentum_error) < 1e-13
    assert abs(known(outcome.barrier.Omega_b)) > 10 and abs(outcome.energy.residual) < 1e-8


@pytest.mark.parametrize(
    ("effects", "lever"), [(BLOCK, 1e-6), pytest.param(YIELDING, 1e-3, marks=pytest.mark.long)]
)
def test_on_a_block_momentum_is_kept_and_angular_momentum_but_for_the_gap_of_the_skins(effects, lever):
    """Impulses on rod and block act at the height of either skin; cells that yield are bent between nodes."""
    outcome = run(ROD, TURNING, {"effects": effects})
    assert known(outcome.barrier.momentum_error) < 1e-12
    assert known(outcome.barrier.angular_momentum_error) < lever
    assert abs(outcome.energy.residual) < 1e-6 and outcome.energy.barrier > 0.1


def turning_model(effects):
    scene = replace_all(load("t5b"), {**ROD, **TURNING, "effects": effects})
    model = build(Case.of(scene), gap=1e-3)
    return scene, model, model.initial_state()


def spin_and_momentum(model, state):
    """Angular momentum about a fixed point and momentum (t, n), N m s and N s, of the half model."""
    layout, total, moved = model.layout, 0.0, np.zeros(2)
    free = [layout.rod[~model.geometry.rod.mesh.is_hanging]]
    free.append(np.arange(layout.barrier_slice.start, layout.barrier_slice.stop).reshape(-1, 3))
    for nodes in free:
        m, x, v = model.mass[nodes[:, 0]], state.x[nodes], state.v[nodes]
        total += m @ (x[:, 2] * v[:, 0] - x[:, 0] * v[:, 2])
        moved += m @ v[:, [0, 2]]
    (t, n), v, m = model.ground.place(state.x), state.v[layout.foundation], model.mass[layout.foundation[0]]
    total += m * (n * v[0] - t * v[2]) + model.mass[layout.turn[0]] * model.ground.spin(state.v)
    return np.array([total, *(moved + m * v[[0, 2]])])


@pytest.mark.parametrize("effects", [BLOCK, YIELDING])
def test_block_springs_and_dashpots_keep_angular_momentum(effects):
    _, model, state = turning_model(effects)
    block = model.layout.barrier_slice
    m, place = model.mass[block].reshape(-1, 3), model.start[0][block].reshape(-1, 3)
    whole = m[:, 0].sum() + model.mass[model.layout.foundation[0]]
    middle = (
        m[:, 0] @ place + model.mass[model.layout.foundation[0]] * model.ground.centre[[0, 0, 1]]
    ) / whole
    assert 2 * whole == pytest.approx(M, rel=1e-12)
    assert middle[[0, 2]] == pytest.approx([OFFSET, -DEPTH], rel=1e-12)
    random = np.random.default_rng(1).normal(size=block.stop - block.start)
    state.v[block] = 0.1 * random * (model.inverse_mass[block] > 0)
    before = spin_and_momentum(model, state)
    for _ in range(30):
        evaluate(model, state)
        advance(model, state)
    assert abs(model.ground.spin(state.v)) > 1e-4
    assert spin_and_momentum(model, state) == pytest.approx(before, abs=1e-12 * np.abs(before).max())


def test_dashpots_add_no_energy_on_a_foundation_of_nearly_no_mass():
    """They were implicit for the block alone, as on a foundation that does not turn."""
    _, model, state = turning_model(BLOCK)
    pots = next(item for item in model.impulses if isinstance(item, TurningDashpots))
    block, own = model.layout.barrier_slice, [*model.layout.foundation[[0, 2]], *model.layout.turn]
    pots.inverse_mass = model.inverse_mass.copy()
    pots.inverse_mass[own] *= 1e5
    moving = np.flatnonzero(pots.inverse_mass)
    state.v[:], state.force[:], state.kick = 0.0, 0.0, model.step
    random = np.random.default_rng(3).normal(size=block.stop - block.start)
    state.v[block] = random * (model.inverse_mass[block] > 0)
    energies = []
    for _ in range(50):
        energies.append(float(0.5 * (state.v[moving] ** 2 / pots.inverse_mass[moving]).sum()))
        pots.resolve(state)
    assert (np.diff(energies) <= 1e-12 * energies[0]).all() and energies[-1] < energies[0]


def test_a_block_that_turns_with_its_foundation_is_not_strained():
    """The centrifugal pull alone is left, rho (omega r)^2 / E; its film shows no stress after 0.1 rad."""
    scene, model, state = turning_model(BLOCK)
    ground, block, spin = model.ground, model.layout.barrier_slice, -500.0  # away from the rod
    arm = state.x[block].reshape(-1, 3)[:, [0, 2]] - ground.centre
    state.v[block].reshape(-1, 3)[:, 0], state.v[block].reshape(-1, 3)[:, 2] = arm[:, 1], -arm[:, 0]
    state.v[block] *= spin * (model.inverse_mass[block] > 0)
    state.v[model.layout.turn] = spin
    while state.x[model.layout.turn[0]] > -0.1:
        evaluate(model, state)
        advance(model, state)
    evaluate(model, state)
    moving = 0.5 * float(model.mass[block] @ state.v[block] ** 2)
    strain = next(sum(f.energies(state)) for f in model.forces if f.body == "barrier")
    assert strain < 1e-3 * moving
    _, cells = FieldSampler.of(model, RodState.of(model), Case(scene).bodies).sample(state)
    of_block = cells["mises"][len(model.geometry.rod.mesh.cells) :]
    assert of_block.max() < 1e7  # its strain is 5e-3 without turning back, 800 MPa


@pytest.mark.parametrize("effects", [PLANE, pytest.param(BLOCK, marks=pytest.mark.long)])
def test_without_an_end_to_its_inertia_it_only_translates(effects):
    still = {key: value for key, value in TURNING.items() if key == "barrier.mass"}
    heavy = run(ROD, TURNING, {"effects": effects, "barrier.inertia": "1e9 kg m2"})
    translating = run(ROD, still, {"effects": effects})
    numbers = [
        (o.motion.V_n, o.motion.V_t, o.motion.Omega, o.barrier.V_bn, o.energy.friction)
        for o in (heavy, translating)
    ]
    np.testing.assert_allclose(*numbers, rtol=1e-8)


def test_a_block_with_more_inertia_than_its_barrier_is_refused():
    scene = replace_all(load("t5b"), {**ROD, **TURNING, "effects": BLOCK, "barrier.inertia": "1e-6 kg m2"})
    with pytest.raises(SceneError, match=r"barrier\.inertia = .*less than that of its meshed block"):
        build(Case.of(scene))


def test_a_surface_that_has_moved_and_turned():
    ground = Ground(np.arange(3), np.array([3]), np.array([0.02, -0.03]))
    x, v = np.array([1e-3, 0.0, 2e-3, 0.1]), np.array([1.0, 0.0, 2.0, 50.0])
    c, s = np.cos(0.1), np.sin(0.1)
    # points of the surface n = 0 at the start, and one 5 mm above it
    local = np.array([[-0.02, 0.03], [0.01, 0.03], [0.01, 0.035]])
    t = 0.021 + c * local[:, 0] + s * local[:, 1]
    n = -0.028 + c * local[:, 1] - s * local[:, 0]
    assert ground.levelled(t, n, x) - ground.risen(x) == pytest.approx([0, 0, 5e-3], abs=1e-15)
    places = np.stack([t, np.zeros(3), n], axis=1)
    turned = ground.turned_on(places, x, 0.2)
    later = ground.levelled(turned[:, 0], turned[:, 2], x, 0.2) - ground.risen(x)
    assert later == pytest.approx([0, 0, 5e-3], abs=1e-15)
    assert ground.as_before(places, x)[:, [0, 2]] == pytest.approx(
        local + np.array([0.021, -0.028]), abs=1e-15
    )
    step = 1e-7
    rate = ground.rate(
        v, x, np.array([[0, 1, 2]])
    )  # of the point that stands where the foundation's shift is
    moved = ground.turned_on(np.array([x[:3]]), x, 50.0 * step)[0] + step * v[:3]
    assert rate == pytest.approx((moved - x[:3])[2] / step, rel=1e-4)
