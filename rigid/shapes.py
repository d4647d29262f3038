"""Outlines of named shapes: vertices (rho, z), m, from the axis at the tip to the tail."""

import math
from itertools import pairwise

import numpy as np

from .inputs import Floats, ShapeError, TooLongError
from .nose import Nose

STEP = math.radians(0.5)
"""Turn between two vertices of an arc, rad; the volume of a ball is then 2e-5 too small."""


def of_nose(nose: Nose, length: float) -> Floats:
    """Return the outline of a rod with a turned tip and a flat tail, (k, 2), m."""
    if not nose.z_side < length:
        raise TooLongError(
            f"the nose is {nose.z_side * 1e3:.3g} mm long, the body only {length * 1e3:.3g} mm"
        )
    line = nose.polyline(_count(nose.sweep))
    return np.concatenate([line, [[nose.radius, length]]])


def cone(length: float, diameter: float, angle: float, nose_radius: float, face: float) -> Floats:
    """Return the outline of a cone of half `angle`, rad, with a round (radius, m) or flat (diameter, m) tip.

    The cone goes on to the radius of the cylinder behind it; round tips are spheres tangent to the cone.
    """
    if nose_radius * math.cos(angle) + 0.5 * face >= 0.5 * diameter:
        problem = f"the tip of {1e3 * max(nose_radius, 0.5 * face):.3g} mm radius leaves no cone on a radius"
        raise ShapeError(f"{problem} of {diameter * 500:.3g} mm")
    return of_nose(Nose(0.5 * diameter, 0.5 * face, nose_radius, 0.5 * math.pi - angle), length)


def ogive(length: float, diameter: float, calibre: float, nose_radius: float) -> Floats:
    """Return the outline of a tangent ogive of radius `calibre` diameters, its tip a tangent sphere, m.

    The circle's centre lies at rho = R - calibre D beside the start of the cylinder.
    """
    R, arc = 0.5 * diameter, calibre * diameter
    if not 0.0 < nose_radius < R:
        raise ShapeError(f"nose_radius must lie between 0 and {R * 1e3:.3g} mm, got {nose_radius * 1e3:.3g}")
    end = math.asin((arc - R) / (arc - nose_radius))
    start = nose_radius + math.sqrt((arc - nose_radius) ** 2 - (arc - R) ** 2)  # of the cylinder
    if not start < length:
        raise TooLongError(f"the nose is {start * 1e3:.3g} mm long, the body only {length * 1e3:.3g} mm")
    sphere = _arc(0.0, nose_radius, nose_radius, 0.0, end)
    side = _arc(R - arc, start, arc, end, 0.5 * math.pi)
    return np.concatenate([sphere[:-1], side, [[R, length]]])


def calibre_of(nose_length: float, diameter: float, nose_radius: float) -> float:
    """Return the radius, in diameters, of the tangent ogive whose nose with its sphere is so long, m.

    The centres of sphere and ogive are a = nose_length - nose_radius apart along the axis, and both circles
    touch: (C - r)^2 = a^2 + (C - R)^2 for the radii C of the ogive, r of the sphere and R of the cylinder.

    Examples
    --------
    >>> line = ogive(0.1, 0.02, calibre_of(0.03, 0.02, 0.002), 0.002)
    >>> f"{line[-2, 1]:.9f}"
    '0.030000000'
    """
    R, length = 0.5 * diameter, nose_length - nose_radius
    if not nose_radius < R:
        raise ShapeError(f"nose_radius must lie below {R * 1e3:.3g} mm, got {nose_radius * 1e3:.3g} mm")
    if not length > R - nose_radius:
        problem = f"an ogive with a nose_length of {nose_length * 1e3:.4g} mm is blunter than a hemisphere"
        raise ShapeError(f"{problem}: give more than half the diameter, {R * 1e3:.4g} mm")
    return 0.5 * (length**2 / (R - nose_radius) + R + nose_radius) / diameter


def cone_angle_of(nose_length: float, diameter: float, nose_radius: float, face: float) -> float:
    """Return the half angle, rad, of a cone whose nose with its round or flat tip is so long, m.

    It is that of the tangent from the edge of the cylinder to the sphere, or of the line to the flat face.

    Examples
    --------
    >>> line = cone(0.1, 0.02, cone_angle_of(0.03, 0.02, 0.002, 0.0), 0.002, 0.0)
    >>> f"{line[-2, 1]:.9f}"
    '0.030000000'
    """
    along, across = nose_length - nose_radius, 0.5 * (diameter - face)
    if not 0.0 < nose_radius + 0.5 * face < 0.5 * diameter:
        problem = f"the tip of {1e3 * max(nose_radius, 0.5 * face):.3g} mm radius leaves no cone on a radius"
        raise ShapeError(f"{problem} of {diameter * 500:.3g} mm")
    return math.atan2(across, along) - math.asin(nose_radius / math.hypot(across, along))


def ball(diameter: float) -> Floats:
    """Return the outline of a ball."""
    half = _arc(0.0, 0.5 * diameter, 0.5 * diameter, 0.0, 0.5 * math.pi)
    return np.concatenate([half, np.array([0.0, diameter]) + half[-2::-1] * [1.0, -1.0]])


def _arc(rho: float, z: float, radius: float, start: float, end: float) -> Floats:
    """Return points of an arc about (rho, z), m, whose normal turns from `start` to `end`, rad."""
    angle = np.linspace(start, end, _count(end - start))
    line = np.column_stack([rho + radius * np.sin(angle), z - radius * np.cos(angle)])
    line[np.abs(line) < 1e-15 * radius] = 0.0
    return line


def _count(turn: float) -> int:
    return 2 + math.ceil(turn / STEP)


def smooth(points: Floats, pieces: int = 24) -> Floats:
    """Return a smooth outline through points (rho, z), m: monotone cubics over the length of the chords.

    Between two points neither radius nor height leaves their range. A tip or tail on the axis is round:
    the curve goes on as its mirror image there.

    Parameters
    ----------
    points : (k, 2) float64, m
    pieces : int
        Straight pieces between two points.
    """
    from scipy.interpolate import PchipInterpolator

    first, last = points[0, 0] == 0.0, points[-1, 0] == 0.0
    mirror = np.array([-1.0, 1.0])
    before = [points[:0:-1] * mirror] if first else []
    after = [points[-2::-1] * mirror] if last else []
    whole = np.concatenate([*before, points, *after])
    chord = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(whole, axis=0).T))])
    start = len(points) - 1 if first else 0
    knots = chord[start : start + len(points)]
    at = np.concatenate([np.linspace(a, b, pieces, endpoint=False) for a, b in pairwise(knots)])
    return np.asarray(np.maximum(PchipInterpolator(chord, whole)(np.append(at, knots[-1])), 0.0))
