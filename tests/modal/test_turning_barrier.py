"""A free barrier that turns: closed forms of two rigid bodies, both momenta, and its limits."""

import math

import numpy as np
import pytest
from light_barrier import DEPTH, OFFSET, TURNING, J, M

from fem_impact.errors import SceneError
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown, known
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

BALL = {
    "projectile": {"shape": "ball", "diameter": "20 mm", "material": "rod-steel"},
    "impact.angle": "0 deg",
    "impact.v_n": "-1 m/s",
    "impact.v_t": "0 m/s",
    "effects": ["barrier-elastic"],
}


def run(*changes, fidelity="modal"):
    whole = {key: value for change in changes for key, value in change.items()}
    return simulate(replace_all(load("t5b"), whole), fidelity)


def test_an_elastic_ball_strikes_a_free_block_off_its_centre():
    """Without friction 2 m* v is exchanged, 1 / m* = 1 / m + 1 / M + offset^2 / J (Goldsmith 1960, 2.2)."""
    outcome = run(BALL, TURNING)
    m = outcome.motion.mass
    impulse = 2.0 / (1 / m + 1 / M + OFFSET**2 / J)
    assert outcome.motion.V_n == pytest.approx(-1.0 + impulse / m, abs=1e-6)
    assert outcome.barrier.V_bn == pytest.approx(-impulse / M, rel=1e-6)
    assert known(outcome.barrier.Omega_b) == pytest.approx(-impulse * OFFSET / J, rel=1e-6)
    assert known(outcome.restitution.edge.e) == pytest.approx(1.0, abs=1e-6)
    spun = 0.5 * J * known(outcome.barrier.Omega_b) ** 2 + 0.5 * M * outcome.barrier.V_bn**2
    assert outcome.energy.barrier == pytest.approx(spun / outcome.energy.E_0, rel=1e-9)


def test_a_ball_that_rubs_turns_the_block_by_its_depth():
    """Sliding all the way: P_t = f P_n against the slip; the point of contact moves .3 mm meanwhile."""
    outcome = run(BALL, TURNING, {"impact.v_t": "-4 m/s", "effects": ["friction", "barrier-elastic"]})
    mu, f = known(outcome.restitution.mu), outcome.motion.friction
    assert mu == pytest.approx(f, rel=1e-3)
    P_n = outcome.motion.mass * (outcome.motion.V_n + 1.0)
    torque = -P_n * OFFSET - mu * P_n * DEPTH
    assert known(outcome.barrier.Omega_b) == pytest.approx(torque / J, rel=5e-3)
    assert abs(outcome.energy.residual) < 1e-6


@pytest.mark.parametrize("effects", ["auto", ["friction", "rod-plasticity", "barrier-elastoplastic"]])
def test_both_bodies_keep_their_momenta_and_the_energy(effects):
    outcome = run(TURNING, {"effects": effects})
    assert known(outcome.barrier.momentum_error) < 1e-10
    assert known(outcome.barrier.angular_momentum_error) < 1e-6
    assert abs(outcome.energy.residual) < 1e-5 and outcome.energy.barrier > 0.1


def test_angular_momentum_about_a_fixed_point_is_that_of_the_start():
    """Reckoned from the velocities alone: the impulse acts on both bodies near the first point of contact."""
    outcome = run(TURNING, {"effects": ["friction", "rod-plasticity", "barrier-elastoplastic"]})
    m, b, rod = outcome.motion, outcome.barrier, replace_all(load("t5b"), TURNING).projectile.rigid_body
    d_c, d_d = rod.arms(m.alpha)
    P_n, P_t = m.mass * (m.V_n - m.v_n), m.mass * (m.V_t - m.v_t)
    on_rod = -d_d * P_t + d_c * P_n - m.mass * m.k_squared * m.Omega
    on_block = -DEPTH * P_t - OFFSET * P_n - J * known(b.Omega_b)
    assert abs(on_rod + on_block) < 3e-3 * m.mass * math.hypot(m.v_n, m.v_t) * d_d


def test_the_coefficients_give_the_motion_back_by_two_body_theory():
    """Brach's equations of two bodies with e of the points that touch and mu."""
    outcome = run(TURNING, {"effects": ["friction", "rod-plasticity", "barrier-elastoplastic"]})
    m, b, one, mu = outcome.motion, outcome.barrier, outcome.restitution.edge, known(outcome.restitution.mu)
    d_c, d_d, I = known(one.d_c), known(one.d_d), m.mass * m.k_squared
    per_impulse = 1 / m.mass + d_c * (d_c - mu * d_d) / I + 1 / M + OFFSET * (OFFSET + mu * DEPTH) / J
    P_n = -(1 + known(one.e)) * m.v_n / per_impulse
    assert P_n == pytest.approx(m.mass * (m.V_n - m.v_n), rel=2e-3)
    assert known(b.Omega_b) == pytest.approx(-P_n * (OFFSET + mu * DEPTH) / J, rel=3e-3)
    lost = known(one.E_ln) + known(one.E_lt)
    assert lost == pytest.approx(1 - outcome.energy.rigid - outcome.energy.barrier, abs=2e-3)


def test_without_an_end_to_its_inertia_it_only_translates():
    still = {key: value for key, value in TURNING.items() if key == "barrier.mass"}
    heavy, translating = run(TURNING, {"barrier.inertia": "1e9 kg m2"}), run(still)
    numbers = [(o.motion.V_n, o.motion.V_t, o.motion.Omega, o.barrier.V_bn) for o in (heavy, translating)]
    np.testing.assert_allclose(*numbers, rtol=1e-8)
    assert isinstance(translating.barrier.Omega_b, Unknown)


def test_a_light_block_that_turns_far_says_so():
    near = {"barrier.centre_depth": "5 mm", "barrier.centre_offset": "5 mm"}
    outcome = run(TURNING, near, {"barrier.inertia": "1e-6 kg m2"})
    assert any(
        "its surface is taken as level" in sentence for sentence in texts(outcome.validity.limitations)
    )


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"barrier.inertia": "1 kg m2", "barrier.centre_depth": "1 mm"}, "state its mass"),
        ({"barrier.mass": "1 kg", "barrier.inertia": "1 kg m2"}, "centre_depth.*is missing"),
        ({"barrier.mass": "1 kg", "barrier.centre_depth": "1 mm"}, "centre_depth.*does not turn"),
        ({"barrier.mass": "1 kg", "barrier.centre_offset": "1 mm"}, "centre_offset.*does not turn"),
        ({**TURNING, "barrier.inertia": "1 kg"}, "inertia"),
    ],
)
def test_a_barrier_that_is_half_stated_is_refused(changes, words):
    with pytest.raises(SceneError, match=words):
        replace_all(load("t5b"), changes)


def test_the_rigid_fidelity_refuses_it():
    with pytest.raises(SceneError, match=r"barrier\.inertia.*rigid fidelity does not hold"):
        run(TURNING, fidelity="rigid")


@pytest.mark.parametrize("slope", ["0 deg", "-50 deg"])
def test_the_error_of_angular_momentum_holds_nothing_of_gravity(slope):
    """Gravity pulls at the ball alone, with m g in the contact of .8 ms: that was 2.7 % of its moment."""
    slow = {"impact.v_n": "-0.02 m/s", "impact.v_t": "-0.01 m/s", "impact.slope": slope}
    outcome = run(BALL, TURNING, slow, {"effects": ["friction", "gravity", "barrier-elastic"]})
    assert known(outcome.barrier.angular_momentum_error) < 1e-4


BELOW = {
    "impact.v_t": "0 m/s",
    "barrier.mass": "2 kg",
    "barrier.inertia": "0.01 kg m2",
    "barrier.centre_depth": "30 mm",
    "barrier.centre_offset": "0 mm",
}
PLAIN = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"}


@pytest.mark.parametrize("tip", [{}, PLAIN], ids=["round edge", "sharp edge"])
def test_an_upright_rod_that_lands_over_the_mass_centre_turns_nothing(tip):
    outcome = run(tip, BELOW, {"impact.angle": "0 deg"})
    assert abs(outcome.motion.Omega) < 1e-6
    assert abs(known(outcome.barrier.Omega_b)) < 1e-6
    assert known(outcome.barrier.angular_momentum_error) < 1e-10


@pytest.mark.parametrize("angle", [90, -90])
@pytest.mark.parametrize("tip", [{}, PLAIN], ids=["round edge", "sharp edge"])
def test_a_rod_that_lands_on_its_side_keeps_the_angular_momentum_of_both(tip, angle):
    outcome = run(tip, BELOW, {"impact.angle": f"{angle} deg"})
    assert known(outcome.barrier.angular_momentum_error) < 1e-6
    assert known(outcome.barrier.momentum_error) < 1e-10
    assert abs(known(outcome.barrier.Omega_b)) < 1.0


def test_what_gravity_gives_between_contacts_is_no_impulse_on_a_barrier_that_turns():
    """A rubber bar touches twice; on a barrier too heavy to turn mu is that of a massive one."""
    bar = {
        "projectile": {"shape": "flat", "length": "12 mm", "diameter": "3 mm", "material": "natural-rubber"},
        "surface": {"state": "custom", "friction": 0.3, "source": "test"},
        "impact.angle": "88 deg",
        "impact.v_n": "-0.3 m/s",
        "impact.v_t": "0.25 m/s",
        "accuracy.across": 6,
    }
    heavy = {"barrier.mass": "1e9 kg", "barrier.inertia": "1e12 kg m2", "barrier.centre_depth": "0.1 m"}
    massive, turning = run(bar), run(bar, heavy)
    assert len(known(massive.contact.intervals)) > 1
    assert known(turning.restitution.mu) == pytest.approx(known(massive.restitution.mu), rel=1e-9)
