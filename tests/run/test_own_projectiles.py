"""The shipped projectiles of own shapes, run on coarse meshes in each fidelity."""

from __future__ import annotations

import pytest

from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

SLOW = pytest.mark.slow
TIPS = {"tube": "0.6 mm", "ogive": "0.3 mm", "heavy-tail": "0.6 mm", "sphere-cone": "0.5 mm"}
QUICK = "sphere-cone"


def coarse(name):
    return replace_all(load(name), {"accuracy.tip_size": TIPS[name], "save.frames": 0})


@pytest.mark.long
@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n == QUICK else SLOW) for n in TIPS])
def test_an_own_projectile_is_run_on_finite_elements(name):
    scene = coarse(name)
    solid, rigid = simulate(scene, "solid"), simulate(scene, "rigid")
    assert solid.validity.finished
    assert abs(solid.energy.residual) < 1e-4
    assert solid.motion.mass == pytest.approx(rigid.motion.mass, rel=1e-9)
    assert solid.motion.k_squared == pytest.approx(rigid.motion.k_squared, rel=5e-3)
    assert solid.energy.vibration == pytest.approx(solid.energy.vibration_check, rel=0.02, abs=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("name", TIPS)
def test_an_own_projectile_is_run_by_its_modes(name):
    outcome = simulate(coarse(name), "modal")
    assert outcome.validity.finished
    assert abs(outcome.energy.residual) < 1e-4


@pytest.mark.long
def test_an_own_projectile_may_be_rigid_behind_its_nose():
    outcome = simulate(replace_all(coarse("ogive"), {"effects": ["auto", "-vibration"]}), "solid")
    assert outcome.validity.finished
    assert abs(outcome.energy.residual) < 1e-4


BALL = {
    "projectile": {"shape": "ball", "diameter": "20 mm", "material": "rod-steel"},
    "impact.v_n": "-1 m/s",
    "impact.v_t": "-1 m/s",
    "accuracy.across": 8,
    "accuracy.unresolved": "report",
    "save.frames": 0,
}


@pytest.mark.long
@pytest.mark.parametrize(
    "effects", [pytest.param(["friction"], marks=pytest.mark.slow), ["vibration", "friction"]]
)
def test_a_ball_is_round_everywhere(effects):
    """Far from its pole, too, it is meshed finely where it touches, and has a rest that may be rigid."""
    ball = BALL | {"effects": [*effects, "barrier-elastic"]}
    ends = []
    for angle in ("0 deg", "60 deg"):
        outcome = simulate(replace_all(load("t5b"), ball | {"impact.angle": angle}), "solid")
        assert outcome.validity.finished and abs(outcome.energy.residual) < 1e-6
        m, e = outcome.motion, outcome.restitution
        ends.append((m.V_n, m.V_t, m.Omega, e.edge.e, e.mu, outcome.energy.friction))
    assert ends[1] == pytest.approx(ends[0], rel=1e-6)
