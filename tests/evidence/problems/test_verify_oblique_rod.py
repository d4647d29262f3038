"""Oblique drops of an elastic rod beside modes, Hertz and friction."""

from math import cos, radians, sin

import pytest

from fem_impact.errors import SceneError
from fem_impact.evidence.problems.oblique_rod import NAMES
from fem_impact.evidence.problems.problem import verify

SHORT = {"length": "80 mm", "v_n": 2.97, "v_t": 2.97}
BRIEF = {"length": "50 mm", "v_n": 8.0, "max_time": 1e-5}
COARSE = SHORT | {"tip_size": "0.3 mm", "max_time": "0.3 ms"}


def checks(found):
    return {c.name: c for c in found.checks}


def drop(degrees, **changes):
    """Return a rod that falls straight down at 2.1 m/s onto a slope."""
    angle = radians(degrees)
    return {"angle": angle, "v_n": 2.1 * cos(angle), "v_t": 2.1 * sin(angle)} | changes


@pytest.mark.slow
def test_a_coarse_tip_on_a_rigid_plane():
    """A rigid plane is unlike the rod: with friction only the ratio of a sliding blow is judged."""
    found = verify("oblique-rod", COARSE | {"elastic_barrier": 0})
    assert found.passed
    values = checks(found)
    assert [values[name].kind for name in NAMES] == ["shown", "absolute", "shown"]
    assert values["restitution e"].error == pytest.approx(0.0, abs=4e-3)
    assert values["impulse ratio mu"].tolerance < 2e-3


@pytest.mark.slow
def test_a_coarse_tip_on_a_block_leans_and_bends():
    """A reference without them, its contacts half-spaces, has mu = 0.55 and a bending energy of 0.0058."""
    found = verify("oblique-rod", COARSE | {"f": 0.55})
    assert found.passed
    values = checks(found)
    assert values["impulse ratio mu"].computed < 0.546
    assert values["impulse ratio mu"].tolerance < 0.01


@pytest.mark.validation
@pytest.mark.parametrize("f", [0.0, 0.34, 0.55])
def test_the_long_rod_on_an_elastic_block(f):
    found = verify("oblique-rod", {"f": f})
    assert found.passed
    assert checks(found)["restitution e"].tolerance < 0.011


@pytest.mark.validation
@pytest.mark.parametrize("f", [0.0, 0.34, 0.55])
def test_the_short_rod_on_an_elastic_block(f):
    assert verify("oblique-rod", SHORT | {"f": f}).passed


@pytest.mark.validation
def test_the_short_rod_comes_nearer_with_smaller_cells():
    """Without the elastic bending of its edge the reference lies 13 % below the solver's limit."""
    errors = [
        checks(verify("oblique-rod", SHORT | {"f": 0.0, "tip_size": h}))["bending energy / E_0"].error
        for h in (6e-4, 3e-4, 1.5e-4)
    ]
    assert errors == sorted(errors, key=abs, reverse=True)
    assert abs(errors[-1]) < 1e-3


@pytest.mark.validation
@pytest.mark.parametrize(
    "changes",
    [
        drop(37, f=0.0),
        drop(37, f=0.57),
        {"f": 0.34, "angle": "60 deg"},
        {"f": 0.1, "angle": "60 deg"},
        SHORT | {"tip_size": "0.15 mm"},
        {"length": "120 mm", "f": 0.0, "angle": "30 deg"},
        {"length": "80 mm", "f": 0.2, "angle": "20 deg"},
    ],
)
def test_other_lengths_and_angles(changes):
    assert verify("oblique-rod", changes).passed


@pytest.mark.validation
def test_a_graze_between_two_contacts_with_a_rigid_plane():
    """Cells of 0.6 mm miss the graze, 2 % of the impulse, that modes and small cells have: e .86, not .83."""
    found = verify("oblique-rod", {"f": 0.0, "elastic_barrier": 0})
    assert found.passed
    assert checks(found)["contacts"].computed == 3


@pytest.mark.validation
def test_a_rod_that_sticks_to_a_rigid_plane_is_shown():
    found = verify("oblique-rod", drop(37, f=0.57, elastic_barrier=0, tip_size="0.3 mm"))
    assert found.passed
    assert checks(found)["impulse ratio mu"].kind == "shown"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"length": "25 mm"}, "2.5 to 100 times the diameter"),
        (BRIEF | {"f": 0.0, "elastic_barrier": 0, "tip_size": "0.5 mm"}, "ends in mid contact"),
        ({"tip_size": "0.8 mm"}, "as narrow on either side"),
        ({"angle": "6 deg"}, "over the end of the rounded edge"),
        ({"v_n": 150.0}, "over the end of the rounded edge"),
    ],
)
def test_what_the_reference_is_not_for_is_refused(changes, words):
    with pytest.raises(SceneError, match=words):
        verify("oblique-rod", changes)
