"""The worst inclination of a verdict, and the change that it proposes to allow, by stated changes."""

import math
import re
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fem_impact.answers.verdict import vibration
from fem_impact.answers.verdict.assess import TOLERANCE, Verdict, assess
from fem_impact.answers.verdict.sentences import box
from fem_impact.answers.verdict.vibration import VibrationEffect
from fem_impact.scene.shipped import load, replace_all

WIDE, NARROW = (0.03, 0.1), (0.045, 0.001)
"""Value and band of a small change that decides nothing, and of a larger one that is allowed."""


def change(value, band, angle=0.0):
    return VibrationEffect("e", angle, value, band, 0.0, 0.0, None, None, "", "", {})


def verdict(here, elsewhere=None, **stated):
    """A verdict of t5b with two changes."""
    made = Verdict(
        load("t5b"), TOLERANCE, "e", "modal", None, here, elsewhere, ((), ""), None, (), (), {"budget_s": 90}
    )
    return replace(made, **stated)


@pytest.fixture
def by_angle(monkeypatch):
    """Let the reduced model tell changes by the inclination in degrees, those of None at all others."""
    told = {}

    def effect(scene, pair, of):
        at = round(math.degrees(scene.impact.angle))
        return change(*told.get(at, told[None]), scene.impact.angle)

    monkeypatch.setattr(vibration, "modal_pair", lambda scene: None)
    monkeypatch.setattr(vibration, "unfinished", lambda pair, of: "")
    monkeypatch.setattr(vibration, "modal_effect", effect)
    return told


def test_the_change_that_answers_worst_comes_before_the_largest():
    wide, narrow = change(*WIDE), change(*NARROW)
    assert (wide.graded(TOLERANCE), narrow.graded(TOLERANCE)) == ("undecided", "yes")
    for order in ([wide, narrow], [narrow, wide]):
        assert vibration.worst(order, TOLERANCE) is wide
    larger = replace(wide, value=-0.04)
    assert vibration.worst([wide, larger, narrow], TOLERANCE) is larger  # of those that answer alike


@pytest.mark.parametrize("side", [1, -1])
def test_the_worst_inclination_of_an_assessment_is_the_one_that_answers_worst(by_angle, side):
    by_angle |= {None: NARROW, 20 * side: WIDE}
    found = assess(replace_all(load("t5b"), {"impact.angle": f"{45 * side} deg"}), "modal")
    assert found.answer == "yes" and found.worst is found.elsewhere
    assert math.degrees(found.worst.angle) == pytest.approx(20 * side)
    assert found.worst.graded(found.tolerance) == found.worst_answer == "undecided"


def test_here_is_the_worst_where_a_larger_change_elsewhere_is_surely_allowed():
    found = verdict(change(*WIDE), change(*NARROW))
    assert found.worst is found.here and found.worst_answer == "undecided"


@pytest.fixture(scope="module")
def real():
    """The verdict by the reduced model, of which the twins are needed for its sentences."""
    scene = replace_all(load("t5b"), {"restitution": 0.4})
    return vibration.modal_effect(scene, vibration.modal_pair(scene))


@pytest.mark.parametrize(("side", "over"), [(1, "from 5 to 80 degrees"), (-1, "from -5 to -80 degrees")])
def test_the_inclinations_that_were_looked_at_are_told_on_their_side(real, side, over):
    scene = replace_all(load("t5b"), {"restitution": 0.4, "impact.angle": f"{45 * side} deg"})
    here, other = (replace(real, value=value, band=0.01) for value in (0.01, 0.02))
    for elsewhere in (other, replace(other, value=0.005)):
        told = box(verdict(here, elsewhere, scene=scene))[0][1]
        assert f"inclination {over}" in told and "every inclination." not in told


def test_the_worst_inclination_is_told_with_its_own_answer(real):
    elsewhere = replace(real, value=WIDE[0], band=WIDE[1], angle=math.radians(20))
    told = box(verdict(replace(real, value=NARROW[0], band=NARROW[1]), elsewhere))[0][1]
    assert told.startswith("YES") and "At the worst inclination, 20 degrees" in told
    assert "it changes e by +0.030 ± 0.100; whether rigid theory may be used there is undecided." in told


@given(st.floats(-0.4, 0.4), st.floats(1e-3, 0.5))
def test_the_change_that_a_verdict_proposes_to_allow_makes_it_a_yes(value, band):
    open_ = verdict(change(value, band))
    assume(open_.missing)
    proposed = float(re.search(r"or a change of (\S+) that may be neglected", open_.missing)[1])
    assert replace(open_, tolerance=proposed).answer == "yes"
