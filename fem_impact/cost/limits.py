"""Limits for vanishing element size from the means of several runs on each mesh, with their uncertainty.

Two meshes do not determine the order of convergence that Richardson's extrapolation needs. `pair_limit`
therefore states the band of the limits of all orders from `LOWEST` up (from the mean on the finer mesh, the
limit of infinite order, to the limit of order `LOWEST`), and its middle as the limit. Three meshes or more
are fitted by least squares (`limit`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from math import sqrt
from statistics import fmean, stdev

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from fem_impact.arrays import Array
from fem_impact.cost.quantities import QUANTITIES, TargetQuantity
from fem_impact.errors import RunError
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import KEYS, Outcome

# Lowest order of convergence in the band of two meshes. Over twelve sets and nine quantities, 91 % of
# such bands contain the limit of all meshes, and all of them do within the band of that limit.
LOWEST = 0.75
# Standard error of a mean over evenly spaced places, over that of places taken at random. Even places cancel
# the first harmonics of the grid. Root mean squares over nine quantities of the 13 sets: means of two places
# lay .49, .45 and .60 of the latter from those of four on 0.59, 0.40 and 0.30 mm (medians .25 to .31), means
# of four .27 from those of eight on 0.59 mm (median .13).
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
    scale : divisor of errors
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


@dataclass(frozen=True, slots=True)
class _Fit:
    """Least squares: the ``terms`` in powers of the element size on each mesh, value at size 0, scatter."""

    terms: Array
    value: float
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


def pair_limit(fine: float, coarse: float, ratio: float) -> tuple[float, float]:
    """Return the limit of two meshes and its half-width; ``ratio`` is coarse over fine size.

    The band holds the limits of all orders from `LOWEST` up, since two meshes do not determine the order; the
    limit is its middle.

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

    The uncertainty of a limit is the scatter of the means plus, of a pair, its band, of more meshes Eca and
    Hoekstra's band less the distance of the finest mesh from the limit.
    """
    sizes = _sizes(meshes)
    finest = sizes.index(min(sizes))
    shared = [q for q in QUANTITIES if all(mean(q, runs) is not None for runs in meshes)]
    return {q.name: _truth(q, sizes, meshes, finest) for q in shared}


def mesh_limits(fine: Placed, coarse: Placed) -> tuple[dict[str, float], dict[str, float]]:
    """Return limit and half-width of two meshes, by key, of every number that all their runs know."""
    fine_values, coarse_values = _banded(fine), _banded(coarse)
    limits = {
        name: _limit_of(_sizes((fine, coarse)), (fine_values[name], coarse_values[name]))
        for name in fine_values
        if name in coarse_values
    }
    return (
        {name: value for name, (value, _, _, _) in limits.items()},
        {name: left_open + scatter for name, (_, _, left_open, scatter) in limits.items()},
    )


def mesh_means(runs: Placed) -> dict[str, float]:
    """Return the means over the places of one mesh, by key, of every number that meshes give a limit."""
    return {name: fmean(values) for name, values in _banded(runs).items()}


def _banded(runs: Placed) -> dict[str, list[float]]:
    """Return the values of the banded keys that all runs know."""
    values = {key.name: [key.of(run) for run in runs] for key in KEYS if key.banded}
    return {name: row for name, row in values.items() if not any(isinstance(v, Unknown) for v in row)}


def _sizes(meshes: Sequence[Placed]) -> list[float]:
    return [known(runs[0].cost.tip_size) for runs in meshes]


def _truth(quantity: TargetQuantity, sizes: list[float], meshes: Sequence[Placed], finest: int) -> Truth:
    values = [values_of(quantity, runs) for runs in meshes]
    value, order, left_open, scatter = _limit_of(sizes, values)
    # the larger of limit and finest value, so that a limit near zero does not inflate the errors
    size = max(abs(value), abs(fmean(values[finest])))
    return Truth(value, order, left_open + scatter, quantity.scale(size, meshes[finest][0]), scatter)


def _limit_of(
    sizes: list[float], values: Sequence[Sequence[float]]
) -> tuple[float, float | None, float, float]:
    """Return limit, order, its uncertainty by extrapolation, and its standard error by scatter."""
    means = [fmean(on_mesh) for on_mesh in values]
    scatter = _carried(sizes, means, [standard_error(on_mesh) for on_mesh in values])
    return *_limit(sizes, means), scatter


def _limit(sizes: list[float], values: list[float]) -> tuple[float, float | None, float]:
    """Return limit, order and uncertainty by extrapolation."""
    last, first = (values[sizes.index(extreme(sizes))] for extreme in (min, max))
    if len(sizes) == 2:
        value, half = pair_limit(last, first, max(sizes) / min(sizes))
        return value, None, half
    fitted = limit(sizes, values)
    return fitted.value, fitted.order, fitted.band - abs(fitted.value - last)


def _carried(sizes: list[float], values: list[float], errors: list[float]) -> float:
    """Return the standard error of a limit from those of the means.

    It is the root mean square change of the limit when each mean is moved up or down by its standard error,
    in all combinations; for a pair exactly the root of the weighted sum of variances.
    """
    value = _limit(sizes, values)[0]
    signs = product((-1.0, 1.0), repeat=len(values)) if any(errors) else ()
    moved = [[v + s * e for v, s, e in zip(values, by, errors, strict=True)] for by in signs]
    return sqrt(fmean((_limit(sizes, other)[0] - value) ** 2 for other in moved)) if moved else 0.0


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
    h, q = np.asarray(sizes, float), np.asarray(values, float)
    if len(np.unique(h)) < 3:
        raise RunError(f"A limit needs three meshes or more; there are {len(np.unique(h))}.")
    h, q = h / h.min(), q.copy()
    order, fit = _best(h, q)
    finest = int(h.argmin())
    return Limit(fit.value, order, _band(order is not None, fit, q, finest), fit.scatter)


def _best(h: Array, q: Array) -> tuple[float | None, _Fit]:
    """Return the order and fit to use; the order is None where only fixed orders are accepted."""

    def scatter(p: float) -> float:
        return _least_squares(h, q, (p,), len(h) - 1).scatter

    p = float(minimize_scalar(scatter, bounds=(0.1, 4.0), method="bounded").x)
    if LOWEST_FITTED <= p <= HIGHEST_FITTED + 0.1:
        return p, _least_squares(h, q, (p,), 3)
    fits = (_least_squares(h, q, (fixed,), 2) for fixed in (1.0, 2.0))
    return None, min(fits, key=lambda fit: fit.scatter)


def _least_squares(h: Array, q: Array, powers: tuple[float, ...], unknowns: int) -> _Fit:
    """Fit q_0 + sum a_j h^p_j with weights 1/h: finer meshes count for more."""
    weights = (1 / h) / (1 / h).mean()
    columns = np.stack([np.ones_like(h), *(h**p for p in powers)], axis=1)
    root = np.sqrt(weights)
    coefficients = np.linalg.lstsq(columns * root[:, None], q * root, rcond=None)[0]
    terms = columns[:, 1:] @ coefficients[1:]
    rest = np.sqrt(weights @ (q - coefficients[0] - terms) ** 2 / max(len(h) - unknowns, 1))
    return _Fit(terms, float(coefficients[0]), float(rest) if len(h) > unknowns else 0.0)


def _band(accepted: bool, fit: _Fit, q: Array, at: int) -> float:
    """Return the half-width about the value on mesh ``at``."""
    spread = (q.max() - q.min()) / (len(q) - 1)
    error, off = abs(fit.terms[at]), abs(q[at] - fit.value - fit.terms[at])
    if fit.scatter < spread:
        return float((SURE if accepted else UNSURE) * error + fit.scatter + off)
    return float(3 * fit.scatter / spread * (error + fit.scatter + off)) if spread else 0.0
