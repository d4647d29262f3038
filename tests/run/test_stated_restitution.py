"""Where the energy goes that a stated restitution takes, in the first impact and in later strikes."""

import pytest

from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import replace

ROD = {
    "id": "rod",
    "restitution": 0.5,
    "projectile": {
        "length": "80 mm",
        "diameter": "19 mm",
        "tip": "B",
        "tip_radius": "3 mm",
        "material": "rod-steel",
    },
    "barrier": {"material": "plate-steel"},
    "impact": {"angle": "45 deg", "v_n": "-2 m/s", "v_t": "-2 m/s", "slope": "0 deg"},
}
RUBBER = {"name": "a rubber", "E": "5 MPa", "nu": 0.49, "rho": "1100 kg/m3", "loss_factor": 0.3}
BALL = {"shape": "ball", "diameter": "20 mm", "material": RUBBER}
FOLLOWED = ("impact.until", "3 strikes")


def test_of_bodies_that_do_not_yield_it_is_assigned_to_none():
    scene = read_dict(ROD | {"effects": ["auto", "-rod-plasticity", "barrier-rigid"]})
    outcome = simulate(scene, "rigid")
    for work in (outcome.energy.plastic_rod, outcome.energy.plastic_barrier, outcome.energy.plastic):
        assert isinstance(work, Unknown) and "not assigned to a body that does not yield" in work.reason
    assert abs(outcome.energy.residual) < 1e-12
    assert "assigned to none" in " ".join(texts(outcome.validity.limitations, "model"))
    strikes = simulate(replace(scene, *FOLLOWED), "rigid").strikes
    assert (strikes.plastic, strikes.damping) == (0.0, 0.0)
    assert strikes.other > 0.1 * strikes.each[0].before and abs(strikes.residual) < 1e-12
    # without a loss there is nothing to assign
    assert simulate(replace(scene, "restitution", 1.0), "rigid").energy.plastic == pytest.approx(0.0)


def test_of_a_viscous_contact_it_is_damping():
    outcome = simulate(scene := read_dict(ROD | {"projectile": BALL}), "rigid")
    lost = 1.0 - outcome.energy.rigid - outcome.energy.friction
    assert outcome.energy.plastic == 0.0
    assert outcome.energy.damping == pytest.approx(lost, rel=1e-9)
    strikes = simulate(replace(scene, *FOLLOWED), "rigid").strikes
    assert strikes.plastic == strikes.other == 0.0 < strikes.damping
    assert abs(strikes.residual) < 1e-12


def test_of_bodies_that_yield_it_is_plastic_work():
    outcome = simulate(read_dict(ROD), "rigid")
    lost = 1.0 - outcome.energy.rigid - outcome.energy.friction
    assert outcome.energy.plastic == pytest.approx(lost, rel=1e-9)
    assert isinstance(outcome.energy.damping, Unknown)
