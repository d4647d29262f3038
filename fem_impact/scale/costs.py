"""How long a study will take, and what more workers would give, from what jobs like these have cost."""

from __future__ import annotations

import heapq
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING

from fem_impact.progress import CaseProgress

if TYPE_CHECKING:
    from fem_impact.progress import Meter
    from fem_impact.scale.job import Job, Kind

__all__ = ["Eta", "expected_costs", "makespan"]

GUESS = {"rigid": 1e-3, "modal": 0.05, "solid": 60.0}
"""s a job, for the order and the ETA until one of its fidelity was measured."""

STEEPNESS = 3.0
"""A solid run costs tip size to minus this power: 2.3 to 3.1 measured from 0.59 to 0.24 mm (README)."""


def expected_costs(jobs: Iterable[Job], measured: Mapping[Kind, list[float]]) -> dict[str, float]:
    """Return the expected wall time, s, of each job by name, from the times of measured kinds.

    A solid job of a tip size that was not measured is scaled from the nearest one that was.
    """
    return {job.name: _expected(job.kind, measured) for job in jobs}


def _expected(kind: Kind, measured: Mapping[Kind, list[float]]) -> float:
    if kind in measured:
        return median(measured[kind])
    fidelity, size = kind
    sizes = [other for name, other in measured if name == fidelity and other > 0]
    if not sizes:
        return GUESS[fidelity]
    near = min(sizes, key=lambda other: max(other / size, size / other))
    return median(measured[fidelity, near]) * float((near / size) ** STEEPNESS)


def makespan(costs: Iterable[float], workers: int) -> float:
    """Return how long the jobs take, s, when the longest left is always given to the next free worker.

    Examples
    --------
    >>> makespan([3.0, 3.0, 2.0, 2.0, 2.0], 2)
    7.0
    >>> makespan([3.0, 3.0, 2.0, 2.0, 2.0], 1000)
    3.0
    """
    ends = [0.0] * workers
    for cost in sorted(costs, reverse=True):
        heapq.heapreplace(ends, ends[0] + cost)
    return max(ends)


@dataclass(slots=True)
class Eta:
    """Tells a meter after every job how much time all jobs still need: time so far over work so far."""

    costs: dict[str, float]
    total: int
    meter: Meter
    begun: float
    left: float
    done: float = 0.0

    @classmethod
    def start(cls, costs: dict[str, float], total: int, meter: Meter) -> Eta:
        """Begin to count now."""
        return cls(costs, total, meter, time.monotonic(), sum(costs.values()))

    def __call__(self, name: str, count: int) -> None:
        """Report that ``name`` is done, ``count`` jobs in all."""
        self.done += self.costs[name]
        self.left -= self.costs[name]
        eta = (time.monotonic() - self.begun) * max(self.left, 0.0) / self.done
        self.meter(CaseProgress(name, count, self.total, eta))
