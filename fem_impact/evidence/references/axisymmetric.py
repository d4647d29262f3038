"""Axisymmetric explicit elements that yield: a code of its own, for answers beside the solver's.

Bilinear quadrilaterals in the meridian plane (r, z) with 2 x 2 points and the element's mean dilatation,
updated Lagrangian, stress turned with the midpoint's spin (Hughes & Winget 1980, doi:10.1002/nme.1620151210),
von Mises' law returned along the radius (Wilkins 1964), lumped masses, central differences.

They answer for a bar that strikes a wall (`taylor_bar`) and for a rigid cone pressed into a half-space
(`indent`): nodes of the face stop at the cone, with Coulomb's friction. The cone has no length of its own:
but for the cells, force over depth squared, contact radius over depth and the mean pressure do not change
with the depth.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import cos, pi, sin, sqrt, tan

import numpy as np

from fem_impact.arrays import Array, Bools, Ints

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
GAUSS = CORNERS / sqrt(3)
SHAPE = np.prod(1 + GAUSS[:, None] * CORNERS, axis=2) / 4  # (points, corners)
SLOPE = CORNERS * (1 + GAUSS[:, None] * CORNERS)[:, :, ::-1] / 4  # by the local coordinates
COURANT, EVERY = 0.9, 10  # time step over the limit of the smallest cell; steps between updates of it
ITERATIONS = 3  # of the flow stress: on a power law they leave less than 1e-9 of it at steps of 1e-3 strain


@dataclass(frozen=True, slots=True)
class Metal:
    """Elastic constants E, Pa, and nu; density, kg/m3; flow curve yield_stress (1 + slope p)^exponent, Pa."""

    E: float
    nu: float
    rho: float
    yield_stress: float
    slope: float = 0.0
    exponent: float = 1.0

    @property
    def wave_speed(self) -> float:
        """Speed of pressure waves, m/s."""
        return sqrt(self.E * (1 - self.nu) / ((1 + self.nu) * (1 - 2 * self.nu)) / self.rho)

    def flow(self, plastic: Array, strength: Array | float = 1.0) -> tuple[Array, Array]:
        """Return flow stresses and their slopes, Pa, at equivalent plastic strains, times a ``strength``."""
        base = 1 + self.slope * plastic
        stress = strength * self.yield_stress * base**self.exponent
        return stress, stress * self.exponent * self.slope / base


@dataclass(frozen=True, slots=True)
class _Places:
    """Shape functions and their derivatives at the 4 points of m cells.

    Attributes
    ----------
    slope : (points, corners, 2, m) slopes of the shapes by r and z; hoop : (points, corners, m) shape over r
    volume : (points, m) m3
    swell : (points, corners, 2, m) a third of: slopes of the mean dilatation less those at the point
    """

    slope: Array
    hoop: Array
    volume: Array
    swell: Array

    @classmethod
    def at(cls, x: Array) -> "_Places":
        """Return those of cells with corners at x (4, 2, m)."""
        J = np.einsum("gak,aim->gkim", SLOPE, x)
        det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
        inverse = np.stack([J[:, 1, 1], -J[:, 0, 1], -J[:, 1, 0], J[:, 0, 0]], axis=1) / det[:, None]
        slope = np.einsum("gak,gikm->gaim", SLOPE, inverse.reshape(J.shape))
        r = np.einsum("ga,am->gm", SHAPE, x[:, 0])
        hoop, volume = SHAPE[:, :, None] / r[:, None], 2 * pi * r * det
        gradient = slope.copy()
        gradient[:, :, 0] += hoop
        mean = np.einsum("gm,gaim->aim", volume / volume.sum(axis=0), gradient)
        return cls(slope, hoop, volume, (mean - gradient) / 3)


def _turned(stress: Array, angle: Array) -> Array:
    """Return stresses rr, zz, hoop, rz (4, points, m) turned by an angle from r towards z."""
    c, s = np.cos(angle), np.sin(angle)
    rr, zz, hoop, rz = stress
    lean = 2 * c * s * rz
    turned = c * s * (rr - zz) + (c * c - s * s) * rz
    return np.stack([c * c * rr + s * s * zz - lean, s * s * rr + c * c * zz + lean, hoop, turned])


def _strained(places: _Places, v: Array) -> tuple[Array, Array]:
    """Return rates of strain rr, zz, hoop, rz (4, points, m) and of spin (points, m) from v (4, 2, m)."""
    L = np.einsum("aim,gajm->ijgm", v, places.slope)
    hoop = np.einsum("am,gam->gm", v[:, 0], places.hoop)
    even = np.einsum("aim,gaim->gm", v, places.swell)
    rate = np.stack([L[0, 0] + even, L[1, 1] + even, hoop + even, 0.5 * (L[0, 1] + L[1, 0])])
    return rate, 0.5 * (L[1, 0] - L[0, 1])


def _returned(
    metal: Metal, stress: Array, plastic: Array, strain: Array, strength: Array | float
) -> tuple[Array, Array]:
    """Return stress and equivalent plastic strain after an increment of strain."""
    G, bulk = metal.E / (2 + 2 * metal.nu), metal.E / (3 - 6 * metal.nu)
    swell, pressure = strain[:3].sum(axis=0), stress[:3].mean(axis=0)
    s = stress + 2 * G * strain
    s[:3] -= pressure + 2 / 3 * G * swell
    q = np.sqrt(1.5 * ((s[:3] ** 2).sum(axis=0) + 2 * s[3] ** 2))
    more = np.zeros_like(plastic)
    for _ in range(ITERATIONS):  # Newton's, from the elastic side: one is exact on a straight flow curve
        flow, slope = metal.flow(plastic + more, strength)
        more = np.maximum(more + (q - 3 * G * more - flow) / (3 * G + slope), 0.0)
    s *= 1 - 3 * G * more / np.maximum(q, 1e-30)
    s[:3] += pressure + bulk * swell
    return s, plastic + more


def _force(places: _Places, stress: Array) -> Array:
    """Return the forces (4, 2, m), N, of the cells on their corners."""
    rr, zz, hoop, rz = stress * places.volume
    tensor = np.stack([rr, rz, rz, zz]).reshape(2, 2, *rr.shape)
    out = np.einsum("ijgm,gajm->aim", tensor, places.slope)
    out[:, 0] += np.einsum("gm,gam->am", hoop, places.hoop)
    return np.asarray(-out - np.einsum("gm,gaim->aim", rr + zz + hoop, places.swell))


def _edge(x: Array) -> float:
    """Return the smallest height of cells with corners at x (4, 2, m)."""
    (a, b), (c, d) = x[2] - x[0], x[3] - x[1]
    longest = np.sqrt(((x - np.roll(x, 1, axis=0)) ** 2).sum(axis=1)).max(axis=0)
    return float((0.5 * np.abs(a * d - b * c) / longest).min())


@dataclass(slots=True)
class Body:
    """A body in motion.

    Attributes
    ----------
    metal : Metal
    x, v : (n, 2) float64, m and m/s, in (r, z)
    corners : (4, m) int64, of the cells, turning left
    strength : factor of the flow stress, of all points or (points, m)
    mass : (n,) float64, kg; force : (n, 2) float64, N, of the cells
    stress : (4, points, m) float64, Pa, rr, zz, hoop, rz; plastic : (points, m)
    dt, time : s
    """

    metal: Metal
    x: Array
    v: Array
    corners: Ints
    strength: Array | float = 1.0
    mass: Array = field(init=False)
    force: Array = field(init=False)
    stress: Array = field(init=False)
    plastic: Array = field(init=False)
    dt: float = 0.0
    time: float = 0.0
    steps: int = 0

    def __post_init__(self) -> None:
        m = self.corners.shape[1]
        heavy = self.metal.rho * np.einsum("gm,ga->am", _Places.at(self._at_corners(self.x)).volume, SHAPE)
        self.mass = np.asarray(np.bincount(self.corners.ravel(), heavy.ravel()), np.float64)
        self.force = np.zeros_like(self.x)
        self.stress, self.plastic = np.zeros((4, 4, m)), np.zeros((4, m))

    def _at_corners(self, nodal: Array) -> Array:
        return np.asarray(nodal[self.corners].transpose(0, 2, 1))

    def advance(self, stop: "Callable[[Body], None]") -> None:
        """Take one step; ``stop`` corrects the velocities after the kick by the forces."""
        if self.steps % EVERY == 0:
            self.dt = COURANT * _edge(self._at_corners(self.x)) / self.metal.wave_speed
        self.v += self.dt * self.force / self.mass[:, None]
        stop(self)
        half = self._at_corners(self.x + 0.5 * self.dt * self.v)
        rate, spin = _strained(_Places.at(half), self._at_corners(self.v))
        turned = _turned(self.stress, self.dt * spin)
        self.stress, self.plastic = _returned(self.metal, turned, self.plastic, self.dt * rate, self.strength)
        self.x += self.dt * self.v
        pushed = _force(_Places.at(self._at_corners(self.x)), self.stress)
        for i in (0, 1):
            self.force[:, i] = np.bincount(self.corners.ravel(), pushed[:, i].ravel())
        self.time, self.steps = self.time + self.dt, self.steps + 1


def grid(r: Array, z: Array) -> tuple[Array, Ints]:
    """Return points (n, 2), row by row from the first z, and corners (4, m) of the cells between them."""
    up, out = np.meshgrid(z, r, indexing="ij")
    n = np.arange(out.size).reshape(out.shape)
    corners = [n[:-1, :-1], n[:-1, 1:], n[1:, 1:], n[1:, :-1]]
    return np.stack([out.ravel(), up.ravel()], axis=1), np.stack([c.ravel() for c in corners])


def taylor_bar(
    metal: Metal, length: float, radius: float, speed: float, time: float, cells: int = 4
) -> tuple[float, float]:
    """Return length and foot radius, m, of a round bar on a frictionless rigid wall after ``time``, s.

    So many ``cells`` lie over the radius; nodes stop at the wall.

    Examples
    --------
    >>> copper = Metal(117e9, 0.35, 8930.0, 400e6, slope=0.25)
    >>> [round(1e3 * size, 1) for size in taylor_bar(copper, 32.4e-3, 3.2e-3, 227.0, 80e-6, 2)]
    [21.5, 6.9]
    """
    along = max(2, round(cells * length / radius))
    x, corners = grid(np.linspace(0, radius, cells + 1), np.linspace(0, length, along + 1))
    bar = Body(metal, x, np.tile([0.0, -speed], (len(x), 1)), corners)
    axis = x[:, 0] == 0.0

    def stop(bar: Body) -> None:
        bar.v[axis, 0] = 0.0
        bar.v[:, 1] = np.maximum(bar.v[:, 1], -bar.x[:, 1] / bar.dt)

    while bar.time < time:
        bar.advance(stop)
    return float(np.ptp(bar.x[:, 1])), float(bar.x[: cells + 1, 0].max())


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
    body, indentation = Body(metal, x, np.zeros_like(x), corners, factors), Indentation()
    speed, depth = cone_speed(metal), 1 / tan(angle)
    face, axis = np.arange(len(x) - len(lines), len(x)), x[:, 0] == 0.0
    far = (x[:, 0] == lines[-1]) | (x[:, 1] == -lines[-1])
    free = np.ones(len(lines), dtype=bool)

    def stop(body: Body) -> None:
        body.v[far], body.v[axis, 0] = 0.0, 0.0
        touched, force = _meet(body, face, speed, angle, friction)
        indentation.depth.append(speed * body.time)
        indentation.force.append(force)
        now = np.flatnonzero(touched & free)
        indentation.touched += [(speed * body.time, float(body.x[face[i], 0])) for i in now]
        free[touched] = False

    while speed * body.time < depth:
        body.advance(stop)
    return indentation


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
