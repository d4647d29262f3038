"""Runs killed at random moments leave readable files, and go on to the answer of a run left alone."""

import random
import shutil
import signal
import subprocess
import sys
import time

import pytest
import solid_scenes as scenes

from fem_impact.files.fields import read_fields
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import to_toml
from fem_impact.tables.table import read_csv

SCENE = replace_all(
    load("t5b"),
    {
        "accuracy.tip_size": "0.8 mm",
        "accuracy.across": 6,
        "accuracy.max_time": "60 us",
        "save.frames": 200,
        "projectile.length": "60 mm",
    },
)
PROBE = """
import sys
from pathlib import Path
from fem_impact.options import RunOptions
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load
print("ready", flush=True)
options = RunOptions(Path(sys.argv[2]), resume=True, checkpoint_s=float(sys.argv[3]))
simulate(load(sys.argv[1]), options=options)
"""


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The run that is never stopped: its scene file, its directory, and how long it took."""
    place = tmp_path_factory.mktemp("alone")
    (place / "scene.toml").write_text(to_toml(SCENE))
    begun = time.monotonic()
    child = start(place / "scene.toml", place / "run")
    assert child.wait() == 0
    return place / "scene.toml", place / "run", time.monotonic() - begun


def start(scene, out):
    words = [sys.executable, "-c", PROBE, str(scene), str(out), "0.05"]
    child = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "ready\n"
    child.stdout.close()
    return child


def numbers(outcome):
    return {k: v for k, v in outcome.to_dict().items() if k not in scenes.OF_THE_CLOCK}


def check_readable(out):
    """Whatever lies there can be read; return the number of files that were there."""
    readers = {"history.csv": read_csv, "fields.vtkhdf": read_fields, "outcome.json": Outcome.read}
    found = [read(out / name) for name, read in readers.items() if (out / name).exists()]
    if (out / "fields.vtkhdf").exists():
        fields = read_fields(out / "fields.vtkhdf")
        for frame in range(len(fields.times)):
            assert fields.point_data("displacement", frame).shape == fields.points.shape
    return len(found)


def kill_until_done(scene, out, chance, longest):
    """Start, kill and resume until a run gets to its end; return the number of kills."""
    kills = 0
    while True:
        child = start(scene, out)
        try:
            if child.wait(timeout=chance.uniform(0.0, longest)) == 0:
                return kills
            raise AssertionError("the run failed by itself")
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGKILL)
            child.wait()
            kills += 1
            check_readable(out)
            longest *= 1.1  # so that it ends, whatever the machine does


def differences(alone, out):
    """Names of the files that are not those of the run left alone, or should not be there."""
    _, whole, _ = alone
    ends = [numbers(Outcome.read(place / "outcome.json")) for place in (out, whole)]
    times = [read_fields(place / "fields.vtkhdf").times.tolist() for place in (out, whole)]
    same = {"outcome.json": ends[0] == ends[1], "fields.vtkhdf": times[0] == times[1]} | {
        name: (out / name).read_bytes() == (whole / name).read_bytes()
        for name in ("history.csv", "contacts.csv", "scene.toml")
    }
    left_over = {path.name for path in out.iterdir()} - {path.name for path in whole.iterdir()}
    # a run killed when it had just ended starts anew, and what it finds is set aside
    left_over = {name for name in left_over if not name.startswith((".", "earlier-"))}
    return {name for name in same if not same[name]} | left_over


def kill_once_begun(scene, out):
    """Start, and kill as soon as there is something to resume from; how long that takes is the machine's."""
    child = start(scene, out)
    while not (out / CHECKPOINT).exists():
        assert child.poll() is None
        time.sleep(0.005)
    child.send_signal(signal.SIGKILL)
    assert child.wait() == -signal.SIGKILL
    check_readable(out)


@pytest.mark.long
def test_killed_and_resumed_is_never_stopped(alone, tmp_path):
    scene, _, took = alone
    kill_once_begun(scene, tmp_path / "run")
    kill_until_done(scene, tmp_path / "run", random.Random(2), 1.2 * took)
    assert differences(alone, tmp_path / "run") == set()


@pytest.mark.slow
def test_dozens_of_kills_lose_nothing(alone, tmp_path):
    scene, _, took = alone
    chance, kills, runs = random.Random(7), 0, 0
    while kills < 60:
        kills += kill_until_done(scene, tmp_path / str(runs), chance, 0.4 * took)
        assert differences(alone, tmp_path / str(runs)) == set()
        shutil.rmtree(tmp_path / str(runs))
        runs += 1
    print(f"\n{kills} kills in {runs} runs, nothing lost")
