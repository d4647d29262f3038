"""Slenderness of a rod and the published limit of rigid-body impact theory (Eq 29)."""

import numpy as np

from .inputs import ArrayLike, Floats, ShapeError, floats, refuse

EXPONENT = 1.3815
LIMIT = 26.45
"""Largest gamma (m^-0.3815) for which a free steel bar was found to rebound as a rigid body."""

TO_MM = float(np.power(1000.0, 1.0 - EXPONENT))
LIMIT_MM = LIMIT * TO_MM
"""The same limit with lengths in millimetres, mm^-0.3815."""


def slenderness(length: ArrayLike, diameter: ArrayLike) -> Floats:
    """Slenderness coefficient gamma = l / d^1.3815 (Eq 29), m^-0.3815.

    It is not dimensionless: lengths must be in metres (see `in_millimetres`). Below `LIMIT` the
    restitution of dropped steel bars did not depend on their inclination (Stoianovici and Hurmuzlu,
    J. Appl. Mech. 63, 1996), which is what rigid-body theory assumes. It says nothing about tips that
    yield, which lengthen the contact and quieten the rod.

    Parameters
    ----------
    length, diameter : array_like
        m, both positive.

    Returns
    -------
    float64 of the broadcast shape, m^-0.3815

    Examples
    --------
    >>> slenderness([0.24, 0.12, 0.08], 0.019).round(1)
    array([57.3, 28.6, 19.1])
    """
    length, diameter = floats(length, diameter)
    shortest = np.minimum(length, diameter)
    refuse(~(shortest > 0), "length and diameter must be positive, got {value} m", shortest, ShapeError)
    return length / diameter**EXPONENT


def in_millimetres(gamma: ArrayLike) -> Floats:
    """Gamma in mm^-0.3815 for gamma in m^-0.3815 (the limit 26.45 becomes 1.896)."""
    return np.asarray(gamma, dtype=np.float64) * TO_MM


def behaves_rigidly(gamma: ArrayLike) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Whether gamma (m^-0.3815) meets the criterion gamma <= 26.45 (Eq 29)."""
    return np.asarray(np.asarray(gamma) <= LIMIT)
