"""How far a ball differs from the half-space of Hertz: the approach measured from its mass centre.

Hertz measures the approach from a point at infinity in a half-space. A ball is only some contact radii a in
size, and its inertia loads it while it is braked. Under Hertz' pressure and the uniform body
force of the braking it is solved exactly by a Legendre series (the two regular solutions of each order:
Lur'e, Three-dimensional problems of the theory of elasticity, 1964, chapter 6). Its compliance, the mean
approach under that pressure over the force, is

    C(a) = 3 / (5 E* a) + chi(a / R) / (E_1* R),    E_1* = E_1 / (1 - nu_1^2).

The first term is Hertz'. chi (`ball_excess`) has a logarithm of a / R, proportional to 1 - 2 nu. For a
tangential traction of the same distribution chi_t (`ball_shear`) is the excess of the tangential compliance.

In an impact the ball also rings (`ball_impact`): while steel at 4 m/s touches, its slowest mode (two lobes,
2.64 c_s / R for nu = 0.29) swings five times. As the share of a mode in the approach is its compliance,
phi^2 / omega^2, the approach is

    z = local(F) + sum phi q,   q'' + omega^2 q = phi F,   local(F) = steady(F) - F sum phi^2 / omega^2,

with the way z of the mass centre and the modes q below `HIGHEST`. Steel at 4 m/s (a / R = 0.074) has a
largest force that is 0.25 % lower than without and a time that is 0.18 % longer; both differences go about as
(a / R)^2 and turn with the phase of the ringing.

An oblique impact with friction is that of Maw, Barber & Fawcett (1976), of a finite ball with its excess.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import ceil, log, pi, sqrt

import numpy as np
from numpy.polynomial.legendre import Legendre, leggauss
from scipy.integrate import OdeSolution, solve_ivp
from scipy.linalg import eigh

from fem_impact.arrays import Array
from fem_impact.evidence.references.hertz import HertzImpact, SpringRow, hertz, tangential_ratio

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
    node, weight = leggauss(GAUSS)
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


# c_s / R: to 20 in place of 12 force and time change by 0.05 % at a / R = 0.1; no order above 12 is so slow
HIGHEST, ORDERS = 12.0, 13
SHAPES, RADII = 10, 40  # functions of the radius, and points of their integrals
PRECISE = 1e-7  # relative, of each step


def ball_modes(nu: float, a: float) -> tuple[Array, Array]:
    """Return omega (k,), in c_s / R, and phi (k,) of the modes of a free ball with the radius a of contact.

    phi^2 / omega^2 is the mode's part of the approach by a unit force with Hertz' pressure, with
    R = G = rho = 1.

    Examples
    --------
    >>> omega, phi = ball_modes(0.29, 0.05)
    >>> round(float(omega.min()), 3), round(float(abs(phi[omega.argmin()])), 2)
    (2.645, 0.9)
    """
    radial, polar = pole_load(a, ORDERS)
    by_order = [modes_of_order(n, nu, radial[n], polar[n]) for n in range(ORDERS)]
    omega, phi = (np.concatenate(part) for part in zip(*by_order, strict=True))
    heard = (omega > 1e-2) & (omega < HIGHEST)  # slower is the translation of order 1
    return omega[heard], phi[heard]


def modes_of_order(n: int, nu: float, radial: float, polar: float) -> tuple[Array, Array]:
    """Return omega and phi of the modes u_r = U(r) P_n, u_theta = V(r) dP_n / d(theta).

    By Ritz' method with r^(n-1), the regular solution's power at the centre, times polynomials of r^2; the
    energies are those of Dahlen & Tromp, Theoretical Global Seismology, 1998, chapter 8.
    """
    node, weight = leggauss(RADII)
    r, power, m = 0.5 * (node + 1), abs(n - 1), n * (n + 1)
    basis = [Legendre.basis(k) for k in range(SHAPES)]
    f = np.stack([r**power * b(2 * r**2 - 1) for b in basis])
    slope = power / r * f + np.stack([r**power * 4 * r * b.deriv()(2 * r**2 - 1) for b in basis])
    none = np.zeros_like(f)
    U, dU, V, dV = f, slope, none, none
    if n:
        U, dU, V, dV = (np.vstack(pair) for pair in ((f, none), (slope, none), (none, f), (none, slope)))

    def integral(q: Array) -> Array:
        return (q * (0.5 * weight * r**2)) @ q.T

    around = (2 * U - m * V) / r
    bulk = 2 * nu / (1 - 2 * nu) + 2 / 3  # over G
    stiffness = bulk * integral(dU + around) + integral(2 * dU - around) / 3
    stiffness += m * integral(dV + (U - V) / r) + m * (m - 2) * integral(V / r)
    squared, modes = eigh(stiffness, integral(U) + m * integral(V))
    skin = modes[:SHAPES].sum(axis=0), modes[SHAPES:].sum(axis=0)  # all polynomials are 1 at r = 1
    phi = sqrt(4 * pi / (2 * n + 1)) * (radial * skin[0] + m * polar * skin[1])
    return np.sqrt(np.maximum(squared, 0.0)), phi


def ball_impact(
    E_star: float, E_ball: float, nu: float, radius: float, mass: float, speed: float, window: float = 0.0
) -> HertzImpact:
    """Return the impact of an elastic ball, E_ball = E / (1 - nu^2), on a half-space; E_star is of both.

    The largest force is that of a mean over the share ``window`` of Hertz' contact time.

    Examples
    --------
    >>> mass = 4 / 3 * pi * 0.01**3 * 7850
    >>> slow, plain = ball_impact(2e11, 2e11, 0.3, 0.01, mass, 1e-3), hertz(2e11, 0.01, mass, 1e-3)
    >>> round(slow.force / plain.force, 3), round(slow.duration / plain.duration, 3)
    (1.001, 0.999)
    """
    plain = hertz(E_star, radius, mass, speed)
    a = plain.radius * np.linspace(0.0, 1.3, POINTS)
    force, approach = np.zeros((2, POINTS))
    excess = fitted(ball_excess, nu, a[1:] / radius) / (E_ball * radius)
    force[1:], approach[1:] = local_law(E_star, radius, a[1:], excess)
    omega, phi = ball_modes(nu, plain.radius / radius)
    rho = mass / (4 / 3 * pi * radius**3)
    omega *= sqrt(0.5 * E_ball * (1 - nu) / rho) / radius
    phi /= sqrt(rho * radius**3)
    local = approach - force * float(np.sum((phi / omega) ** 2))
    motion = _bounce(force, local, omega, phi, mass, speed, plain.duration)
    t = np.linspace(0.0, motion.t_max, POINTS)
    z, v, q = np.split(motion(t), [1, 2])
    pushed = np.interp(z[0] - phi @ q[: len(phi)], local, force)
    if window:
        half = 0.5 * window * plain.duration
        before, after = (np.interp(t + shift, t, v[0]) for shift in (-half, half))
        pushed = mass * (before - after) / (2 * half)
    peak = float(pushed.max())
    return HertzImpact(peak, float(z.max()), float(np.interp(peak, force, a)), float(motion.t_max))


def _bounce(
    force: Array, local: Array, omega: Array, phi: Array, mass: float, speed: float, time: float
) -> OdeSolution:
    """Return way, speed, and the modes' q and q' until the ball leaves the barrier.

    ``force`` (k,), N, belongs to the local approach ``local`` (k,), m; ``time``, s, is Hertz'.
    """
    n = len(omega)

    def gap(t: float, y: Array) -> float:
        return float(y[0] - phi @ y[2 : 2 + n])

    def rates(t: float, y: Array) -> Array:
        F = np.interp(gap(t, y), local, force)
        return np.concatenate([[y[1], -F / mass], y[2 + n :], phi * F - omega**2 * y[2 : 2 + n]])

    gap.terminal, gap.direction = True, -1  # type: ignore[attr-defined]
    start = np.zeros(2 + 2 * n)
    start[1] = speed
    small = PRECISE * speed * np.concatenate([[time, 1], np.full(n, time), np.ones(n)]) * 1e-3
    small[2:] *= sqrt(mass)
    solution = solve_ivp(
        rates, (0.0, 2 * time), start, "DOP853", events=gap, rtol=PRECISE, atol=small, dense_output=True
    )
    return solution.sol


STEPS = 4000  # time steps over the contact time
INERTIA = 0.4  # K^2 of a solid sphere


@dataclass(frozen=True, slots=True)
class SphereRebound:
    """Motion after the impact: velocity of the centre and spin R Omega, m/s; ratio mu."""

    centre_t: float
    spin: float
    ratio: float


def oblique_sphere(
    E_star: float, nu: float, radius: float, mass: float, f: float, v_n: float, v_t: float
) -> SphereRebound:
    """Return the rebound of a sphere without spin; v_n, v_t > 0 are approach and slip speeds, m/s."""
    impact = hertz(E_star, radius, mass, v_n)
    row = SpringRow(E_star, tangential_ratio(nu) * E_star, radius, f, 1.001 * impact.radius)
    return _rebound(row, lambda approach: (approach, 0.0), mass, v_n, v_t, impact.duration)


def oblique_ball(
    E_star: float, E_ball: float, nu: float, radius: float, mass: float, f: float, v_n: float, v_t: float
) -> SphereRebound:
    """Return the rebound of a ball of finite size from a half-space; E_ball = E / (1 - nu^2) of the ball.

    The normal force follows `local_law`; the tangential excess compliance of the ball is in series with the
    springs.

    Examples
    --------
    >>> slow, fast = (oblique_ball(2e11, 4e11, 0.23, 2.5e-3, 2.6e-4, 0.1, v, v / 12) for v in (1e-4, 4.0))
    >>> round(slow.centre_t * 1.2e5, 2), round(fast.centre_t * 3, 2)
    (0.75, 0.73)
    """
    impact = hertz(E_star, radius, mass, v_n)
    a = 1.3 * impact.radius * np.linspace(0.0, 1.0, POINTS)[1:]
    force, approach = local_law(E_star, radius, a, fitted(ball_excess, nu, a / radius) / (E_ball * radius))
    depth = (3 * force / (4 * E_star * sqrt(radius))) ** (2 / 3)
    depth, approach = np.array([0.0, *depth]), np.array([0.0, *approach])
    shear = fitted(ball_shear, nu, np.array([a[0], *a]) / radius) / (E_ball * radius)
    row = SpringRow(E_star, tangential_ratio(nu) * E_star, radius, f, 1.1 * impact.radius)

    def contact(at: float) -> tuple[float, float]:
        return float(np.interp(at, approach, depth)), float(np.interp(at, approach, shear))

    return _rebound(row, contact, mass, v_n, v_t, impact.duration)


def _rebound(
    row: SpringRow,
    contact: Callable[[float], tuple[float, float]],
    mass: float,
    v_n: float,
    v_t: float,
    duration: float,
) -> SphereRebound:
    """March in time; ``contact`` gives approach of the springs, m, and shear compliance, m/N."""
    dt, approach, rate, slip, pushed = duration / STEPS, 0.0, v_n, v_t, 0.0
    impulse, shift, moved, T = 0.0, 0.0, 0.0, 0.0
    while True:
        approach += dt * rate
        if approach <= 0.0:
            break
        depth, shear = contact(approach)
        shift += dt * slip
        shift_of_springs = shift - shear * T
        F, T = row.normal(depth), row.slide(depth, shift_of_springs - moved)
        moved = shift_of_springs
        rate -= dt * F / mass
        slip -= dt * T / mass * (1 + 1 / INERTIA)
        impulse += dt * F
        pushed += dt * T
    return SphereRebound(v_t - pushed / mass, pushed / mass / INERTIA, pushed / impulse)
