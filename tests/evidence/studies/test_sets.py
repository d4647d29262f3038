"""The study of the measured sets: two meshes a set, bands, friction ends, failures as rows."""

import json
from dataclasses import replace

import pytest
from study_fakes import outcome, published
from wide_contact import WIDE

from fem_impact.answers.refine.extrapolate import LOWEST, ONE_RUN
from fem_impact.answers.report import SCHEMA, Request
from fem_impact.case.case import Case
from fem_impact.evidence.runner import run_study
from fem_impact.evidence.studies.inputs import INPUT_CHANGES
from fem_impact.evidence.studies.pairs import COARSER, finer_and_coarser
from fem_impact.evidence.studies.sets import QUICK_SETS, conclude, jobs_of, plan
from fem_impact.jobs.job import Failure
from fem_impact.outcome.record import Outcome
from fem_impact.pages.study_page import read_study, study_page
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load, replace_all
from fem_impact.tables.table import read_csv


def computed(jobs, broken=()):
    """What the jobs give; e grows with the tip size."""
    return {job.name: Failure(job.name, "folded") if job.name in broken else fake(job) for job in jobs}


def fake(job):
    size = Case.of(job.scene).zones.tip_size
    return outcome(scene_id=job.scene.id, tip_size_m=size, e_paper=0.3 + 100 * size, E_vib_over_E_0=0.01)


def study(out, *ids, broken=(), quick=True):
    request = Request(out, ids, quick)
    return published(conclude, request, computed(plan(request, {}), broken))


def test_a_set_is_two_meshes_and_a_table(tmp_path):
    found = study(tmp_path, "t5b")
    (row,) = found.document["rows"]
    half = 0.5 * 100 * 0.296875e-3 / (2**LOWEST - 1)
    assert row["mesh_band"]["e_paper"] == pytest.approx(ONE_RUN * half)
    assert row["mesh_limit"]["e_paper"] == pytest.approx(row["e_paper"] - half)
    assert json.loads((tmp_path / "study.json").read_text())["rows"] == [row]
    assert (tmp_path / "comparison.csv").is_file()
    assert "t5b" in found.text
    assert found.runs == (tmp_path / "t5b",)
    stored = Outcome.read(tmp_path / "t5b" / "outcome.json")
    assert stored.validity.mesh_band["e_paper"] == pytest.approx(ONE_RUN * half)


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


def test_a_failing_coarse_mesh_leaves_the_fine_result_without_bands(tmp_path):
    (row,) = study(tmp_path, "t5b", broken=("t5b-coarse",)).document["rows"]
    assert row["mesh_limit"] is row["mesh_band"] is None
    assert "run t5b-coarse failed" in row["reasons"]["mesh_band"]


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ((), "Model, with the band of its two meshes, /"),
        (("t5b-coarse",), "Model, with the band of its two meshes (one mesh: t5b), /"),
        (("t5b-coarse", "t5c-coarse"), "Model on one mesh, without a band, /"),
    ],
)
def test_the_table_says_which_sets_have_a_band(tmp_path, broken, said):
    assert said in study(tmp_path, "t5b", "t5c", broken=broken).text


def test_a_first_look_is_one_set_a_rod(tmp_path):
    assert [job.name for job in plan(Request(tmp_path, quick=True), {})][::2] == list(QUICK_SETS)


def test_changed_inputs_are_run_unless_quick(tmp_path):
    found = study(tmp_path, "t5b", quick=False)
    assert [sheet["name"] for sheet in found.document["sheets"]][-3:] == [
        "sensitivity",
        "changes",
        "explanations",
    ]
    assert {*read_csv(tmp_path / "sensitivity.csv").texts("input")} >= {i.name for i in INPUT_CHANGES}
    quick = study(tmp_path / "quick", "t5b").document["sheets"]
    assert "sensitivity" not in {sheet["name"] for sheet in quick}


def test_the_study_publishes_as_every_other(tmp_path):
    found = study(tmp_path, "t5b")
    read = read_study(tmp_path)
    assert found.document["schema"] == SCHEMA
    assert read.command == "fem-impact study sets t5b --quick"
    assert [row.provenance.scene_id for row in read.rows] == ["t5b"]
    assert (tmp_path / "summary.md").read_text() == found.text
    assert read_csv(tmp_path / "runs.csv").texts("run") == ["t5b", "t5b-coarse"]
    page = study_page(tmp_path)
    assert "Where the energy went" in page and "beside.csv" in page


def test_the_coarser_twin(tmp_path):
    group = jobs_of("t5b", False, tmp_path)
    fine, coarse = group["fine"].scene, group["coarse"].scene
    assert coarse.accuracy.tip_size == pytest.approx(COARSER * Case.of(fine).zones.tip_size, rel=1e-5)
    assert coarse.save.frames == 0
    assert replace(coarse, accuracy=fine.accuracy, save=fine.save) == fine


def test_a_scene_that_cannot_be_made_coarser_is_the_coarser_twin(tmp_path):
    """The quick cells are as large as those of a thin rod can be: twice as large, nothing could yield."""
    thin = replace_all(load("t5b"), {"projectile.diameter": "10 mm", "accuracy.tip_size": "0.6 mm"})
    for scene in (WIDE, thin):
        fine, coarse = finer_and_coarser(scene)
        sizes = [Case.of(one).zones.tip_size for one in (fine, coarse, scene)]
        assert sizes[1] == sizes[2] == pytest.approx(COARSER * sizes[0])
        assert (fine.save, coarse.save.frames) == (scene.save, 0)
        assert coarse.accuracy.unresolved == "report"
        assert fine.accuracy.unresolved == scene.accuracy.unresolved
