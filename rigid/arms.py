"""Lever arms of the contact point: Eq 6-7 of Averill et al."""

from typing import NamedTuple

import numpy as np

from .inputs import ArrayLike, Floats, floats
from .touch import Touch, on_side

ROUND_OFF = 1e-12
"""Share of its distance from the mass centre below which an arm of a point is 0."""


class Arms(NamedTuple):
    """Position of the contact point: it lies at -d_c t - d_d n from the mass centre (m)."""

    d_c: Floats
    d_d: Floats


def point_arms(z_c: float, x: ArrayLike, z: ArrayLike, alpha: ArrayLike) -> Arms:
    """Arms, m, of a point (x, z) about a mass centre at z_c, m from the tip; x is counted from it."""
    x, z = floats(x, z)
    sin, cos = np.sin(alpha), np.cos(alpha)
    return Arms((z_c - z) * sin - x * cos, (z_c - z) * cos + x * sin)


def touch_arms(touch: Touch, x_c: float, z_c: float, alpha: float) -> Arms:
    """Arms, m, of the middle of what touches first about a mass centre (x_c, z_c), m; 0 below `ROUND_OFF`."""
    arms = point_arms(z_c, touch.x - x_c, touch.z, alpha)
    least = ROUND_OFF * np.hypot(*arms)
    return Arms(*(np.where(np.abs(arm) < least, 0.0, arm) for arm in arms))


def corner_arms(length: ArrayLike, diameter: ArrayLike, alpha: ArrayLike) -> Arms:
    """Arms of the sharp corner of a plain cylinder (Eq 6-7), at alpha below 0 of that on the other side.

    The printed form, with the half diagonal s = sqrt(l^2 + d^2)/2 and the angle
    alpha - pi/2 + arctan(l/d), is the rotation of the corner (d/2, l/2) written in polar form.

    Parameters
    ----------
    length, diameter : array_like
        Of the cylinder, m.
    alpha : array_like
        Inclination of the barrier, rad.

    Returns
    -------
    Arms
        d_c, d_d in m, of the broadcast shape.

    Examples
    --------
    >>> d_c, d_d = corner_arms(0.08, 0.019, np.radians(17.0))
    >>> f"{1e3 * d_c:.2f} mm, {1e3 * d_d:.2f} mm"
    '2.61 mm, 41.03 mm'
    """
    length, diameter, alpha = floats(length, diameter, alpha)
    half_diagonal = 0.5 * np.hypot(length, diameter)
    angle = np.abs(alpha) - np.pi / 2 + np.arctan(length / diameter)
    return Arms(on_side(half_diagonal * np.sin(angle), alpha), half_diagonal * np.cos(angle))
