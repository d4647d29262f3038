"""Arcs and corners of a body's convex outline: its lowest point at every inclination."""

from itertools import pairwise
from math import cos, pi, radians, sin

import numpy as np
import pytest

from rigid import SHAPES, Projectile, Turned, shapes
from rigid.strikes import Finish, FlightState, Pull, outline, sequence

L, R = 0.08, 9.5e-3
WAVY = np.array([[0.0, 0.0], [4e-3, 1e-3], [7e-3, 5e-3], [9e-3, 60e-3], [6e-3, 80e-3]])
BOTTLE = np.array([[0, 0], [0.5 * R, 0], [0.5 * R, 0.3 * L], [R, 0.4 * L], [0.8 * R, 0.7 * L], [R, L]])
OUTLINES = {
    "ball": shapes.ball(0.02),
    "ogive": shapes.ogive(0.2, 0.02, 3.0, 0.002),
    "cone": shapes.cone(0.1, 0.02, radians(20), 0.002, 0.0),
    "cut cone": shapes.cone(0.1, 0.02, radians(20), 0.0, 0.004),
    "smooth": shapes.smooth(WAVY),
    "bottle": BOTTLE,
}


def outline_of(body):
    return shapes.of_nose(body.nose, L) if isinstance(body, Projectile) else body.outline


BODIES = {
    **{name: Turned(line, ((line[-1, 1], 7850.0),)) for name, line in OUTLINES.items()},
    "A": Projectile(L, 2 * R, "A", 7e-3, 7850.0),
    "B": Projectile(L, 2 * R, "B", 3e-3, 7850.0),
    "half ball": Projectile(L, 2 * R, "B", R, 7850.0),
    "plain": Projectile(L, 2 * R, "plain", 0.0, 7850.0),
}


def height(rounds, alpha):
    """Return the height, m, of what is lowest over the tip's end at an inclination."""
    return min(
        one.z * cos(alpha) - one.x * sin(alpha) - one.radius * cos(min(max(alpha, one.low), one.high) - alpha)
        for one in rounds
    )


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("turned", [False, True])
def test_the_lowest_of_the_rounds_is_the_lowest_of_the_outline(name, turned):
    """To what the straight pieces of a stated curve leave off it."""
    body = BODIES[name].reversed() if turned else BODIES[name]
    line = outline_of(body)
    both = np.vstack([line * [-1, 1], line])
    rounds = body.rounds()
    for alpha in np.radians(np.linspace(-179.0, 179.0, 359)):
        lowest = (both[:, 1] * cos(alpha) - both[:, 0] * sin(alpha)).min()
        assert height(rounds, alpha) == pytest.approx(lowest, abs=3e-6)


@pytest.mark.parametrize("name", BODIES)
def test_the_rounds_go_around_the_body_and_are_its_mirror_image(name):
    rounds = BODIES[name].rounds()
    assert rounds[0].low == pytest.approx(-pi) and rounds[-1].high == pytest.approx(pi)
    for one, other in pairwise(rounds):
        assert one.high == pytest.approx(other.low, abs=1e-12)
        assert other.curve - one.curve in (0, 1)
    for one, other in zip(rounds, rounds[::-1], strict=True):
        mirrored = (-other.x, other.z, other.radius, -other.high, -other.low)
        assert one[:5] == pytest.approx(mirrored, abs=1e-12)


def test_a_curve_is_one_and_straight_parts_and_corners_part_them():
    curves = {name: BODIES[name].rounds()[-1].curve + 1 for name in BODIES}
    assert curves == {
        "ball": 1,
        "ogive": 3,
        "cone": 5,
        "cut cone": 6,
        "smooth": 3,
        "bottle": 6,
        "A": 5,
        "B": 4,
        "half ball": 3,
        "plain": 4,
    }
    ogive = {round(1e3 * one.radius) for one in BODIES["ogive"].rounds() if one.curve == 1}
    assert {2, 60} <= ogive
    assert set(SHAPES) >= {"A", "B", "plain"}


def test_a_collar_has_edges_and_a_rod_with_one_comes_to_rest():
    """The convex outline turns by 8 and 5 degrees there: as a curve of 84 mm radius it rocked for ever."""
    line = np.array([[0, 0], [5, 0], [6, 1], [6, 30], [10, 30], [10, 38], [6, 38], [6, 80]]) / 1e3
    body = Turned(line, ((0.08, 7830.0),))
    assert len(body.rounds()) == 10 and not any(one.radius for one in body.rounds())
    start = FlightState(0.0, float(body.arms(0.2).d_d), 0.0, 0.2, -0.98, -0.17, 0.0)
    found = sequence(outline(body), start, Pull(9.81, 0.0, body.k2, 0.2), lambda strike: 0.3)
    assert found.finish is Finish.RESTS
