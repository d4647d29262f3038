"""The one refinement loop: meshes from coarse to fine until a judge decides or the time is used up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import sqrt
from typing import Literal, Protocol

from fem_impact.answers.refine.budget import Budget, below
from fem_impact.answers.refine.extrapolate import EVEN, MeshRuns
from fem_impact.answers.refine.levels import (
    FEW_OFFSETS,
    GRID_OFFSETS,
    at_offsets,
    contact_size,
    mesh_levels,
    on_mesh,
)
from fem_impact.errors import FemImpactError, RunError, SceneError
from fem_impact.options import RunOptions
from fem_impact.scene.types import Scene

SETTLED = EVEN[len(GRID_OFFSETS)] / EVEN[FEW_OFFSETS] * sqrt(FEW_OFFSETS / len(GRID_OFFSETS))
"""Share of the scatter at few grid offsets that is left at all of them."""


@dataclass(frozen=True, slots=True)
class Level:
    """What may run on one mesh.

    Attributes
    ----------
    size : edge of the cells that resolve the contact, m
    scenes : the scene at all of its grid offsets, or a scene and its twin
    """

    size: float
    scenes: tuple[Scene, ...]


def levels_at_offsets(scene: Scene) -> tuple[Level, ...]:
    """Return all levels that can be made for a scene, from coarse to fine, each at all of its grid offsets.

    Raises
    ------
    SceneError
        None can be made.
    """
    return _levels([tuple(at_offsets(scene, mesh)) for mesh in mesh_levels(scene)])


def levels_of_twins(scene: Scene, twin: Scene) -> tuple[Level, ...]:
    """Return all levels that can be made for a scene and its twin, from coarse to fine.

    Raises
    ------
    SceneError
        None can be made for one of them.
    """
    both = [mesh for mesh in mesh_levels(scene) if mesh in mesh_levels(twin)]
    return _levels([(on_mesh(scene, mesh), on_mesh(twin, mesh)) for mesh in both])


def _levels(scenes: Sequence[tuple[Scene, ...]]) -> tuple[Level, ...]:
    return tuple(Level(contact_size(on_level[0]), on_level) for on_level in scenes)


class Judge(Protocol):
    """What turns finished levels into a decision."""

    def failure(self, done: MeshRuns) -> str:
        """Return why runs on a level cannot be judged, empty where they can."""
        ...

    def decided(self, done: Sequence[MeshRuns], scatter: float = 1.0) -> bool:
        """Say whether finished levels, from coarse to fine, are enough for an answer.

        ``scatter`` is the share of their scatter over the grid offsets that counts.
        """
        ...


@dataclass(frozen=True, slots=True)
class Stop:
    """Why a loop ended.

    Attributes
    ----------
    because : the judge ``decided``; the ``finest`` level has run; the ``budget`` does not afford another run;
        or a level ``failed``, which does not count
    error : of the level that failed
    """

    because: Literal["decided", "finest", "budget", "failed"]
    error: FemImpactError | None = None


Batch = tuple[int, Sequence[Scene]]
"""Scenes that run together, with the number of their level."""


@dataclass(slots=True)
class RefinementLoop:
    """Levels from coarse to fine, as far as a budget allows, until a judge decides.

    The coarsest level runs at few grid offsets where the next fits then, too, else at the first alone, and so
    do finer ones. What a level took forecasts the next one. The other offsets of the finest two levels run
    where only their scatter is in the way.

    Attributes
    ----------
    levels : from coarse to fine
    budget : of all runs
    options : of the first run; the files of each further one lie in a directory of their own
    least : levels that run whatever the budget
    first : scenes of a level that run at least: one offset, or both twins
    announce : called before a level begins with its number, from 0, and its forecast time, s
    done : runs on each level so far, from coarse to fine
    finest_run : number of the first run on the finest of these
    """

    levels: Sequence[Level]
    budget: Budget
    options: RunOptions = field(default_factory=RunOptions)
    least: int = 1
    first: int = 1
    announce: Callable[[int, float], object] = lambda level, seconds: None
    done: list[MeshRuns] = field(default_factory=list)
    finest_run: int = 0

    def run(self, judge: Judge) -> Stop:
        """Run levels until the judge decides or no other can run; a failure leaves the coarser ones."""
        while len(self.done) < max(self.least, 1) or not judge.decided(self.done):
            batches = self._next(judge)
            if not batches:
                return Stop("budget" if self.finer else "finest")
            try:
                for level, scenes in batches:
                    self._run(level, scenes, judge)
            except (RunError, SceneError) as error:  # a mesh that folds is found when it is made
                return Stop("failed", error)
        return Stop("decided")

    @property
    def finer(self) -> Sequence[Level]:
        """The levels that have not run."""
        return self.levels[len(self.done) :]

    @property
    def at_few(self) -> bool:
        """Whether the coarsest level ran at few grid offsets or more, or at all that it has."""
        return len(self.done[0].runs) >= min(FEW_OFFSETS, len(self.levels[0].scenes))

    def _next(self, judge: Judge) -> list[Batch]:
        """Return the scenes that run next, each with the number of its level; none where none fits."""
        ran, affords = len(self.done), self.budget.affords
        if ran == 1 and len(self.done[0].runs) == self.first:
            second = self.levels[0].scenes[self.first : FEW_OFFSETS]
            if second and affords(second, *(level.scenes[:FEW_OFFSETS] for level in self.finer[:1])):
                return [(0, second)]
        others = self._other_offsets(judge)
        if others and affords(*(scenes for _, scenes in others)):
            return others
        for scenes in self._choices():
            if ran < self.least or affords(scenes):
                return [(ran, scenes)]
        return []

    def _other_offsets(self, judge: Judge) -> list[Batch]:
        """Return the other offsets of the finest two levels, where only their scatter is in the way."""
        ran = len(self.done)
        if ran < 2 or not self.at_few:
            return []
        others: list[Batch] = [
            (level, self.levels[level].scenes[len(self.done[level].runs) :]) for level in (ran - 2, ran - 1)
        ]
        return others if all(scenes for _, scenes in others) and judge.decided(self.done, SETTLED) else []

    def _choices(self) -> Sequence[Sequence[Scene]]:
        """Return the next level at few offsets, and at the first alone where no more fit of those before."""
        following = [level.scenes for level in self.finer[:1]]
        at_few = bool(self.done) and self.at_few
        few = [scenes[:FEW_OFFSETS] for scenes in following if at_few]
        return few + [scenes[: self.first] for scenes in following if len(self.done) < 2 or not at_few]

    def _run(self, level: int, scenes: Sequence[Scene], judge: Judge) -> None:
        """Run scenes of a level, the next one or one that ran, and add them to what is done.

        Raises
        ------
        RunError, SceneError
            A run failed, its mesh could not be made, or the judge cannot use it.
        """
        self.announce(level, self.budget.forecast_s(scenes))
        before = sum(len(mesh.runs) for mesh in self.done)
        options = [below(self.options, before + at) for at in range(len(scenes))]
        runs = MeshRuns(self.levels[level].size, self.budget.run(scenes, options))
        if failure := judge.failure(runs):
            raise RunError(failure)
        if level == len(self.done):
            self.done.append(runs)
            self.finest_run = before
        else:
            self.done[level].runs.extend(runs.runs)
