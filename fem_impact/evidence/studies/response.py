"""Response surfaces: results as polynomials of the uncertain inputs, fitted to a sample of runs."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from fem_impact.arrays import Array
from fem_impact.errors import RunError

SPARE = 1.3  # runs over coefficients that a surface of second order needs


@dataclass(frozen=True, slots=True)
class ResponseSurface:
    """Least-squares polynomials in inputs scaled to 0 ... 1 (Box & Wilson 1951, J. R. Stat. Soc. B 13, 1-45).

    Attributes
    ----------
    coefficients : (terms, quantities) float64
    order : 1 or 2
    error : (quantities,) float64, root mean square error at runs that the fit was not given, by leaving out
        one run after the other (PRESS: Allen 1974, doi:10.1080/00401706.1974.10489157)
    """

    coefficients: Array
    order: int
    error: Array

    def __call__(self, unit: Array) -> Array:
        """Return the quantities (n, quantities) at inputs (n, d) scaled to 0 ... 1."""
        values: Array = _terms(unit, self.order) @ self.coefficients
        return values


def fit(unit: Array, values: Array) -> ResponseSurface:
    """Return the surfaces through runs: of second order where there are enough of them, else of first.

    Parameters
    ----------
    unit : (n, d) float64, inputs scaled to 0 ... 1
    values : (n, quantities) float64

    Raises
    ------
    RunError
        There are too few runs for a surface of first order.

    Examples
    --------
    >>> x = np.linspace(0, 1, 9)[:, None]
    >>> surface = fit(x, 3 * x**2)
    >>> surface.order, float(surface(np.array([[0.3]]))[0, 0].round(6))
    (2, 0.27)
    """
    runs, inputs = unit.shape
    full = (inputs + 1) * (inputs + 2) // 2
    order = 2 if runs >= SPARE * full else 1
    terms = _terms(unit, order)
    if runs <= terms.shape[1]:
        raise RunError(f"{runs} finished runs are too few for {inputs} uncertain inputs.")
    q, r = np.linalg.qr(terms)
    coefficients = np.linalg.solve(r, q.T @ values)
    left_out = (values - terms @ coefficients) / (1 - np.sum(q**2, axis=1))[:, None]
    return ResponseSurface(coefficients, order, np.sqrt(np.mean(left_out**2, axis=0)))


def _terms(unit: Array, order: int) -> Array:
    """Return the columns 1, x_i and, for second order, x_i x_j, with x = 2 unit - 1."""
    x = 2 * unit - 1
    pairs = combinations_with_replacement(range(x.shape[1]), 2) if order == 2 else ()
    return np.column_stack([np.ones(len(x)), x, *(x[:, i] * x[:, j] for i, j in pairs)])
