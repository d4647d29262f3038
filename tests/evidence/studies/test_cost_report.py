"""Reports of what accuracy costs: the answer, the plot of error against time, the tables."""

import pytest

from fem_impact.answers.cost.judge import Judged
from fem_impact.answers.cost.measure import CostStudy
from fem_impact.answers.refine.extrapolate import ExtrapolatedValue
from fem_impact.evidence.studies.cost_report import FRONT, paper_report, scene_report
from fem_impact.figures import still, style
from fem_impact.figures.live import live
from fem_impact.scene.shipped import load

NAMES = ("e", "mu", "E_vib")


def setting(kind, cpu_s, error, band=None):
    return Judged(
        name=kind,
        kind=kind,
        fidelity=kind,
        meshes=[dict(finer=1), dict(finer=0)] if band else [],
        places=4,
        tip_size_m=None,
        value=dict.fromkeys(NAMES, 0.5),
        error=dict.fromkeys(NAMES, error),
        scatter=dict.fromkeys(NAMES, 0.001),
        band={} if band is None else dict.fromkeys(NAMES, band),
        wall_s=cpu_s,
        cpu_s=cpu_s,
        two_cores_s=cpu_s,
        element_steps=None,
        peak_memory_MB=None,
    )


def study(settings, scene="t5b"):
    limits = dict.fromkeys(NAMES, ExtrapolatedValue(0.5, 1.0, 0.01, 0.5))
    return CostStudy(load(scene), limits, sorted(settings, key=lambda one: one.cpu_s), [], {})


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Return the plot of a rigid run and a mesh whose errors, of 1, lie so far apart."""
    kept = []
    monkeypatch.setattr(style, "save", lambda figure, path: kept.append(figure))

    def draw(rigid, mesh, names=("e",)):
        settings = [setting("rigid", 1e-4, rigid), setting("mesh", 30.0, mesh)]
        still.draw(scene_report(study(settings), names).pictures[0], tmp_path / "x.svg")
        kept[0].draw_without_rendering()
        return [axes for axes in kept[0].axes if axes.get_visible()]

    return draw


def shown(axis):
    """Return the words at the ticks that lie within the axis."""
    low, high = axis.get_view_interval()
    both = zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)
    return [label.get_text() for at, label in both if low <= at <= high]


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
    setting("default", 4.0, 0.015),
    setting("mesh", 10.0, 0.04),
    setting("numerics", 12.0, 0.05),
]


def test_the_answer_comes_first_and_names_the_default_run():
    (answer,) = scene_report(study(RUNG), ("e", "mu")).findings
    assert answer == (
        "No setting brings e and mu within 2 %; best: mesh, error 4 % in 10 s. "
        "The default run takes 4 s of processor time; its error is at most 1.5 % in e and 1.5 % in mu. "
        "It ran at one place of the grid, so that may be small by chance, and it is not compared with the "
        "others."
    )
    (answer,) = scene_report(study(RUNG), ("e",), 0.05).findings
    assert answer.startswith("Cheapest within 5 % of e: mesh, error 4 % in 10 s. The default run")


def test_a_quantity_is_answered_alone_only_where_another_setting_serves_it():
    quick = setting("modal", 0.01, 0.3)
    quick.error["e"] = 0.01
    (answer,) = scene_report(study([*RUNG, quick]), ("e", "mu"), 0.05).findings
    assert answer.startswith(
        "Cheapest within 5 % of e and mu: mesh, error 4 % in 10 s. "
        "Cheapest within 5 % of e: modal, error 1 % in 0.01 s. The default run"
    )


def test_the_plot_marks_the_front_and_names_each_point():
    (picture,) = scene_report(study(RUNG), ("e",)).pictures
    series = {one.label: one for one in picture.panels[0].series}
    assert (list(series[FRONT].x), list(series[FRONT].y)) == ([1e-4, 10.0], [30.0, 4.0])
    assert series["default run"].texts == ("default",)
    names = picture.table().texts("setting")
    assert names == ["rigid", "default", "mesh", "numerics"]
    (panel,) = live(picture)["panels"]
    assert next(trace["text"] for trace in panel["data"] if "text" in trace) == ["rigid"]
    words = panel["layout"]["xaxis"]["ticktext"]
    assert words == ["0.0001", "0.001", "0.01", "0.1", "1", "10", "100"]
    assert panel["layout"]["yaxis"]["ticktext"][:4] == ["1", "2", "5", "10"]


def test_the_page_over_all_sets_counts_what_several_meshes_reach():
    one = study([*RUNG, setting("extrapolated", 30.0, 0.02, band=0.015)])
    two = study([*RUNG, setting("extrapolated", 40.0, 0.03, band=0.025)], "t4")
    report = paper_report({"t5b": one, "t4": two})
    (answer,) = report.findings
    assert answer.startswith(
        "Two or three meshes together give e to 2 % in 1 of 2 sets, in 30 to 30 s on two cores."
    )
    assert "One default run takes 4 to 4 s on one core" in answer
    assert [panel.title for panel in report.pictures[0].panels] == ["t5b: e", "t5b: E_vib"]
    assert [sheet.name for sheet in report.sheets] == ["price", "meshes", "settings"]
    price, meshes, settings = (sheet.table for sheet in report.sheets)
    assert price.cells("error, %") == ["10", "5", "2", "1"]
    for name in ("e", "E_vib"):
        assert price.cells(f"{name}: reached in") == ["2 of 2", "2 of 2", "1 of 2", "0 of 2"]
        assert price.cells(f"{name}: median, s")[:3] == ["35", "35", "30"]
        assert price.cells(f"{name}: longest, s")[:3] == ["40", "40", "30"]
    assert meshes.cells("e: band, % (scatter)") == ["**1.5** (0.1)", "2.5 (0.1)"]
    assert settings.cells("mesh") == ["4 ± 0.1 / 4 ± 0.1, 10 s"] * 2
