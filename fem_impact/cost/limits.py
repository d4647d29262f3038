"""Limits for vanishing elements from the means of several runs on each mesh, with their uncertainty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import sqrt
from statistics import fmean, stdev
from typing import Any

from fem_impact.cost.quantities import QUANTITIES, Quantity
from fem_impact.outcome import Outcome
from fem_impact.study.richardson import limit

__all__ = ["Placed", "Truth", "known_mean", "mean", "pair_limit", "standard_error", "truths"]

# order of convergence: bands from here up held 91 of 100 limits of all meshes, taken as exact, and all within
# those limits' own bands (twelve sets, nine quantities)
LOWEST = 0.75
# Standard error of a mean over evenly spaced places, over that of places taken at random. Even places cancel
# the first harmonics of the grid. Root mean squares over nine quantities of the 13 sets: means of two places
# lay .49, .45 and .60 of the latter from those of four on 0.59, 0.40 and 0.30 mm (medians .25 to .31), means
# of four .27 from those of eight on 0.59 mm (median .13).
EVEN = {2: 0.6, 4: 0.35}

Placed = Sequence[Outcome]  # the runs on one mesh, the grid of the barrier at other places


@dataclass(frozen=True, slots=True)
class Truth:
    """What the meshes say of one quantity.

    Attributes
    ----------
    value : limit; order : observed, None where it was not
    uncertainty : of the limit, ``scatter`` included
    scale : what errors are divided by
    scatter : standard error of the limit, as the places of the grid tell it
    """

    value: float
    order: float | None
    uncertainty: float
    scale: float
    scatter: float = 0.0


def mean(quantity: Quantity, runs: Placed) -> float | None:
    """Return the mean of a quantity over the runs on a mesh, None where the fidelity does not know it."""
    values = [quantity.value(run) for run in runs]
    return None if None in values else fmean(v for v in values if v is not None)


def known_mean(quantity: Quantity, runs: Placed) -> float:
    """Return the mean of a quantity over runs that know it."""
    return fmean(_known(quantity, run) for run in runs)


def standard_error(quantity: Quantity, runs: Placed) -> float:
    """Return the standard error of that mean over two or four even places; 0 for one run alone."""
    values = [_known(quantity, run) for run in runs]
    return EVEN[len(values)] * stdev(values) / sqrt(len(values)) if len(values) > 1 else 0.0


def pair_limit(fine: float, coarse: float, ratio: float) -> tuple[float, float]:
    """Return the limit of two meshes and its half-width; ``ratio`` is coarse over fine size.

    Two meshes tell no order, so the band holds what every order from `LOWEST` up would give; the limit is its
    middle.

    Examples
    --------
    >>> value, half = pair_limit(1.1, 1.2, 2.0 ** (4 / 3))
    >>> round(value, 6), round(half, 6)
    (1.05, 0.05)
    """
    half = 0.5 * (fine - coarse) / (ratio**LOWEST - 1)
    return fine + half, abs(half)


def truths(meshes: Sequence[Placed]) -> dict[str, Truth]:
    """Return the limit from two or more meshes of every quantity that their runs know.

    The uncertainty of a limit is what Eca and Hoekstra's band leaves beyond the finest mesh's own
    distance from it, or the band of a pair, and the scatter of the means.
    """
    sizes = [float(runs[0]["tip_size_m"]) for runs in meshes]
    finest = sizes.index(min(sizes))
    known = [q for q in QUANTITIES if all(mean(q, runs) is not None for runs in meshes)]
    return {q.name: _truth(q, sizes, meshes, finest) for q in known}


def _known(quantity: Quantity, outcome: Mapping[str, Any]) -> float:
    value = quantity.value(outcome)
    assert value is not None  # the caller has looked
    return value


def _truth(quantity: Quantity, sizes: list[float], meshes: Sequence[Placed], finest: int) -> Truth:
    values = [known_mean(quantity, runs) for runs in meshes]
    value, order, left_open = _limit(sizes, values)
    scatter = _carried(sizes, values, [standard_error(quantity, runs) for runs in meshes])
    size = max(abs(value), abs(values[finest]))  # an extrapolation to zero must not inflate every error
    return Truth(value, order, left_open + scatter, quantity.scale(size, meshes[finest][0]), scatter)


def _limit(sizes: list[float], values: list[float]) -> tuple[float, float | None, float]:
    """Return limit, order and what the means leave open."""
    last, first = (values[sizes.index(extreme(sizes))] for extreme in (min, max))
    if len(sizes) == 2:
        value, half = pair_limit(last, first, max(sizes) / min(sizes))
        return value, None, half
    found = limit(sizes, values)
    away = abs(found.value - last)
    return found.value, found.order, found.band - away


def _carried(sizes: list[float], values: list[float], errors: list[float]) -> float:
    """Return the standard error of a limit: each mean moved up or down by its own, in all combinations.

    The root mean square of what the limit moves by; of a pair it is exactly the weighted sum of variances.
    """
    value = _limit(sizes, values)[0]
    signs = product((-1.0, 1.0), repeat=len(values)) if any(errors) else ()
    moved = [[v + s * e for v, s, e in zip(values, by, errors, strict=True)] for by in signs]
    return sqrt(fmean((_limit(sizes, other)[0] - value) ** 2 for other in moved)) if moved else 0.0
