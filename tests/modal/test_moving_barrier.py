"""Free and moving barriers without a mesh: two-body theory, momentum, and the frame of the observer."""

import numpy as np
import pytest

import rigid
from fem_impact.case.case import Case
from fem_impact.outcome.groups import texts
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from rigid.finite import solve_free

FREE = {"barrier.mass": "0.5 kg"}
MOVING = {
    "barrier.v_n": "0.5 m/s",
    "barrier.v_t": "0.2 m/s",
    "impact.v_n": "-1.0024 m/s",
    "impact.v_t": "-1.2821 m/s",
}
GAINED = np.array([0.5, 0.2, 0.0])
BOTH = pytest.mark.parametrize("fidelity", ["rigid", "modal"])


def run(fidelity, *changes):
    whole = {key: value for change in changes for key, value in change.items()}
    return simulate(replace_all(load("t5b"), whole), fidelity)


def motion(outcome):
    return np.array([outcome.motion.V_n, outcome.motion.V_t, outcome.motion.Omega])


@BOTH
def test_the_coefficients_of_a_free_barrier_give_its_motion_back_by_two_body_theory(fidelity):
    outcome = run(fidelity, FREE)
    m, b, one = outcome.motion, outcome.barrier, outcome.restitution.edge
    body = {"d_c": one.d_c, "d_d": one.d_d, "k2": m.k_squared, "mass_ratio": m.mass / 0.5}
    after = solve_free(m.v_n, m.v_t, e=one.e, mu=outcome.restitution.mu, e_m=one.e_m, **body)
    found = (m.V_n, m.V_t, m.Omega, b.V_bn, b.V_bt)
    assert found == pytest.approx([float(v) for v in after], rel=1e-9)
    assert b.momentum_error < 1e-12 and abs(outcome.energy.residual) < 1e-5


@BOTH
def test_only_the_relative_motion_matters(fidelity):
    still, moving = run(fidelity, FREE), run(fidelity, FREE, MOVING)
    assert motion(moving) == pytest.approx(motion(still) + GAINED, rel=1e-9)
    assert moving.restitution.edge.e == pytest.approx(still.restitution.edge.e, rel=1e-9)
    assert moving.energy.rigid == pytest.approx(still.energy.rigid, rel=1e-9)


@BOTH
def test_a_very_heavy_barrier_is_a_massive_one(fidelity):
    assert motion(run(fidelity, {"barrier.mass": "1e9 kg"})) == pytest.approx(motion(run(fidelity)), rel=1e-8)


def test_a_massive_barrier_that_moves_gives_energy_and_keeps_its_speed():
    outcome = run("rigid", MOVING)
    assert (outcome.barrier.V_bn, outcome.barrier.V_bt) == (0.5, 0.2)
    scene = load("t5b")
    d_c, d_d = Case(scene).contact.arms
    general = rigid.General(
        -1.0024,
        -1.2821,
        e=outcome.restitution.edge.e,
        mu=outcome.restitution.mu,
        d_c=d_c,
        d_d=d_d,
        mass=scene.projectile.rigid_body.mass,
        k2=scene.projectile.rigid_body.k2,
        v_bn=0.5,
    ).solve()
    assert motion(outcome) == pytest.approx([float(v) for v in general], rel=1e-9)


def test_an_elastic_rod_and_a_free_mass_part_with_the_speed_of_their_approach():
    upright = {"impact.angle": "0 deg", "impact.v_t": "0 m/s", "projectile.tip": "A"}
    elastic = {"effects": ["barrier-elastic"], "projectile.tip_radius": "7 mm"}
    outcome = run("modal", FREE, upright, elastic)
    m, M = outcome.motion.mass, 0.5
    v = outcome.motion.v_n
    assert outcome.motion.V_n == pytest.approx((m - M) / (m + M) * v, rel=1e-6)
    assert outcome.barrier.V_bn == pytest.approx(2 * m / (m + M) * v, rel=1e-6)


@pytest.mark.parametrize("name", ["plate-10mm", "free-barrier-5kg", "moving-barrier", "spinning-rod"])
def test_a_shipped_scene_runs_and_says_that_nothing_was_measured_there(name):
    outcome = simulate(load(name), "modal")
    assert outcome.validity.finished and abs(outcome.energy.residual) < 1e-4
    assert any(
        "outside the measured range" in sentence for sentence in texts(outcome.validity.limitations, "range")
    )


@pytest.mark.parametrize("v_n", [-0.02, -0.2])
def test_what_gravity_gives_while_a_slow_rod_touches_is_no_error_of_the_momentum(v_n):
    slow = {"barrier.mass": "5 kg", "impact.angle": "30 deg", "impact.v_n": f"{v_n} m/s"}
    outcome = simulate(replace_all(load("quick"), slow | {"impact.v_t": "0 m/s"}), "modal")
    assert "gravity" in outcome.provenance.effects
    touched = sum(one.end - one.start for one in outcome.contact.intervals)
    assert outcome.barrier.momentum_error < 0.05 * 9.81 * touched / abs(v_n)
    assert outcome.barrier.momentum_error < 1e-3
