"""A rigid cone pressed into a half-space that yields, in axisymmetric elements.

Nodes of the face stop at the cone, with Coulomb's friction. The cone has no length of its own: but for the
cells, force over depth squared, contact radius over depth and the mean pressure do not change with the depth.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import cos, pi, sin, sqrt, tan

import numpy as np

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.evidence.references.axisymmetric import CORNERS, Body, Metal, grid

Strength = Callable[[Array, Array], Array]

REACH = 12.0  # half-width and depth of the body over the contact radius: 24 changes the pressure by .1 %
FINE, GROWTH = 1.4, 1.12  # radius and depth of the equal cells over the contact radius; growth beyond
SLOW = 0.02  # rho v^2 over the yield stress, at the speed of the cone: .01 has .4 % less pressure
FROM = 0.4  # share of the depth from which on force and radius are read


@dataclass(slots=True)
class Indentation:
    """Force and contact radius of a cone as it goes down.

    Attributes
    ----------
    depth, force : of each step, m and N
    touched : depth, m, at which a node of the face was first touched, and its radius then, m
    """

    depth: list[float] = field(default_factory=list)
    force: list[float] = field(default_factory=list)
    touched: list[tuple[float, float]] = field(default_factory=list)

    def coefficients(self) -> Array:
        """Return (2,) float64: mean pressure, Pa, and contact radius over depth.

        The radius follows the line through the first touches of the face's nodes, which come cell by cell; a
        tip that is blunt by a part of a cell shifts it and does not count.
        """
        end = self.depth[-1]
        depth, radius = np.array([t for t in self.touched if t[0] > FROM * end]).T
        slope, offset = np.polyfit(depth, radius, 1)
        d, force = np.array(self.depth), np.array(self.force)
        late = d > FROM * end
        contact = offset + slope * d[late]
        return np.array([np.sum(force[late]) / np.sum(pi * contact**2), slope])


def cone_speed(metal: Metal) -> float:
    """Return a speed of the cone, m/s, so slow that inertia adds .8 % to the pressure on steel."""
    return sqrt(SLOW * metal.yield_stress / metal.rho)


def indent(
    metal: Metal, angle: float, friction: float = 0.0, cells: int = 10, strength: Strength | None = None
) -> Indentation:
    """Press a cone in and return what it met.

    Parameters
    ----------
    metal : Metal
    angle : half the angle at the tip, rad
    friction : Coulomb's coefficient
    cells : over the radius of the cone at the face, at the end, which is the unit of length
    strength : of a hardened layer, the mean factor of the flow stress between two depths under the face
    """
    lines = _lines(cells)
    x, corners = grid(lines, -lines[::-1])
    factors = _factors(-x[corners, 1], strength) if strength else 1.0
    body, found = Body(metal, x, np.zeros_like(x), corners, factors), Indentation()
    speed, depth = cone_speed(metal), 1 / tan(angle)
    face, axis = np.arange(len(x) - len(lines), len(x)), x[:, 0] == 0.0
    far = (x[:, 0] == lines[-1]) | (x[:, 1] == -lines[-1])
    free = np.ones(len(lines), dtype=bool)

    def stop(body: Body) -> None:
        body.v[far], body.v[axis, 0] = 0.0, 0.0
        touched, force = _meet(body, face, speed, angle, friction)
        found.depth.append(speed * body.time)
        found.force.append(force)
        now = np.flatnonzero(touched & free)
        found.touched += [(speed * body.time, float(body.x[face[i], 0])) for i in now]
        free[touched] = False

    while speed * body.time < depth:
        body.advance(stop)
    return found


def _factors(under: Array, strength: Strength) -> Array:
    """Return the factor of the flow stress (points, m) of cells with corners ``under`` (4, m) the face, m."""
    bottom, top = under.max(axis=0), under.min(axis=0)
    middle = 0.5 * (bottom + top)
    lower, upper = strength(middle, bottom), strength(top, middle)
    return np.asarray([lower if z < 0 else upper for _, z in CORNERS])


def _lines(cells: int) -> Array:
    """Return grid lines from 0: equal cells, a radius of 1 holds so many, then growing ones."""
    fine = np.arange(round(FINE * cells) + 1) / cells
    count = int(np.ceil(np.log(1 + (REACH - fine[-1]) * cells * (GROWTH - 1)) / np.log(GROWTH)))
    return np.concatenate([fine, fine[-1] + np.cumsum(GROWTH ** np.arange(1, count + 1)) / cells])


def _meet(body: Body, face: Ints, speed: float, angle: float, friction: float) -> tuple[Bools, float]:
    """Stop nodes of the face at the cone; return which were touched, and the force on it, N."""
    x, v, m = body.x[face], body.v[face], body.mass[face]
    tip = -speed * (body.time + body.dt)
    gap = (tip + (x[:, 0] + body.dt * v[:, 0]) / tan(angle) - x[:, 1] - body.dt * v[:, 1]) * sin(angle)
    push = np.maximum(-gap / body.dt, 0.0)
    push[0] /= sin(angle)  # on the axis straight down
    normal = np.tile([cos(angle), -sin(angle)], (len(x), 1))
    normal[0] = 0.0, -1.0
    along = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    slip = np.sum((v + push[:, None] * normal - [0.0, -speed]) * along, axis=1)
    held = -np.clip(slip, -friction * push, friction * push)
    change = push[:, None] * normal + held[:, None] * along
    body.v[face] = v + change
    return push > 0, float(-np.sum(m * change[:, 1]) / body.dt)
