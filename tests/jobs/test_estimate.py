"""What a study will take: from measured costs, on any number of workers."""

from statistics import median

import pytest
from hypothesis import given
from hypothesis import strategies as st
from outcome_maker import outcome
from scale_tasks import Acting, Here, job, record

from fem_impact.case.case import Case
from fem_impact.cli.study import _estimate_text
from fem_impact.jobs.job import GUESS, REFUSED, Failure, Job
from fem_impact.jobs.run import Eta, Pace, estimate, expected_costs, makespan, run_jobs
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load, replace


def solid(name, size):
    return Job(name, replace(load("t5b"), "accuracy.tip_size", f"{size} mm"))


def ran(job, pace):
    """An outcome of a job that took ``pace`` times what is planned, a fifth of it around the time loop."""
    time = pace * job.planned_s
    return outcome(fidelity=job.fidelity, cpu_s=0.8 * time, setup_cpu_s=0.2 * time)


def test_costs_are_planned_times_at_the_pace_of_what_has_run():
    done = [solid(f"done {size}", size) for size in (0.8, 1.0, 1.2)]
    new = [solid("coarse", 0.9), solid("fine", 0.3)]
    results = {job.name: ran(job, pace) for job, pace in zip(done, (0.5, 0.7, 3.0), strict=True)}
    costs = expected_costs([*done, *new, job("r")], results)
    planned = {one.name: Case.of(one.scene).size.time for one in new}
    assert planned["fine"] > 2 * planned["coarse"]
    wanted = {name: 0.7 * time for name, time in planned.items()}
    assert costs == pytest.approx(wanted | {"r": GUESS["rigid"]})
    assert expected_costs(new, {}) == planned
    failed = {"done 0.8": Failure("done 0.8", "folded")}
    assert expected_costs([done[0], *new], failed) == planned


def test_the_time_of_a_fidelity_without_a_mesh_is_the_median_of_what_has_run():
    results = {name: ran(job(name), pace) for name, pace in (("a", 2.0), ("b", 4.0), ("c", 9.0))}
    costs = expected_costs([job(name) for name in "abcd"], results)
    assert costs == pytest.approx({"d": 4.0 * GUESS["rigid"]})


def test_a_scene_without_a_mesh_is_refused_at_once():
    deep = Job("deep", replace(load("t5b"), "impact.v_n", "-400 m/s"))
    assert expected_costs([deep], {}) == {"deep": REFUSED}


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
    jobs = [job(f"j{i}") for i in range(40)]
    found = estimate(jobs, store, NullMeter(), Acting(engine))
    assert len(engine.names) == 8
    assert (found.jobs, found.stored) == (40, 8)
    took = record(jobs[0].scene).cost
    assert found.work_s == pytest.approx(32 * took.whole_cpu)
    assert found.wall_s[1] == pytest.approx(found.work_s)
    assert found.wall_s[10] == pytest.approx(4 * found.longest_s)
    assert found.wall_s[1000] == pytest.approx(found.longest_s)
    (group,) = found.groups
    assert (group.fidelity, group.tip_size_m, group.jobs) == ("rigid", None, 32)
    assert found.paces["rigid"].measured == 8 and "rigid: median of 8 that ran" in _estimate_text(found)
    run_jobs(jobs, store, NullMeter(), Acting(engine))
    assert len(engine.names) == 40
    assert estimate(jobs, store, NullMeter(), Acting(engine)).work_s == 0.0


def test_samples_are_cheap_and_each_group_tells_its_times(tmp_path):
    jobs = [solid(f"j{i}", 1.5 - 0.03 * i) for i in range(40)]
    store, engine = tmp_path / "store.sqlite", Here()
    found = estimate(jobs, store, NullMeter(), Acting(engine))
    planned = {job.name: job.planned_s for job in jobs}
    assert len(engine.names) == 8
    assert max(planned[name] for name in engine.names) <= median(planned.values())  # of the cheaper half
    took = record(jobs[0].scene).cost
    pace = median(took.whole_cpu / planned[name] for name in engine.names)
    left = [pace * time for name, time in planned.items() if name not in engine.names]
    assert found.work_s == pytest.approx(sum(left)) and found.longest_s == pytest.approx(max(left))
    assert sum(group.jobs for group in found.groups) == 32
    assert found.paces["solid"] == Pace(pytest.approx(pace), 8)
    text, (fidelity, size) = _estimate_text(found), jobs[-1].kind
    last = next(line for line in text.splitlines() if f"{fidelity}, tip {size * 1e3:.2g} mm" in line)
    assert f"{max(left):.2g} s each" in last
    assert f"solid: the forecast of each scene, times {pace:.2g} by 8 that ran\n" in text
