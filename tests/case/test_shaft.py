"""A shaft that the strike would make flow is told by the models that have none."""

from math import sqrt

import pytest

from fem_impact import load, replace_all, simulate
from fem_impact.case.case import Case
from fem_impact.case.shaft import shaft_flows

ROD = {"projectile.length": "0.12 m", "impact.angle": "0 deg", "impact.v_t": "0 m/s"}


def flows(**changed):
    return shaft_flows(Case(replace_all(load("t5b"), ROD | changed)).bodies)


def test_the_least_speed_is_that_of_a_plane_wave_at_the_yield_stress():
    steel = load("t5b").projectile.material
    limit = steel.yield_stress / sqrt(steel.E * steel.rho)
    # a rod so long and thin that the contact could press harder than a wave can
    thin = {"projectile.length": "0.6 m", "projectile.diameter": "6 mm", "projectile.tip_radius": "1 mm"}
    assert not flows(**thin | {"impact.v_n": f"{-0.99 * limit} m/s"})
    assert "would yield" in flows(**thin | {"impact.v_n": f"{-1.01 * limit} m/s"})


def test_a_short_rod_turns_back_before_the_wave_has_its_full_stress():
    told = flows(**{"impact.v_n": "-14 m/s"})
    assert not told, (
        "the force over the section is 14 m/s times the mass over the contact's time, below yield"
    )


@pytest.mark.parametrize("fidelity", ["rigid", "modal"])
def test_models_without_a_mesh_tell_it(fidelity):
    changed = {
        "projectile.diameter": "6 mm",
        "projectile.tip_radius": "1 mm",
        "impact.v_n": "-60 m/s",
        "impact.angle": "20 deg",
    }
    outcome = simulate(replace_all(load("t5b"), ROD | changed), fidelity)
    texts = [one.text for one in outcome.validity.limitations]
    assert any(text.startswith("Left out: a shaft that would yield") for text in texts), texts
