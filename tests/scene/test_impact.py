"""The motion at first contact: three ways to state it, and what becomes of it when a scene is changed."""

from math import cos, hypot, radians, sin

import pytest

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import texts
from fem_impact.scene.impact import Impact
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import to_dict


def stated(**impact):
    data = to_dict(load("quick"))
    data.pop("measured", None)
    return read_dict(data | {"impact": {"angle": "30 deg", **impact}})


def test_a_drop_falls_from_its_height_along_the_axis():
    impact = stated(height="0.82 m").impact
    speed = (2 * 9.80665 * 0.82) ** 0.5
    assert hypot(impact.v_n, impact.v_t) == pytest.approx(speed, rel=1e-12)
    assert impact.v_t / impact.v_n == pytest.approx(0.57735, rel=1e-5)


def test_a_speed_goes_along_the_axis():
    impact = stated(speed="2 m/s", omega="5 rad/s").impact
    assert (impact.v_n, impact.v_t) == pytest.approx(
        (-2 * cos(radians(30)), -2 * sin(radians(30))), rel=1e-12
    )
    assert impact.omega == 5.0


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"height": "1 m", "speed": "2 m/s"}, "impact: states the velocity twice, by height and by speed"),
        ({"speed_m_per_s": 2.0, "v_n": "-1 m/s"}, "twice, by speed and by v_n"),
        ({"height": "1 m", "v_n": "-1 m/s", "v_t": "0 m/s"}, "twice, by height and by v_n and v_t"),
        ({}, "does not say how fast the body comes. Give a height"),
        ({"v_n": "-1 m/s"}, "impact.v_t: is missing"),
        ({"height": "-1 m"}, "impact.height = -1 m"),
        ({"height": "13 km/s"}, "impact.height"),
        ({"speed": "600 m/s"}, "impact.speed = 600 m/s"),
        ({"hight": "1 m"}, "impact.hight: is not a known key. Did you mean height"),
    ],
)
def test_a_motion_is_stated_in_one_way(given, said):
    with pytest.raises(SceneError) as refused:
        stated(**given)
    assert said in str(refused.value)


def test_objects_are_held_to_what_they_state():
    with pytest.raises(SceneError, match="height"):
        Impact(0.5, -1.0, -1.0, height=1.0)
    with pytest.raises(SceneError, match="height"):
        Impact(0.0, -4.429, 0.0, height=1.0, speed=4.429)


@pytest.mark.parametrize("way", [{"height": "0.2 m"}, {"speed": "1.98 m/s"}])
def test_a_new_angle_keeps_the_way_a_fall_is_stated(way):
    before, after = stated(**way), replace(stated(**way), "impact.angle", "45 deg")
    assert after.impact.stated == before.impact.stated == tuple(way)
    assert after.impact.v_t == pytest.approx(after.impact.v_n, rel=1e-12)


def test_a_measured_drop_at_a_new_angle_falls_as_fast_and_is_no_longer_measured():
    old, new = load("t5b"), replace(load("t5b"), "impact.angle", "80 deg")
    assert new.impact.speed == hypot(old.impact.v_n, old.impact.v_t)
    assert new.measured is None and "impact.angle = 80 deg" in new.title
    sentences = " ".join(texts(Case.of(new, "rigid").limitations, "range", "model"))
    assert "angle 80 deg, measured 17 deg to 60 deg" in sentences and "beside its axis" not in sentences


def test_the_order_of_changes_does_not_matter():
    changes = {"projectile.length": "100 mm", "impact.angle": "30 deg"}
    one = replace_all(load("t5b"), changes)
    other = replace_all(load("t5b"), dict(reversed(changes.items())))
    third = replace(replace(load("t5b"), "projectile.length", "100 mm"), "impact.angle", "30 deg")
    assert one.impact == other.impact == third.impact


@pytest.mark.parametrize(
    ("changes", "way", "v"),
    [
        ({"impact.v_n": "-1 m/s", "impact.v_t": "-1 m/s"}, ("v_n", "v_t"), (-1.0, -1.0)),
        ({"impact.height_m": 0.5, "impact.angle": "0 deg"}, ("height",), (-(9.80665**0.5), 0.0)),
        ({"impact.omega": "3 rad/s"}, ("speed",), (-(3**0.5), -1.0)),
    ],
)
def test_a_changed_velocity_takes_the_place_of_the_stated_one(changes, way, v):
    impact = replace_all(stated(speed="2 m/s"), changes).impact
    assert impact.stated == way
    assert (impact.v_n, impact.v_t) == pytest.approx(v, rel=1e-12)


@pytest.mark.parametrize(("one", "other"), [("v_n", "v_t"), ("v_t", "v_n")])
@pytest.mark.parametrize("way", ["speed", "height"])
def test_one_velocity_alone_of_a_fall_is_refused_with_what_to_do(one, other, way):
    scene = stated(**{way: "2 m" if way == "height" else "2 m/s"})
    words = rf"impact\.{one}.*states its impact by {way}.*Change impact\.{way}.*add impact\.{other}"
    with pytest.raises(SceneError, match=words):
        replace(scene, f"impact.{one}", "-1 m/s")


def test_velocities_beside_the_axis_stay_what_they_are():
    before = stated(v_n="-1 m/s", v_t="-1 m/s")
    after = replace(before, "impact.angle", "20 deg").impact
    assert (after.v_n, after.v_t) == (-1.0, -1.0)
