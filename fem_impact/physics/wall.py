"""Ovalling of a hollow projectile: its section becomes an ellipse and back, as beam theory cannot tell."""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fem_impact.scene.projectile import ProjectileSpec


def ovalling_period(rod: ProjectileSpec) -> float:
    """Return the period of the wall's ovalling, s; 0 of a body without a bore.

    Notes
    -----
    Rayleigh's quotient of inextensional bending in n = 2 waves around, the same over the bored part of the
    length: w^2 = sum(9 D / R^3) / sum(1.25 rho h R), with the wall h, its mean radius R and a plate's
    stiffness D = E h^3 / (12 (1 - nu^2)); of a ring A. E. H. Love, A Treatise on the Mathematical Theory of
    Elasticity, 4th ed. 1927, section 293. A closed end holds the wall, which this does not know: the period
    is the longest there may be.
    """
    if not rod.bore:
        return 0.0
    z, outer, inner = rod.wall()
    ends = [part.to for part in rod.segments][:-1]
    steels = [part.material for part in rod.segments] or [rod.material]
    of = np.searchsorted(ends, z)
    E, nu, rho = (np.array([getattr(steel, key) for steel in steels])[of] for key in ("E", "nu", "rho"))
    h, R = outer - inner, 0.5 * (outer + inner)
    stiffness, mass = 9 * E * h**3 / (12 * (1 - nu**2) * R**3), 1.25 * rho * h * R
    return 2 * pi * sqrt(float(mass.sum() / stiffness.sum()))
