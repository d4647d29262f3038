"""Real processes: they end with their study, and the death of one costs one job at most."""

import os
import signal
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import BrokenExecutor
from pathlib import Path

import pytest
from other_processes import alive, children_of, wait_until
from scale_tasks import LOG, Acting, job

from fem_impact.errors import RunError
from fem_impact.jobs import run as run_module
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.job import Failure
from fem_impact.jobs.run import run_jobs
from fem_impact.progress import NullMeter

HERE = Path(__file__).parent
STUDY = """
import sys
from pathlib import Path
from scale_tasks import Acting, job
from fem_impact.progress import NullMeter
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.run import run_jobs
if __name__ == "__main__":
    jobs = [job(f"j{i}", "sleep 0.15") for i in range(12)]
    with LocalProcesses(2) as processes:
        found = run_jobs(jobs, Path(sys.argv[1]), NullMeter(), Acting(processes))
    print(len(found))
"""


class Meter:
    def __init__(self):
        self.seen = []

    def __call__(self, progress):
        self.seen.append(progress)


@pytest.mark.long
def test_a_job_that_kills_its_process_fails_alone(tmp_path):
    meter, once = Meter(), tmp_path / "died"
    jobs = [job("a"), job("deadly", "die"), job("unlucky", f"die-once {once}"), job("b"), job("bad", "fail")]
    with LocalProcesses(2) as processes:
        found = run_jobs(jobs, tmp_path / "store.sqlite", meter, Acting(processes))
    assert [name for name, result in found.items() if isinstance(result, Failure)] == ["deadly", "bad"]
    assert "process that computed it was killed" in found["deadly"].reason
    assert once.exists()
    assert [p.done for p in meter.seen] == [1, 2, 3, 4, 5]
    assert meter.seen[-1].total == 5
    assert meter.seen[-1].eta_s == 0.0


def test_threads_are_one_a_process():
    with LocalProcesses(1) as processes:
        assert processes.submit(os.getenv, "NUMBA_NUM_THREADS").result() == "1"


def test_an_error_of_a_call_comes_back_and_the_process_stays():
    with LocalProcesses(1) as processes:
        first = processes.submit(os.getpid).result()
        with pytest.raises(FileNotFoundError):
            processes.submit(os.stat, "no-such-place").result()
        assert processes.submit(os.getpid).result() == first


def test_a_fault_of_a_call_tells_its_place_in_the_other_process():
    with LocalProcesses(1) as processes, pytest.raises(ValueError, match="invalid literal") as fault:
        processes.submit(int, "no number").result()
    assert "answer = fn(*args, **kwargs)" in "".join(fault.value.__notes__)


def test_a_process_of_its_own_for_every_job():
    with LocalProcesses(1, reuse=False) as processes:
        first = processes.submit(os.getpid).result()
        with pytest.raises(FileNotFoundError):
            processes.submit(os.stat, "no-such-place").result()
        assert processes.submit(os.getpid).result() != first
        assert not alive(first)


def test_an_interrupt_stops_running_jobs_at_once():
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt), LocalProcesses(1) as processes:
        running = processes.submit(time.sleep, 60)
        processes.submit(time.sleep, 60)
        time.sleep(0.5)
        raise KeyboardInterrupt
    assert time.monotonic() - begun < 20
    assert isinstance(running.exception(), BrokenExecutor)


@pytest.mark.long
def test_a_worker_of_another_version_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(run_module, "source_digest", lambda: "another program")
    with LocalProcesses(1) as processes, pytest.raises(RunError, match="another version"):
        run_jobs([job("a")], tmp_path / "store.sqlite", NullMeter(), Acting(processes))


@pytest.mark.long
def test_a_study_killed_at_once_loses_and_repeats_nothing(tmp_path):
    script, log, store = tmp_path / "study.py", tmp_path / "log", tmp_path / "store.sqlite"
    script.write_text(STUDY)
    environment = {**os.environ, LOG: str(log), "PYTHONPATH": os.pathsep.join([str(HERE), *sys.path])}
    line = [sys.executable, str(script), str(store)]
    killed = subprocess.Popen(line, env=environment)
    wait_until(lambda: log.exists() and len(log.read_text().split()) >= 5)
    workers = children_of(killed.pid)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert workers
    wait_until(lambda: not any(map(alive, workers)))
    begun = Counter(log.read_text().split())
    done = subprocess.run(line, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "12\n"
    twice = [name for name, count in Counter(log.read_text().split()).items() if count > 1]
    # at most the two that were running when the study was killed
    assert len(twice) <= 2
    assert sum(begun.values()) - len(twice) >= 3


def test_two_jobs_of_one_name_are_refused(tmp_path):
    with pytest.raises(RunError, match="two runs have one name, a"):
        run_jobs([job("a"), job("b"), job("a", "fail")], tmp_path / "store.sqlite", NullMeter())
    assert not (tmp_path / "store.sqlite").exists()
