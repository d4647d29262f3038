"""Limits for vanishing element size from the means of several runs on each mesh, with their uncertainty.

Two meshes do not determine the order of convergence that Richardson's extrapolation needs. `pair_limit`
therefore states the band of the limits of all orders from `LOWEST` up (from the mean on the finer mesh, the
limit of infinite order, to the limit of order `LOWEST`), and its middle as the limit. Where each mesh ran at
one place of the barrier's grid alone, the scatter by the place is not known, and the band is
`ONE_RUN` times as wide. Three meshes or more are fitted by least squares (`limit`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import sqrt
from operator import itemgetter
from statistics import fmean, stdev

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.answers.refine.quantities import QUANTITIES, TargetQuantity
from fem_impact.arrays import Array
from fem_impact.errors import RunError
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.outcome.record import KEYS, Outcome

# Lowest order of convergence in the band of two meshes. Over thirteen sets and nine quantities, 82 % of
# such bands contain the limit of all three meshes, and all of them do within the band of that limit; the
# band of the coarser two contains the limit of the finer two in 69 %.
LOWEST = 0.75
# Safety factor of two meshes with one run each (Roache 1994, doi:10.1115/1.2910291, takes 3 for two grids).
# Of 98 pairs of the gamma study, bands of one place held the limit of the next finer pair in 42 (vibration)
# and 44 (e) cases, three times as wide ones in 91 and 81. Three times as wide, bands of one place contain the
# limit of all meshes of the 13 sets in 91 %, that of the finer two in 85 %.
ONE_RUN = 3.0
# Standard error of a mean over evenly spaced places, over that of places taken at random. Even places cancel
# the first harmonics of the grid. Root mean squares over nine quantities of the 13 sets: means of two places
# lay .40 and .50 of the latter from those of four on 0.59 and 0.30 mm (medians .31 and .35; on rods with
# cells twice as large .45 to .60), means of four .27 from those of eight on 0.59 mm (median .13).
EVEN = {2: 0.6, 4: 0.35}
LOWEST_FITTED, HIGHEST_FITTED = 0.5, 2.0  # orders of an accepted fit; the method is of second order
SURE, UNSURE = 1.25, 3.0  # safety factors of an accepted fit and of one with fixed orders

Placed = Sequence[Outcome]  # the runs on one mesh, the grid of the barrier at other places


@dataclass(frozen=True, slots=True)
class Truth:
    """The limit of one quantity and its uncertainty.

    Attributes
    ----------
    value : limit; order : observed order of convergence, None where there is none
    uncertainty : of the limit, ``scatter`` included
    scale : divisor of errors, in the unit of the quantity
    scatter : standard error of the limit by the scatter over the places of the grid
    """

    value: float
    order: float | None
    uncertainty: float
    scale: float
    scatter: float = 0.0


@dataclass(frozen=True, slots=True)
class Limit:
    """A fit over three meshes or more.

    Attributes
    ----------
    value : the fit at element size 0
    band : half-width about the finest mesh's value that should hold the limit in 95 of 100 cases
    order : fitted order, None where it lies outside the accepted range and fixed orders are used
    scatter : standard deviation of the values about the fit
    """

    value: float
    order: float | None
    band: float
    scatter: float


def mean(quantity: TargetQuantity, runs: Placed) -> float | None:
    """Return the mean of a quantity over the runs on a mesh, None where the fidelity does not know it."""
    values = values_of(quantity, runs)
    return fmean(values) if len(values) == len(runs) else None


def values_of(quantity: TargetQuantity, runs: Placed) -> list[float]:
    """Return the values of a quantity in the runs on a mesh that know it."""
    return [value for run in runs if (value := quantity.value(run)) is not None]


def standard_error(values: Sequence[float]) -> float:
    """Return the standard error of the mean over two or four even places; 0 for one value alone."""
    return EVEN[len(values)] * stdev(values) / sqrt(len(values)) if len(values) > 1 else 0.0


def pair_limit(fine: float, coarse: float, ratio: float, places: int = 1) -> tuple[float, float]:
    """Return the limit of two meshes and its half-width; ``ratio`` is coarse over fine size.

    The band holds the limits of all orders from `LOWEST` up, since two meshes do not determine the order; the
    limit is its middle. Each value is the mean over ``places`` of the grid; with one the band is `ONE_RUN`
    times as wide.

    Examples
    --------
    >>> value, half = pair_limit(1.1, 1.2, 2.0 ** (4 / 3), places=2)
    >>> round(value, 6), round(half, 6)
    (1.05, 0.05)
    >>> round(pair_limit(1.1, 1.2, 2.0 ** (4 / 3))[1], 6)
    0.15
    """
    half = 0.5 * (fine - coarse) / (ratio**LOWEST - 1)
    return fine + half, abs(half) * (ONE_RUN if places == 1 else 1.0)


def truths(meshes: Sequence[Placed]) -> dict[str, Truth]:
    """Return the limit from two or more meshes of every quantity that their runs know.

    The uncertainty of a limit is the scatter of the means plus, of a pair, its band, of more meshes Eca and
    Hoekstra's band less the distance of the finest mesh from the limit; that of the vibration energy is at
    least the `vibration_floor` of the finest mesh.
    """
    sizes = _sizes(meshes)
    finest = sizes.index(min(sizes))
    limits = {}
    for quantity in QUANTITIES:
        if any(mean(quantity, runs) is None for runs in meshes):
            continue
        values = [values_of(quantity, runs) for runs in meshes]
        truth = limit_of(sizes, values)
        if quantity.name == "E_vib":
            truth = replace(truth, uncertainty=max(truth.uncertainty, _floor(meshes[finest])))
        # the larger of limit and finest value, so that a limit near zero does not inflate the errors
        size = max(abs(truth.value), abs(fmean(values[finest])))
        limits[quantity.name] = replace(truth, scale=quantity.scale(size, meshes[finest][0]))
    return limits


def mesh_limits(meshes: Sequence[Placed]) -> tuple[dict[str, float], dict[str, float]]:
    """Return limit and half-width of two meshes or more, by key, of every number that all their runs know."""
    sizes, values = _sizes(meshes), [_banded(runs) for runs in meshes]
    limits = {
        name: limit_of(sizes, [of_mesh[name] for of_mesh in values])
        for name in values[0]
        if all(name in of_mesh for of_mesh in values)
    }
    return (
        {name: limit.value for name, limit in limits.items()},
        {name: limit.uncertainty for name, limit in limits.items()},
    )


def vibration_floor(run: Outcome) -> float:
    """Return the half-width, of E_0, below which no band of the vibration energy of a run may be.

    It is the distance of the two independent counts of that energy, by modes and without them, or the floor
    of the energy balance if that is more. Meshes that agree by chance cannot know the energy better than
    their own two counts do.
    """
    energy = run.energy
    vibration, check = or_none(energy.vibration), or_none(energy.vibration_check)
    apart = 0.0 if vibration is None or check is None else abs(check - vibration)
    return max(apart, or_none(energy.vibration_floor) or 0.0)


def stated_limits(meshes: Sequence[Placed]) -> tuple[dict[str, float], dict[str, float]]:
    """Return `mesh_limits`, that of the vibration energy with no less half-width than `vibration_floor`."""
    limits, bands = mesh_limits(meshes)
    sizes, name = _sizes(meshes), "E_vib_over_E_0"
    if name in bands:
        bands[name] = max(bands[name], _floor(meshes[sizes.index(min(sizes))]))
    return limits, bands


def _floor(runs: Placed) -> float:
    """Return the mean `vibration_floor` of the runs on a mesh."""
    return fmean(map(vibration_floor, runs))


def mesh_means(runs: Placed) -> dict[str, float]:
    """Return the means over the places of one mesh, by key, of every number that meshes give a limit."""
    return {name: fmean(values) for name, values in _banded(runs).items()}


def _banded(runs: Placed) -> dict[str, list[float]]:
    """Return the values of the banded keys that all runs know."""
    values = {key.name: [key.of(run) for run in runs] for key in KEYS if key.banded}
    return {name: row for name, row in values.items() if not any(isinstance(v, Unknown) for v in row)}


def _sizes(meshes: Sequence[Placed]) -> list[float]:
    return [known(runs[0].cost.tip_size) for runs in meshes]


def limit_of(sizes: list[float], values: Sequence[Sequence[float]]) -> Truth:
    """Return the limit, with scale 1, from the values of several runs on each mesh; ``sizes`` in any unit.

    The standard error of the limit by the scatter of those values is the root mean square change of the
    limit when each mean is moved up or down by its standard error, in all combinations; for a pair exactly
    the root of the weighted sum of variances.
    """
    means, errors = [fmean(on_mesh) for on_mesh in values], [standard_error(on_mesh) for on_mesh in values]
    places = min(map(len, values))
    value, order, extrapolation = _limit(sizes, means, places)
    changes = [
        _limit(sizes, [v + s * e for v, s, e in zip(means, signs, errors, strict=True)], places)[0] - value
        for signs in product((-1.0, 1.0) if any(errors) else (0.0,), repeat=len(means))
    ]
    scatter = sqrt(fmean(change**2 for change in changes))
    return Truth(value, order, extrapolation + scatter, 1.0, scatter)


def _limit(sizes: list[float], values: list[float], places: int) -> tuple[float, float | None, float]:
    """Return limit, order and uncertainty by extrapolation from the mean of ``places`` on each mesh."""
    last, first = (values[sizes.index(extreme(sizes))] for extreme in (min, max))
    if len(sizes) == 2:
        value, half = pair_limit(last, first, max(sizes) / min(sizes), places)
        return value, None, half
    fitted = limit(sizes, values)
    return fitted.value, fitted.order, fitted.band - abs(fitted.value - last)


def limit(sizes: ArrayLike, values: ArrayLike) -> Limit:
    """Return limit, order and band of q(h) by least squares over at least three meshes.

    Parameters
    ----------
    sizes : (n,) float64, m, element size of each mesh of one self-similar family, in any order
    values : (n,) float64, the quantity on each mesh

    Raises
    ------
    RunError
        Fewer than three different sizes.

    Notes
    -----
    L. Eca and M. Hoekstra, J. Comput. Phys. 262 (2014) 104-130, doi:10.1016/j.jcp.2014.01.006: q_0 + a h^p
    where .5 <= p <= 2, else fixed orders with a larger safety factor; the scatter of noisy data widens
    the band. Their fit of two terms is left out: with four meshes it follows the scatter. With three meshes
    nothing is left over to tell scatter from trend, so it reads 0.

    Examples
    --------
    >>> fitted = limit([4.0, 2.0, 1.0], [1.16, 1.04, 1.01])
    >>> round(fitted.value, 6), round(fitted.order, 3), round(fitted.band, 6)
    (1.0, 2.0, 0.0125)
    """
    from scipy.optimize import minimize_scalar  # .4 s, for which no page of a run should wait

    h, q = np.asarray(sizes, float), np.asarray(values, float)
    if len(np.unique(h)) < 3:
        raise RunError(f"A limit needs three meshes or more; there are {len(np.unique(h))}.")
    h = h / h.min()
    p = minimize_scalar(
        lambda p: _least_squares(h, q, p, len(h) - 1)[2], bounds=(0.1, 4.0), method="bounded"
    ).x
    accepted = LOWEST_FITTED <= p <= HIGHEST_FITTED + 0.1
    fits = (
        [_least_squares(h, q, float(p), 3)] if accepted else [_least_squares(h, q, p, 2) for p in (1.0, 2.0)]
    )
    value, terms, scatter = min(fits, key=itemgetter(2))
    finest, spread = int(h.argmin()), (q.max() - q.min()) / (len(q) - 1)
    error, off = abs(terms[finest]), abs(q[finest] - value - terms[finest])
    if scatter < spread:
        band = (SURE if accepted else UNSURE) * error + scatter + off
    else:
        band = 3 * scatter / spread * (error + scatter + off) if spread else 0.0
    return Limit(value, float(p) if accepted else None, float(band), scatter)


def _least_squares(h: Array, q: Array, order: float, unknowns: int) -> tuple[float, Array, float]:
    """Fit q_0 + a h^order with weights 1/h, as finer meshes count for more.

    Returns q_0, the terms a h^order (n,), and the standard deviation of q about the fit.
    """
    weights = (1 / h) / (1 / h).mean()
    columns, root = np.stack([np.ones_like(h), h**order], axis=1), np.sqrt(weights)
    value, slope = np.linalg.lstsq(columns * root[:, None], q * root, rcond=None)[0]
    terms = columns[:, 1] * slope
    rest = np.sqrt(weights @ (q - value - terms) ** 2 / max(len(h) - unknowns, 1))
    return float(value), terms, float(rest) if len(h) > unknowns else 0.0
