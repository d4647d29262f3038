"""How far a ball differs from the half-space of Hertz: the approach measured from its mass centre.

Hertz measures the approach from a point at infinity in a half-space. A ball is only some contact radii a in
size, and its inertia loads it while it is braked. Under Hertz' pressure and the uniform body
force of the braking it is solved exactly by a Legendre series (the two regular solutions of each order:
Lur'e, Three-dimensional problems of the theory of elasticity, 1964, chapter 6). Its compliance, the mean
approach under that pressure over the force, is

    C(a) = 3 / (5 E* a) + chi(a / R) / (E_1* R),    E_1* = E_1 / (1 - nu_1^2).

The first term is Hertz'. chi (`ball_excess`) has a logarithm of a / R, proportional to 1 - 2 nu. For a
tangential traction of the same distribution chi_t (`ball_shear`) is the excess of the tangential compliance.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import ceil, log, pi

import numpy as np

from fem_impact.arrays import Array

GAUSS = 100  # points of the quadrature over the contact circle
POINTS = 4001  # tabulated contact radii, and points of the integral over the approach
SMALLEST, LARGEST = 5e-3, 0.4  # a / R of the fit; below, the excess is under 0.5 % of the approach
RESOLUTION = 40.0  # last order of the series times a / R


def legendre(theta: Array, orders: int) -> tuple[Array, Array]:
    """Return P_n(cos theta) and its derivative by theta, both (orders, points)."""
    x = np.cos(theta)
    P = np.ones((orders, len(x)))
    P[1] = x
    for n in range(2, orders):
        P[n] = ((2 * n - 1) * x * P[n - 1] - (n - 1) * P[n - 2]) / n
    slope = np.zeros_like(P)
    slope[1:] = np.arange(1, orders)[:, None] * (x * P[1:] - P[:-1]) / np.sin(theta)
    return P, slope


def pressure_rings(a: float) -> tuple[Array, Array]:
    """Return angles (k,) from the pole and p rho d(rho) (k,) of Hertz' pressure of a unit force."""
    node, weight = np.polynomial.legendre.leggauss(GAUSS)
    s = pi / 4 * (node + 1)  # rho = a sin(s) makes the pressure's edge smooth
    ring = 3 / (2 * pi) * np.sin(s) * np.cos(s) ** 2 * pi / 4 * weight
    return np.arcsin(a * np.sin(s)), ring


def pole_load(a: float, orders: int) -> tuple[Array, Array]:
    """Return the series (orders,) of radial and polar traction of Hertz' pressure on a unit ball.

    A unit force pushes along the axis, as a flattened cap is pushed, against the pole theta = 0.
    """
    theta, ring = pressure_rings(a)
    P, slope = legendre(theta, orders)
    n = np.arange(orders)
    radial = -(2 * n + 1) / 2 * (P @ (ring * np.cos(theta)))
    polar = (2 * n + 1) / (2 * np.maximum(n * (n + 1), 1)) * (slope @ (ring * np.sin(theta)))
    return radial, polar


def surface_shape(nu: float, radial: Array, polar: Array) -> tuple[Array, Array]:
    """Return the displacement series of the skin of a unit ball with 2 G = 1, without order 1."""
    n = np.arange(len(radial), dtype=float)
    # tractions of Lur'e's amplitudes A and B
    r_A, r_B = (n + 1) * (n**2 - n - 2 - 2 * nu), n * (n - 1)
    t_A, t_B = n**2 + 2 * n - 1 + 2 * nu, n - 1
    t_A[0], t_B[0] = 0.0, 1.0  # order 0 swells and has no polar part
    t_B[1] = r_A[1] = 1.0
    det = r_A * t_B - r_B * t_A
    A, B = (radial * t_B - polar * r_B) / det, (polar * r_A - radial * t_A) / det
    out, along = A * (n + 1) * (n - 2 + 4 * nu) + B * n, A * (n + 5 - 4 * nu) + B
    out[1] = along[1] = 0.0
    return out, along


def braked(nu: float, polar: float) -> tuple[float, float]:
    """Return the displacement of order 1: the body force against a unit force, the mass centre at rest.

    c r^2 e_z balances the body force 3 / (4 pi); Lur'e's A of order 1 sets the traction right.
    """
    lame = nu / (1 - 2 * nu)
    c = -3 / (4 * pi) / (2 * lame + 4)
    A = (polar - c) / (2 * (1 + nu))
    centre = 0.6 * c + 2 * A
    return c + A * 2 * (4 * nu - 1) - centre, c + A * (6 - 4 * nu) - centre


def ball_excess(a: float, nu: float) -> float:
    """Return chi for a contact radius of ``a`` ball radii.

    Examples
    --------
    >>> round(ball_excess(0.05, 0.29), 3)
    -0.424
    """
    orders = ceil(RESOLUTION / a)
    radial, polar = pole_load(a, orders)
    out, along = surface_shape(nu, radial, polar)
    out[1], along[1] = braked(nu, float(polar[1]))
    n = np.arange(orders)
    work = 4 * pi / (2 * n + 1) * (radial * out + n * (n + 1) * polar * along)
    stiffness = 1 / (1 - nu)  # E / (1 - nu^2) with 2 G = 1
    return float(stiffness * work.sum() - 3 / (5 * a))


def local_law(E_star: float, radius: float, a: Array, excess: Array) -> tuple[Array, Array]:
    """Return force, N, and approach, m, at contact radii ``a`` (k,), m.

    ``excess`` (k,), m/N, is the compliance less Hertz'. The contact takes the radius of least
    complementary energy F^2 C(a) / 2 + F a^2 / (5 R); the approach is its derivative by F.
    """
    slope = -3 / (5 * E_star * a**2) + np.gradient(excess, a, edge_order=2)
    force = -4 * a / (5 * radius * slope)
    return force, force * (3 / (5 * E_star * a) + excess) + a**2 / (5 * radius)


def fitted(excess: Callable[[float, float], float], nu: float, a: Array) -> Array:
    """Return ``excess(a, nu)`` at many contact radii (k,), in ball radii, by a polynomial in log(a)."""
    return np.asarray(np.polyval(_excess_series(excess, nu), np.log(a)))


@cache
def _excess_series(excess: Callable[[float, float], float], nu: float) -> Array:
    """Return ``excess`` as a polynomial (5,) of log(a / R), fitted from `SMALLEST` to `LARGEST`."""
    reach = np.exp(np.linspace(log(SMALLEST), log(LARGEST), 9))
    return np.polyfit(np.log(reach), [excess(float(a), nu) for a in reach], 4)


def _shear_load(a: float, orders: int) -> tuple[Array, Array, Array, Array]:
    """Return norms (orders,) and series of the traction on a unit ball: radial, polar, torsional.

    With S = dP_n / d(theta) the fields are S cos(phi) along r, the surface gradient of S cos(phi), and r
    times that of S sin(phi); the last two have norms larger by n (n + 1).
    """
    theta, ring = pressure_rings(a)
    P, S = legendre(theta, orders)
    n = np.arange(orders)
    square = n * (n + 1)
    slope = -square[:, None] * P - S / np.tan(theta)
    norm = 2 * pi * np.maximum(square, 1) / (2 * n + 1)
    around = S / np.sin(theta)
    radial = pi * (S @ (ring * np.sin(theta))) / norm
    polar = pi * ((slope * np.cos(theta) + around) @ ring) / (np.maximum(square, 1) * norm)
    torsional = pi * ((around * np.cos(theta) + slope) @ ring) / (np.maximum(square, 1) * norm)
    return norm, radial, polar, torsional


def ball_shear(a: float, nu: float) -> float:
    """Return chi_t, for a tangential force, at a contact radius of ``a`` ball radii.

    Examples
    --------
    >>> round(ball_shear(0.05, 0.29), 3)
    0.802
    """
    orders = ceil(RESOLUTION / a)
    norm, radial, polar, torsional = _shear_load(a, orders)
    n = np.arange(orders)
    out, along = surface_shape(nu, radial, polar)
    out[0] = along[0] = 0.0
    out[1], along[1] = braked(nu, float(polar[1]))
    twist = 2 * torsional / np.maximum(n - 1, 1)  # 2 G = 1
    twist[1] = 2 * torsional[1] / 7  # its moment is balanced by inertia, the mean rotation is 0
    twist[0] = 0.0
    work = norm * (radial * out + n * (n + 1) * (polar * along + torsional * twist))
    stiffness = 1 / (1 - nu)  # E / (1 - nu^2) with 2 G = 1
    return float(stiffness * (work.sum() - 3 * (2 - nu) / (10 * a)))
