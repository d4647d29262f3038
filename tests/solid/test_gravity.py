"""A slow rod in gravity: it starts in touch, and what gravity gives it in contact is told."""

from math import cos, pi

import pytest
import solid_scenes as scenes

from fem_impact.case.case import Case
from fem_impact.outcome.groups import texts
from fem_impact.run.solid import reduce
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.run import solve

SLOW = {"length": 0.08, "v_n": -0.01, "v_t": -0.01, "f": 0.0, "tip": 1.6e-3}
PLANE = ("vibration", "friction", "barrier-rigid")


def run(*effects, **changes):
    return solve(Case.of(scenes.scene(*effects, **changes)))


@pytest.mark.parametrize("barrier", ["barrier-rigid", "barrier-elastic", "barrier-elastoplastic"])
def test_the_first_step_touches(barrier):
    """A fall from 2 um takes 0.1 ms at 20 mm/s: gravity and spin changed what the scene states at contact."""
    model = scenes.model("vibration", "friction", barrier, length=0.08, v_n=-0.3, v_t=-0.1)
    state = model.initial_state()
    for _ in range(2):
        evaluate(model, state)
        advance(model, state)
    assert model.book.intervals[0].start <= model.step


def test_the_contact_bears_gravity_and_the_outcome_says_so():
    on, off = (run(*PLANE, *gravity, **SLOW) for gravity in (("gravity",), ()))
    with_it, without = reduce(on), reduce(off)
    assert with_it.energy.E_0 == pytest.approx(without.energy.E_0, rel=1e-9)
    touch = on.model.book.intervals[0]
    borne = 9.80665 * cos(pi / 4) * (touch.end - touch.start) / 0.01
    assert 0.03 < borne < 0.1
    gained = with_it.restitution.edge.e - without.restitution.edge.e
    assert abs(gained) < 0.1 * borne
    assert any("Gravity gives the rod" in told for told in texts(with_it.validity.limitations))
    assert not any("Gravity" in told for told in texts(without.validity.limitations))


def test_an_impact_in_which_gravity_rules_is_no_result():
    told = reduce(run(*PLANE, "gravity", **SLOW | {"v_n": -5e-4, "v_t": -5e-4})).validity
    assert not told.finished
    assert "no impact any more" in told.stopped_because
