"""Periods and wave speeds of the projectile as a free beam: Timoshenko's bending, stretching of a bar."""

from math import pi, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.physics import stepped_beam
from fem_impact.physics.disc import disc_period
from fem_impact.scene.material import Material
from fem_impact.scene.projectile import ProjectileSpec

ROOTS = np.array([4.730041, 7.853205, *((2 * np.arange(3, 31) + 1) * pi / 2)])  # cos cosh = 1
SHEAR = 0.9  # shear coefficient of a round section, about 6 (1 + nu) / (7 + 6 nu) (Cowper 1966)
HORIZON = 4e-3  # s, least time that a free flight is looked ahead: the camera's window, 40 frames at 10 kHz
PERIODS = 1.5  # of the rod's bending, that a free flight is looked ahead if they are longer
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
    """Return the first free-free bending period, s; of a short body that of a plate, if longer."""
    as_beam = 2 * pi / float(bending_frequencies(rod)[0])
    return max(as_beam, disc_period(rod)) if rod.is_short else as_beam


def stretching_period(rod: ProjectileSpec) -> float:
    """Return the first longitudinal period, s: 2 l / c0 of a rod."""
    if not rod.is_rod:
        return 2 * pi / float(stepped_beam.beam_modes(rod).stretched[0])
    return 2 * rod.length / bar_speed(rod.material)


def bar_speed(metal: Material) -> float:
    """Return the speed c0 = sqrt(E/rho) of stretching waves in a thin rod, m/s."""
    return float((metal.E / metal.rho) ** 0.5)


def horizon(rod: ProjectileSpec) -> float:
    """Return the time, s, that a free flight is looked ahead for a further contact by the rod's bending."""
    return max(HORIZON, PERIODS * bending_period(rod))


def latest_time(rod: ProjectileSpec, duration: float) -> float:
    """Return the latest time of a run, s, such that long rods touch again and slow ones leave.

    ``duration``, s, is that of the first contact.
    """
    return max(LATEST, SPAN * (bending_period(rod) + duration))


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
    if not rod.bore:
        return 0.0
    z, outer, inner = rod.wall()
    ends = [part.to for part in rod.segments][:-1]
    steels = [part.material for part in rod.segments] or [rod.material]
    of = np.searchsorted(ends, z)
    E, nu, rho = (np.array([getattr(steel, key) for steel in steels])[of] for key in ("E", "nu", "rho"))
    h, R = outer - inner, 0.5 * (outer + inner)
    stiffness, mass = 9 * E * h**3 / (12 * (1 - nu**2) * R**3), 1.25 * rho * h * R
    return 2 * pi * sqrt(float(mass.sum() / stiffness.sum()))
