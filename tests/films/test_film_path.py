"""The film of a body from strike to strike."""

from itertools import pairwise

import numpy as np
import pytest

from fem_impact.figures.runs import body_line, placed, state_at
from fem_impact.films import path
from fem_impact.films.movement import FPS
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from rigid import GRAVITY
from rigid.strikes import outline

FALL = {"impact.slope": "0 deg", "impact.angle": "75 deg", "impact.v_t": "0 m/s", "restitution": 0.5}


def film(**changes):
    scene = replace_all(
        load("quick"), FALL | {"impact.until": "4 strikes", "surface.friction": 0.3} | changes
    )
    shape = outline(scene.projectile.rigid_body)
    each = simulate(scene, "rigid").strikes.each
    return each, shape, list(path._course(each, shape, (GRAVITY, 0.0)))


@pytest.fixture(scope="module")
def followed():
    return film()


def test_the_body_touches_at_its_strikes_and_lies_over_the_barrier_between_them(followed):
    each, shape, frames = followed
    heights = [placed(body_line(shape), one.state)[:, 1].min() for one in frames]
    assert min(heights) > -1e-6
    held = [frame for frame in frames if frame.words.startswith("strike")]
    assert len(held) == len(each) * round(path.HELD * FPS)
    assert max(placed(body_line(shape), one.state)[:, 1].min() for one in held) < 2e-5
    assert max(heights) > 1e-4  # it flies


def test_a_body_that_pivots_lies_on_the_barrier_and_the_film_says_so():
    _, shape, frames = film(**{"restitution": 0.0, "impact.angle": "40 deg", "surface.friction": 0.6})
    assert any(one.words == path.TURNED for one in frames)
    assert max(abs(placed(body_line(shape), one.state)[:, 1].min()) for one in frames) < 2e-5


def test_a_flight_ends_where_the_next_strike_begins_and_is_shortened(followed):
    each, shape, frames = followed
    longest = max(after.time - before.time for before, after in pairwise(each))
    for number, (before, after) in enumerate(pairwise(each), 1):
        flown = [one for one in frames if one.struck == number and not one.words.startswith("strike")]
        end, state = flown[-1].state, state_at(after, shape)
        assert end.time == pytest.approx(after.time, rel=1e-9)
        assert (end.alpha, end.along) == pytest.approx((state.alpha, state.along), abs=1e-9)
        share = (after.time - before.time) / longest
        assert path.LEAST <= len(flown) <= max(path.LEAST, 1 + path.FLIGHT * FPS * share)


def test_a_picture_shows_the_body_where_it_is(followed):
    each, shape, frames = followed
    one, other = path._drawn([frames[0], frames[-1]], each, shape, "a rod", (320, 176))
    assert (one.size, one.mode) == ((320, 176), "RGB")
    assert np.mean(np.asarray(one) != np.asarray(other)) > 0.01
