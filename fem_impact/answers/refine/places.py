"""The finest two levels of a scene and its twin at another place of the barrier's grid.

A finer level takes four to ten times as long as the last one. Where a budget does not hold that, it may hold
the last two again with the grid half a cell further: the scatter by the place of the grid is known then, and
the band need not allow for it unseen (`fem_impact.answers.refine.extrapolate.ONE_RUN`).
"""

from contextlib import closing
from dataclasses import replace
from functools import partial

from fem_impact.answers.refine import forecast
from fem_impact.answers.refine.chain import GRID_OFFSETS, LevelChain
from fem_impact.answers.refine.level import LevelRun, simulate_level
from fem_impact.case.case import Case
from fem_impact.case.record import together
from fem_impact.errors import RunError, SceneError
from fem_impact.options import RunOptions


def run_elsewhere(levels: LevelChain) -> bool:
    """Run the last two levels at the other place of the grid, too; say whether both gave their numbers.

    They do not run where the budget does not hold that, the barrier has no grid, or one of them does not
    resolve the narrow side of its contact: bands rest on the changes between levels alone there.
    """
    two = levels.done[-2:]
    if len(two) < 2 or not levels.case.bodies.contact.compliant or not all(map(_counts, two)):
        return False
    walls = [[run.cost.whole_wall for run in level.outcomes] for level in two]
    took_s = sum(forecast.longest_s(times, levels.workers) for times in walls)
    if levels.spent_s + took_s > levels.budget_s:
        return False
    with closing(forecast.Turns()) as turns:
        for at, level in zip((-2, -1), two, strict=True):
            try:
                more = _at_other_place(levels, level, turns)
            except (SceneError, RunError):
                return False
            if not _counts(more):
                return False
            levels.done[at] = more
    return True


def _counts(level: LevelRun) -> bool:
    return level.runs.wide and not level.cut_off


def _at_other_place(levels: LevelChain, level: LevelRun, turns: forecast.Turns) -> LevelRun:
    """Return a level with its runs at the other place of the grid beside those that it has."""
    begun, cases = forecast.now(), list[Case]()
    for case in level.cases:
        accuracy = case.scene.accuracy
        shifted = replace(accuracy, grid_shift=(accuracy.grid_shift + GRID_OFFSETS[1]) % 1.0)
        cases.append(Case.of(replace(case.scene, accuracy=shifted), "solid", case.record))
    workers = forecast.at_once(cases, levels.workers)
    number = 1 + next(at for at, one in enumerate(levels.done) if one.splits == level.splits)
    options = [
        RunOptions(
            progress=forecast.LevelProgress(
                show,
                f"{levels.scene.id}, level {number} at another place of the grid",
                used_s=levels.spent_s,
                limit_s=levels.limit_s,
                begun=begun,
            ).after(level.outcome.cost, forecast.turns(len(cases), workers))
        )
        for show in (levels.options.progress, *[None] * (len(cases) - 1))
    ]
    work = [partial(simulate_level, *one) for one in zip(cases, options, strict=True)]
    runs = turns(work, workers)
    outcomes = [*level.outcomes, *(outcome for outcome, _ in runs)]
    return replace(
        level,
        cases=(*level.cases, *cases),
        outcomes=tuple(outcomes),
        record=together([level.record, *(record for _, record in runs)]),
        wall_s=level.wall_s + forecast.now() - begun,
        earlier=(*level.earlier, *[0.0] * (len(outcomes) - len(level.earlier))),
    )
