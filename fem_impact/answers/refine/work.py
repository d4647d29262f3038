"""The levels of a scene as work of a study: what each of them gave, stored and read back."""

import hashlib
import json
from dataclasses import dataclass
from math import inf

from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.extrapolate import MeshRuns
from fem_impact.case.case import Case
from fem_impact.errors import ResultError
from fem_impact.jobs.job import Job, JobKind
from fem_impact.outcome.record import Outcome
from fem_impact.run.program import source_digest
from fem_impact.scene.types import Scene, digest

# processor time of the levels of a default run over that planned of its last one, and of each finer level
# over the one before: about, for the order of jobs and a first forecast
ALL, FINER = 2.0, 3.0


@dataclass(frozen=True, slots=True)
class Levels:
    """Levels that have run, from coarse to fine.

    Attributes
    ----------
    meshes : of each level, up to the finest that saw the bodies part
    default : how many of them a run makes that is asked for no more
    """

    meshes: tuple[MeshRuns, ...]
    default: int


@dataclass(frozen=True, slots=True)
class LevelsJob:
    """The levels of a scene, as its runs make them, and finer ones.

    Attributes
    ----------
    name : unique within its study
    scene : Scene
    finer : levels beyond those of the scene's own run
    twin : a scene that runs on the same meshes
    budget_s : wall time, s, that all levels may take
    """

    name: str
    scene: Scene
    finer: int = 0
    twin: Scene | None = None
    budget_s: float = inf

    @property
    def key(self) -> str:
        """Content address of the result: the scenes, what is asked of them, and the program."""
        twin = digest(self.twin) if self.twin else ""
        text = f"{digest(self.scene)} {twin} {self.finer} {self.budget_s} {source_digest()}"
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def fidelity(self) -> str:
        """What tells works apart whose times do not compare."""
        return "levels"

    @property
    def kind(self) -> JobKind:
        """Fidelity, and no tip size: the meshes are the run's own affair."""
        return self.fidelity, 0.0

    @property
    def planned_s(self) -> float:
        """Expected processor time, s."""
        runs = 2 if self.twin else self.scene.accuracy.offsets or 1
        return runs * ALL * Job(self.name, self.scene).planned_s * FINER**self.finer

    def run(self) -> str:
        """Run the levels; return what each gave as JSON.

        Raises
        ------
        SceneError, RunError
            As `LevelChain.refine`.
        """
        chain = LevelChain(Case(self.scene), budget_s=self.budget_s, twin=self.twin)
        chain.refine()
        default, most = len(chain.done), chain.done[-1].splits + self.finer
        if self.finer and not chain.refused:
            chain.decides = lambda levels: levels[-1].splits >= most
            chain.refine()
        levels = [level.runs for level in chain.done[: chain.counted]]
        stored = [
            {**{name: getattr(level, name) for name in PLAIN}, "runs": [run.to_json() for run in level.runs]}
            for level in levels
        ]
        return json.dumps({"default": min(default, len(levels)), "meshes": stored})

    def read(self, text: str) -> Levels:
        """Return the levels from their text.

        Raises
        ------
        ResultError
            The text is damaged.
        """
        try:
            stored = json.loads(text)
            meshes = [
                MeshRuns(
                    runs=[Outcome.from_json(run, self.name) for run in level["runs"]],
                    **{name: level[name] for name in PLAIN},
                )
                for level in stored["meshes"]
            ]
            return Levels(tuple(meshes), int(stored["default"]))
        except (ValueError, TypeError, KeyError) as error:
            raise ResultError(f"{self.name}: its stored result is damaged ({error}).") from error

    def cpu_s(self, result: Levels) -> float:
        """Return the processor time, s, of all levels."""
        return sum(level.cpu_s for level in result.meshes)


PLAIN = ("size", "resolved", "wide", "rows", "repeats", "earlier")
"""What is stored of a level beside its outcomes."""
