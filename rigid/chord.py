"""How wide an outline is a little above its lowest point."""

import math

import numpy as np

from .inputs import Floats


def chord(outline: Floats, alpha: float, height: float) -> tuple[float, float]:
    """Return how far, m, an outline goes down and up the slope at a `height` > 0, m, over its lowest point.

    Parameters
    ----------
    outline : (k, 2) float64, m
        Vertices (x, z) in order, those of smaller x first; the body ends where they do.
    alpha : float
        Inclination, rad.
    """
    sin, cos = math.sin(alpha), math.cos(alpha)
    t, over = outline @ (cos, sin), outline @ (-sin, cos)
    low = int(np.argmin(over))
    over = over - over[low] - height
    return _reach(t[low::-1], over[low::-1]), _reach(t[low:], over[low:])


def mirrored_chord(outline: Floats, alpha: float, height: float) -> tuple[float, float]:
    """As `chord` of an outline whose side x > 0 stands for the one that comes down first.

    At an inclination below 0 that is the side x < 0 of the body, its mirror image.
    """
    down, up = chord(outline, abs(alpha), height)
    return (up, down) if alpha < 0 else (down, up)


def both_sides(side: Floats) -> Floats:
    """Return the outline of a body of revolution from one side (k, 2), (rho, z), which starts on the axis."""
    return np.vstack([side[:0:-1] * [-1, 1], side])


def _reach(t: Floats, over: Floats) -> float:
    """Return how far, m, a line goes from its first place, below 0, to where it first rises above 0."""
    after = int(np.argmax(over > 0.0))
    if over[after] <= 0.0:
        return abs(float(t[-1] - t[0]))
    share = over[after] / (over[after] - over[after - 1])
    return abs(float(t[after] + share * (t[after - 1] - t[after]) - t[0]))
