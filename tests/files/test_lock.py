"""One process writes to a result directory at a time; a terminated one leaves no draft and no worker."""

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
from other_processes import alive, children_of, wait_until

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import LOCK, directory_lock
from fem_impact.options import RunOptions
from fem_impact.outcome.record import Outcome
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load

HOLDER = """
import sys
from pathlib import Path
from fem_impact.files.atomic import directory_lock
with directory_lock(Path(sys.argv[1])):
    print("locked", flush=True)
    sys.stdin.read()
"""
WRITER = """
import sys, time
import fem_impact.files.fields_write as fields
from fem_impact.cli.main import main
write_mesh = fields.write_mesh
def slowly(*arguments):
    write_mesh(*arguments)
    print("writing", flush=True)
    time.sleep(60)
fields.write_mesh = slowly
sys.exit(main(["run", "quick", "--quiet", "--set", "accuracy.levels=1", "--out", sys.argv[1]]))
"""


def start(script, *arguments):
    line = [sys.executable, "-c", script, *map(str, arguments)]
    child = subprocess.Popen(
        line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    child.stdout.readline()
    return child


@contextmanager
def locked(out):
    """Another process that writes to ``out``."""
    child = start(HOLDER, out)
    try:
        yield child
    finally:
        child.communicate()


LINES = [
    ("run", "t5b", "--fidelity", "rigid"),
    ("run", "t5b", "--resume"),
    ("study", "gamma", "--quick"),
    ("study", "sets", "--estimate"),
    ("study", "report"),
    ("cost", "t5b"),
    ("stress", "--only", "angle-1"),
]


@pytest.mark.parametrize("line", LINES)
def test_a_second_command_into_the_same_directory_is_refused(cli, line):
    with locked("out") as first:
        code, _, err = cli(*line, "--out", "out")
        assert code == 4
        assert f"process {first.pid} on " in err
        assert "another directory" in err
        assert [path.name for path in Path("out").iterdir()] == [LOCK]


def test_a_second_run_leaves_the_first_alone(tmp_path):
    with directory_lock(tmp_path / "out"):
        first = simulate(load("t5b"), "rigid", RunOptions(tmp_path / "out"))
        refusals = []

        def second():
            try:
                simulate(load("t5c"), "rigid", RunOptions(tmp_path / "out"))
            except OutputPathError as error:
                refusals.append(str(error))

        thread = threading.Thread(target=second)
        thread.start()
        thread.join()
    assert f"process {os.getpid()}" in refusals[0]
    assert Outcome.read(tmp_path / "out" / "outcome.json") == first
    assert not (tmp_path / "out" / LOCK).exists()


def test_the_lock_of_a_killed_process_locks_nothing(tmp_path):
    first = start(HOLDER, tmp_path / "out")
    first.kill()
    first.communicate()
    assert (tmp_path / "out" / LOCK).exists()
    simulate(load("t5b"), "rigid", RunOptions(tmp_path / "out"))
    assert not (tmp_path / "out" / LOCK).exists()


def test_a_directory_that_cannot_be_locked_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputPathError, match="file: cannot be written"), directory_lock(tmp_path / "file"):
        pass


def test_a_file_system_without_locks_is_used_without(tmp_path, monkeypatch):
    def flock(*_):
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr("fcntl.flock", flock)
    with directory_lock(tmp_path):
        assert (tmp_path / LOCK).exists()


@pytest.mark.long
def test_a_terminated_run_leaves_no_draft(tmp_path):
    child = start(WRITER, tmp_path)
    assert list(tmp_path.glob(".fields-*"))
    child.terminate()
    _, err = child.communicate(timeout=30)
    assert child.returncode == 130
    assert "interrupted" in err
    assert (tmp_path / "scene.toml").exists()
    assert not list(tmp_path.glob(".*"))


@pytest.mark.long
def test_the_drafts_of_a_killed_run_are_removed_by_the_next(tmp_path):
    child = start(WRITER, tmp_path)
    child.kill()
    child.communicate()
    assert list(tmp_path.glob(".fields-*"))
    simulate(load("t5b"), "rigid", RunOptions(tmp_path))
    assert not list(tmp_path.glob(".*"))


@pytest.mark.long
@pytest.mark.parametrize("stop", [pytest.param(signal.SIGTERM, marks=pytest.mark.slow), signal.SIGKILL])
def test_a_stopped_cost_leaves_no_worker(tmp_path, stop):
    line = [sys.executable, "-m", "fem_impact", "cost", "t5b", "--quiet", "--out", str(tmp_path)]
    child = subprocess.Popen(line, stderr=subprocess.DEVNULL)
    wait_until(lambda: child.poll() is None and len(children_of(child.pid)) >= 2)  # worker, resource tracker
    time.sleep(1.0)
    workers = children_of(child.pid)
    child.send_signal(stop)
    assert child.wait(30) == (130 if stop == signal.SIGTERM else -signal.SIGKILL)
    wait_until(lambda: not any(map(alive, workers)), 10)
