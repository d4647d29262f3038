"""Reports of what accuracy costs: the answer, the plot of error against time, the tables."""

import pytest

from fem_impact.answers.cost.judge import Judged
from fem_impact.answers.cost.measure import PLACES, CostStudy
from fem_impact.answers.refine.extrapolate import QuantityLimit
from fem_impact.evidence.studies.cost_report import FRONT, paper_report, scene_report
from fem_impact.figures import still
from fem_impact.figures.live import live
from fem_impact.scene.shipped import load

pytestmark = pytest.mark.usefixtures("unrendered")

NAMES = ("e", "mu", "E_vib")


def setting(kind, cpu_s, error, name=None, default=False):
    return Judged(
        name=name or kind,
        kind=kind,
        levels=3 if kind in PLACES.values() else 0,
        default=default,
        tip_size_m=None,
        value=dict.fromkeys(NAMES, 0.5),
        error=dict.fromkeys(NAMES, error),
        cpu_s=cpu_s,
        two_cores_s=cpu_s,
    )


def study(settings, scene="t5b"):
    limits = dict.fromkeys(NAMES, QuantityLimit(0.5, 0.01, 0.5))
    return CostStudy(load(scene), limits, {}, sorted(settings, key=lambda one: one.cpu_s), [], {})


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Return the plot of a rigid run and a mesh whose errors, of 1, lie so far apart."""
    kept = []
    monkeypatch.setattr(still, "save", lambda figure, path: kept.append(figure))

    def draw(rigid, mesh, names=("e",)):
        settings = [setting("rigid", 1e-4, rigid), setting("levels", 30.0, mesh)]
        still.draw(scene_report(study(settings), names).pictures[0], tmp_path / "x.svg")
        kept[0].draw_without_rendering()
        return [axes for axes in kept[0].axes if axes.get_visible()]

    return draw


def shown(axis):
    """Return the words at the ticks that lie within the axis."""
    low, high = axis.get_view_interval()
    both = zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)
    return [label.get_text() for at, label in both if low <= at <= high]


@pytest.mark.long
@pytest.mark.parametrize("errors", [(0.275, 0.115), (0.27, 0.085), (2.1, 0.8), (0.5, 0.004), (0.9, 0.00002)])
def test_ticks_are_at_least_two_plain_numbers(drawn, errors):
    (axes,) = drawn(*errors)
    words = shown(axes.yaxis)
    assert len(words) > 1
    assert [f"{float(word):g}" for word in words] == words
    assert not any(label.get_text() for label in axes.yaxis.get_minorticklabels())
    assert {"0.001", "10"} <= set(shown(axes.xaxis))


def test_every_panel_has_its_times_and_no_panel_is_empty(drawn):
    panels = drawn(0.2, 0.1, ("e", "mu", "E_vib"))
    assert [axes.get_title(loc="left") for axes in panels] == ["e", "µ", r"$E_{\mathrm{vib}}$"]
    assert all(axes.xaxis.get_tick_params()["labelbottom"] for axes in panels)


RUNG = [
    setting("rigid", 1e-4, 0.3),
    setting("levels", 10.0, 0.04, "3 levels", default=True),
    setting("two places", 25.0, 0.05),
    setting("variant", 12.0, 0.01, "default run without savings"),
]


def test_the_answer_comes_first_and_names_the_default_run():
    (answer,) = scene_report(study(RUNG), ("e", "mu")).findings
    assert answer == (
        "No setting brings e and mu within 2 %; best: 3 levels, error 4 % in 10 s. "
        "The default run takes 10 s of processor time; its bands are 4 % of e and 4 % of mu."
    )
    (answer,) = scene_report(study(RUNG), ("e",), 0.05).findings
    assert answer.startswith("Cheapest within 5 % of e: 3 levels, error 4 % in 10 s. The default run")


def test_a_quantity_is_answered_alone_only_where_another_setting_serves_it():
    quick = setting("modal", 0.01, 0.3)
    quick.error["e"] = 0.01
    (answer,) = scene_report(study([*RUNG, quick]), ("e", "mu"), 0.05).findings
    assert answer.startswith(
        "Cheapest within 5 % of e and mu: 3 levels, error 4 % in 10 s. "
        "Cheapest within 5 % of e: modal, error 1 % in 0.01 s. The default run"
    )


def test_the_plot_marks_the_front_and_names_each_point():
    (picture,) = scene_report(study(RUNG), ("e",)).pictures
    series = {one.label: one for one in picture.panels[0].series}
    assert (list(series[FRONT].x), list(series[FRONT].y)) == ([1e-4, 10.0], [30.0, 4.0])
    assert series["levels, one place of the grid"].texts == ("3 levels",)
    assert picture.table().texts("setting") == ["rigid", "3 levels", "two places"]
    (panel,) = live(picture)["panels"]
    assert next(trace["text"] for trace in panel["data"] if "text" in trace) == ["rigid"]
    words = panel["layout"]["xaxis"]["ticktext"]
    assert words == ["0.0001", "0.001", "0.01", "0.1", "1", "10", "100"]


def test_the_page_over_all_sets_counts_what_levels_reach():
    one = study([*RUNG, setting("two places", 30.0, 0.015, "4 levels, two places")])
    two = study([*RUNG, setting("two places", 40.0, 0.025, "4 levels, two places")], "t4")
    report = paper_report({"t5b": one, "t4": two})
    (answer,) = report.findings
    assert answer.startswith("Levels give e to 2 % in 1 of 2 sets, in 30 to 30 s on two cores.")
    assert "The default run takes 10 to 10 s on one core; its bands have a median of 4 % of e" in answer
    assert "without savings takes 1.2 to 1.2 times as long and changes e by at most 1 %" in answer
    assert [panel.title for panel in report.pictures[0].panels] == ["t5b: e", "t5b: E_vib"]
    assert [sheet.name for sheet in report.sheets] == ["price", "settings", "levels"]
    price, settings, _ = (sheet.table for sheet in report.sheets)
    assert price.cells("error, %") == ["20", "10", "5", "2"]
    for name in ("e", "E_vib"):
        assert price.cells(f"{name}: reached in") == ["2 of 2", "2 of 2", "2 of 2", "1 of 2"]
        assert price.cells(f"{name}: median, s") == ["25", "25", "25", "30"]
    assert settings.cells("3 levels") == ["4 / 4, 10 s (default)"] * 2
