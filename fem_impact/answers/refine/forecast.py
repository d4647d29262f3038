"""How long levels take that have not run yet, as a range, and the progress that tells it.

The mesh of a level says how long its run takes: by its cells, those that may yield, and its steps. Finer
levels are forecast from it by what halving the cells costs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from time import perf_counter

from fem_impact.answers.refine.budget import about_s
from fem_impact.errors import RunError
from fem_impact.progress import Notice, Progress, left_text

# Least, middle and most of 84 levels of 35 runs of drawn scenes: what a level took over its forecast when its
# mesh stood (5 to 95 %: 0.4 to 1.9), and how much longer a level takes than one with cells twice as large
# (5 to 95 %: 1.0 to 5.3). Contacts along a line take 4 to 7 times, points 1.5 to 3 times. Ranges that follow
# from these, for the levels that then ran, held what those after the pilot took in 33 of the 35.
OWN = (0.6, 1.0, 1.6)
GROWTH = (1.2, 2.4, 4.5)
MIDDLE = GROWTH[1]
WORTH = 10.0  # s: a time left that is told in a sentence of its own


def later_s(own_s: float, halvings: Sequence[int]) -> list[float]:
    """Return least, middle and most time, s, of the levels after one that takes about ``own_s``.

    Each of them halves the cells so often.

    Examples
    --------
    >>> [round(time, 1) for time in later_s(10.0, [1, 2])]
    [17.6, 162.2, 1530.0]
    """
    spans = []
    for share, growth in zip(OWN, GROWTH, strict=True):
        times = [share * own_s]
        for halved in halvings:
            times.append(times[-1] * growth**halved)
        spans.append(sum(times[1:]))
    return spans


@dataclass
class LevelProgress:
    """Shows the progress of a level's first run with the time left of all levels.

    Attributes
    ----------
    show : what takes it; None: nobody
    name : of the level
    halvings : of each later level, as far as known; None on the pilot, which tells no time
    turns : runs of the level one after the other
    duration_s : of the impact on the level before, s, from which the steps are forecast
    limit_s : wall time, s, after which the level is given up
    own_s : forecast of one run on the mesh that stands, s
    """

    show: Callable[[Progress | Notice], None] | None
    name: str
    halvings: Sequence[int] | None = None
    turns: int = 1
    duration_s: float = 0.0
    limit_s: float = inf
    own_s: float = 0.0
    begun: float = field(default_factory=lambda: perf_counter())

    def __call__(self, progress: Progress | Notice) -> None:
        """Take one report; raise RunError where the level takes too long."""
        if perf_counter() - self.begun > self.limit_s:
            raise RunError(f"It was given up after {about_s(self.limit_s)}, as the budget was used up.")
        if self.show is None:
            return
        if isinstance(progress, Notice):
            return self.show(progress)
        if self.halvings is None or progress.eta_s is None:
            return self.show(replace(progress, note=self.name, eta_s=None))
        if progress.step == 0:  # the mesh stands, and no step has shown the pace
            self.own_s = progress.eta_s * self.duration_s / progress.end_time_s
            own = [share * self.turns * self.own_s for share in OWN]
        else:
            own = [progress.eta_s + (self.turns - 1) * self.own_s] * len(OWN)
        later = later_s(self.turns * self.own_s, self.halvings)
        least, about, most = (of + after for of, after in zip(own, later, strict=True))
        told = replace(progress, note=self.name, eta_s=about, eta_range_s=(least, most))
        self.show(told)
        if progress.step == 0 and about > WORTH:
            self.show(Notice(f"{self.name}: {left_text(told)}."))
