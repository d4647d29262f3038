"""Levels of finite elements until a question is decided, or the budget is used up."""

import shlex
from collections.abc import Callable, Mapping, Sequence
from math import ceil, log2
from typing import Any, Protocol, TypeVar

from fem_impact.answers.refine.chain import MOST_FINER, LevelChain
from fem_impact.answers.refine.forecast import about_s, for_levels_s, turns
from fem_impact.answers.refine.level import LevelRun
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.answers.refine.places import run_elsewhere
from fem_impact.answers.verdict.vibration import Answer, GradedAnswer
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.jobs.executors import cores
from fem_impact.options import RunOptions
from fem_impact.progress import Notice, Progress
from fem_impact.scene.types import Scene
from fem_impact.tables.text import plain

LEAST_LEVELS = 2
"""Levels that an answer needs: one alone cannot estimate its own error."""
Tell = Callable[[str], object]
Means = Mapping[str, Any]
"""Arguments of `fem_impact.assess`: its ``fidelity`` and ``budget_s``."""
AT_ONCE = 2
"""Runs that a level of twins carries out at a time, where the machine has as many cores."""


class Found(Protocol):
    """A number with its error."""

    def answer(self, limit: float) -> Answer:
        """Say whether the number stays below a limit."""
        ...

    def graded(self, limit: float) -> GradedAnswer:
        """Return the answer, or a probable one where there is one."""
        ...

    def over(self, limit: float) -> float:
        """Return the error over the one with which there would be an answer."""
        ...


Number = TypeVar("Number", bound=Found)


def by_levels(
    twins: tuple[Scene, Scene | None],
    estimate: Callable[[Sequence[LevelRun]], Number | None],
    as_text: Callable[[Number], str],
    limit: float,
    means: tuple[float, int | None],
    tell: Tell,
    steps: list[str],
    before_s: float = 0.0,
    needed: int = LEAST_LEVELS,
) -> tuple[Number | None, list[str], Means]:
    """Return what finite elements say, None where they tell nothing; notes; the means for another level.

    An interrupt ends the levels: those that ran count.

    Parameters
    ----------
    twins : the scene, and another that runs on its meshes or None
    estimate : of levels from coarse to fine, None where they give no number
    as_text : the number and its error as text
    means : budget, s, and runs at a time; None: `AT_ONCE`
    tell : called with a sentence as a level begins, and after each
    steps : a sentence on each level is added, once that has run
    before_s : of the whole budget, s, what went by before
    needed : levels without which ``estimate`` tells nothing

    Raises
    ------
    SceneError, RunError
        The scene cannot be meshed, or its first level does not come to an end.
    """
    heard, told = set[str](), list[Number | None]()

    def report(ran: Sequence[LevelRun]) -> Number | None:
        for number, level in enumerate(ran[len(told) :], len(told) + 1):
            told.append(estimate(ran[:number]))
            found = told[-1]
            said = "no band yet" if found is None else f"{as_text(found)}: {found.graded(limit)}"
            took = f"cells of {plain(1e3 * level.size, 2)} mm in {about_s(level.wall_s)}"
            steps.append(f"finite elements, level {number}, {took}: {said}")
            tell(steps[-1])
        return told[-1]

    def decided(found: Number | None) -> bool:
        return found is not None and found.answer(limit) != "undecided"

    def decides(ran: Sequence[LevelRun]) -> bool:
        # two levels may agree by chance where the coarser does not resolve the contact: a third one follows
        return decided(report(ran)) and (len(ran) != LEAST_LEVELS or ran[0].runs.wide)

    def announce(progress: Progress | Notice) -> None:
        if isinstance(progress, Progress) and progress.note not in heard:
            heard.add(progress.note)
            tell(f"finite elements, {progress.note} ...")

    (free, twin), (budget_s, workers) = twins, means
    workers = workers or min(AT_ONCE, cores())
    levels = LevelChain(Case(free), RunOptions(progress=announce), budget_s, workers, decides, twin)
    try:
        levels.refine()
        if not decided(report(levels.done)) and twin and told[-1] and run_elsewhere(levels):
            told[-1] = found = estimate(levels.done)
            last, said = len(told), "no band" if found is None else f"{as_text(found)}: {found.graded(limit)}"
            two = f"levels {last - 1} and {last} at another place of the grid, too"
            steps.append(f"finite elements, {two}: {said}")
            tell(steps[-1])
    except KeyboardInterrupt:
        return told[-1] if told else None, [STOPPED.format(len(told))], with_budget(ceil(before_s + budget_s))
    estimated = report(levels.done)
    if decided(estimated):
        return estimated, [], {}
    over = None if estimated is None else estimated.over(limit)
    return estimated, *_open(levels, over, before_s, needed)


HOPELESS = 1000.0  # times that an error is too large, from which on no level is advised
ON_THE_LIMIT = (
    "It lies so near the limit that finer levels will hardly decide: an error about halves on each, and "
    "would have to be a thousandth of this one or less."
)
NO_ANSWER = "Finite elements have no answer here"
STOPPED = "It was stopped by hand after {} levels of finite elements; those count."


def _open(levels: LevelChain, over: float | None, before_s: float, needed: int) -> tuple[list[str], Means]:
    """Return why levels leave an answer open, and the means for another.

    ``over`` is their error over the one with which there would be an answer, None where they tell no number,
    of which fewer than ``needed`` never do.
    """
    if over is not None and over >= HOPELESS:
        return [ON_THE_LIMIT], {}
    lacking = needed - len(levels.done)
    note, enough = levels.advice(before_s, max(lacking, 1) if over is None else halvings(over))
    if over is not None:
        return [note], with_budget(enough)
    ends = [one.validity for one in levels.done[-1].outcomes if not one.validity.finished]
    if ends:  # as it would on finer meshes: the rod's tail strikes, or it touches for too long
        return [f"{NO_ANSWER}: {ends[0].stopped_because}"], {}
    nothing = "The last level of finite elements does not resolve the contact."
    if len(levels.done) < LEAST_LEVELS:
        nothing = "One level of finite elements alone does not tell its error."
    if needed > max(LEAST_LEVELS, len(levels.done)):
        nothing = f"Finite elements tell this number from {needed} levels on."
    return [note, nothing], with_budget(enough)


def halvings(over: float) -> int:
    """Return how many levels bring down an error so many times too large: each about halves it."""
    return ceil(log2(min(max(2.0, over), 2.0**MOST_FINER)))


def with_budget(budget_s: int | None) -> Means:
    """Return the means of a budget, s; none where none helps."""
    return {} if budget_s is None else {"budget_s": budget_s}


def finite_elements(scene: Scene, budget_s: float, levels: int = LEAST_LEVELS, places: int = 1) -> Means:
    """Return the means that let finite elements answer: a wall time, s, that holds levels of twins at places.

    None help where finite elements cannot compute the scene.
    """
    try:
        pilot_s = LevelMeshes.of(Case(scene)).pilot.size.time
    except SceneError:
        return {}
    both_s = pilot_s * turns(2, min(AT_ONCE, cores()))
    return {"fidelity": "solid", "budget_s": max(budget_s, for_levels_s(both_s, levels, places))}


def next_step(command: str, more: Means) -> str | None:
    """Return the command that asks again with ``more`` means, None where none are known."""
    if not more:
        return None
    words = ["--fidelity", more["fidelity"]] if "fidelity" in more else []
    words += ["--budget", f"{more['budget_s']:g} s"]
    return f"{command} {shlex.join(words)}"
