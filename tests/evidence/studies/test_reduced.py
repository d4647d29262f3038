"""The study of the reduced model: scenes on both models, near or not, and the stored copy of its table."""

import pandas
import pytest
from study_fakes import outcome, published

from fem_impact.answers.report import Request
from fem_impact.evidence.studies.reduced import (
    COUNT,
    KEYS,
    MODELS,
    SIDES,
    conclude,
    design,
    group_of,
    plan,
    report_of,
    scenes,
)
from fem_impact.jobs.job import Failure

pytestmark = pytest.mark.usefixtures("unrendered")


def fake(job):
    off = 0.05 if job.fidelity == "modal" else 0.0
    return outcome(e_edge=0.4 + off, mu=0.3, E_vib_over_E_0=0.02 - 0.08 * off, W_skin_over_E_0=0.1)


def test_every_scene_runs_on_both_models_and_lies_within_the_hypercube():
    assert len({job.name for job in plan(Request("x"), {})}) == 2 * (13 + 6 + COUNT)
    for row in design(COUNT):
        assert all(low <= row[side] <= high for side, (low, high) in SIDES.items())
    assert {group_of(name) for name in scenes(Request("x", quick=True))} == {"hypercube"}
    groups = [group_of(name) for name in scenes(Request("x"))]
    assert [groups.count(name) for name in ("measured", "calibration", "hypercube")] == [13, 6, COUNT]


def test_near_and_far_are_counted_and_a_failed_run_leaves_its_row_out(tmp_path):
    request = Request(tmp_path, quick=True)
    results = {job.name: fake(job) for job in plan(request, {})}
    results["reduced-1-solid"] = Failure("reduced-1-solid", "folded")
    found = published(conclude, request, results)
    assert "e within 0.06 in 3 of 3 scenes" in found.text and "both in 3" in found.text
    assert "median difference of e 0.050" in found.text


def test_a_difference_beyond_the_limit_is_not_near():
    values = (0.47, 0.40, 0.3, 0.3, 1.0, 1.0, 0.026, 0.02, 0.1, 0.1)
    columns = pandas.MultiIndex.from_product([KEYS, MODELS])
    (sentence,) = report_of(pandas.DataFrame([values], ["reduced-0"], columns)).findings
    assert "in 0 of 1 scenes" in sentence and "in 0, both in 0" in sentence
