"""Friction over sliding speed, pressure and temperature: its grid, its tables, its names, its refusals."""

import pytest

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.scene.inputs import inputs
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.sliding import SlidingLaw
from fem_impact.scene.types import digest, to_dict

TABLE = {
    "speed": ["0 m/s", "1 m/s", "4 m/s"],
    "pressure": ["100 MPa", "300 MPa"],
    "factor": [[1.0, 0.8, 0.4], [0.9, 0.6, 0.2]],
    "source": "own tests",
}


def with_law(law):
    return replace(load("quick"), "surface.sliding_law", law)


def test_a_table_is_linear_between_its_points_and_constant_beyond():
    law = with_law(TABLE).surface.sliding_law
    assert law.over_speed(200e6, 293.0) == ((0.0, 1.0, 4.0), pytest.approx((0.95, 0.7, 0.3)))
    assert law.over_speed(900e6, 293.0)[1] == pytest.approx((0.9, 0.6, 0.2))
    assert law.over_speed(0.0, 293.0)[1] == pytest.approx((1.0, 0.8, 0.4))


def test_a_function_of_all_three_becomes_a_grid():
    law = SlidingLaw.of(
        lambda v, p, T: 0.5 / (1 + v) * (2e9 - p) / 1e9 * (600 - T) / 300,
        *((0.0, 1.0), (1e9, 1.5e9), (300.0, 400.0)),
        source="an example",
    )
    assert law.shape == (2, 2, 2)
    assert law.over_speed(1.25e9, 350.0)[1] == pytest.approx((0.75 * 5 / 6, 0.375 * 5 / 6))


def test_a_scene_keeps_its_law():
    for law in (TABLE, "dry-rail"):
        scene = with_law(law)
        assert read_dict(to_dict(scene)) == scene
        assert digest(scene) != digest(load("quick"))
        assert scene.surface.state == "machined"
    (row,) = [row for row in inputs(scene).rows if row[0] == "surface.sliding_law"]
    assert "Polach 2005" in row[2]


def test_the_shipped_law_is_that_of_its_source():
    law = with_law("dry-rail").surface.sliding_law
    for v, factor in zip(*law.over_speed(1e9, 293.0), strict=True):
        assert factor == pytest.approx(0.4 + 0.6 * 2.718281828 ** (-0.6 * v), abs=1e-4)


def test_the_pressure_is_that_of_the_estimated_contact_and_speeds_beyond_are_told():
    case = Case(with_law(TABLE))
    assert case.estimate.pressure > 300e6
    assert case.slots.friction_over_speed[1] == pytest.approx((0.9, 0.6, 0.2))
    told = " ".join(one.text for one in case.limitations)
    assert "beyond the law of friction, whose last value is used: a contact pressure of" in told
    smooth = Case(replace(with_law(TABLE), "effects", ["auto", "-friction"]))
    assert smooth.slots.friction_over_speed is None


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ("dry-rial", "Did you mean dry-rail?"),
        ({**TABLE, "speed": ["1 m/s", "2 m/s", "4 m/s"]}, "two speeds or more, from 0 on"),
        ({**TABLE, "speed": ["0 m/s", "2 m/s", "1 m/s"]}, "must grow"),
        ({**TABLE, "factor": [1.0, 0.8, 0.4]}, "is not 2 lists of 3 numbers"),
        ({**TABLE, "factor": [[1.0, 0.8], [0.9, "x"]]}, "must be numbers"),
        ({**TABLE, "factor": [[1.0, 0.8, 0.4], [0.9, 0.6, -0.2]]}, "must lie from 0 to 10"),
        ({**TABLE, "factor": [[0.57, 0.5, 0.3], [0.5, 0.4, 0.2]]}, "must begin with 1"),
        ({**TABLE, "speed": [0.0, 1.0, 4.0]}, "speed"),
        ({key: TABLE[key] for key in ("speed", "pressure", "factor")}, "source"),
    ],
)
def test_what_is_no_law_is_refused_with_its_key(law, words):
    with pytest.raises(SceneError) as refused:
        with_law(law)
    assert "surface.sliding_law" in str(refused.value) and words in str(refused.value)


def test_strikes_after_the_first_are_refused():
    scene = replace_all(load("quick"), {"surface.sliding_law": "dry-rail", "impact.until": "rest"})
    with pytest.raises(SceneError, match="strikes after the first do not know"):
        Case.of(scene, "rigid")
