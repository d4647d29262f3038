"""The limit of a quantity for vanishing elements, from several meshes of one family, and its uncertainty."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

from fem_impact.errors import RunError

Array = NDArray[np.float64]

LOWEST, HIGHEST = 0.5, 2.0  # orders that a fit is believed; the method and its elements are second order
SURE, UNSURE = 1.25, 3.0  # safety factors of a believed and of a disbelieved fit


@dataclass(frozen=True, slots=True)
class Limit:
    """What the meshes say of one quantity.

    Attributes
    ----------
    value : the fit at element size 0
    band : half-width about the finest mesh's value that should hold the limit in 95 of 100 cases
    order : fitted order, None where it is not believed and fixed orders are used
    scatter : standard deviation of the values about the fit
    """

    value: float
    order: float | None
    band: float
    scatter: float


@dataclass(frozen=True, slots=True)
class _Fit:
    terms: Array  # contribution of the element size on every mesh
    value: float
    scatter: float


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
    >>> found = limit([4.0, 2.0, 1.0], [1.16, 1.04, 1.01])
    >>> round(found.value, 6), round(found.order, 3), round(found.band, 6)
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
    """Return the order and fit to use; the order is None where only fixed orders are believed."""
    p = float(minimize_scalar(lambda p: _misfit(h, q, (p,)), bounds=(0.1, 4.0), method="bounded").x)
    if LOWEST <= p <= HIGHEST + 0.1:
        return p, _least_squares(h, q, (p,), 3)
    fits = (_least_squares(h, q, (fixed,), 2) for fixed in (1.0, 2.0))
    return None, min(fits, key=lambda fit: fit.scatter)


def _misfit(h: Array, q: Array, powers: tuple[float, ...]) -> float:
    return _least_squares(h, q, powers, len(h) - 1).scatter


def _least_squares(h: Array, q: Array, powers: tuple[float, ...], unknowns: int) -> _Fit:
    """Fit q_0 + sum a_j h^p_j with weights 1/h: finer meshes count for more."""
    weights = (1 / h) / (1 / h).mean()
    columns = np.stack([np.ones_like(h), *(h**p for p in powers)], axis=1)
    root = np.sqrt(weights)
    found = np.linalg.lstsq(columns * root[:, None], q * root, rcond=None)[0]
    terms = columns[:, 1:] @ found[1:]
    rest = np.sqrt(weights @ (q - found[0] - terms) ** 2 / max(len(h) - unknowns, 1))
    return _Fit(terms, float(found[0]), float(rest) if len(h) > unknowns else 0.0)


def _band(believed: bool, fit: _Fit, q: Array, at: int) -> float:
    spread = (q.max() - q.min()) / (len(q) - 1)
    error, off = abs(fit.terms[at]), abs(q[at] - fit.value - fit.terms[at])
    if fit.scatter < spread:
        return float((SURE if believed else UNSURE) * error + fit.scatter + off)
    return float(3 * fit.scatter / spread * (error + fit.scatter + off)) if spread else 0.0
