"""The ladder of causes: what is on in each step, and what the study tells of known runs."""

import json

import pytest
from study_fakes import outcome, published

from fem_impact.answers.report import Request
from fem_impact.case.case import Case
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.evidence.studies.causes import BASE, STEPS, conclude, plan
from fem_impact.jobs.job import Failure
from fem_impact.scene.shipped import load


def jobs_of(request):
    return {job.name.removeprefix("t5b: "): job for job in plan(request, {})}


def fake(job):
    """A model whose e grows by .01 with the rate, .1 with hardness and 1 with the skin."""
    scene = job.scene
    e = 0.2 + 0.01 * (len(scene.effects) == 1) + 0.1 * (scene.barrier.material.law == "hardness")
    return outcome(e_paper=e + 1.0 * (scene.barrier.material.skin is not None), Omega_rad_per_s=10.0)


def test_each_step_switches_on_what_it_says(tmp_path):
    jobs = jobs_of(Request(tmp_path, ("t5b",)))
    assert list(jobs) == list(STEPS)
    active = {step: Case.of(job.scene).active for step, job in jobs.items()}
    assert "rate-hardening" not in active[BASE] and "machined-skin" not in active[BASE]
    assert "rate-hardening" in active["rate"]
    assert jobs["rate"].scene.barrier == load("t5b").barrier  # the nominal inputs
    harder = hardening_of(jobs["+ hardness"].scene.barrier.material)
    assert float(harder.flow_stress(0.08)) == pytest.approx(533e6, rel=2e-3)
    assert {"rate-hardening", "machined-skin"} <= set(active["+ skin"])
    assert "rate-hardening" not in active["hardness alone"]
    assert "machined-skin" in active["skin alone"]
    assert jobs["skin alone"].scene.barrier.material.law == "tensile"


def test_the_study_tells_each_change_and_draws_the_measured_interval(tmp_path):
    request = Request(tmp_path, ("t5b",))
    found = published(conclude, request, {j.name: fake(j) for j in plan(request, {})})
    assert "None of these readings brings e, mu and Omega of a set" in found.text
    assert "one of them alone: t5b e +1 (skin), mu" in found.text
    assert "e 0.2, +0.13 to the measured mean: rate +0.01, hardness +0.1, skin +1, all +1.1" in found.text
    written = json.loads((tmp_path / "study.json").read_text())
    (sheet,) = written["sheets"]
    row = dict(zip(sheet["columns"], sheet["rows"][0], strict=True))
    assert [row[step] for step in STEPS] == pytest.approx([0.2, 0.21, 0.31, 1.31, 0.3, 1.2])
    assert row["measured low"] < row["measured"] < row["measured high"]
    assert (tmp_path / "figures" / "causes.svg").stat().st_size > 500


def test_a_set_with_a_failed_run_is_left_out_and_said(tmp_path):
    request = Request(tmp_path, ("t5b",))
    runs = {j.name: fake(j) for j in plan(request, {})} | {f"t5b: {BASE}": Failure(f"t5b: {BASE}", "folded")}
    assert "No set has all its runs" in published(conclude, request, runs).text
