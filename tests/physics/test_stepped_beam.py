"""The beam of a profile against closed forms and against Rayleigh and Ritz's method."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from fem_impact.physics.stepped_beam import beam_modes, shear_coefficient
from fem_impact.scene import library
from fem_impact.scene.projectile import ProjectileSpec, Segment
from fem_impact.scene.shapes import Profile

STEEL = library.material("rod-steel")
LIGHT = library.material("aluminium-6061-t6")
C = (STEEL.E / STEEL.rho) ** 0.5


def of_points(*points, **others):
    return ProjectileSpec.turned(Profile(tuple(points)), STEEL, **others)


def ritz(length, outer, inner, count=24):
    """Bending frequencies, rad/s, of a steel beam of radii outer(z), inner(z) by polynomials."""
    x, weight = np.polynomial.legendre.leggauss(80)
    z, dz = 0.5 * length * (x + 1), 0.5 * length * weight
    value = np.array([np.polynomial.legendre.legval(x, np.eye(count)[k]) for k in range(count)])
    slope = [np.polynomial.legendre.legder(np.eye(count)[k]) for k in range(count)]
    slope = np.array([np.polynomial.legendre.legval(x, s) for s in slope]) * 2 / length
    R, r = outer(z), inner(z)
    area, second = np.pi * (R**2 - r**2), np.pi / 4 * (R**4 - r**4)
    GA = shear_coefficient(np.full_like(z, STEEL.nu), r / R) * STEEL.E / (2 * (1 + STEEL.nu)) * area

    def form(a, b, what):
        return (a * (what * dz)) @ b.T

    none = np.zeros((count, count))
    K = np.block(
        [
            [form(slope, slope, GA), -form(slope, value, GA)],
            [-form(value, slope, GA), form(slope, slope, STEEL.E * second) + form(value, value, GA)],
        ]
    )
    M = STEEL.rho * np.block([[form(value, value, area), none], [none, form(value, value, second)]])
    return np.sqrt(np.maximum(eigh(K, M, eigvals_only=True), 0.0))[2:]


def test_a_tapered_body_bends_as_ritz_finds():
    body = beam_modes(of_points((0.0, 3e-3), (0.2, 9e-3)))
    exact = ritz(0.2, lambda z: 3e-3 + 0.03 * z, lambda z: 0.0 * z)
    assert body.bent[:3] == pytest.approx(exact[:3], rel=1e-3)


def test_a_tube_bends_as_ritz_finds_and_stretches_as_a_bar():
    bore = ((0.0, 6e-3), (0.2, 6e-3))
    body = beam_modes(of_points((0.0, 9.5e-3), (0.2, 9.5e-3), bore=bore))
    exact = ritz(0.2, lambda z: 9.5e-3 + 0.0 * z, lambda z: 6e-3 + 0.0 * z)
    assert body.bent[:3] == pytest.approx(exact[:3], rel=1e-3)
    assert body.stretched[:2] == pytest.approx(np.pi * C / 0.2 * np.array([1, 2]), rel=1e-3)


def test_a_cone_stretches_as_its_closed_form():
    """A bar of radius a z between z_1 and z_2: (z u)'' + k^2 z u = 0, free at both ends."""
    z_1, z_2 = 0.1, 0.3
    body = beam_modes(of_points((0.0, 3e-3), (z_2 - z_1, 9e-3)))
    k = body.stretched[0] / C
    # u = sin(k (z - d)) / z with u' = 0: tan(k (z - d)) = k z at both ends
    turned = np.arctan(k * z_2) - np.arctan(k * z_1)
    assert (k * (z_2 - z_1) - turned) % np.pi == pytest.approx(np.pi, rel=2e-3) or (
        k * (z_2 - z_1) - turned
    ) % np.pi == pytest.approx(0.0, abs=5e-3)


def test_two_metals_stretch_as_their_closed_form():
    """Of two bars of one section, free at the ends: Z_1 tan(w l_1 / c_1) + Z_2 tan(w l_2 / c_2) = 0."""
    parts = (Segment(0.08, STEEL), Segment(0.2, LIGHT))
    w = beam_modes(of_points((0.0, 9.5e-3), (0.2, 9.5e-3), segments=parts)).stretched[0]
    speeds = [(m.E / m.rho) ** 0.5 for m in (STEEL, LIGHT)]
    tangents = [np.tan(w * l / c) for l, c in zip((0.08, 0.12), speeds, strict=True)]
    impedance = [m.rho * c for m, c in zip((STEEL, LIGHT), speeds, strict=True)]
    assert impedance[0] * tangents[0] == pytest.approx(-impedance[1] * tangents[1], rel=5e-3)


def test_modes_are_normalised_with_the_mass_of_the_body():
    rod = of_points((0.0, 3e-3), (0.2, 9e-3))
    body, mass = beam_modes(rod), rod.body()
    line = mass.density[0][1] * np.pi * mass.radius(body.z) ** 2
    for u in body.u[:2]:
        assert np.trapezoid(line * u**2, body.z) == pytest.approx(1.0, rel=1e-3)
