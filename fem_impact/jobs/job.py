"""What a worker computes, such as a scene with a fidelity, its answer, and the store of answers.

The store is one SQLite file that only the process of the study writes.
"""

import hashlib
import json
import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Protocol, TypeVar

from fem_impact.case.case import Case
from fem_impact.errors import FemImpactError, OutputPathError, ResultError, SceneError
from fem_impact.files.atomic import make_directory
from fem_impact.options import RunOptions
from fem_impact.outcome.record import Outcome
from fem_impact.progress import silent
from fem_impact.run import simulate as run
from fem_impact.run.program import source_digest
from fem_impact.scene.types import Scene, digest

JobKind = tuple[str, float]
GUESS = {"rigid": 1e-3, "modal": 0.05}
"""Assumed processor time, s, of a job without a mesh, until one of its fidelity was measured."""
REFUSED = 0.05
"""Time, s, of a solid job whose scene is refused."""


Result = TypeVar("Result", covariant=True)


class Work(Protocol[Result]):
    """What a worker computes and a store keeps: the run of a scene (`Job`), or another with a result."""

    @property
    def name(self) -> str:
        """Unique within its study."""

    @property
    def key(self) -> str:
        """Content address of the result: all that it depends on, and the program."""

    @property
    def fidelity(self) -> str:
        """What tells works apart whose times do not compare."""

    @property
    def kind(self) -> JobKind:
        """Fidelity and tip size, m (0 without a mesh)."""

    @property
    def planned_s(self) -> float:
        """Expected processor time, s."""

    def run(self) -> str:
        """Compute the result, as text.

        Raises
        ------
        FemImpactError
            There is none: the work counts as failed.
        """

    def read(self, text: str) -> Result:
        """Return the result from its text.

        Raises
        ------
        ResultError
            The text is damaged or of other work.
        """

    def cpu_s(self, result: Any) -> float:
        """Return the processor time, s, that a result took."""


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
    way : callable or None
        What computes the outcome from scene, fidelity and `RunOptions`, a function of a module; None takes
        `fem_impact.run.simulate.simulate`, which runs on the mesh that the scene gives.
    """

    name: str
    scene: Scene
    fidelity: str = "solid"
    out: Path | None = None
    way: Callable[[Scene, str, RunOptions], Outcome] | None = None

    def __post_init__(self) -> None:
        if self.out:  # a worker may stand in another directory than this process
            object.__setattr__(self, "out", self.out.absolute())

    @property
    def key(self) -> str:
        """Content address of the result: scene, fidelity, sources and library versions."""
        way = f" {self.way.__module__}.{self.way.__qualname__}" if self.way else ""
        text = f"{digest(self.scene)} {self.fidelity} {source_digest()}{way}"
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def kind(self) -> JobKind:
        """Fidelity and tip size, m (0 without a mesh)."""
        return self.fidelity, _planned(self.scene)[0] if self.fidelity == "solid" else 0.0

    @property
    def planned_s(self) -> float:
        """Processor time, s, as the case of its scene expects it; `GUESS` for a fidelity without a mesh."""
        return _planned(self.scene)[1] if self.fidelity == "solid" else GUESS[self.fidelity]

    def run(self) -> str:
        """Return the outcome as JSON; a run with files goes on from its checkpoint."""
        options = RunOptions(out=self.out, resume=True, progress=silent)
        way = self.way or run.simulate
        try:
            return way(self.scene, self.fidelity, options).to_json()
        except ResultError:  # a checkpoint of another scene or program
            return way(self.scene, self.fidelity, replace(options, resume=False)).to_json()

    def read(self, text: str) -> Outcome:
        """Return the outcome from its JSON text.

        Raises
        ------
        ResultError
            The text is damaged, or of another scene or fidelity, or the directory of the run does not hold
            the files of this run.
        """
        outcome = Outcome.from_json(text, source=self.name)
        written = outcome.provenance.scene_digest, outcome.provenance.fidelity
        if written != (digest(self.scene), self.fidelity):
            raise ResultError(f"{self.name}: is an outcome of another scene or fidelity.")
        if self.out is not None:
            path = self.out / "outcome.json"
            if _run_of(Outcome.read(path)) != _run_of(outcome):
                raise ResultError(f"{path}: is of another run.")
        return outcome

    def cpu_s(self, result: Outcome) -> float:
        """Return the processor time, s, of steps and set-up of an outcome."""
        return result.cost.whole_cpu


@cache
def _planned(scene: Scene) -> tuple[float, float]:
    """Return planned tip size, m, and processor time, s; where no mesh is possible, 0 and `REFUSED`."""
    try:
        planned = Case.of(scene)
    except SceneError:
        return 0.0, REFUSED
    return planned.zones.tip_size, planned.size.time


@dataclass(frozen=True, slots=True)
class Failure:
    """A job that gave no outcome, and why."""

    name: str
    reason: str


JobResults = dict[str, Outcome | Failure]
"""What jobs gave, by their names."""


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


def compute(job: Work[object]) -> Answer:
    """Run a job in this process. A failure is a value, so that a study goes on."""
    begun = time.perf_counter()
    program = source_digest()  # before the run: files may be changed during it
    text, reason, lasting = "", "", False
    try:
        text = job.run()
    except FemImpactError as error:
        reason, lasting = str(error), error.lasting
    except Exception as error:  # whatever went wrong, the other jobs of the study go on
        reason = repr(error)
    return Answer(program, text, reason, lasting, time.perf_counter() - begun)


def _run_of(outcome: Outcome) -> tuple[str, str, object]:
    """Return the identity of a run: scene digest, date and wall time."""
    return outcome.provenance.scene_digest, outcome.provenance.created_utc, outcome.cost.wall


STORE = "store.sqlite"
_TABLE = """
CREATE TABLE IF NOT EXISTS answers (
  key TEXT PRIMARY KEY, name TEXT, fidelity TEXT, tip_size_m REAL, outcome TEXT, reason TEXT, wall_s REAL,
  checksum TEXT
)
"""
_INSERT = "INSERT OR REPLACE INTO answers VALUES (?, ?, ?, ?, ?, ?, ?, ?)"
PATIENCE = 30.0  # s to wait while another process reads or writes
# remedies for faults of the place by SQLite's primary result code; any other fault is a damaged file
_PLACE = {
    sqlite3.SQLITE_FULL: "Free some space.",
    sqlite3.SQLITE_BUSY: "Close the program that uses it.",
    sqlite3.SQLITE_LOCKED: "Close the program that uses it.",
    **dict.fromkeys(
        (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_IOERR),
        "Check that its place can be read and written, or choose another place.",
    ),
}


class Store:
    """The answers in a file; made by `Store.open`."""

    def __init__(self, path: Path, base: sqlite3.Connection) -> None:
        self._path, self._base = path, base

    @classmethod
    @contextmanager
    def open(cls, path: Path) -> "Iterator[Store]":
        """Open the file, make it if it is not there, and close it at the end.

        Raises
        ------
        OutputPathError
            The file cannot be made.
        ResultError
            The file is no store, or damaged.
        """
        make_directory(path.parent)
        try:
            base = sqlite3.connect(path, timeout=PATIENCE)
        except sqlite3.Error as error:
            raise OutputPathError(f"{path}: cannot be opened ({error}).") from error
        try:
            with _named(path):
                # one commit a result: it outlives a killed process without waiting for the disk
                base.execute("PRAGMA journal_mode=WAL")
                base.execute("PRAGMA synchronous=NORMAL")
                base.execute(_TABLE)
            yield cls(path, base)
        finally:
            base.close()

    def get(self, job: Work[object]) -> tuple[str, str] | None:
        """Return text of the result and reason of a failure, None if there is no answer.

        Raises
        ------
        ResultError
            The stored answer does not match its checksum.
        """
        key = job.key
        with _named(self._path):
            rows = self._base.execute("SELECT outcome, reason, checksum FROM answers WHERE key = ?", (key,))
            row = rows.fetchone()
        if row is None:
            return None
        outcome, reason, checksum = row
        if checksum != _checksum(key, outcome, reason):
            raise ResultError(f"{job.name}: its stored answer does not match its checksum.")
        return outcome, reason

    def put(self, job: Work[object], answer: Answer) -> None:
        """Keep an answer."""
        row = (job.key, job.name, *job.kind, answer.outcome, answer.reason, answer.wall_s)
        with _named(self._path), self._base:
            self._base.execute(_INSERT, (*row, _checksum(job.key, answer.outcome, answer.reason)))


def _checksum(key: str, outcome: object, reason: object) -> str:
    """Return the SHA-256 of key and answer; a damaged row may hold values of any type."""
    return hashlib.sha256(json.dumps([key, outcome, reason], default=repr).encode()).hexdigest()


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Raise OutputPathError for a fault of the place, ResultError for a damaged file."""
    try:
        yield
    except (sqlite3.Error, UnicodeDecodeError) as error:  # the library quotes a spoiled name in its message
        code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT)
        remedy = _PLACE.get(code & 0xFF)
        if remedy and code != sqlite3.SQLITE_IOERR_SHORT_READ:
            raise OutputPathError(f"{path}: cannot be used ({error}). {remedy}") from error
        problem = f"{path}: is damaged ({error}). Move it away; its results are computed again."
        raise ResultError(problem) from error
