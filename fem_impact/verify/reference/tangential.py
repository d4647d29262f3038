"""Hertz contact with tangential compliance and local slip: a row of independent springs.

The method of dimensionality reduction (Popov & Hess 2015, doi:10.1007/978-3-642-53876-6) maps the
Cattaneo-Mindlin-Jaeger contact of round bodies exactly onto springs at x under the profile x^2 / R, with
E* and G* per length and Coulomb's law for each spring. Bodies of like material: G*/E* = 2(1-nu)/(2-nu).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

__all__ = ["SpringRow", "sliding_ratio", "tangential_ratio"]

Array = NDArray[np.float64]
SPRINGS = 100
MEAN_PRESSURE = 0.6716  # over the largest: 3/4 weighted by itself over the contact, 0.896 over the impulse


def tangential_ratio(nu: float) -> float:
    """Return G* / E* of two bodies with the same elastic constants."""
    return 2 * (1 - nu) / (2 - nu)


def sliding_ratio(f: float, nu: float, G: float, pressure: float) -> float:
    """Return the impulse ratio of a sliding collision of like bodies with a largest Hertz pressure, Pa.

    The traction f p lowers the skin ahead of the contact and raises it behind (Cerruti: Johnson, Contact
    Mechanics, 1985, Eq 3.75c), in both bodies alike. So the interface, on which friction is f, leans by
    (1 - 2 nu) f p / (4 G), weighted with the pressure, and along the barrier's own directions less is seen.

    Examples
    --------
    >>> round(sliding_ratio(0.5, 0.29, 85e9, 8e9), 4), sliding_ratio(0.5, 0.5, 85e9, 8e9)
    (0.4959, 0.5)
    """
    lean = MEAN_PRESSURE * (1 - 2 * nu) * f * pressure / (4 * G)
    return (f - lean) / (1 + f * lean)


@dataclass(slots=True)
class SpringRow:
    """Normal and tangential force of one contact, moved in small increments.

    Attributes
    ----------
    E_star, G_star : Pa; radius : m; friction : Coulomb's coefficient
    reach : largest contact radius to come, m
    """

    E_star: float
    G_star: float
    radius: float
    friction: float
    reach: float
    profile: Array = field(init=False)
    width: Array = field(init=False)
    shift: Array = field(init=False)

    def __post_init__(self) -> None:
        # even steps of area: the outer springs, where slip begins, lie closer together
        edges = self.reach * np.sqrt(np.linspace(0.0, 1.0, SPRINGS + 1))
        middle = 0.5 * (edges[1:] + edges[:-1])
        self.profile = middle**2 / self.radius
        self.width = 2 * np.diff(edges)
        self.shift = np.zeros(SPRINGS)

    def normal(self, depth: float) -> float:
        """Return the normal force, N, at an approach, m: Hertz', by the springs that also carry friction."""
        return float(self.E_star * (self.width @ np.maximum(depth - self.profile, 0.0)))

    def slide(self, depth: float, step: float) -> float:
        """Move the contact tangentially by ``step``, m; return the force against it, N."""
        limit = self.friction * self.E_star / self.G_star * np.maximum(depth - self.profile, 0.0)
        self.shift = np.clip(self.shift + step, -limit, limit)
        return float(self.G_star * (self.width @ self.shift))
