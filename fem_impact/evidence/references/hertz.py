"""Hertz impact of a sphere on a half-space (Johnson, Contact Mechanics, 1985, 11.4), and on a thin plate."""

from dataclasses import dataclass, field
from math import pi, sqrt

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import beta, ellipe, ellipk

from fem_impact.arrays import Array

# t_c = HALF_SPAN d / v with HALF_SPAN = 2 int_0^1 (1 - s^(5/2))^(-1/2) ds
SPAN = 0.8 * float(beta(0.4, 0.5))
DIRECTIONS = 2000


@dataclass(frozen=True, slots=True)
class HertzImpact:
    """Largest force, N, approach and contact radius, m; duration, s."""

    force: float
    approach: float
    radius: float
    duration: float


def contact_modulus(E: float, nu: float, E_2: float = float("inf"), nu_2: float = 0.0) -> float:
    """Return E*, Pa: 1 / E* = (1 - nu^2) / E + (1 - nu_2^2) / E_2."""
    return 1 / ((1 - nu**2) / E + (1 - nu_2**2) / E_2)


@dataclass(frozen=True, slots=True)
class Ellipse:
    """Contact of principal radii R_1 < R_2 (Johnson, Contact Mechanics, 1985, Eq 4.26 to 4.28).

    Attributes
    ----------
    mean : sqrt(R_1 R_2), m; axes : half-axis along R_2 over that along R_1
    F_1, F_2 : of sqrt(a b) and of the approach over those of a sphere of the mean radius
    """

    mean: float
    axes: float
    F_1: float
    F_2: float

    def half_axes(self, touch: float) -> tuple[float, float]:
        """Return those along R_1 and R_2, m, where the equivalent sphere has the contact radius ``touch``."""
        both = self.F_1 * self.F_2 * touch
        return both / sqrt(self.axes), both * sqrt(self.axes)


def contact_ellipse(R_1: float, R_2: float) -> Ellipse:
    """Return the contact of a surface of principal radii R_1 <= R_2, m, with a plane.

    Examples
    --------
    >>> a, b = contact_ellipse(3.0, 12.2).half_axes(1.0)
    >>> round(a, 2), round(b, 2)
    (0.6, 1.51)
    """
    mean, ratio = sqrt(R_1 * R_2), R_2 / R_1
    if ratio < 1 + 1e-6:
        return Ellipse(mean, 1.0, 1.0, 1.0)

    def parts(axes: float) -> tuple[float, float, float]:
        m = 1 - axes**-2
        return axes**2 * float(ellipe(m)) - float(ellipk(m)), float(ellipk(m) - ellipe(m)), m

    axes = float(brentq(lambda a: parts(a)[0] / parts(a)[1] - ratio, 1 + 1e-9, 2 * ratio))
    over, under, m = parts(axes)
    F_1 = (4 / (pi * m) * axes**-1.5 * sqrt(over * under)) ** (1 / 3)
    return Ellipse(mean, axes, F_1, 2 / pi * axes**-0.5 / F_1 * float(ellipk(m)))


def equivalent_radius(R_1: float, R_2: float) -> float:
    """Return the radius, m, of the sphere as stiff as a surface of principal radii R_1 and R_2.

    The approach of an elliptical contact is that of the mean radius times F_2, so the force at an approach
    is that of a radius larger by F_2^-3.

    Examples
    --------
    >>> round(equivalent_radius(6.0, 6.0), 4), round(equivalent_radius(3.0, 12.2) / (3.0 * 12.2) ** 0.5, 3)
    (6.0, 1.083)
    """
    contact = contact_ellipse(min(R_1, R_2), max(R_1, R_2))
    return float(contact.mean * contact.F_2**-3)


def patch_compliance(nu: float, along: float, across: float) -> tuple[float, float]:
    """Return C_n and C_t of a half-space under Hertz' pressure on an ellipse, E = 1, t along the first axis.

    The mean displacement under the pressure over its force, as an integral of the kernels of Boussinesq and
    Cerruti over the directions of the wave number; on a circle 3 (1 - nu^2) / (5 a) and
    3 (2 - nu) (1 + nu) / (10 a) (Johnson, sections 3.4, 3.6).

    Examples
    --------
    >>> [round(C, 4) for C in patch_compliance(0.3, 1.0, 1.0)]
    [0.546, 0.663]
    """
    phi = np.arange(DIRECTIONS) * 2 * pi / DIRECTIONS
    t, b = np.cos(phi) / along, np.sin(phi) / across
    k = np.hypot(t, b)
    scale = 3 / (10 * along * across) * 2 * (1 + nu)
    normal, shear = (1 - nu) / k, (1 - nu * (t / k) ** 2) / k
    return float(scale * normal.mean()), float(scale * shear.mean())


def hertz(E_star: float, radius: float, mass: float, speed: float) -> HertzImpact:
    """Return the impact of a mass behind a spherical surface.

    Examples
    --------
    >>> from math import pi
    >>> R = 9.5e-3
    >>> steel = hertz(contact_modulus(210e9, .29, 210e9, .29), R, 4 / 3 * pi * R**3 * 7850, 1.0)
    >>> round(steel.force, 1), round(steel.duration * 1e6, 2), round(steel.radius * 1e3, 3)
    (1575.7, 65.82, 0.461)
    """
    stiffness = 4 / 3 * E_star * sqrt(radius)
    approach = (5 * mass * speed**2 / (4 * stiffness)) ** 0.4
    return HertzImpact(stiffness * approach**1.5, approach, sqrt(radius * approach), SPAN * approach / speed)


SPRINGS = 100
MEAN_PRESSURE = 0.6716  # over the largest: 3/4 weighted by itself over the contact, 0.896 over the impulse


def tangential_ratio(nu: float, axes: float = 1.0) -> float:
    """Return G* / E* of two bodies with the same elastic constants, along the first axis of an ellipse.

    ``axes`` is the second half-axis over the first. Stick and slip areas of an ellipse are ellipses of its
    shape (Vermeulen & Johnson 1964, doi:10.1115/1.3629610), so that one ratio holds throughout.

    Examples
    --------
    >>> round(tangential_ratio(0.3), 4) == round(2 * 0.7 / 1.7, 4), round(tangential_ratio(0.3, 2.6), 3)
    (True, 0.858)
    """
    normal, shear = patch_compliance(nu, 1.0, axes)
    return normal / shear


def sliding_ratio(f: float, nu: float, G: float, pressure: float) -> float:
    """Return the impulse ratio of a sliding collision of like bodies with a largest Hertz pressure, Pa.

    The traction f p lowers the skin ahead of the contact and raises it behind (Cerruti: Johnson, Contact
    Mechanics, 1985, Eq 3.75c), in both bodies alike. So the interface, on which friction is f, leans by
    (1 - 2 nu) f p / (4 G), weighted with the pressure, and along the barrier's own directions less is seen.

    Examples
    --------
    >>> round(sliding_ratio(0.5, 0.29, 85e9, 8e9), 4), sliding_ratio(0.5, 0.5, 85e9, 8e9)
    (0.4959, 0.5)
    """
    lean = MEAN_PRESSURE * (1 - 2 * nu) * f * pressure / (4 * G)
    return (f - lean) / (1 + f * lean)


def row_lean(E_star: float, nu: float, G: float, radius: float, ellipse: Ellipse) -> float:
    """Return the slope of a sliding interface over f times the radius of the equivalent round contact, 1/m.

    As in `sliding_ratio`, at each moment; on an ellipse the waves of the traction that run along t, which
    alone lean, have the share b / (a + b) in place of a half, and the largest pressure is 3 F / (2 pi a b).

    Examples
    --------
    >>> E_star, touch = 1.2e11, 0.1  # of the radius: a largest pressure of 7.6 GPa
    >>> slope = 0.896 * 0.5 * touch * row_lean(E_star, 0.29, 85e9, 1.0, Ellipse(1.0, 1.0, 1.0, 1.0))
    >>> round((0.5 - slope) / (1 + 0.5 * slope), 4) == round(sliding_ratio(0.5, 0.29, 85e9, 7.64e9), 4)
    True
    """
    share = ellipse.axes / (1 + ellipse.axes)
    largest = 2 * E_star / (pi * radius * (ellipse.F_1 * ellipse.F_2) ** 2)
    return 0.75 * (1 - 2 * nu) / (2 * G) * share * largest


@dataclass(slots=True)
class SpringRow:
    """Normal and tangential force of one contact, moved in small increments.

    Attributes
    ----------
    E_star, G_star : Pa; radius : m; friction : Coulomb's coefficient
    reach : largest contact radius to come, m
    lean : slope of the interface over friction times contact radius, 1/m (`sliding_ratio`, `row_lean`)
    """

    E_star: float
    G_star: float
    radius: float
    friction: float
    reach: float
    lean: float = 0.0
    profile: Array = field(init=False)
    width: Array = field(init=False)
    shift: Array = field(init=False)

    def __post_init__(self) -> None:
        # even steps of area: the outer springs, where slip begins, lie closer together
        edges = self.reach * np.sqrt(np.linspace(0.0, 1.0, SPRINGS + 1))
        middle = 0.5 * (edges[1:] + edges[:-1])
        self.profile = middle**2 / self.radius
        self.width = 2 * np.diff(edges)
        self.shift = np.zeros(SPRINGS)

    def normal(self, depth: float) -> float:
        """Return the normal force, N, at an approach, m: Hertz', by the springs that also carry friction."""
        return float(self.E_star * (self.width @ np.maximum(depth - self.profile, 0.0)))

    def stiffness(self, depth: float) -> float:
        """Return the slope of the normal force, N/m."""
        return float(self.E_star * self.width[self.profile < depth].sum())

    def grip(self, depth: float) -> float:
        """Return the slope of the tangential force, N/m: that of the springs that stick."""
        sticks = abs(self.shift) < self._limit(depth)
        return float(self.G_star * self.width[sticks].sum())

    def slide(self, depth: float, step: float) -> float:
        """Move the contact tangentially by ``step``, m; return the force against it, N."""
        limit = self._limit(depth)
        self.shift = np.clip(self.shift + step, -limit, limit)
        return float(self.G_star * (self.width @ self.shift))

    def _limit(self, depth: float) -> Array:
        """Return how far each spring can be shifted before it slides, m."""
        lean = self.lean * self.friction * sqrt(self.radius * max(depth, 0.0))
        ratio = (self.friction - lean) / (1 + self.friction * lean)
        return ratio * self.E_star / self.G_star * np.maximum(depth - self.profile, 0.0)


# mean pressure of a fully plastic contact over yield stress, the E* a / (Y R) from which it has stopped
# rising (Johnson, Contact Mechanics, 1985, section 6.3), and the a / R up to which the contact is small
MEAN, FULL, SMALL = 2.8, 40.0, 0.2


def plastic_radius(yield_stress: float, radius: float, mass: float, speed: float) -> float:
    """Return the contact radius, m, at which a constant mean pressure of 2.8 Y has stopped a sphere."""
    return float((2 * mass * speed**2 * radius / (pi * MEAN * yield_stress)) ** 0.25)


def plastic_speeds(yield_stress: float, E_star: float, radius: float, mass: float) -> tuple[float, float]:
    """Return the speeds, m/s, from which the contact is fully plastic and up to which it is small.

    Examples
    --------
    >>> from math import pi
    >>> [round(v, 2) for v in plastic_speeds(546e6, 239e9, 9.5e-3, 4 / 3 * pi * 9.5e-3**3 * 7850)]
    [2.26, 10.81]
    """
    unit = plastic_radius(yield_stress, radius, mass, 1.0)  # goes as the root of the speed
    return (FULL * yield_stress * radius / (E_star * unit)) ** 2, (SMALL * radius / unit) ** 2


def yield_speed(limit: float, E_star: float, radius: float, mass: float) -> float:
    """Return the speed, m/s, at which the peak pressure reaches the limiting contact pressure, Pa."""
    return float((pi / (2 * E_star)) ** 2 * sqrt(8 * pi * radius**3 / (15 * mass)) * limit**2.5)


def thornton_restitution(speed: float, yields_at: float) -> float:
    """Return e at a speed, given the speed of first yield; 1 below it.

    Examples
    --------
    >>> round(thornton_restitution(100.0, 1.0) / thornton_restitution(1600.0, 1.0), 2)
    2.0
    """
    if speed <= yields_at:
        return 1.0
    y = yields_at / speed
    losses = (y / (y + 2 * sqrt(6 / 5 - y**2 / 5))) ** 0.25
    return float(sqrt(6 * sqrt(3) / 5) * sqrt(1 - y**2 / 6) * losses)


def fitted_restitution(speed: float, first_yield: float) -> float:
    """Return e of finite-element runs of elastic, perfectly plastic spheres, 2.08 (v_y / v)^(1/4).

    v_y is the speed of first yield, peak pressure 1.6 times the yield stress; the fit holds for contacts that
    are fully plastic and small. From memory it is that of Wu, Li & Thornton (Rebound behaviour of spheres for
    plastic impacts, Int. J. Impact Eng. 28, 929-946, 2003); neither the paper nor a list that cites it was at
    hand, so nothing is judged by it.

    Examples
    --------
    >>> fitted_restitution(81.0, 1.0) / fitted_restitution(1296.0, 1.0)
    2.0
    """
    return float(min(1.0, 2.08 * (first_yield / speed) ** 0.25))


@dataclass(frozen=True, slots=True)
class PlateImpact:
    """Restitution of the striker, contact time over T, largest force over k (v T)^1.5."""

    restitution: float
    duration: float
    peak: float


def zener_impact(inelasticity: float) -> PlateImpact:
    """Return the elastic impact on an infinite thin plate, for Zener's lambda.

    With the approach s over v T, time over T and T = (m / (k sqrt(v)))^(2/5),

        s'' + (1 + lambda d/dt) s^1.5 = 0,    s(0) = 0,  s'(0) = 1,

    where lambda = m / (Z T) and Z = 8 sqrt(D rho h) is the impedance of the plate (Zener 1941,
    doi:10.1103/PhysRev.59.669, form from memory and derived anew; an open derivation: Mathematics 2021, 9,
    2222). The equation is integrated as that of the striker, u' = -s^1.5, whose point on the plate moves at
    lambda s^1.5, so s' = u - lambda s^1.5; e is -u when s = 0 again.

    Examples
    --------
    >>> hit = zener_impact(0.2)
    >>> f"{hit.restitution:.4f} {hit.duration:.3f} {hit.peak:.3f}"
    '0.7140 3.349 0.946'
    """

    def rates(t: float, y: Array) -> Array:
        s, u = y  # u: velocity of the striker towards the plate
        force = max(s, 0.0) ** 1.5
        return np.array([u - inelasticity * force, -force])

    def left(t: float, y: Array) -> float:
        return float(y[0]) if t > 0.1 else 1.0

    left.terminal, left.direction = True, -1.0  # type: ignore[attr-defined]
    solved = solve_ivp(rates, (0.0, 1e3), [0.0, 1.0], events=left, rtol=1e-10, atol=1e-13, max_step=0.01)
    return PlateImpact(-float(solved.y[1, -1]), float(solved.t[-1]), float(solved.y[0].max()) ** 1.5)
