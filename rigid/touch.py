"""What of a body is lowest over an inclined barrier, on either side of its axis."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .inputs import ArrayLike, Floats, floats, refuse

LEVEL = 1e-9
"""Share of the length within which places of a body that is stated by its sizes count as equally low."""


class Touch(NamedTuple):
    """The lowest part in the plane of motion: its middle (x, z), m, and its length, m, 0 of one point."""

    x: float
    z: float
    length: float


def inclinations(alpha: ArrayLike) -> Floats:
    """Return inclinations, rad, as an array; refuse any beyond a right angle to either side (ImpactError)."""
    (alpha,) = floats(alpha)
    outside = ~(np.abs(alpha) <= 0.5 * np.pi)
    refuse(outside, "the inclination must lie in -pi/2 <= alpha <= pi/2 rad, got {value}", alpha)
    return alpha


def on_side(rho: Floats, alpha: Floats) -> Floats:
    """Return the place x, m, of a radius ``rho``, m, on the side that comes down first: -rho below 0."""
    return np.asarray(np.where(np.asarray(alpha) < 0, -rho, rho))[()]


def level_part(places: Floats, alpha: float, level: float) -> Touch | None:
    """Return what is equally low, within ``level``, m, of places (k, 2), (x, z), m; None of one place."""
    t, height = places @ (np.cos(alpha), np.sin(alpha)), places @ (-np.sin(alpha), np.cos(alpha))
    low: NDArray[np.int64] = np.flatnonzero(height <= height.min() + level)
    first, last = places[low[np.argmin(t[low])]], places[low[np.argmax(t[low])]]
    far = float(np.hypot(*(last - first)))
    if far <= level:
        return None
    x, z = 0.5 * (first + last)
    return Touch(float(x), float(z), far)
