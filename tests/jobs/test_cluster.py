"""A study on a real dask.distributed scheduler with workers as processes, one of them killed."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

import pytest
from scale_tasks import LOG, Acting, job

from fem_impact.errors import MissingLibraryError, UsageError
from fem_impact.jobs import executors as cluster_module
from fem_impact.jobs.executors import on_scheduler
from fem_impact.jobs.job import Failure
from fem_impact.jobs.run import run_jobs
from fem_impact.progress import NullMeter

HERE = Path(__file__).parent


def start(module, *words, log):
    environment = {**os.environ, LOG: str(log), "PYTHONPATH": os.pathsep.join([str(HERE), *sys.path])}
    line = [sys.executable, "-m", f"distributed.cli.{module}", *map(str, words)]
    return subprocess.Popen(line, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """The address of a scheduler, its two workers, and the log of what they computed."""
    place = tmp_path_factory.mktemp("cluster")
    told, log = place / "scheduler.json", place / "log"
    scheduler = start(
        "dask_scheduler",
        "--host",
        "127.0.0.1",
        "--port",
        0,
        "--no-dashboard",
        "--scheduler-file",
        told,
        log=log,
    )
    options = ("--nthreads", 1, "--no-nanny", "--no-dashboard", "--local-directory", place)
    workers = [start("dask_worker", "--scheduler-file", told, *options, log=log) for _ in range(2)]
    end = time.monotonic() + 60
    while not told.exists():
        assert time.monotonic() < end, "no scheduler came up"
        time.sleep(0.05)

    yield json.loads(told.read_text())["address"], workers, log
    for process in (*workers, scheduler):
        process.kill()
        process.wait()


@pytest.mark.long
def test_a_worker_killed_in_mid_study_costs_nothing(cluster, tmp_path):
    address, workers, log = cluster
    jobs = [*(job(f"j{i}", "sleep 0.1") for i in range(14)), job("bad", "fail")]

    def kill_one():
        while not log.exists() or len(log.read_text().split()) < 4:
            time.sleep(0.02)
        workers[0].send_signal(signal.SIGKILL)

    with on_scheduler(address) as executor:
        threading.Thread(target=kill_one, daemon=True).start()
        found = run_jobs(jobs, tmp_path / "store.sqlite", NullMeter(), Acting(executor))
    workers[0].wait(10)
    assert [name for name, result in found.items() if isinstance(result, Failure)] == ["bad"]
    assert found["j3"].provenance.scene_id == "j3"
    counts = Counter(log.read_text().split())
    assert set(counts) == {j.name for j in jobs}
    with on_scheduler(address) as executor:
        run_jobs(jobs, tmp_path / "store.sqlite", NullMeter(), Acting(executor))
    assert Counter(log.read_text().split()) == counts


def test_a_scheduler_that_does_not_answer_is_refused(monkeypatch):
    monkeypatch.setattr(cluster_module, "SCHEDULER_PATIENCE", 1)
    with (
        pytest.raises(UsageError, match=r"scheduler=.*no scheduler answers"),
        on_scheduler("tcp://127.0.0.1:1"),
    ):
        pass
    with pytest.raises(UsageError, match="scheduler"), on_scheduler("nowhere://x"):
        pass


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with (
        pytest.raises(MissingLibraryError, match=r"fem-impact\[cluster\]"),
        on_scheduler("tcp://127.0.0.1:1"),
    ):
        pass
