"""Where the mesh of a scene is fine, and how fine: from the estimated contact, before any mesh is made."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, floor, log2, sin

import numpy as np

from fem_impact.arrays import Array
from fem_impact.errors import SceneError
from fem_impact.physics.contact import (
    ContactBodies,
    ContactEstimate,
    approach,
    barrier_conforms,
    contact_estimate,
    projectile,
    sliding,
)
from fem_impact.scene.types import Scene

# half-widths of the fine zone in units of the estimated contact ellipse's semi-axes (depth: of their
# geometric mean), and how many cells it has at least
ALONG, AROUND, DEPTH, FEWEST = 2.2, 1.5, 2.0, 4.0
# the rod slides down the slope while it touches: length of the fine strip over depth and tan(alpha), and
# at least over the half-width along t, because the surface is dragged along in front of a rod that sticks
# (at 17 to 37 degrees, where 1.1 to 1.3 half-widths left the edge flowing by up to 0.5 %)
SLIDE, DRAG = 5.0, 0.6
# a flat face whose middle is no higher than this many depths may touch as a whole
FLAT = 2.0
# under a tip that sticks the plate shears in a layer some 0.05 mm thick: so many rows at its skin are drawn
# together, each to half the height of the next; the first no lower than a share of the indentation, or it is
# crushed at the edge of the contact
SKIN_ROWS, LOW = 3, 0.1


@dataclass(frozen=True, slots=True)
class Zones:
    """Sizes of the fine zones about the contact, m.

    Attributes
    ----------
    base : edge of the body's cells; levels : how often they are halved at the contact
    half : half-widths along t and b, and depth along n
    reach : how far the rod's zone follows its flat face along -t; along : how far the barrier's goes along -t
    conforming : the barrier flows under all of the contact, so that its surface takes the rod's form
    skin_rows : thin rows of cells at the top of the barrier
    """

    base: float
    levels: int
    half: tuple[float, float, float]
    reach: float
    along: float
    conforming: bool
    skin_rows: int

    @property
    def tip_size(self) -> float:
        """Return the finest cell edge, m; in the barrier along t and b."""
        return self.base * 0.5**self.levels


def zones_of(bodies: ContactBodies) -> Zones:
    """Return the fine zones of two bodies that touch."""
    scene = bodies.scene
    base, levels = scene.projectile.diameter / scene.accuracy.across, levels_of(scene)
    h, rho = base / 2**levels, float(lowest_point(scene)[0])
    t, b, n = half_widths(contact_estimate(bodies), h)
    reach = face_reach(bodies, rho)
    conforming = barrier_conforms(bodies)
    rows = skin_rows(bodies, h) if conforming and bodies.f > 0 else 0
    half = t, max(b, rho) if reach > 0 else b, n
    return Zones(base, levels, half, reach, reach + slide(bodies, t), conforming, rows)


def lowest_point(scene: Scene) -> Array:
    """Return the rod's lowest point (3,) in its own frame, m."""
    rho, z = projectile(scene).contact_point(scene.impact.angle)
    return np.array([float(rho), 0.0, float(z)])


def levels_of(scene: Scene) -> int:
    """Return how often base cells are split to come nearest to the wanted tip size."""
    base = scene.projectile.diameter / scene.accuracy.across
    return max(0, round(float(np.log2(base / scene.accuracy.tip_size))))


def half_widths(size: ContactEstimate, h: float) -> tuple[float, float, float]:
    """Return the fine zone's extents along t (each side), b and n, m."""
    depth = DEPTH * np.sqrt(size.a_t * size.a_b)
    return max(ALONG * size.a_t, FEWEST * h), max(AROUND * size.a_b, FEWEST * h), max(depth, FEWEST * h)


def skin_rows(bodies: ContactBodies, h: float) -> int:
    """Return how many rows of cells ``h`` m high are drawn together at the skin of a plate that may stick."""
    halvings = floor(log2(h / (LOW * contact_estimate(bodies).depth)))
    return min(max(halvings, 0), SKIN_ROWS)


def face_reach(bodies: ContactBodies, rho: float) -> float:
    """Return how far the fine zone must follow the flat face, m: 0 unless the face nearly lies flat.

    The face rises from the contact by tan(alpha); if its middle stands no higher than `FLAT` depths of the
    estimated indentation, all of it may touch.
    """
    depth, alpha = contact_estimate(bodies).depth, bodies.scene.impact.angle
    return 2 * rho * cos(alpha) if rho * sin(alpha) <= FLAT * depth else 0.0


def slide(bodies: ContactBodies, t: float) -> float:
    """Return how far the fine zone of a barrier goes on down the slope, m, ``t`` m its half-width there."""
    down = -sliding(bodies.scene)
    if down <= 0:
        return 0.0
    way = SLIDE * contact_estimate(bodies).depth * down / max(approach(bodies.scene), 1e-6)
    return max(way, DRAG * t)


def require_fine_zone(bodies: ContactBodies) -> None:
    """Refuse a tip without a fine zone where one is needed (SceneError)."""
    scene = bodies.scene
    if levels_of(scene) == 0 and (bodies.compliant or bodies.rod_yields):
        base = scene.projectile.diameter / scene.accuracy.across
        raise SceneError(
            "leaves the tip as coarse as the rod: nothing could yield, and the barrier has no fine zone.",
            key="accuracy.tip_size",
            value=f"{scene.accuracy.tip_size * 1e3:.3g} mm",
            remedy=f"Give at most {0.7 * base * 1e3:.2g} mm, or the barrier-rigid effect on an elastic rod.",
        )
