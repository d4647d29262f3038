"""Jobs that other processes can import: a solver whose behaviour stands in the title of its scene."""

import os
import signal
import time
from concurrent.futures import Executor
from pathlib import Path
from unittest import mock

from outcome_maker import outcome

import fem_impact.run.simulate
from fem_impact.errors import RunError
from fem_impact.jobs.job import Job, compute
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest

LOG = "SCALE_TEST_LOG"


def job(name, does="", **kept):
    """A job that ``does`` something: fails, dies, dies once, breaks, or sleeps some seconds."""
    return Job(name, replace_all(load("t5b"), {"id": name, "title": f"does {does}"}), "rigid", **kept)


def record(scene, fidelity="rigid"):
    """A complete outcome of a scene."""
    return outcome(fidelity=fidelity, scene_id=scene.id, scene_digest=digest(scene))


def simulate(scene, fidelity="solid", options=None):
    """Act as the title says; every call is logged."""
    if LOG in os.environ:
        with Path(os.environ[LOG]).open("a") as log:
            log.write(f"{scene.id}\n")
    word, _, rest = scene.title.removeprefix("does ").partition(" ")
    act(word, rest)
    found = record(scene, fidelity)
    if options and options.out is not None:
        found.write(options.out / "outcome.json")
    return found


def act(word, rest):
    if word == "sleep":
        time.sleep(float(rest))
    elif word == "fail":
        raise RunError("An element folded at 12.00 us.")
    elif word == "break":
        raise ZeroDivisionError("a fault of the program")
    elif word == "die" or (word == "die-once" and not Path(rest).exists()):
        if rest:
            Path(rest).touch()
        os.kill(os.getpid(), signal.SIGKILL)


def computed(job):
    """What a worker does, with the solver above."""
    # a worker may live in the process of the tests, whose other tests want the true one back
    with mock.patch.object(fem_impact.run.simulate, "simulate", simulate):
        return compute(job)


class Acting(Executor):
    """Another executor, whose workers use the solver above."""

    def __init__(self, inner):
        self.inner = inner

    def submit(self, fn, job):
        return self.inner.submit(computed, job)


class Here(Executor):
    """Runs every job at once in this process."""

    def __init__(self):
        self.names = []

    def submit(self, fn, job):
        from concurrent.futures import Future

        self.names.append(job.name)
        future = Future()
        future.set_result(fn(job))
        return future
