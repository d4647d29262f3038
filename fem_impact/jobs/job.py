"""One job of a study, a scene and a fidelity, and the answer that a worker returns."""

from __future__ import annotations

import hashlib
import time
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.case.plan import plan
from fem_impact.errors import FemImpactError, ResultError, SceneError
from fem_impact.options import RunOptions
from fem_impact.run import simulate as run
from fem_impact.run.program import source_digest
from fem_impact.scene.write import digest

if TYPE_CHECKING:
    from fem_impact.outcome.record import Outcome
    from fem_impact.scene.types import Scene


Kind = tuple[str, float]
GUESS = {"rigid": 1e-3, "modal": 0.05}
"""Assumed processor time, s, of a job without a mesh, until one of its fidelity was measured."""
REFUSED = 0.05
"""Time, s, of a solid job whose scene is refused."""


@dataclass(frozen=True, slots=True)
class Job:
    """A scene to compute.

    Attributes
    ----------
    name : str
        Unique within its study.
    scene : Scene
    fidelity : str
        As `fem_impact.run.simulate.simulate` takes it.
    out : Path or None
        Directory for the files of the run (on a cluster one that all workers share); None keeps the
        outcome only.
    """

    name: str
    scene: Scene
    fidelity: str = "solid"
    out: Path | None = None

    @property
    def key(self) -> str:
        """Content address of the result: scene, fidelity, sources and library versions."""
        text = f"{digest(self.scene)} {self.fidelity} {source_digest()}"
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def kind(self) -> Kind:
        """Fidelity and tip size, m (0 without a mesh)."""
        return self.fidelity, _planned(self.scene)[0] if self.fidelity == "solid" else 0.0

    @property
    def planned_s(self) -> float:
        """Processor time, s, as the plan of its scene expects it; `GUESS` for a fidelity without a mesh."""
        return _planned(self.scene)[1] if self.fidelity == "solid" else GUESS[self.fidelity]


@cache
def _planned(scene: Scene) -> tuple[float, float]:
    """Return planned tip size, m, and processor time, s; where no mesh is possible, 0 and `REFUSED`."""
    try:
        planned = plan(scene)
    except SceneError:
        return 0.0, REFUSED
    return planned.zones.tip_size, planned.size.time


@dataclass(frozen=True, slots=True)
class Failure:
    """A job that gave no outcome, and why."""

    name: str
    reason: str


@dataclass(frozen=True, slots=True)
class Answer:
    """Answer of a worker: the outcome as text or the reason of a failure.

    Attributes
    ----------
    program : str
        Digest of the program that ran.
    outcome : str
        JSON text; empty when the job failed.
    reason : str
        Empty when it did not.
    lasting : bool
        Whether the same program would fail again, so that the failure is stored.
    wall_s : float
        Wall time, s.
    """

    program: str
    outcome: str
    reason: str
    lasting: bool
    wall_s: float


def compute(job: Job) -> Answer:
    """Run a job in this process. A failure is a value, so that a study goes on."""
    begun = time.perf_counter()
    program = source_digest()  # before the run: files may be changed during it
    text, reason, lasting = "", "", False
    try:
        text = _run(job)
    except FemImpactError as error:
        reason, lasting = str(error), error.exit_code in (3, 6)  # the scene or the run, not the disk
    except Exception as error:  # whatever went wrong, the other jobs of the study go on
        reason = repr(error)
    return Answer(program, text, reason, lasting, time.perf_counter() - begun)


def _run(job: Job) -> str:
    options = RunOptions(out=job.out, resume=True)
    try:
        return run.simulate(job.scene, job.fidelity, options).to_json()
    except ResultError:  # a checkpoint of another scene or program
        return run.simulate(job.scene, job.fidelity, replace(options, resume=False)).to_json()


def read_outcome(job: Job, text: str) -> Outcome:
    """Return the outcome of a job from its JSON text.

    Raises
    ------
    ResultError
        The text is damaged, or of another scene or fidelity, or the directory of the run does not hold the
        files of this run.
    """
    from fem_impact.outcome.record import Outcome

    outcome = Outcome.from_json(text, source=job.name)
    stated = outcome.provenance.scene_digest, outcome.provenance.fidelity
    if stated != (digest(job.scene), job.fidelity):
        raise ResultError(f"{job.name}: is an outcome of another scene or fidelity.")
    if job.out is not None:
        path = job.out / "outcome.json"
        if _run_of(Outcome.read(path)) != _run_of(outcome):
            raise ResultError(f"{path}: is of another run.")
    return outcome


def _run_of(outcome: Outcome) -> tuple[str, str, object]:
    """Return the identity of a run: scene digest, date and wall time."""
    return outcome.provenance.scene_digest, outcome.provenance.created_utc, outcome.cost.wall
