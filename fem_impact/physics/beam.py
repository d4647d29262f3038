"""Periods and wave speeds of the projectile as a free beam, and of one shorter than wide as a free disc.

A beam bends by Timoshenko, a bar stretches. A disc or a ring is a thin plate, free all around: a mode
w = W(r) cos(n theta) obeys nabla^4 W = k^4 W, w^2 = k^4 D / (rho h) with D = E h^3 / (12 (1 - nu^2)): W is a
sum of J_n(kr), I_n(kr) and, of a ring, Y_n(kr), K_n(kr). At a free edge bending moment and Kirchhoff's edge
force vanish (A. W. Leissa, Vibration of Plates, NASA SP-160, 1969, chapter 2). Shear and rotary inertia,
which the thin plate leaves out, lengthen the period.
"""

from functools import lru_cache
from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.physics import stepped_beam
from fem_impact.physics.plate import bending_stiffness
from fem_impact.scene.material import Material
from fem_impact.scene.projectile import ProjectileSpec
from rigid import Faceted

ROOTS = np.array([4.730041, 7.853205, *((2 * np.arange(3, 31) + 1) * pi / 2)])  # cos cosh = 1
SHEAR = 0.9  # shear coefficient of a round section, about 6 (1 + nu) / (7 + 6 nu) (Cowper 1966)
CANTILEVER = 2 * pi * sqrt(12) / 3.516
SLICES = 100  # of a mesh, in which prongs are looked for
LATEST, SPAN = 2.5e-3, 2.8  # s, and over the bending period and the contact time, if longer


def bending_frequencies(rod: ProjectileSpec) -> Array:
    """Return circular frequencies of free-free bending, rad/s, ascending; those of a profile by `beam_modes`.

    Timoshenko's dispersion at the wave numbers of the Euler-Bernoulli modes.
    """
    if not rod.is_rod:
        return stepped_beam.beam_modes(rod).bent
    return bending_dispersion(rod, ROOTS / rod.length)


def bending_dispersion(rod: ProjectileSpec, wave: Array) -> Array:
    """Return circular frequencies, rad/s, of bending waves of wave numbers b = ``wave``, 1/m.

    The lower root of Timoshenko's dispersion, r = d/4 and s = kappa G/E:
    w^4 r^2/s - w^2 c0^2 (1 + b^2 r^2 (1 + 1/s)) + b^4 r^2 c0^4 = 0.
    """
    s = SHEAR / (2 * (1 + rod.material.nu))
    b2, r2 = wave**2, (rod.diameter / 4) ** 2
    middle = 1 + b2 * r2 * (1 + 1 / s)
    root = 2 * b2**2 * r2 / (middle + np.sqrt(middle**2 - 4 * b2**2 * r2**2 / s))
    return np.asarray(bar_speed(rod.material) * np.sqrt(root))


def bending_group_speed(rod: ProjectileSpec) -> float:
    """Return the largest group speed dw/db of bending waves, m/s: no packet of them runs ahead of it."""
    wave = np.linspace(0.0, 8.0, 801)[1:] / rod.diameter
    return float(np.gradient(bending_dispersion(rod, wave), wave).max())


def bending_period(rod: ProjectileSpec) -> float:
    """Return the first free-free bending period, s; that of prongs or of a short body's plate, if longer.

    Of a mesh that is shorter than wide, and has no wall, the plate is as thick as it is long.
    """
    as_beam = 2 * pi / float(bending_frequencies(rod)[0])
    return max(as_beam, prongs(rod).period, disc_period(rod) if rod.length < rod.diameter else 0.0)


class Prongs(NamedTuple):
    """Parts of a mesh, side by side in the plane of motion, of the longest first period: m, m and s."""

    length: float
    width: float
    period: float


@lru_cache(maxsize=32)
def prongs(rod: ProjectileSpec) -> Prongs:
    """Return the prongs of a body, such as a fork: as long as their gap, as wide as the narrowest.

    The period is that of a cantilever, 2 pi sqrt(12) L^2 / (3.516 w c0); finite elements of a fork, prongs of
    40 x 4 mm, have 1.12 times it. All are 0 of a body in one piece. What lies on both sides of the plane of
    motion moves alike, and counts as one piece.
    """
    body, found = rod.body(), Prongs(0.0, 0.0, 0.0)
    if not isinstance(body, Faceted):
        return found
    step = body.length / SLICES
    strips = [body.strips((k + 0.5) * step) for k in range(SLICES)]
    narrowest = np.array([np.ptp(x, axis=1).min() if len(x) > 1 else 0.0 for x in strips])
    for part in np.split(narrowest, np.flatnonzero(np.diff(narrowest > 0)) + 1):
        if part[0]:
            length, width = len(part) * step, float(part.min())
            period = CANTILEVER * length**2 / (width * bar_speed(rod.material))
            found = max(found, Prongs(length, width, period), key=lambda one: one.period)
    return found


def stretching_period(rod: ProjectileSpec) -> float:
    """Return the first longitudinal period, s: 2 l / c0 of a rod."""
    if not rod.is_rod:
        return 2 * pi / float(stepped_beam.beam_modes(rod).stretched[0])
    return 2 * rod.length / bar_speed(rod.material)


def bar_speed(metal: Material) -> float:
    """Return the speed c0 = sqrt(E/rho) of stretching waves in a thin rod, m/s."""
    return float((metal.E / metal.rho) ** 0.5)


def latest_time(rod: ProjectileSpec, duration: float) -> float:
    """Return the latest time of a run, s, such that long rods touch again and slow ones leave.

    ``duration``, s, is that of the first contact.
    """
    return max(LATEST, SPAN * (bending_period(rod) + duration))


@lru_cache(maxsize=32)
def wall(rod: ProjectileSpec) -> tuple[Array, Array, Array]:
    """Return places along the axis of a bore, outer and inner radii there, m, (k,) each; of a mesh, too."""
    body = rod.body()
    if not isinstance(body, Faceted):
        return rod.wall() if rod.bore else (np.zeros(0),) * 3
    z = (np.arange(SLICES) + 0.5) * body.length / SLICES
    outer, inner = body.wall(z)
    return z[inner > 0], outer[inner > 0], inner[inner > 0]


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
    z, outer, inner = wall(rod)
    if not len(z):
        return 0.0
    of = np.searchsorted([part.to for part in rod.segments[:-1]], z)
    E, nu, rho = stepped_beam.elastic_constants(rod.materials, of)
    h, R = outer - inner, 0.5 * (outer + inner)
    stiffness, mass = 9 * E * h**3 / (12 * (1 - nu**2) * R**3), 1.25 * rho * h * R
    return 2 * pi * sqrt(float(mass.sum() / stiffness.sum()))


SADDLE = 2  # nodal diameters of the lowest mode
LOWEST, HIGHEST, STEPS = 0.3, 6.0, 200  # of k a, in which the first root lies, and places looked at
THINNEST = 0.99  # largest inner over outer radius: with a narrower rim the four waves are too much alike


def free_plate_root(waves: int, nu: float, hole: float = 0.0) -> float:
    """Return the lowest k a of a free plate of radius a with ``waves`` nodal diameters.

    ``hole`` is the radius of a hole over a.

    Examples
    --------
    >>> [round(free_plate_root(n, 0.33) ** 2, 2) for n in (2, 0)]
    [5.26, 9.07]
    """
    from scipy.optimize import brentq  # .1 s, for which no help text should wait

    share = min(hole, THINNEST)

    def determinant(k: float) -> float:
        return float(np.linalg.det(_free_edges(k, waves, nu, share)))

    places = np.linspace(LOWEST, HIGHEST, STEPS)
    signs = np.sign([determinant(k) for k in places])
    first = int(np.flatnonzero(signs[1:] != signs[:-1])[0])
    return float(brentq(determinant, places[first], places[first + 1]))


def _free_edges(k: float, waves: int, nu: float, hole: float) -> Array:
    """Return moment and edge force of each wave at each edge of the unit plate, (2, 2) or (4, 4), scaled."""
    from scipy import special

    kinds = [(special.jv, special.jvp, -1.0), (special.iv, special.ivp, 1.0)]
    if hole > 0:
        kinds += [(special.yv, special.yvp, -1.0), (special.kv, special.kvp, 1.0)]
    columns = []
    for wave, slope, sign in kinds:
        column = []
        for r in (1.0, hole)[: len(kinds) // 2]:
            w, dw, laplace = wave(waves, k * r), k * slope(waves, k * r), sign * k**2
            bent = (1 - nu) * (dw / r - waves**2 * w / r**2)
            sheared = (1 - nu) * waves**2 / r**2 * (dw - w / r)
            column += [laplace * w - bent, laplace * dw - sheared]
        columns.append(np.array(column) / np.abs(column).max())
    return np.stack(columns, axis=1)


def disc_period(rod: ProjectileSpec) -> float:
    """Return the longest period, s, of a body that bends as a plate.

    A body that is closed at one end or both bends as the thinner of the plates that close it, which its wall
    holds: the period is the longest there may be.
    """
    metal, thickness, hole = rod.material, rod.length, 0.0
    z, outer, inner = wall(rod)
    if len(z):
        half = 0.0 if rod.bore else 0.5 * rod.length / SLICES  # of a slice
        first, last = (rod.bore[0][0], rod.bore[-1][0]) if rod.bore else (z[0] - half, z[-1] + half)
        closing = [h for h in (first, rod.length - last) if h > half]
        if closing:
            thickness = min(closing)
        else:
            hole = float((inner / outer).mean())
    root = free_plate_root(SADDLE, metal.nu, hole)
    speed = sqrt(bending_stiffness(metal.E, metal.nu, thickness) / (metal.rho * thickness))
    return 2 * pi * (0.5 * rod.diameter / root) ** 2 / speed
