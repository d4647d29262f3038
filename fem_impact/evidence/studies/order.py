"""Limit and order of convergence of a quantity on three meshes or more, by least squares."""

from __future__ import annotations

from dataclasses import dataclass
from operator import itemgetter

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.arrays import Array
from fem_impact.errors import RunError

LOWEST_FITTED, HIGHEST_FITTED = 0.5, 2.0  # orders of an accepted fit; the method is of second order
SURE, UNSURE = 1.25, 3.0  # safety factors of an accepted fit and of one with fixed orders


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
