"""How long levels take that have not run yet, as a range, and the progress that tells it.

The mesh of a level says how long its run takes: by its cells, those that may yield, and its steps. Finer
levels are forecast from it by what halving the cells costs. Several runs share one process or two.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise, zip_longest
from math import ceil, floor, inf, log10, sqrt
from time import perf_counter, process_time
from typing import Any, Self, TypeVar

from fem_impact.answers.refine.level import LevelRun
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.case.case import Case
from fem_impact.case.record import ContactRecord
from fem_impact.case.size import machine_memory, setup_time
from fem_impact.errors import RunError, SceneError
from fem_impact.fem.kernels import COMPILING
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.outcome.groups import RunCost
from fem_impact.outcome.keys import known
from fem_impact.progress import Notice, Progress, left_text
from fem_impact.scene.types import Scene

Work = TypeVar("Work")
Result = TypeVar("Result")

# Largest ratio of what a mesh took to its forecast from the mesh before it, of 26 pairs of meshes of the 13
# measured sets (.75 to 1.54, root mean square factor 1.21); a budget that is advised for a mesh that stands
# holds as much
LONGER = 1.55
# the same of 95 % of 84 levels of other scenes before their mesh stood, see `MIDDLE`
LONGER_UNMESHED = 2.2
# of that forecast, what 5 % of 80 levels of 32 scenes (seed 20262401; median .87) took less than. One that
# the budget may hold begins, and is given up within seconds where its mesh, once made, says that it does not
SHORTER = 0.4


class Turns:
    """Carries out pieces of work, by two workers half of it in another process, which stays for the next."""

    def __init__(self) -> None:
        self._other: LocalProcesses | None = None

    def __call__(self, work: Sequence[Callable[[], Result]], workers: int) -> list[Result]:
        """Return the results in the order of the work."""
        shares = by_worker(work, workers)
        if len(shares) > 1:
            self._other = self._other or LocalProcesses(1)
        try:
            later = [self._other.submit(_done, share) for share in shares[1:]] if self._other else []
            done = [_done(shares[0]), *(share.result() for share in later)]
        except BaseException:
            self.close()  # the other half is not waited for
            raise
        return [result for turn in zip_longest(*done) for result in turn if result is not None]

    def close(self) -> None:
        """End the other process, if there is one."""
        if self._other:
            self._other.shutdown(cancel_futures=True)
            self._other = None


def _done(work: Sequence[Callable[[], Result]]) -> list[Result]:
    """Do work piece after piece; a function of the module, since it is sent to another process."""
    return [piece() for piece in work]


def by_worker(work: Sequence[Work], workers: int) -> list[Sequence[Work]]:
    """Return which work each process does: every second piece another one's, where there are two."""
    return [work[0::2], work[1::2]] if workers > 1 and len(work) > 1 else [work]


def at_once(cases: Sequence[Case], workers: int) -> int:
    """Return how many runs of these cases go on at a time: one where memory does not hold all of them."""
    return workers if sum(case.size.memory for case in cases) <= machine_memory() else 1


def turns(runs: int, workers: int) -> int:
    """Return how many of so many runs the busiest process does."""
    return max(map(len, by_worker(range(runs), workers)))


def longest_s(times: Sequence[float], workers: int) -> float:
    """Return the time, s, of the process that is busy longest."""
    return max(map(sum, by_worker(times, workers)))


def about_s(time: float) -> str:
    """Return a time as text in whole seconds, at least one, two digits of them: 4 s, 17 s, 170 s."""
    return f"{max(float(f'{time:.2g}'), 1.0):.0f} s"


# What the levels took that were still to run when the mesh of the second stood, over what was planned for
# them, of 291 scenes of the study of coverage (seed 20261801): 5 % took less than the first times the levels
# that the pilot's contact asks for; half took less than the second, 5 % more than the third times those that
# the estimated contact asks for. Conformal (Vovk et al. 2005, doi:10.1007/b106715); the 24 that were broken
# off after 60 s count by Kaplan and Meier (1958, doi:10.1080/01621459.1958.10501452).
LEFT = (0.42, 0.8, 3.9)
# of the forecast of a level whose mesh stands: 3 of 134 second levels of scenes (seed 20261901) took less,
# 90 % of them .65 to 1.54; and how many times as long a level takes as one with cells twice as large, in the
# median of 84 levels of other scenes (5 to 95 %: 1.0 to 5.3)
SURELY, MIDDLE = 0.6, 2.4
# least of what a pilot takes over its forecast, by its mesh or before there is one: the contact that it finds
# may be much shorter than the estimate
PILOT = 0.33
WORTH = 10.0  # s: a time left that is told in a sentence of its own
# of an impact's duration, after which its pace counts: a level that surely does not end in time is given up.
# Its step only falls from there, as cells are squeezed
SHOWN = 0.2
SEEN = 1.0  # s of processor time after which what a level shows of the load counts as much as the one before


def now() -> float:
    """Return the time, s, on a clock that stands still while kernels are compiled, once on a machine."""
    return perf_counter() - COMPILING.wall


def worked() -> float:
    """Return the processor time, s, of this process without that of compilation."""
    return process_time() - COMPILING.cpu


def budget_of(refused: SceneError | RunError | None, before_s: float = 0.0) -> int | None:
    """Return a budget, s, with which what was refused would run after ``before_s``, None where none helps."""
    enough = refused.enough_s if isinstance(refused, OverBudgetError) else None
    return None if enough is None else enough + ceil(before_s)


class OverBudgetError(RunError):
    """A level that takes longer than its budget allows; ``enough_s`` is one, s, that holds it, if known."""

    lasting = False  # it depends on how busy the machine was

    def __init__(self, reason: str, enough_s: int | None = None) -> None:
        super().__init__(reason)
        self.enough_s = enough_s


def lasting(shown_s: float, planned_s: float) -> float:
    """Return how long an impact lasts over its plan, where a level before showed ``shown_s``; 0: none did.

    It is the geometric mean of both: on a coarse mesh a contact is too stiff, and the estimate knows no mesh.
    """
    return sqrt(shown_s / planned_s) if shown_s else 1.0


def shown_s(before: RunCost) -> float:
    """Return about how long, s, the impact of a run lasted."""
    return known(before.steps) * known(before.min_step)


def planned_s(last: LevelRun, meshes: LevelMeshes, levels: Sequence[int]) -> float:
    """Return the processor time, s, of a run on each of some levels after the last, by planned meshes.

    One that is too large to be meshed counts `MIDDLE` times the one before for each halving.
    """
    each_s, splits = [last.outcome.cost.whole_cpu], [last.splits, *levels]
    for coarse, fine in pairwise(splits):
        try:
            case = Case.of(meshes.at(fine), "solid", last.found)
        except SceneError:
            each_s.append(each_s[-1] * MIDDLE ** (fine - coarse))
            continue
        size, setup_s = case.size, setup_of(case)
        longer = lasting(shown_s(last.outcome.cost), size.steps * size.step)
        each_s.append(setup_s + (size.time - setup_s) * longer)
    return sum(each_s[1:])


def setup_of(case: Case) -> float:
    """Return about the processor time, s, before the first step of a run."""
    size = case.size
    return setup_time(case.bodies, case.slots.vibrating, size.rod, size.rod + size.barrier)


def range_s(few_s: float, many_s: float) -> list[float]:
    """Return least, middle and most time, s, that levels take which have not begun.

    They are planned to take ``few_s`` if as many run as the contact found asks for, and ``many_s`` if as many
    as the estimated one does.

    Examples
    --------
    >>> [round(time, 1) for time in range_s(30.0, 60.0)]
    [12.6, 48.0, 234.0]
    """
    return [share * planned for share, planned in zip(LEFT, (few_s, many_s, many_s), strict=True)]


def require_pilot(
    pilot: Case, limit_s: float, budget_s: float, tell: Callable[[Notice], None] | None
) -> None:
    """Refuse a pilot that surely takes more than ``limit_s``, s (OverBudgetError).

    It is told where the budget, s, may hold the pilot alone, whose numbers have no error.
    """
    pilot_s, enough = pilot.size.time, for_levels_s(pilot.size.time)
    reason, more = f"The coarsest level would take about {about_s(pilot_s)}", FOR_TWO.format(enough)
    if max(PILOT * pilot_s, SURELY * setup_of(pilot)) > limit_s:
        raise OverBudgetError(f"{reason}: it is not begun. {more}", enough)
    if tell and budget_s < (1.0 + MIDDLE) * pilot_s:
        tell(Notice(f"{reason}, and the budget of {about_s(budget_s)} may hold it alone. {more}"))


def enough_s(used_s: float, level_s: float, longer: float = LONGER_UNMESHED) -> int:
    """Return a budget, s, of two digits that holds a level of about ``level_s``, s, after ``used_s``, s.

    It holds as well one that takes ``longer`` times that.
    """
    least = used_s + longer * level_s
    unit = 10 ** max(floor(log10(max(least, 1.0))) - 1, 0)
    return int(ceil(least / unit) * unit)


def growth(own_s: float, halvings: int, last: Case, scene: Scene, found: ContactRecord) -> float:
    """Return how many times as long as the last case, of ``own_s``, a run of a finer scene takes.

    What takes `WORTH` is forecast by what both meshes hold: of 16 levels of 6 drawn scenes that was off by a
    factor of 1.6 (root mean square), `MIDDLE` by 2.1: a level takes up to 20 times as long as the one before.
    """
    longer = float(MIDDLE**halvings)
    if own_s * longer < WORTH:
        return longer
    try:
        return Case.of(scene, "solid", found).size.time / last.size.time
    except SceneError:
        return longer


def advice(number: int, used_s: float, each_s: Sequence[float]) -> tuple[str, int]:
    """Say what levels take from a number on, s each, and the budget for them; return that, too, s."""
    enough, more = enough_s(used_s, sum(each_s)), about_s(sum(each_s))
    if len(each_s) == 1:
        return f"Level {number}, finer, takes about {more} more: for it give a budget of {enough} s.", enough
    last = number + len(each_s) - 1
    sentence = f"An error about halves on each level: levels {number} to {last} take about {more} more"
    return f"{sentence}, for which give a budget of {enough} s.", enough


FOR_TWO = "For it and a finer one, which tell the error of each number, give a budget of {} s."


def for_levels_s(pilot_s: float, count: int = 2, places: int = 1) -> int:
    """Return a budget, s, that holds levels at each of some places, by the time of a first level, s."""
    times = [pilot_s * MIDDLE**level for level in range(count)]
    return enough_s(places * sum(times) - times[-1], times[-1])


@dataclass
class LevelProgress:
    """Shows the progress of a level's run with the time left of all levels; ends it where it takes too long.

    Attributes
    ----------
    show : what takes it; None: nobody
    name : of the level
    later_s : processor times, s, of all later levels, see `range_s`; None on the pilot, which tells no time
    turns : runs of the level one after the other
    duration_s : of the impact on the level before, s, from which the steps are forecast; 0 on the pilot
    used_s : wall time, s, of the levels before
    limit_s : wall time, s, after which the level is given up
    load : wall time over processor time of the level before
    own_s : forecast of one run on the mesh that stands, s of wall time
    begun : when the level began, by `now`
    since : `now` and `worked` at the first report of this run, which may be in another process
    stands : `now` when its mesh stood, 0 before
    """

    show: Callable[[Progress | Notice], None] | None
    name: str
    later_s: Sequence[float] | None = None
    turns: int = 1
    duration_s: float = 0.0
    used_s: float = 0.0
    limit_s: float = inf
    load: float = 1.0
    own_s: float = 0.0
    begun: float = field(default_factory=lambda: now())
    since: tuple[float, float] | None = None
    stands: float = 0.0

    def after(self, before: RunCost, turns: int) -> Self:
        """Return self, which expects load and duration of a run before, and so many runs in turn."""
        self.load = before.whole_wall / max(before.whole_cpu, 1e-3)
        self.duration_s = shown_s(before)
        self.turns = turns
        return self

    def __getstate__(self) -> dict[str, Any]:
        """Send to another process how long ago the level began: clocks without compilation differ."""
        return {**vars(self), "begun": now() - self.begun}

    def __setstate__(self, sent: dict[str, Any]) -> None:
        vars(self).update(sent, begun=now() - sent["begun"])

    def __call__(self, progress: Progress | Notice) -> None:
        """Take one report; raise OverBudgetError where the level takes too long, or surely will."""
        if isinstance(progress, Notice):
            return self._tell(progress)
        left_s, busy = progress.eta_s, self._busy
        setup_s = busy * progress.setup_s
        self.stands = self.stands if progress.step else now()
        if progress.step == 0 and left_s is not None:  # the mesh stands, and no step has shown the pace
            left_s *= busy
            self.own_s = setup_s + (left_s - setup_s) * lasting(self.duration_s, progress.end_time_s)
            least_s = self.own_s if self.duration_s else PILOT * self.own_s
            self._require_time(self.own_s, max(least_s, SURELY * setup_s))
        elif progress.step == 0:
            self._require_time(self.own_s or setup_s, SURELY * setup_s)
        else:
            self._require_time(self._left_s(progress), SURELY * self._paced_s(progress))
        if self.later_s is None or left_s is None:
            return self._tell(replace(progress, note=self.name, eta_s=None))
        later = [self.turns * busy * planned for planned in self.later_s]
        if progress.step == 0:
            least, about, most = range_s(*(self.turns * self.own_s + planned for planned in later))
        else:  # what is left of a run that goes on is known better
            going_on = left_s + (self.turns - 1) * self.own_s
            least, about, most = (going_on + planned for planned in range_s(*later))
        estimated = replace(progress, note=self.name, eta_s=about, eta_range_s=(least, most))
        self._tell(estimated)
        if progress.step == 0 and about > WORTH:
            dear = now() - self.begun + about > self.limit_s
            more = f" For all of it give a budget of {enough_s(self.used_s, about)} s." * dear
            self._tell(Notice(f"{self.name}: {left_text(estimated)}.{more}"))

    def _tell(self, progress: Progress | Notice) -> None:
        if self.show is not None:
            self.show(progress)

    @property
    def _busy(self) -> float:
        """Wall time that a second of processor time takes now, s: 1 where nothing else runs."""
        clocks = now(), worked()
        self.since = self.since or clocks
        spent_s, worked_s = (at - before for at, before in zip(clocks, self.since, strict=True))
        return max(1.0, (spent_s + SEEN * self.load) / (worked_s + SEEN))

    def _left_s(self, progress: Progress) -> float:
        """Return about the wall time, s, that is left of a run after some steps.

        While the bodies touch it follows from the duration that the level before showed, on a pilot from the
        mesh, and is at least half of what is spent.
        """
        if progress.eta_s is not None:
            return progress.eta_s
        spent_s = now() - (self.stands or self.begun)
        if not (self.duration_s and progress.time_s):
            return max(self.own_s - spent_s, 0.5 * spent_s)
        return max(spent_s * (self.duration_s / progress.time_s - 1.0), 0.5 * spent_s)

    def _paced_s(self, progress: Progress) -> float:
        """Return what is surely left of a run, s, by the impact of the level before; 0 before it is shown."""
        if not progress.time_s >= SHOWN * self.duration_s > 0.0:
            return 0.0
        by_pace = (now() - (self.stands or self.begun)) * (self.duration_s / progress.time_s - 1.0)
        return max(min(self._left_s(progress), by_pace), 0.0)

    def _require_time(self, left_s: float, least_s: float = 0.0) -> None:
        """Raise OverBudgetError where the limit does not hold what is spent and ``least_s``, s, more."""
        spent_s = now() - self.begun
        if spent_s + least_s <= self.limit_s:
            return
        whole_s = spent_s + left_s
        enough = enough_s(self.used_s, whole_s, LONGER) if self.duration_s else for_levels_s(whole_s)
        level, more = "It", f"For it give a budget of {enough} s."
        if not self.duration_s:
            level, more = "The coarsest level", f"It gave no number. {FOR_TWO.format(enough)}"
        given_up = f"{level} was given up after {about_s(spent_s)}, as the budget does not hold it"
        raise OverBudgetError(f"{given_up}: it takes about {about_s(whole_s)}. {more}", enough)
