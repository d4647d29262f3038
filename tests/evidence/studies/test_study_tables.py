"""The study's Markdown, and pictures that may be missing."""

import json
from concurrent.futures import Executor, Future

import pytest
from outcome_maker import altered
from study_fakes import outcome

from fem_impact.answers.report import Request, StudyReport, publish
from fem_impact.errors import MissingLibraryError
from fem_impact.evidence.studies.sets import sets_report
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.outcome.shares import shares
from fem_impact.pages.write import film, present
from fem_impact.progress import NullMeter
from fem_impact.tables.table import COMPARISON as COLUMNS

pytestmark = pytest.mark.usefixtures("unrendered")


def row(quantity, verdict, model=0.3, band=0.01):
    return dict.fromkeys(COLUMNS) | {
        "set": "t5b",
        "quantity": quantity,
        "model": model,
        "band": band,
        "measured_mean": 0.327,
        "measured_sd": 0.078,
        "verdict": verdict,
    }


COMPARISON = [
    row("e", "inside"),
    row("mu", "undecided: mesh band"),
    row("Omega", "miss by +3.0 SD", 12.34, 1.26),
    row("E_ln/E_0", "outside, within the scatter"),
    row("E_lt/E_0", "inside", band=None),
    row("E_r/E_0", "inside"),
    row("V_n", "inside"),
]
OUTCOME = outcome(
    **{share.key.name: 0.1234 for share in shares("report")},
    scene_id="t5b",
    residual_over_E_0=-2.1e-5,
    steps=9100,
    cpu_s=7.26,
)


def tables(outcomes):
    """The tables of the study by name."""
    return {sheet.name: sheet.table for sheet in sets_report(outcomes, COMPARISON).sheets}


def test_marks_tell_inside_undecided_and_outside_apart():
    (cells,) = tables([OUTCOME])["beside"].rows
    assert cells == (
        "t5b",
        "**0.300 ± 0.010** / 0.327 ± 0.078",
        "0.300 ± 0.010 / 0.327 ± 0.078 ?",
        "12.3 ± 1.3 / 0.3 ± 0.1",
        "0.300 ± 0.010 / 0.327 ± 0.078",
        "**0.300** / 0.327 ± 0.078",
        "**0.300 ± 0.010** / 0.327 ± 0.078",
    )


def test_limits_say_how_uncertain_they_are():
    limits = {"e_edge": 0.32, "E_vib_over_E_0": 0.002}
    limited = altered(OUTCOME, mesh_limit=limits, mesh_band={"e_edge": 0.016, "E_vib_over_E_0": 0.0005})
    (cells,) = tables([limited])["limits"].rows
    assert cells == ("t5b", "0.320 ± 0.016", "5", "0.200 ± 0.050", "25", "7")
    assert "limits" not in tables([OUTCOME])


def test_shares_are_percent_and_of_two_meshes_their_limits_with_bands():
    limits, bands = {"E_vib_over_E_0": 0.00354, "e_edge": 0.3}, {"E_vib_over_E_0": 0.0012, "e_edge": 0.1}
    limited = altered(OUTCOME, mesh_limit=limits, mesh_band=bands, W_damping_over_E_0=None)
    (cells,) = tables([limited])["shares"].rows
    shown = ["0.35 ± 0.12" if share.label == "vibration" else "12.3" for share in shares("report")]
    shown[[share.label for share in shares("report")].index("damping")] = None
    assert cells == ("t5b", *shown, "25.0", "-2e-05", 9100, "7")  # of E_0, 25 % was added by gravity


def test_a_missing_library_costs_a_film_only(tmp_path, monkeypatch):
    run = tmp_path / "t4"
    run.mkdir()
    (run / "fields.vtkhdf").write_bytes(b"")

    def no_film(place, **_):
        raise MissingLibraryError("install libegl1")

    monkeypatch.setattr("fem_impact.pages.write.render", no_film)
    assert film(run) == ["t4: install libegl1"]


@pytest.mark.long
def test_several_runs_are_drawn_in_processes_and_what_lacks_is_told_once(tmp_path):
    runs = [tmp_path / name for name in ("t4", "t5b")]
    for run in runs:
        run.mkdir()
    notes = present(runs, tmp_path, NullMeter())
    assert [note.partition(": ")[0] for note in notes] == ["t4", "t5b", tmp_path.name]
    assert all("outcome.json" in note for note in notes[:2])


def test_the_processes_of_the_runs_draw_films_first_and_a_page_after_its_film(tmp_path):
    calls = []

    class Here(Executor):
        def submit(self, work, *args):
            calls.append((work.__name__, args[0].name))
            future = Future()
            future.set_result(work(*args))
            return future

    runs = [tmp_path / name for name in ("t4", "t5b")]
    present(runs, tmp_path, NullMeter(), Here())
    pages = [(name, run) for name, run in calls if name in ("film", "page")]
    assert calls[:2] == [("film", "t4"), ("film", "t5b")]
    assert pages[2:] == [("page", "t4"), ("page", "t5b")]
    assert [name for name, _ in calls].count("_attempt") == 2


def test_a_panel_with_one_place_along_x_is_not_shown(tmp_path):
    one = Panel("e", "angle, degrees", "e", (Series("e", [45.0, 45.0], [0.1, 0.2]),))
    two = Panel("e", "angle, degrees", "e", (Series("e", [45.0, 60.0], [0.1, 0.3]),))
    drawn = [Picture("both", "Both.", (one, two)), Picture("none", "None.", (one,))]
    conclusions = [("both", "It rises."), ("none", "It stands.")]
    report = StudyReport("gamma", "A study", ["It rises."], drawn, conclusions=conclusions)
    document = publish(report, Request(tmp_path), {}).document
    assert [figure["name"] for figure in document["figures"]] == ["both"]
    assert [said["name"] for said in document["conclusions"]] == ["both", ""]
    drawn = json.loads((tmp_path / "figures" / "both.json").read_text())
    assert len(drawn["panels"]) == 1 and drawn["panels"][0]["data"][0]["x"] == [45.0, 60.0]
