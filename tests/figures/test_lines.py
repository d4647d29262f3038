"""Panels of lines as a reader sees them: nothing written over, names instead of numbers."""

from dataclasses import replace

import numpy as np
import pytest

from fem_impact.figures import still
from fem_impact.figures.live import live
from fem_impact.figures.panels import Mark, Panel, Picture, Series, ShadedInterval, ShadedMap, error_bars
from fem_impact.figures.still import draw
from fem_impact.tables.table import read_csv

MARKS = (Mark(28.7, "0.12 m"), Mark(26.45, "limit of Eq 29"), Mark(57.3, "0.24 m"))


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Draw panels and return the figure as it was saved."""
    kept, save = [], still.save
    monkeypatch.setattr(still, "save", lambda figure, path: (kept.append(figure), save(figure, path)))

    def drawn_of(panels):
        draw(picture(panels), tmp_path / "lines.svg")
        kept[-1].draw_without_rendering()  # the file had other dots per inch
        return kept[-1]

    return drawn_of


def picture(panels):
    return Picture("lines", "Lines.", tuple(panels))


def panel(title, *labels, marks=()):
    return Panel(
        title, "gamma", "e", tuple(Series(label, [10.0, 120.0], [0.0, 1.0]) for label in labels), marks
    )


def test_one_legend_names_all_series_and_stands_under_the_panels(drawn):
    labels = [f"a series with a long name {at}" for at in range(6)]
    figure = drawn([panel("elastic", *labels[:5]), panel("yielding", *labels)])
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == labels
    box = legend.get_window_extent()
    assert box.x0 >= 0 and box.x1 <= figure.bbox.x1 and box.y0 >= 0
    assert all(axes.get_tightbbox().y0 >= box.y1 for axes in figure.axes)


def test_one_series_needs_no_legend(drawn):
    assert drawn([panel("elastic", "one")]).legends == []


def test_words_of_near_marks_stand_apart(drawn):
    figure = drawn([panel("elastic", "one", marks=MARKS), panel("yielding", "one", marks=MARKS)])
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


@pytest.mark.parametrize(("count", "look"), [(2, "points"), (3, "points"), (4, "joined")])
def test_two_or_three_values_are_points_without_a_line(drawn, count, look):
    series = Series("one", range(count), [*range(count - 1), 1.0], "joined")
    assert series.drawn == look
    (line,) = drawn([Panel("e", "gamma", "e", (series,))]).axes[0].lines
    assert (line.get_linestyle() == "None") == (look == "points")
    mode = live(picture([Panel("e", "gamma", "e", (series,))]))["panels"][0]["data"][0]["mode"]
    assert ("lines" in mode) == (look == "joined")


def test_a_gap_is_no_value(drawn):
    assert Series("one", range(4), [1.0, float("nan"), 2.0, 3.0], "joined").drawn == "points"


def test_a_live_panel_holds_bands_names_marks_and_intervals():
    values = Series("e of E_0", [0.0, 1.0], [5.0, float("nan")], "points", 0, [0.5, float("nan")])
    shown = Panel("T1/tau", "set", "e_m", (values,), MARKS, (Mark(1.0, "one"),), ("t2", "t4"))
    told = live(picture([replace(shown, intervals=(ShadedInterval(0.0, 0.5, "contact"),))]))["panels"][0]
    (trace,) = told["data"]
    assert trace["y"] == [5.0, None] and trace["error_y"]["array"] == [0.5, None]
    assert told["title"] == "<i>T</i><sub>1</sub>/τ"
    layout = told["layout"]
    assert layout["xaxis"]["ticktext"] == ["t2", "t4"]
    assert layout["yaxis"]["title"]["text"] == "<i>e</i><sub>m</sub>"
    assert {note["text"] for note in layout["annotations"]} == {mark.label for mark in MARKS} | {
        "one",
        "contact",
    }
    assert [shape["type"] for shape in layout["shapes"]] == ["line"] * 4 + ["rect"]


def test_bands_lie_along_the_rows_of_a_panel(drawn):
    values = Series("model", [1.0], [0], "diamonds", band=[0.25])
    panel = Panel("", "e", "", (values,), rows=("t2",))
    (container,) = drawn([panel]).axes[0].containers
    assert container[2][0].get_segments()[0].tolist() == [[0.75, 0.0], [1.25, 0.0]]
    assert live(picture([panel]))["panels"][0]["data"][0]["error_x"]["array"] == [0.25]


def test_bars_are_stacked_from_the_left(drawn):
    bars = [Series(name, [3.0, 1.0], [0, 1], "bars") for name in ("rigid", "vibration")]
    axes = drawn([Panel("", "%", "", tuple(bars), rows=("t2", "t4"))]).axes[0]
    assert [patch.get_x() for patch in axes.patches] == [0.0, 0.0, 3.0, 1.0]


def test_a_shaded_map_has_its_values_and_ends(drawn):
    shaded = ShadedMap([0.0, 1.0], [0.0, 1.0, 2.0], [[1.0, -2.0]] * 3, 2.0, "strain")
    panel = Panel("", "x", "t", (), shaded=shaded)
    assert drawn([panel]).axes[0].collections[0].get_clim() == (-2.0, 2.0)
    (trace,) = live(picture([panel]))["panels"][0]["data"]
    assert trace["z"] == [[1.0, -2.0]] * 3 and (trace["zmin"], trace["zmax"]) == (-2.0, 2.0)


def test_error_bars_end_where_numbers_do():
    share = Series("E_vib", [1.0, 2.0], [0.1, 0.95], band=[0.3, 0.02], ends=(0.0, 1.0))
    assert error_bars(share, horizontal=False) == pytest.approx(np.array([[0.1, 0.02], [0.3, 0.02]]))
    (drawn,) = live(picture([Panel("t", "x", "y", (share,))]))["panels"][0]["data"]
    assert drawn["error_y"]["arrayminus"] == [0.1, 0.02] and drawn["error_y"]["array"] == [0.3, 0.02]
    assert drawn["customdata"][0] == "0.10 (0.00 to 0.40)"
