"""Velocities of a rod dropped on an inclined barrier: Eq 27-28."""

import numpy as np

from .inputs import ArrayLike, Floats, floats, refuse

GRAVITY = 9.80665
"""Standard gravity, m/s2."""


def drop_velocities(height: ArrayLike, alpha: ArrayLike, gravity: float = GRAVITY) -> tuple[Floats, Floats]:
    """Velocities just before impact of a rod dropped without spin (Eq 27-28).

    Parameters
    ----------
    height : array_like
        Drop height of the lowest point, m, not negative.
    alpha : array_like
        Inclination of the barrier, rad.
    gravity : float
        m/s2.

    Returns
    -------
    v_n, v_t : float64 of the broadcast shape, m/s
        Both negative: into the barrier and down the slope.

    Examples
    --------
    >>> v_n, v_t = drop_velocities(0.82, np.pi / 4)
    >>> f"{v_n:.3f} {v_t:.3f}"
    '-2.836 -2.836'
    """
    height, alpha = floats(height, alpha)
    refuse(~(height >= 0), "the drop height must not be negative, got {value} m", height)
    speed = np.sqrt(2.0 * gravity * height)
    return -speed * np.cos(alpha), -speed * np.sin(alpha)
