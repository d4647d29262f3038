"""Levels of finite elements until a question is decided, or the budget is used up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol, TypeVar

from fem_impact.answers.refine.budget import LONGER, about_s
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.level import LevelRun
from fem_impact.answers.verdict.effect import Answer
from fem_impact.case.case import Case
from fem_impact.options import RunOptions
from fem_impact.progress import Notice, Progress
from fem_impact.tables.text import plain

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene

LEAST_LEVELS = 2
"""Levels that an answer needs: one alone cannot estimate its own error."""
Tell = Callable[[str], object]


class Found(Protocol):
    """A number with its error."""

    def answer(self, limit: float) -> Answer:
        """Say whether the number stays below a limit."""
        ...


Number = TypeVar("Number", bound=Found)


def by_levels(
    twins: tuple[Scene, Scene | None],
    estimate: Callable[[Sequence[LevelRun]], Number | None],
    told: Callable[[Number], str],
    limit: float,
    means: tuple[float, int],
    tell: Tell,
    steps: list[str],
) -> tuple[Number | None, list[str], str]:
    """Return what finite elements say, None where they tell nothing; notes; options for another level.

    Parameters
    ----------
    twins : the scene, and another that runs on its meshes or None
    estimate : of levels from coarse to fine, None where they give no number
    told : the number and its error as text
    means : budget, s, and runs at a time
    tell : called with a sentence as a level begins, and after each
    steps : a sentence on each level is added

    Raises
    ------
    SceneError, RunError
        The scene cannot be meshed, or its first level does not come to an end.
    """

    def decides(levels: Sequence[LevelRun]) -> bool:
        found = estimate(levels)
        return found is not None and found.answer(limit) != "undecided"

    begun = set[str]()

    def announce(progress: Progress | Notice) -> None:
        if isinstance(progress, Progress) and progress.note not in begun:
            begun.add(progress.note)
            tell(f"finite elements, {progress.note} ...")

    free, twin = twins
    levels = LevelChain(Case(free), RunOptions(progress=announce), *means, decides, twin)
    levels.refine()
    found = None
    for number, level in enumerate(levels.done, 1):
        found = estimate(levels.done[:number])
        said = "no band yet" if found is None else f"{told(found)}: {found.answer(limit)}"
        took = f"cells of {plain(1e3 * level.size, 2)} mm in {about_s(level.wall_s)}"
        steps.append(f"finite elements, level {number}, {took}: {said}")
        tell(steps[-1])
    if decides(levels.done):
        return found, [], ""
    note, more = _why_stopped(levels)
    if found is not None:
        return found, [note], more
    nothing = "The last level of finite elements does not resolve the contact."
    if levels.done[-1].stopped:
        nothing = f"Finite elements have no answer here: {levels.done[-1].stopped}"
    elif len(levels.done) < LEAST_LEVELS:
        nothing = "One level of finite elements alone does not tell its error."
    return None, [note, nothing], more


def _why_stopped(levels: LevelChain) -> tuple[str, str]:
    """Return a note on why no other level runs, and the options with which one would."""
    if levels.failed:
        return f"Finite elements give no result on level {len(levels.done) + 1}: {levels.failed}", ""
    then = levels.following
    if then is None:
        return "No finer level is tried.", ""
    more_s, spent_s = levels.forecast_s(then), levels.spent_s
    left_s, enough = max(levels.budget_s - spent_s, 0.0), about_s(spent_s + LONGER * more_s)
    note = (
        f"Level {len(levels.done) + 1}, finer, would take about {about_s(more_s)} more, and "
        f"{plain(left_s, 2)} s are left of the budget of {levels.budget_s:g} s. For it give "
        f"a budget of {enough}."
    )
    return note, f'--budget "{enough}"'
