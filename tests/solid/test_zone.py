"""The fine zone of the barrier: where its surface may flow."""

import pytest

from fem_impact.estimates import contact_estimate
from fem_impact.scene import load
from fem_impact.solid.geometry import DRAG, SLIDE, build_geometry, half_widths

SCENE = load("t6-17").replace("accuracy.tip_size", "0.6 mm")


def _reach(scene):
    """Return the extent of the finest cells down and up the slope over the half-width along t."""
    geometry = build_geometry(scene, 2e-6, True)
    block = geometry.barrier
    t = block.points[block.cells[block.level == geometry.levels], 0]
    return -t.min() / _half_width(scene, geometry), t.max() / _half_width(scene, geometry)


def _half_width(scene, geometry):
    return half_widths(contact_estimate(scene), geometry.tip_size)[0]


def test_it_follows_the_surface_that_a_sticking_rod_drags_down_the_slope():
    down, up = _reach(SCENE)
    assert 1 + DRAG <= down and 1 <= up < 1 + DRAG


def test_without_sliding_it_lies_even():
    down, up = _reach(SCENE.replace("impact.v_t", "0 m/s"))
    assert 1 <= down < 1 + DRAG
    assert down == pytest.approx(up, rel=0.2)


def test_it_follows_a_long_slide():
    steep = SCENE.replace("impact.v_t", "-20 m/s")
    slide = SLIDE * contact_estimate(steep).depth * 20 / -steep.impact.v_n
    half = _half_width(steep, build_geometry(steep, 2e-6, True))
    assert slide > DRAG * half
    assert _reach(steep)[0] >= 1 + slide / half
