"""Closed-form size of a contact before it is computed: for mesh zones and for the choice of effects.

Local contact of principal radii R1 (meridian) and R2 (around the rod) under the effective mass m*,

    1/m* = (1 + d_c (d_c - f d_d) / k^2) / m      (frictional impulse along one direction)

at the approach v_n of the contact point either Hertzian, 8/15 E* sqrt(R) d^(5/2) = m* v_n^2 / 2, or fully
plastic with the limiting pressure p = 2.8 sigma_y of the softer body, pi p R d^2 = m* v_n^2 / 2 (Thornton
1997, doi:10.1115/1.2787319; Johnson, Contact Mechanics, 1985), R = sqrt(R1 R2). Where the tip is wider at the
depth d than R1 says, as behind a sharp edge, R1 is that of the parabola as wide there, w^2 / (8 d).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi, sin, sqrt
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from fem_impact.arrays import Array
    from fem_impact.scene.material import Material
    from fem_impact.scene.projectile import ProjectileSpec
    from fem_impact.scene.types import Scene
    from rigid import Body, Projectile


LIMIT_PRESSURE = 2.8  # mean pressure of a fully plastic indentation over the yield stress
SECTION = 1.8412  # first zero of J1': cut-off k R of shear modes within the round section
FLAT = 2.0  # depths, within which a face or a flank lies flat on the barrier
ROUNDS = 12  # of depth and width, each of which moves the depth a quarter of the last
FLATTEST = 0.2  # m, upper limit of R2, which is infinite for a contact on a flat face


@dataclass(frozen=True, slots=True)
class ContactBodies:
    """Rod and barrier at the contact: a scene, and which of its properties the effects in force use.

    Attributes
    ----------
    rod_yields, barrier_yields : whether the material may yield
    compliant : whether the barrier deforms
    f : Coulomb coefficient in force, 0 without friction
    """

    scene: Scene
    rod_yields: bool
    barrier_yields: bool
    compliant: bool
    f: float

    @property
    def yielding(self) -> list[Material]:
        """Return the materials that may yield and have a yield stress."""
        rod, barrier = self.scene.projectile.material, self.scene.barrier.struck
        return [m for m in [rod] * self.rod_yields + [barrier] * self.barrier_yields if m.yields]

    @property
    def elastic(self) -> list[Material]:
        """Return the materials that deform: a rigid barrier has no share in the contact's compliance."""
        return [self.scene.projectile.material] + [self.scene.barrier.struck] * self.compliant


@dataclass(frozen=True, slots=True)
class ContactEstimate:
    """Depth d and semi-axes a_t, a_b of the contact ellipse, m; duration, s; mean pressure, Pa.

    R1, R2, m, are the radii of the round surface that is as wide as the tip at this depth, and ``wider`` is
    its R1 over that of the tip where it touches first. Its middle lies ``shift``, m, down the slope from it.
    """

    depth: float
    a_t: float
    a_b: float
    duration: float
    pressure: float
    R1: float
    R2: float
    shift: float = 0.0
    wider: float = 1.0


def principal_radii(scene: Scene) -> tuple[float, float]:
    """Return (R1, R2), m, of the tip at its lowest point."""
    from rigid import Faceted

    rod, alpha = projectile(scene), scene.impact.angle
    rho, _ = rod.contact_point(alpha)
    R1 = rod.tip_curvature(alpha) or rod.diameter / 200
    if isinstance(rod, Faceted):
        return R1, min(max(rod.curvature_around(alpha), R1), FLATTEST)
    at_pole = FLATTEST if rod.face > 0 else R1
    around = float(rho) / sin(alpha) if alpha > 0 else at_pole
    return R1, min(max(around, R1), FLATTEST)


def projectile(scene: Scene) -> Body:
    """Return the rigid projectile of a scene."""
    rod = scene.projectile
    return plain_rod(rod) if rod.is_rod else rod.body()


def plain_rod(rod: ProjectileSpec) -> Projectile:
    """Return the rigid rod of one material with one of the tips."""
    from rigid import Projectile

    return Projectile(rod.length, rod.diameter, rod.tip, rod.tip_radius, rod.material.rho)


def arms(scene: Scene) -> tuple[float, float]:
    """Return (d_c, d_d), m; an upright rod strikes with its whole face, so d_c is 0."""
    d_c, d_d = projectile(scene).arms(scene.impact.angle)
    return float(d_c) if scene.impact.angle > 0 else 0.0, float(d_d)


def touch_point(scene: Scene) -> tuple[float, float]:
    """Return (rho, z), m, of the contact in the rod; that of a whole face is its centre."""
    rho, z = projectile(scene).contact_point(scene.impact.angle)
    return float(rho) if scene.impact.angle > 0 else 0.0, float(z)


def lands_flat(scene: Scene) -> bool:
    """Say whether a flat face touches all at once: estimates and laws of a round contact do not hold then."""
    return scene.impact.angle == 0 and projectile(scene).face > 0


def approach(scene: Scene) -> float:
    """Return the speed, m/s, at which the contact point comes towards the barrier, spin included."""
    return -scene.relative.v_n - arms(scene)[0] * scene.impact.omega


def sliding(scene: Scene) -> float:
    """Return the velocity, m/s, of the contact point up the slope before the impact, spin included."""
    return scene.relative.v_t - arms(scene)[1] * scene.impact.omega


def fall(gravity: float | None, time: float, intervals: Array) -> float:
    """Return the speed, m/s, that gravity, m/s2, gave the rod while it touched and after that.

    Parameters
    ----------
    time : s since first contact at which the rod's motion is taken
    intervals : (k, 2) start and end of each contact, s; speed gained in flights between them is not included
    """
    return (gravity or 0.0) * (time - between(intervals))


def between(intervals: Array) -> float:
    """Return the time of flight between contacts whose start and end, s, are the rows of (k, 2)."""
    return float((intervals[1:, 0] - intervals[:-1, 1]).sum())


def pressure_speed(steel: Material) -> float:
    """Return the speed of pressure waves in an unbounded body of a material, m/s."""
    return sqrt(steel.E * (1 - steel.nu) / ((1 + steel.nu) * (1 - 2 * steel.nu) * steel.rho))


def shear_speed(scene: Scene) -> float:
    """Return the speed of shear waves in the rod, m/s."""
    steel = scene.projectile.material
    return sqrt(steel.E / (2 * (1 + steel.nu) * steel.rho))


def section_frequency(scene: Scene) -> float:
    """Return the circular frequency, rad/s, above which the rod's modes deform the section.

    Such modes are local; their compliance under a point load is part of the contact law.
    """
    return SECTION * shear_speed(scene) / (scene.projectile.diameter / 2)


def reduced(scene: Scene) -> tuple[float, float]:
    """Return mass, kg, and k^2, m2, of the relative motion of rod and barrier.

    A free barrier of mass M that does not turn leaves the relative motion of mass centre and barrier the same
    equations, with m M / (m + M) for m and unchanged m k^2.
    """
    rod, M = projectile(scene), scene.barrier.mass
    share = 1.0 if M is None else 1 / (1 + rod.mass / M)
    return rod.mass * share, rod.k2 / share


def effective_mass(bodies: ContactBodies) -> float:
    """Return m*, kg, at least that of a frictionless contact."""
    (mass, k2), (d_c, d_d) = reduced(bodies.scene), arms(bodies.scene)
    barrier, frictionless = bodies.scene.barrier, 1 + d_c**2 / k2
    turning = mass * barrier.centre_offset**2 / barrier.inertia if barrier.inertia else 0.0
    return float(mass / (min(frictionless, max(1.0, 1 + d_c * (d_c - bodies.f * d_d) / k2)) + turning))


def start_energy(scene: Scene) -> float:
    """Return E_0, J."""
    rod, impact = projectile(scene), scene.relative
    return float(0.5 * rod.mass * (impact.v_n**2 + impact.v_t**2 + rod.k2 * impact.omega**2))


def normal_share(bodies: ContactBodies) -> float:
    """Return the share of E_0 that the normal impact can take, m* / 2 times the approach squared over E_0."""
    return 0.5 * effective_mass(bodies) * approach(bodies.scene) ** 2 / start_energy(bodies.scene)


def contact_modulus(bodies: ContactBodies) -> float:
    """Return E*, Pa."""
    return 1 / sum((1 - m.nu**2) / m.E for m in bodies.elastic)


class _Blow(NamedTuple):
    """What presses a tip in: energy, J, speed, m/s, E*, Pa, and the limiting pressure, Pa."""

    energy: float
    speed: float
    E_star: float
    limit: float


def contact_estimate(bodies: ContactBodies) -> ContactEstimate:
    """Return the size of the first contact."""
    blow, (R1, R2) = _blow(bodies), principal_radii(bodies.scene)
    size = as_round = _pressed_in(blow, R1, R2)
    body, alpha = projectile(bodies.scene), bodies.scene.impact.angle
    for _ in range(ROUNDS):
        down, up = body.reaches(alpha, size.depth)
        wide = (down + up) ** 2 / (8 * size.depth)
        if wide <= R1:
            break
        size = _pressed_in(blow, wide, max(R2, wide))
        size = replace(size, shift=max(0.0, 0.5 * (down - up)), wider=wide / R1)
    # of a face nearly flat all may touch, whatever the depth
    return as_round if body.face > 0 and nearly_flat(bodies.scene, size.depth) else size


def round_contact(bodies: ContactBodies) -> ContactEstimate:
    """Return the size of the first contact of a tip that is round everywhere as where it touches first."""
    return _pressed_in(_blow(bodies), *principal_radii(bodies.scene))


def _blow(bodies: ContactBodies) -> _Blow:
    speed = max(approach(bodies.scene), 1e-6)
    limit = LIMIT_PRESSURE * min((m.yield_stress for m in bodies.yielding), default=inf)
    return _Blow(0.5 * effective_mass(bodies) * speed**2, speed, contact_modulus(bodies), limit)


def _pressed_in(blow: _Blow, R1: float, R2: float) -> ContactEstimate:
    """Return the size of the contact of a tip of radii ``R1`` and ``R2``, m."""
    R = sqrt(R1 * R2)
    depth = (blow.energy / (8 / 15 * blow.E_star * sqrt(R))) ** 0.4
    pressure = 4 / (3 * pi) * blow.E_star * sqrt(depth / R)
    if pressure <= blow.limit:
        duration = 2.94 * depth / blow.speed
        return ContactEstimate(depth, sqrt(R1 * depth), sqrt(R2 * depth), duration, pressure, R1, R2)
    depth = sqrt(blow.energy / (pi * blow.limit * R))
    duration = 0.5 * pi * depth / blow.speed * 1.3
    return ContactEstimate(depth, sqrt(2 * R1 * depth), sqrt(2 * R2 * depth), duration, blow.limit, R1, R2)


def nearly_flat(scene: Scene, depth: float) -> bool:
    """Return whether the middle of the face stands so low that all of it may touch at a depth, m."""
    rho, _ = projectile(scene).contact_point(scene.impact.angle)
    return float(rho) * sin(scene.impact.angle) <= FLAT * depth


def barrier_conforms(bodies: ContactBodies) -> bool:
    """Return whether the barrier yields under the whole contact, so that it takes the rod's shape."""
    flows = contact_estimate(bodies).pressure >= LIMIT_PRESSURE * bodies.scene.barrier.struck.yield_stress
    return flows and bodies.barrier_yields
