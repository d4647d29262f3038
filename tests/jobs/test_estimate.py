"""What a study will take: from measured costs, on any number of workers."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale_tasks import Acting, Here, job

from fem_impact.jobs.forecast import estimate
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import GUESS, REFUSED, STEEPNESS, Eta, expected_costs, makespan, run_jobs
from fem_impact.plan.plan import plan
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load, replace


def solid(name, size):
    return Job(name, replace(load("t5b"), "accuracy.tip_size", f"{size} mm"))


def test_costs_come_from_the_same_kind_or_scale_with_the_tip():
    measured = {("solid", 0.6e-3): [8.0, 12.0], ("solid", 1.2e-3): [1.0], ("rigid", 0.0): [0.5]}
    jobs = [solid("same", 0.6), solid("finer", 0.3), solid("coarser", 2.4), job("r")]
    costs = expected_costs(jobs, measured)
    assert costs == pytest.approx(
        {"same": 10.0, "finer": 10.0 * 2**STEEPNESS, "coarser": 1.0 / 2**STEEPNESS, "r": 0.5}
    )
    assert expected_costs([solid("new", 0.3)], {}) == {"new": GUESS["solid"]}


def test_a_scene_that_leaves_the_tip_size_out_counts_with_the_planned_one():
    stated, planned = solid("stated", 0.6), Job("planned", load("t5b"))
    assert load("t5b").accuracy.tip_size is None
    size = plan(load("t5b")).zones.tip_size
    costs = expected_costs([stated, planned], {stated.kind: [10.0]})
    assert costs == pytest.approx({"stated": 10.0, "planned": 10.0 * (0.6e-3 / size) ** STEEPNESS})


def test_a_scene_without_a_mesh_is_refused_at_once():
    deep = Job("deep", replace(load("t5b"), "impact.v_n", "-400 m/s"))
    assert expected_costs([deep], {("solid", 0.6e-3): [10.0]}) == {"deep": REFUSED}


@given(st.lists(st.floats(0.1, 100.0), min_size=1, max_size=30), st.integers(1, 40))
def test_a_makespan_lies_between_its_bounds(costs, workers):
    ideal = max(max(costs), sum(costs) / workers)
    most = sum(costs) / workers + (1 - 1 / workers) * max(costs)  # Graham 1966, for any list
    assert ideal * (1 - 1e-12) <= makespan(costs, workers) <= most * (1 + 1e-12)


def test_the_eta_follows_the_work_not_the_number_of_jobs(monkeypatch):
    seen, now = [], [100.0]
    monkeypatch.setattr("fem_impact.jobs.run.time.monotonic", lambda: now[0])
    eta = Eta({"long": 8.0, "short": 2.0}, 3, seen.append)
    now[0] = 116.0
    eta("long", 2)
    assert (seen[0].done, seen[0].total, seen[0].eta_s) == (2, 3, pytest.approx(4.0))


def test_an_estimate_measures_a_few_jobs_and_keeps_them(tmp_path):
    store, engine = tmp_path / "store.sqlite", Here()
    jobs = [job(f"j{i}", "sleep 0.02") for i in range(40)]
    found = estimate(jobs, store, NullMeter(), Acting(engine))
    assert len(engine.names) == 8
    assert (found.jobs, found.stored) == (40, 8)
    assert found.work_s == pytest.approx(32 * 0.02, rel=0.5)
    assert found.wall_s[1] == pytest.approx(found.work_s)
    assert found.wall_s[10] == pytest.approx(4 * found.longest_s)
    assert found.wall_s[1000] == pytest.approx(found.longest_s)
    assert found.kinds[0]["measured"] == 8
    run_jobs(jobs, store, NullMeter(), Acting(engine))
    assert len(engine.names) == 40
    assert estimate(jobs, store, NullMeter(), Acting(engine)).work_s == 0.0
