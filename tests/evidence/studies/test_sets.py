"""The study of the measured sets: a run a set with its bands, failures as rows."""

import json

import pytest
from study_fakes import outcome, published

from fem_impact.answers.report import SCHEMA, Request
from fem_impact.answers.simulate import simulate
from fem_impact.evidence.runner import run_study
from fem_impact.evidence.studies.sets import QUICK_SETS, conclude, plan, set_job
from fem_impact.jobs.job import Failure
from fem_impact.pages.study_page import read_study, study_page
from fem_impact.progress import NullMeter
from fem_impact.tables.table import read_csv

pytestmark = pytest.mark.usefixtures("unrendered")


def computed(jobs, broken=(), unbanded=()):
    """What the jobs give."""
    return {
        job.name: Failure(job.name, "folded") if job.name in broken else fake(job, job.name not in unbanded)
        for job in jobs
    }


def fake(job, banded=True):
    limits, bands = ({"e_paper": of, "e_edge": of, "E_vib_over_E_0": of} for of in (0.3, 0.01))
    numbers = {"mesh_limit": limits, "mesh_band": bands}
    if not banded:
        numbers = {"mesh_limit": None, "mesh_band": None, "reasons": {"mesh_band": "the budget"}}
    return outcome(scene_id=job.scene.id, tip_size_m=4e-4, e_paper=0.31, E_vib_over_E_0=0.01, **numbers)


def study(out, *ids, quick=True, **lost):
    request = Request(out, ids, quick)
    return published(conclude, request, computed(plan(request, {}), **lost))


def test_a_set_is_a_run_with_bands_and_a_table(tmp_path):
    found = study(tmp_path, "t5b")
    (row,) = found.document["rows"]
    assert (row["mesh_limit"]["e_paper"], row["mesh_band"]["e_paper"]) == (0.3, 0.01)
    assert json.loads((tmp_path / "study.json").read_text())["rows"] == [row]
    assert (tmp_path / "comparison.csv").is_file()
    assert "**0.300 ± 0.010** / 0.327" in found.text
    assert found.runs == ()
    assert study(tmp_path, "t5b", quick=False).runs == (tmp_path / "t5b",)


def test_levels_run_at_two_places_of_the_grid_unless_quick(tmp_path):
    full, quick = (set_job("t5b", quick, tmp_path) for quick in (False, True))
    assert (full.scene.accuracy.offsets, quick.scene.accuracy.offsets) == (2, None)
    assert (full.scene.accuracy.tip_size, quick.scene.accuracy.tip_size) == (None, 0.7e-3)
    assert full.way == quick.way == simulate
    assert full.out == tmp_path / "t5b"


def test_the_study_runs_its_jobs_through_the_store(tmp_path, monkeypatch):
    asked = []

    def run_jobs(jobs, store, progress, executor):
        asked.append((store, executor))
        return computed(jobs)

    monkeypatch.setattr("fem_impact.evidence.runner.run_jobs", run_jobs)
    request = Request(tmp_path / "s", ("t5b",), quick=True)
    found = run_study("studies.sets", request, NullMeter(), "an executor")
    assert asked == [(tmp_path / "s" / "store.sqlite", "an executor")]
    assert found.document["failures"] == []


def test_a_failing_job_is_a_row(tmp_path):
    found = study(tmp_path, "t5b", "t5c", broken=("t5c",))
    assert [r["scene_id"] for r in found.document["rows"]] == ["t5b"]
    assert found.document["failures"] == [{"scene_id": "t5c", "error": "folded"}]
    assert "failed: t5c: folded" in found.text


@pytest.mark.parametrize(
    ("unbanded", "said"),
    [
        ((), "Model, with the band of its levels, /"),
        (("t5b",), "Model, with the band of its levels (none: t5b), /"),
        (("t5b", "t5c"), "Model, without a band, /"),
    ],
)
def test_the_table_says_which_sets_have_a_band(tmp_path, unbanded, said):
    assert said in study(tmp_path, "t5b", "t5c", unbanded=unbanded).text


def test_a_first_look_is_one_set_a_rod(tmp_path):
    assert [job.name for job in plan(Request(tmp_path, quick=True), {})] == list(QUICK_SETS)


def test_the_study_publishes_as_every_other(tmp_path):
    found = study(tmp_path, "t5b")
    read = read_study(tmp_path)
    assert found.document["schema"] == SCHEMA
    assert read.command == "fem-impact study sets t5b --quick"
    assert [row.provenance.scene_id for row in read.rows] == ["t5b"]
    assert (tmp_path / "summary.md").read_text() == found.text
    assert read_csv(tmp_path / "runs.csv").texts("run") == ["t5b"]
    page = study_page(tmp_path)
    assert "Where the energy went" in page and "beside.csv" in page
