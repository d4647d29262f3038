"""How far the inputs of a set, by its response surface, reach towards a measurement that the model misses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_impact.answers.v_and_v import Comparison
from fem_impact.evidence.studies.inputs import UNCERTAIN_INPUTS
from fem_impact.evidence.studies.validated import NAMES, ValidatedSet, nominal_place

PLACES = np.linspace(0.0, 1.0, 21)  # of one input over its interval
SHOWN = ("e", "mu", "Omega")
MISS = "miss by"


@dataclass(frozen=True, slots=True)
class Reach:
    """What inputs can do about the error of one quantity, in its unit.

    Attributes
    ----------
    missed : the comparison
    name, place : of the single input that brings the model nearest to the tests, and where in its interval,
        0 to 1
    change : by that input
    low, high : smallest and largest change by all inputs at once
    """

    missed: Comparison
    name: str
    place: float
    change: float
    low: float
    high: float

    @property
    def left(self) -> float:
        """Error that all inputs together leave, 0 where they reach the measured mean."""
        E = self.missed.E
        return E + float(np.clip(-E, self.low, self.high))

    @property
    def sentence(self) -> str:
        """What it would take."""
        ends = {0.0: "at its lower end", 1.0: "at its upper end"}
        where = ends.get(self.place, f"at {100 * self.place:.0f} % of its interval")
        unit = " rad/s" if self.missed.quantity == "Omega" else ""
        told = (
            f"{self.missed.quantity} is off by {self.missed.E:+.2g}{unit}; {self.name} {where} alone changes "
            f"it by {self.change:+.2g}, all inputs together by {self.low:+.2g} to {self.high:+.2g}"
        )
        return f"{told}, which leaves {self.left:+.2g} to what is not among them" if self.left else told


def misses(found: ValidatedSet) -> list[Comparison]:
    """Return comparisons of e, mu and Omega that show an error of the model or miss the scatter."""
    return [
        c for c in found.comparisons if c.quantity in SHOWN and (c.in_error or c.scatter.startswith(MISS))
    ]


def reach(found: ValidatedSet, missed: Comparison) -> Reach:
    """Return what the inputs of a set, each inside its interval, can do about a missed quantity."""
    at, nominal = NAMES.index(missed.quantity), nominal_place(found.name)
    before = found.surface(nominal)[0, at]
    single = np.repeat(nominal, len(UNCERTAIN_INPUTS) * len(PLACES), axis=0)
    for i in range(len(UNCERTAIN_INPUTS)):
        single[i * len(PLACES) : (i + 1) * len(PLACES), i] = PLACES
    changes = found.surface(single)[:, at] - before
    best = int(np.abs(missed.E + changes).argmin())
    every = found.all_inputs[:, at] - before
    return Reach(
        missed,
        UNCERTAIN_INPUTS[best // len(PLACES)].name,
        float(PLACES[best % len(PLACES)]),
        float(changes[best]),
        float(every.min()),
        float(every.max()),
    )


def reach_sentences(found: ValidatedSet) -> list[str]:
    """Return one sentence on the missed quantities of a set; none where nothing is missed."""
    parts = [reach(found, missed).sentence for missed in misses(found)]
    return [f"{found.name}: {'; '.join(parts)}."] if parts else []
