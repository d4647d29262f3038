"""Axial impact of a rod on a barrier: one-dimensional waves, and the compliance of its round end.

`strike` is the exact impact of a bar with a flat end on a rigid wall. `rod_impact` joins the bar to a contact
law of its end (Sears' delay equation): Hertz' in `sears`, that of the round end of a narrow rod by `end_law`.

Behind its nose a rod is only as wide as its section, unlike Hertz' half-space. The nose, a paraboloid, is
solved as an axisymmetric static problem (quadratic quadrilaterals, graded towards the pole) under Hertz'
pressure on a circle of radius a, fixed at a section some radii behind. The compression of a one-dimensional
bar that has a flat end and the same volume is subtracted. The mean approach under the pressure over the force
is then

    C(a) = 3 / (5 E* a) + chi / (E_1* R),    E_1* = E_1 / (1 - nu_1^2),    R radius of the rod.

Inertia of the nose is neglected, a share of about R / (c0 t_c) of the force.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import ceil, log2, pi, sqrt

import numpy as np
import skfem
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, div, sym_grad

from fem_impact.arrays import Array
from fem_impact.evidence.references.finite_sphere import POINTS, local_law

SMALLEST, RADII = 1 / 128, 7  # contact radii over R: the smallest, and how many, each twice the last
PER_OCTAVE, CORE = 4, 8  # cells per octave of radius, and over the smallest radius
BEHIND = 3.0  # radii of rod behind the nose: the stress of a loaded end decays like exp(-2.7 z / R)
ORDER = 24  # of the quadrature of the pressure, which ends like a square root
FOLLOWED = 1.3  # durations of a bar's contact after which its rebound is read
STEPS = 4000  # time steps per round trip of the wave through the rod


@dataclass(frozen=True, slots=True)
class AxialImpact:
    """Largest force, N; contact time, s; vibration share of E_0."""

    force: float
    duration: float
    vibration: float


@dataclass(frozen=True, slots=True)
class BarImpact:
    """Plateau of the wall force, N; duration, s; the restitution is 1 and no vibration is left."""

    force: float
    duration: float


def _graded(length: float) -> Array:
    """Return coordinates from 0 to ``length``, even up to the smallest contact radius, then geometric."""
    count = round(log2(length / SMALLEST) * PER_OCTAVE)
    far = SMALLEST * (length / SMALLEST) ** np.linspace(0.0, 1.0, count + 1)
    return np.concatenate([np.linspace(0.0, SMALLEST, CORE + 1)[:-1], far])


def _nose(tip: float) -> skfem.MeshQuad:
    """Return the meridian plane (r, z) of a rod of radius 1 behind z = r^2 / (2 tip)."""
    end = 1 / (2 * tip) + BEHIND
    mesh = skfem.MeshQuad.init_tensor(_graded(1.0), _graded(end))
    r, s = mesh.p
    return skfem.MeshQuad(np.stack([r, r**2 / (2 * tip) * (1 - s / end) + s]), mesh.t)


def _stiffness(basis: skfem.CellBasis, nu: float) -> csr_matrix:
    """Return the axisymmetric stiffness with E = 1."""
    two_G, lame = 1 / (1 + nu), nu / ((1 + nu) * (1 - 2 * nu))

    @skfem.BilinearForm
    def form(u, v, w):  # type: ignore[no-untyped-def]
        r = w.x[0]
        swell_u, swell_v = (div(y) + y[0] / r for y in (u, v))
        shear = ddot(sym_grad(u), sym_grad(v)) + u[0] * v[0] / r**2
        return 2 * np.pi * r * (two_G * shear + lame * swell_u * swell_v)

    matrix: csr_matrix = form.assemble(basis)
    return matrix


def _pressure(basis: skfem.FacetBasis, a: float) -> Array:
    """Return the load along z, a unit force in all, of Hertz' pressure on a flattened cap of radius ``a``."""

    @skfem.LinearForm
    def form(v, w):  # type: ignore[no-untyped-def]
        r = w.x[0]
        # 2 pi r p over -n_z dA, the area seen along the axis
        return -3 * r / a**2 * np.sqrt(np.maximum(1 - (r / a) ** 2, 0.0)) * w.n[1] * v[1]

    load: Array = form.assemble(basis)
    return load


def _compliances(nu: float, tip: float, radii: Array) -> Array:
    """Return the approach for a unit force on circles of ``radii`` (k,), beyond the bar's; E = R = 1."""
    mesh, element = _nose(tip), skfem.ElementVector(skfem.ElementQuad2())
    far = float(mesh.p[1].max())
    front = mesh.facets_satisfying(
        lambda x: (0 < x[0]) & (x[0] < 1 - 1e-9) & (x[1] < far - 1e-9), boundaries_only=True
    )
    body = skfem.Basis(mesh, element)
    skin = skfem.FacetBasis(mesh, element, facets=front, intorder=ORDER)
    axis = body.get_dofs(lambda x: np.isclose(x[0], 0.0)).all(["u^1"])
    back = body.get_dofs(lambda x: np.isclose(x[1], far)).all(["u^2"])
    free = body.complement_dofs(np.concatenate([axis, back]))
    solve = splu(_stiffness(body, nu)[free][:, free].tocsc()).solve
    loads = [_pressure(skin, a)[free] for a in radii]
    bar = (far - 1 / (4 * tip)) / pi
    return np.array([load @ solve(load) - bar for load in loads])


@cache
def _excess_series(nu: float, tip: float) -> Array:
    """Return chi as a polynomial (6,) of the logarithm of a / R for a tip radius over R."""
    radii: Array = SMALLEST * np.exp2(np.arange(float(RADII)))
    chi = _compliances(nu, tip, radii) / (1 - nu**2) - 3 / (5 * radii)
    return np.polyfit(np.log(radii), chi, 5)


def end_excess(a: Array, nu: float, tip: float) -> Array:
    """Return chi at contact radii ``a`` (k,) for a radius of the tip at its pole, both over the rod's radius.

    Examples
    --------
    >>> end_excess(np.array([0.1]), 0.29, 0.75).round(2)
    array([-0.48])
    """
    return np.asarray(np.polyval(_excess_series(nu, tip), np.log(a)))


def end_law(
    E_star: float, E_rod: float, nu: float, radius: float, tip_radius: float, largest: float
) -> tuple[Array, Array]:
    """Return force, N, and approach beyond the bar's, m, (k,), up to a contact radius ``largest``, m.

    ``E_rod`` is E / (1 - nu^2) of the rod, ``E_star`` that of both bodies; the barrier is a half-space.
    """
    a = largest * np.linspace(0.0, 1.0, POINTS)[1:]
    excess = end_excess(a / radius, nu, tip_radius / radius) / (E_rod * radius)
    force, approach = local_law(E_star, tip_radius, a, excess)
    return np.array([0.0, *force]), np.array([0.0, *approach])


def _history(law: Callable[[float], float], impedance: float, speed: float, dt: float, delay: int) -> Array:
    """Return the contact force (n,), N, at times k dt until the end separates, by Heun's method."""
    force, d = [0.0], 0.0
    while True:
        k = len(force)
        past = [sum(force[j - n * delay] for n in range(1, j // delay + 1)) for j in (k - 1, k)]
        first = speed - (force[-1] + 2 * past[0]) / impedance
        guess = law(max(d + dt * first, 0.0))
        second = speed - (guess + 2 * past[1]) / impedance
        d += 0.5 * dt * (first + second)
        if d <= 0.0:
            return np.array([*force, 0.0])
        force.append(law(d))


def rod_impact(
    E: float, rho: float, length: float, radius: float, law: Callable[[float], float], speed: float
) -> AxialImpact:
    """Return the impact of a rod whose end pushes with the force ``law`` (m to N) of its approach."""
    c0, area = bar_speed(E, rho), pi * radius**2
    dt = 2 * length / c0 / STEPS
    F = _history(law, rho * c0 * area, speed, dt, STEPS)
    rebound = float(F.sum()) * dt / (rho * area * length) - speed
    return AxialImpact(float(F.max()), dt * (len(F) - 1), 1 - (rebound / speed) ** 2)


def sears(
    E: float, rho: float, length: float, radius: float, E_star: float, tip_radius: float, speed: float
) -> AxialImpact:
    """Return the impact of a rod (length, radius in m) with a tip of ``tip_radius`` by Hertz' law.

    Examples
    --------
    >>> rod = sears(219e9, 7850.0, 0.24, 9.5e-3, 115.9e9, 7e-3, 2.0)
    >>> round(rod.force, -1), round(rod.duration * 1e6), round(rod.vibration, 4)
    (17780.0, 219, 0.0024)
    """
    k = 4 / 3 * E_star * sqrt(tip_radius)
    return rod_impact(E, rho, length, radius, lambda d: k * d**1.5, speed)


def bar_speed(E: float, rho: float) -> float:
    """Return c0 = sqrt(E / rho), m/s."""
    return sqrt(E / rho)


def strike(E: float, rho: float, area: float, length: float, speed: float) -> BarImpact:
    """Return the impact of a flat bar: force rho c0 A v during 2 L / c0, after which it is free of stress.

    Examples
    --------
    >>> from math import pi
    >>> bar = strike(219e9, 7850.0, pi * 0.0095**2, 0.24, 2.0)
    >>> round(bar.force), round(bar.duration * 1e6, 2)
    (23512, 90.88)
    """
    c0 = bar_speed(E, rho)
    return BarImpact(rho * c0 * area * speed, 2 * length / c0)


def chain_restitution(links: int, step: float) -> float:
    """Return the restitution of a chain of equal masses, half ones at its ends, and springs between them.

    Central differences with ``step`` over a link's length over c0; a mass that would pass the wall in a step
    stops there. The end stops dead, and the front of the wave, which lags over links^(1/3) of them (an Airy
    function), leaves links^(-2/3) of the energy ringing.

    Examples
    --------
    >>> [round(chain_restitution(n, 0.9), 4) for n in (50, 400)]
    [0.9866, 0.9969]
    """
    mass = np.ones(links + 1)
    mass[[0, -1]] = 0.5
    # displacements over that of a step of free flight, velocities over the approach
    u, v = np.zeros(links + 1), np.full(links + 1, -1.0)
    for _ in range(ceil(FOLLOWED * 2 * links / step)):
        stretch = np.diff(u)
        v[:-1] += step**2 * stretch / mass[:-1]
        v[1:] -= step**2 * stretch / mass[1:]
        if u[0] + v[0] < 0.0:
            v[0] = max(v[0], -max(u[0], 0.0))
        u += v
    return float(mass @ v / mass.sum())
