"""A yielding round bar on a frictionless rigid wall: an axisymmetric explicit code of its own.

Bilinear quadrilaterals in the meridian plane (r, z) with 2 x 2 points and the element's mean dilatation,
updated Lagrangian, stress turned with the midpoint's spin (Hughes & Winget 1980, doi:10.1002/nme.1620151210),
von Mises' law with linear hardening returned along the radius (Wilkins 1964), lumped masses, central
differences. A node that would pass the wall is stopped at it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from fem_impact.arrays import Array

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
GAUSS = CORNERS / sqrt(3)
SHAPE = np.prod(1 + GAUSS[:, None] * CORNERS, axis=2) / 4  # (points, corners)
SLOPE = CORNERS * (1 + GAUSS[:, None] * CORNERS)[:, :, ::-1] / 4  # by the local coordinates
COURANT, EVERY = 0.9, 10  # time step over the limit of the smallest cell; steps between updates of it


@dataclass(frozen=True, slots=True)
class Metal:
    """Elastic constants E, Pa, and nu; density, kg/m3; yield stress and plastic modulus, Pa."""

    E: float
    nu: float
    rho: float
    yield_stress: float
    hardening: float


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
    def at(cls, x: Array) -> _Places:
        """Return those of cells with corners at x (4, 2, m)."""
        J = np.einsum("gak,aim->gkim", SLOPE, x)
        det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
        inverse = np.stack([J[:, 1, 1], -J[:, 0, 1], -J[:, 1, 0], J[:, 0, 0]], axis=1) / det[:, None]
        slope = np.einsum("gak,gikm->gaim", SLOPE, inverse.reshape(J.shape))
        r = np.einsum("ga,am->gm", SHAPE, x[:, 0])
        hoop, volume = SHAPE[:, :, None] / r[:, None], 2 * pi * r * det
        own = slope.copy()
        own[:, :, 0] += hoop
        mean = np.einsum("gm,gaim->aim", volume / volume.sum(axis=0), own)
        return cls(slope, hoop, volume, (mean - own) / 3)


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


def _returned(metal: Metal, stress: Array, plastic: Array, strain: Array) -> tuple[Array, Array]:
    """Return stress and equivalent plastic strain after an increment of strain."""
    G, bulk = metal.E / (2 + 2 * metal.nu), metal.E / (3 - 6 * metal.nu)
    swell, pressure = strain[:3].sum(axis=0), stress[:3].mean(axis=0)
    s = stress + 2 * G * strain
    s[:3] -= pressure + 2 / 3 * G * swell
    q = np.sqrt(1.5 * ((s[:3] ** 2).sum(axis=0) + 2 * s[3] ** 2))
    more = np.maximum(q - metal.yield_stress - metal.hardening * plastic, 0.0) / (3 * G + metal.hardening)
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


def _grid(radius: float, length: float, cells: int) -> tuple[Array, NDArray[np.int64]]:
    """Return points (n, 2), the foot's first, and the cells' corners (4, m)."""
    along = max(2, round(cells * length / radius))
    z, r = np.meshgrid(np.linspace(0, length, along + 1), np.linspace(0, radius, cells + 1), indexing="ij")
    n = np.arange(r.size).reshape(r.shape)
    corners = [n[:-1, :-1], n[:-1, 1:], n[1:, 1:], n[1:, :-1]]
    return np.stack([r.ravel(), z.ravel()], axis=1), np.stack([c.ravel() for c in corners])


def taylor_bar(
    metal: Metal, length: float, radius: float, speed: float, time: float, cells: int = 4
) -> tuple[float, float]:
    """Return length and foot radius, m, at a time, s, with so many cells over the radius.

    Examples
    --------
    >>> copper = Metal(117e9, 0.35, 8930.0, 400e6, 100e6)
    >>> [round(1e3 * size, 1) for size in taylor_bar(copper, 32.4e-3, 3.2e-3, 227.0, 80e-6, 2)]
    [21.5, 6.9]
    """
    x, corners = _grid(radius, length, cells)

    def at_corners(nodal: Array) -> Array:
        return nodal[corners].transpose(0, 2, 1)

    heavy = metal.rho * np.einsum("gm,ga->am", _Places.at(at_corners(x)).volume, SHAPE)
    mass = np.bincount(corners.ravel(), heavy.ravel())
    c_d = sqrt(metal.E * (1 - metal.nu) / ((1 + metal.nu) * (1 - 2 * metal.nu)) / metal.rho)
    v, force = np.tile([0.0, -speed], (len(x), 1)), np.zeros_like(x)
    stress, plastic = np.zeros((4, 4, corners.shape[1])), np.zeros((4, corners.shape[1]))
    axis, now, step = x[:, 0] == 0.0, 0.0, 0
    while now < time:
        if step % EVERY == 0:
            dt = COURANT * _edge(at_corners(x)) / c_d
        v += dt * force / mass[:, None]
        v[axis, 0] = 0.0
        v[:, 1] = np.maximum(v[:, 1], -x[:, 1] / dt)
        rate, spin = _strained(_Places.at(at_corners(x + 0.5 * dt * v)), at_corners(v))
        stress, plastic = _returned(metal, _turned(stress, dt * spin), plastic, dt * rate)
        x += dt * v
        pushed = _force(_Places.at(at_corners(x)), stress)
        force = np.stack([np.bincount(corners.ravel(), pushed[:, i].ravel()) for i in (0, 1)], axis=1)
        now, step = now + dt, step + 1
    return float(np.ptp(x[:, 1])), float(x[: cells + 1, 0].max())
