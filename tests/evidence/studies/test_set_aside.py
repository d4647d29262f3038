"""Reports of studies: one of other cases does not replace another."""

import pytest

from fem_impact.answers.report import Request, StudyReport, publish
from fem_impact.files.run_directory import earlier_runs
from fem_impact.options import RunOptions
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load

pytestmark = pytest.mark.usefixtures("unrendered")

REPORT = StudyReport("gamma", "Title", ["A finding."])


@pytest.mark.parametrize(
    ("first", "second", "kept"),
    [
        ({}, {}, 0),
        ({}, {"quick": True}, 1),
        ({"ids": ("t4",)}, {"ids": ("t4", "t2")}, 1),
        ({"line": "fem-impact cost t5b"}, {"line": "fem-impact cost t5b --stored"}, 0),
        ({"cases": "one"}, {"cases": "two"}, 1),
        ({"cases": "one"}, {}, 1),
    ],
)
def test_a_report_of_other_cases_is_set_aside(tmp_path, first, second, kept):
    publish(REPORT, Request(tmp_path, **first), {})
    told = (tmp_path / "summary.md").read_text()
    publish(REPORT, Request(tmp_path, **second), {})
    assert [(place / "summary.md").read_text() for place in earlier_runs(tmp_path)] == [told] * kept
    assert (tmp_path / "study.json").exists()


def test_a_damaged_report_is_set_aside(tmp_path):
    publish(REPORT, Request(tmp_path), {})
    (tmp_path / "study.json").write_text("{")
    publish(REPORT, Request(tmp_path), {})
    (place,) = earlier_runs(tmp_path)
    assert (place / "study.json").read_text() == "{"


def test_a_run_and_a_report_in_one_directory_set_each_other_aside(tmp_path):
    simulate(load("t5b"), "rigid", RunOptions(out=tmp_path))
    (tmp_path / "history.csv").write_text("time_s\n")
    publish(REPORT, Request(tmp_path), {})
    (run,) = earlier_runs(tmp_path)
    assert {path.name for path in run.iterdir()} >= {"outcome.json", "scene.toml", "history.csv"}
    simulate(load("t5b"), "rigid", RunOptions(out=tmp_path))
    (report,) = set(earlier_runs(tmp_path)) - {run}
    assert {path.name for path in report.iterdir()} == {"study.json", "summary.md", "runs.csv"}
