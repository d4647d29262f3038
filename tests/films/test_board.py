"""The words around the views of a film: none is cut, and none runs into another."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.figure import Figure

from fem_impact.figures.still import QUIET
from fem_impact.films.film import TITLE, _title
from fem_impact.films.frame import (
    FrameLayout,
    SideBySideLayout,
    below,
    blank,
    clock,
    colour_bar,
    curve_axes,
    heading,
    limits_of,
    origin,
    picture,
)
from fem_impact.films.motion import FIELDS

LONG = "a rod of a title that somebody wrote with all that was known of surfaces, speed, angle and tip " * 3


def boxes(drawn: Figure):
    """Return the boxes of a figure's words, pixels from the upper left corner: left, top, right, bottom."""
    drawn.draw_without_rendering()
    found = [text.get_window_extent() for text in drawn.texts]
    return [(box.x0, drawn.bbox.y1 - box.y1, box.x1, drawn.bbox.y1 - box.y0) for box in found]


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize("count", [None, 3, 4])
def test_words_under_a_view_clear_the_view_the_bar_and_the_strip(field, count):
    frame = FrameLayout(1280, 720) if count is None else SideBySideLayout(1280, 720, count)
    view = frame.close if count is None else frame.views[1]
    drawn = blank(frame)
    colour_bar(drawn, frame, view, field, (-1.0, 1.0))
    if count:
        words = "one scale; deformation × 1000,\nfading to × 1 at the contact"
        below(drawn, frame, frame.views[0], words, QUIET)
    for left, top, right, bottom in boxes(drawn):
        assert view.top + view.height <= top
        assert bottom < frame.height - 176
        assert right - left < (130 if left == view.left else view.width)


class Pen:
    """Takes the place of a word that is written anew on every frame."""

    def text(self, place, text, font, **_):
        self.left = place[0] - font.getlength(text)


@pytest.mark.parametrize("title", [TITLE, LONG])
def test_a_title_ends_before_the_clock(title):
    frame, pen = FrameLayout(1280, 720), Pen()
    drawn = blank(frame)
    heading(drawn, frame, title)
    clock(pen, frame, 8000e-6)
    ((_, _, right, _),) = boxes(drawn)
    assert right < pen.left
    assert drawn.texts[0].get_text().split() == title.split()


def test_the_axis_of_the_force_ends_with_the_last_contact():
    time = np.linspace(0.0, 1.0, 101)
    curves = [(time, np.where(time < end, 50.0, 0.0)) for end in (0.2005, 0.1)]
    assert limits_of(curves) == (0.0, pytest.approx(0.22), 50.0)
    assert limits_of([(np.zeros(0), np.zeros(0))])[2] == 1.0


@pytest.mark.parametrize("count", [2, 3, 4])
def test_titles_of_rods_clear_the_heading_and_each_other(count):
    frame = SideBySideLayout(1280, 720, count)
    drawn = blank(frame)
    heading(drawn, frame, TITLE)
    for view in frame.views:
        _title(drawn, frame, view, LONG)
    (_, _, _, bottom), *titles = boxes(drawn)
    assert all(top >= bottom for _, top, _, _ in titles)
    assert all(a[2] <= b[0] for a, b in pairwise(titles))


def test_a_title_with_dollar_signs_is_no_formula():
    frame = FrameLayout(1280, 720)
    drawn = blank(frame)
    heading(drawn, frame, "costs $5 and $x_{$")
    assert picture(drawn).size == (1280, 720)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_the_origin_of_the_runs_lies_under_the_axes_of_time(count):
    frame = SideBySideLayout(1280, 720, count)
    drawn = blank(frame)
    origin(drawn, frame, [f"fem-impact 0.1.0 · scene {at}2f6a7b8c9d0e" for at in range(count)])
    axes = [curve_axes(drawn, frame, place, "time, µs", "normal force, kN") for place in frame.strips]
    ((_, top, _, _),) = boxes(drawn)
    for one in axes:
        assert drawn.bbox.y1 - one.xaxis.label.get_window_extent().y0 <= top
