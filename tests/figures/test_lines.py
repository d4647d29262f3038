"""Panels of lines as a reader sees them: nothing written over, names instead of numbers."""

import pytest

from fem_impact.figures import style
from fem_impact.figures.lines import Mark, Panel, Series, lines_figure
from fem_impact.tables.table import read_csv

MARKS = (Mark(28.7, "0.12 m"), Mark(26.45, "limit of Eq 29"), Mark(57.3, "0.24 m"))


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Draw panels and return the figure as it was saved."""
    kept, save = [], style.save
    monkeypatch.setattr(style, "save", lambda figure, path: (kept.append(figure), save(figure, path)))

    def draw(panels, shape="wide"):
        lines_figure(panels, tmp_path / "lines.svg", shape)
        kept[-1].draw_without_rendering()  # the file had other dots per inch
        return kept[-1]

    return draw


def panel(title, *labels, marks=()):
    return Panel(
        title, "gamma", "e", tuple(Series(label, [10.0, 120.0], [0.0, 1.0]) for label in labels), marks
    )


@pytest.mark.parametrize("shape", ["wide", "narrow"])
def test_one_legend_names_all_series_and_stands_under_the_panels(drawn, shape):
    labels = [f"a series with a long name {at}" for at in range(6)]
    figure = drawn([panel("elastic", *labels[:5]), panel("yielding", *labels)], shape)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == labels
    box = legend.get_window_extent()
    assert box.x0 >= 0 and box.x1 <= figure.bbox.x1 and box.y0 >= 0
    assert all(axes.get_tightbbox().y0 >= box.y1 for axes in figure.axes)


def test_one_series_needs_no_legend(drawn):
    assert drawn([panel("elastic", "one")]).legends == []


@pytest.mark.parametrize("shape", ["wide", "narrow"])
def test_words_of_near_marks_stand_apart(drawn, shape):
    figure = drawn([panel("elastic", "one", marks=MARKS), panel("yielding", "one", marks=MARKS)], shape)
    for axes in figure.axes:
        boxes = [text.get_window_extent() for text in axes.texts]
        assert not any(a.overlaps(b) for at, a in enumerate(boxes) for b in boxes[:at])


def test_names_stand_at_the_ticks_and_in_the_data(drawn, tmp_path):
    series = (
        Series("first", [-0.1, 0.9], [1.0, 2.0], "points"),
        Series("total", [0.1, 1.1], [3.0, 4.0], "rings"),
    )
    (axes,) = [
        one
        for one in drawn([Panel("e", "input", "index", series, names=("f", "angle"))]).axes
        if one.get_visible()
    ]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["f", "angle"]
    data = read_csv(tmp_path / "lines.csv")
    assert data.texts("x") == ["f", "angle", "f", "angle"]
    assert data.numbers("y").tolist() == [1.0, 2.0, 3.0, 4.0]


def test_areas_are_stacked_in_order(drawn):
    areas = [Series(label, [0.0, 1.0], [1.0, 2.0], "area", "blue") for label in ("rigid", "vibration")]
    axes = drawn([Panel("shares", "gamma", "%", tuple(areas))]).axes[0]
    spans = [area.get_datalim(axes.transData).extents[[1, 3]].tolist() for area in axes.collections]
    assert spans == [[0.0, 2.0], [1.0, 4.0]]


def test_a_band_is_drawn_about_its_point_and_stands_in_the_data(drawn, tmp_path):
    values = Series("one", [1.0, 2.0, 3.0], [5.0, 6.0, float("nan")], "joined", 0, [0.5, float("nan"), 1.0])
    axes = drawn([Panel("e", "gamma", "e", (values,))]).axes[0]
    (container,) = axes.containers
    (bars,) = container[2]
    assert bars.get_segments()[0].tolist() == [[1.0, 4.5], [1.0, 5.5]]
    data = read_csv(tmp_path / "lines.csv")
    assert data.texts("band") == ["0.5", "", "1.0"] and data.texts("y") == ["5.0", "6.0", ""]
