"""Closed-form size of a contact before it is computed: for mesh zones and for the choice of effects.

Local contact of principal radii R1 (meridian) and R2 (around the rod) under the effective mass m*,

    1/m* = (1 + d_c (d_c - f d_d) / k^2) / m      (frictional impulse along one direction)

at the approach v_n of the contact point either Hertzian, 8/15 E* sqrt(R) d^(5/2) = m* v_n^2 / 2, or fully
plastic with the limiting pressure p = 2.8 sigma_y of the softer body, pi p R d^2 = m* v_n^2 / 2 (Thornton
1997, doi:10.1115/1.2787319; Johnson, Contact Mechanics, 1985), R = sqrt(R1 R2). Where the tip is wider at the
depth d than R1 says, as behind a sharp edge, R1 is that of the parabola as wide there, w^2 / (8 d).
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import copysign, cos, inf, pi, sin, sqrt
from typing import NamedTuple

from fem_impact.arrays import Array
from fem_impact.scene.material import Material
from rigid import Body, Faceted, Touch, sliding_path, touch_arms

LIMIT_PRESSURE = 2.8  # mean pressure of a fully plastic indentation over the yield stress
SECTION = 1.8412  # first zero of J1': cut-off k R of shear modes within the round section
ON_SIDE = 0.25 * pi  # stiffness of a lying cylinder over E* times its length (Popov 2010)
FLAT = 2.0  # depths, within which a face or a flank lies flat on the barrier
ROUNDS = 12  # of depth and width, each of which moves the depth a quarter of the last
FLATTEST = 0.2 / 0.019  # diameters, upper limit of R2, which is infinite for a contact on a flat face


class Plate(NamedTuple):
    """A barrier that bends: Pa, -, kg/m3, and its thickness, m."""

    E: float
    nu: float
    rho: float
    thickness: float


@dataclass(frozen=True, slots=True)
class ContactEstimate:
    """Depth d and semi-axes a_t, a_b of the contact ellipse, m; duration, s; mean pressure, Pa.

    R1, R2, m, are the radii of the round surface that is as wide as the tip at this depth, and ``wider`` is
    its R1 over that of the tip where it touches first. Its middle lies ``shift``, m, down the slope from it,
    below 0 up the slope.
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

    @property
    def radius(self) -> float:
        """The radius, m, of the circle as large as the contact: the geometric mean of its semi-axes."""
        return sqrt(self.a_t * self.a_b)


@dataclass(frozen=True, eq=False)
class ContactPair:
    """Projectile and barrier at their first contact, in numbers, and which of their properties are in force.

    What follows from these numbers is worked out when it is first asked for, and kept.

    Attributes
    ----------
    body : the rigid projectile; angle : of its axis to the barrier's normal, rad
    v_n, v_t, omega : velocities of its mass centre, m/s, and its spin, rad/s, as seen from the barrier
    rod, barrier : materials that touch
    rod_yields, barrier_yields : whether the material may yield
    compliant : whether the barrier deforms
    f : Coulomb coefficient in force, 0 without friction
    barrier_mass, barrier_inertia : of a free barrier, kg, kg m2; None of one that does not move or turn
    centre_offset : of the barrier's mass centre from the struck point along t, m
    plate : the barrier, if it bends
    spans : whether the contact of a body of facets is as large as the body where it is pressed in
    """

    body: Body
    angle: float
    v_n: float
    v_t: float
    omega: float
    rod: Material
    barrier: Material
    rod_yields: bool
    barrier_yields: bool
    compliant: bool
    f: float
    barrier_mass: float | None = None
    barrier_inertia: float | None = None
    centre_offset: float = 0.0
    plate: Plate | None = None
    spans: bool = False

    @cached_property
    def elastic(self) -> "ContactPair":
        """The same bodies, none of which yields."""
        return replace(self, rod_yields=False, barrier_yields=False)

    @property
    def yielding(self) -> list[Material]:
        """The materials that may yield and have a yield stress."""
        both = [self.rod] * self.rod_yields + [self.barrier] * self.barrier_yields
        return [metal for metal in both if metal.yields]

    @property
    def softer(self) -> Material | None:
        """The material that yields first, None where nothing may yield."""
        return min(self.yielding, key=lambda metal: metal.yield_stress, default=None)

    @property
    def deforming(self) -> list[Material]:
        """The materials that deform: a rigid barrier has no share in the contact's compliance."""
        return [self.rod] + [self.barrier] * self.compliant

    @property
    def loss_factor(self) -> float:
        """Loss factor of the contact: those of the materials by their shares of its compliance."""
        soft = [(metal, (1 - metal.nu**2) / metal.E) for metal in self.deforming]
        return sum((metal.loss_factor or 0.0) * part for metal, part in soft) / sum(part for _, part in soft)

    @cached_property
    def touch(self) -> Touch:
        """What touches first of the rod in the plane of motion: a point, or a straight part by its middle."""
        return self.body.touch(self.angle)

    @cached_property
    def arms(self) -> tuple[float, float]:
        """(d_c, d_d), m, of the middle of what touches first."""
        d_c, d_d = touch_arms(self.touch, self.body.x_c, self.body.z_c, self.angle)
        return float(d_c), float(d_d)

    @property
    def touch_point(self) -> tuple[float, float]:
        """(x, z), m, of the contact in the rod; that of a whole face or side is its middle."""
        return self.touch.x, self.touch.z

    @property
    def lands_flat(self) -> bool:
        """Whether a flat face or a straight side touches all at once: no law of a round contact holds."""
        return self.touch.length > 0

    @property
    def side(self) -> float:
        """1 where the side x > 0 of the rod comes down first, -1 where the other one does."""
        return -1.0 if self.angle < 0 else 1.0

    @property
    def approach(self) -> float:
        """The speed, m/s, at which the contact point comes towards the barrier, spin included."""
        return -self.v_n - self.arms[0] * self.omega

    @property
    def sliding(self) -> float:
        """The velocity, m/s, of the contact point up the slope before the impact, spin included."""
        return self.v_t - self.arms[1] * self.omega

    @cached_property
    def most_sliding(self) -> float:
        """The largest speed, m/s, at which the contact point slides in a rigid impact that loses nothing.

        That is when it touches or when it leaves, with friction or without: the normal force turns a leaning
        rod, so that its tip slides even where it did not at first touch.
        """
        (d_c, d_d), (_, k2), fs = self.arms, self.reduced, [0.0, self.f]
        left = sliding_path(self.v_n, self.v_t, omega=self.omega, e=1.0, f=fs, d_c=d_c, d_d=d_d, k2=k2).motion
        return float(max(abs(self.sliding), *abs(left.V_t - d_d * left.Omega)))

    @cached_property
    def principal_radii(self) -> tuple[float, float]:
        """(R1, R2), m, of the tip at its lowest point."""
        R1 = self.body.tip_curvature(self.angle) or self.body.diameter / 200
        flattest = FLATTEST * self.body.diameter
        if isinstance(self.body, Faceted):
            return R1, min(max(self.body.curvature_around(self.angle), R1), flattest)
        x, _ = self.body.contact_point(self.angle)
        at_pole = flattest if self.body.face > 0 else R1
        around = float(x) / sin(self.angle) if self.angle else at_pole
        # a straight side is round about the rod's axis, whatever the radius of the edge at its end
        return R1, min(around if self.lands_flat and self.angle else max(around, R1), flattest)

    @property
    def reduced(self) -> tuple[float, float]:
        """Mass, kg, and k^2, m2, of the relative motion of rod and barrier.

        A free barrier of mass M that does not turn leaves the relative motion of mass centre and barrier the
        same equations, with m M / (m + M) for m and unchanged m k^2.
        """
        share = 1.0 if self.barrier_mass is None else 1 / (1 + self.body.mass / self.barrier_mass)
        return self.body.mass * share, self.body.k2 / share

    @cached_property
    def effective_mass(self) -> float:
        """m*, kg, at least that of a frictionless contact."""
        (mass, k2), (d_c, d_d) = self.reduced, self.arms
        frictionless = 1 + d_c**2 / k2
        mu = copysign(self.f, -self.sliding or d_c)  # friction acts against the sliding
        turning = mass * self.centre_offset**2 / self.barrier_inertia if self.barrier_inertia else 0.0
        return float(mass / (min(frictionless, max(1.0, 1 + d_c * (d_c - mu * d_d) / k2)) + turning))

    @property
    def modulus(self) -> float:
        """E*, Pa."""
        return 1 / sum((1 - metal.nu**2) / metal.E for metal in self.deforming)

    @property
    def shear_stiffness(self) -> float:
        """8 G*, Pa, 1/G* = sum of (2 - nu)/G: no slip under a constant normal force (Mindlin 1949)."""
        return 8 / sum((2 - metal.nu) * 2 * (1 + metal.nu) / metal.E for metal in self.deforming)

    @cached_property
    def round_contact(self) -> ContactEstimate:
        """The size of the first contact of a tip that is round everywhere as where it touches first."""
        return self._pressed_in(*self.principal_radii)

    @cached_property
    def estimate(self) -> ContactEstimate:
        """The size of the first contact."""
        R2 = self.principal_radii[1]
        size = self._widened(R2)
        # of a face nearly flat all may touch, whatever the depth
        if self.body.face > 0 and self.nearly_flat(size.depth):
            return self.round_contact
        if self.lands_flat or isinstance(self.body, Faceted) or not self.angle:
            return size
        # what is pressed in of a face that leans is a part of its circle, however flat its rim is
        rim = self.touch_point[0] / sin(self.angle)
        return self._widened(rim) if self.body.face > 0 and rim > R2 else size

    def _widened(self, R2: float) -> ContactEstimate:
        """Return the size of the first contact of a tip that has the radius ``R2``, m, around the rod."""
        R1 = self.principal_radii[0]
        steep = abs(sin(self.angle))
        around = max(R1, 0.5 * self.body.diameter / steep) if steep else inf  # no section is flatter
        size = self._pressed_in(R1, R2)
        for _ in range(ROUNDS):
            down, up = self.body.reaches(self.angle, size.depth)
            wide = (down + up) ** 2 / (8 * size.depth)
            if self.spans and isinstance(self.body, Faceted):
                b = 2 * self.body.section(self.angle, size.depth) / (pi * (down + up))
                size = self._pressed_in(max(wide, R1), max(b**2 / (2 * size.depth), R1))
            elif wide <= R1:
                break
            else:
                size = self._pressed_in(wide, max(R2, min(wide, around)))
            size = replace(size, shift=self.side * max(0.0, self.side * 0.5 * (down - up)), wider=wide / R1)
        return size

    def nearly_flat(self, depth: float) -> bool:
        """Return whether the middle of the face stands so low that all of it may touch at a depth, m."""
        x, _ = self.body.contact_point(self.angle)
        return float(x) * sin(self.angle) <= FLAT * depth

    @property
    def all_may_touch(self) -> bool:
        """Whether a face comes down so nearly flat that all of it may touch."""
        return self.body.face > 0 and self.nearly_flat(self.estimate.depth)

    @property
    def barrier_conforms(self) -> bool:
        """Whether the barrier yields under the whole contact, so that it takes the rod's shape."""
        flows = self.estimate.pressure >= LIMIT_PRESSURE * self.barrier.yield_stress
        return flows and self.barrier_yields

    @cached_property
    def energy(self) -> float:
        """What presses the tip in, J."""
        return 0.5 * self.effective_mass * max(self.approach, 1e-6) ** 2

    def _pressed_in(self, R1: float, R2: float) -> ContactEstimate:
        """Return the size of the contact of a tip of radii ``R1`` and ``R2``, m."""
        R, E_star, speed = sqrt(R1 * R2), self.modulus, max(self.approach, 1e-6)
        limit = LIMIT_PRESSURE * min((metal.yield_stress for metal in self.yielding), default=inf)
        depth = (self.energy / (8 / 15 * E_star * sqrt(R))) ** 0.4
        pressure = 4 / (3 * pi) * E_star * sqrt(depth / R)
        if pressure <= limit:
            duration = 2.94 * depth / speed
            return ContactEstimate(depth, sqrt(R1 * depth), sqrt(R2 * depth), duration, pressure, R1, R2)
        depth = sqrt(self.energy / (pi * limit * R))
        duration = 0.5 * pi * depth / speed * 1.3
        return ContactEstimate(depth, sqrt(2 * R1 * depth), sqrt(2 * R2 * depth), duration, limit, R1, R2)


def fall(gravity: float | None, angle: float, time: float, intervals: Array) -> tuple[float, float]:
    """Return the normal and the tangential speed, m/s, that gravity, m/s2, gave the rod beside its impact.

    That is the fall after the last contact, and along the barrier also that while the rod touched. Across the
    barrier the contact bears it: what gravity does going in it takes back coming out, so that an elastic ball
    keeps e = 1.

    Parameters
    ----------
    angle : rad, of the fall to the barrier's normal
    time : s since first contact at which the rod's motion is taken
    intervals : (k, 2) start and end of each contact, s; speed gained in flights between them is not included
    """
    g, later = gravity or 0.0, max(time - float(intervals[-1, 1]), 0.0) if len(intervals) else 0.0
    return g * cos(angle) * later, g * sin(angle) * (time - between(intervals))


def between(intervals: Array) -> float:
    """Return the time of flight between contacts whose start and end, s, are the rows of (k, 2)."""
    return float((intervals[1:, 0] - intervals[:-1, 1]).sum())


def pressure_speed(metal: Material) -> float:
    """Return the speed of pressure waves in an unbounded body of a material, m/s."""
    return sqrt(metal.E * (1 - metal.nu) / ((1 + metal.nu) * (1 - 2 * metal.nu) * metal.rho))


def shear_speed(metal: Material) -> float:
    """Return the speed of shear waves in a material, m/s."""
    return sqrt(metal.E / (2 * (1 + metal.nu) * metal.rho))


def section_frequency(metal: Material, diameter: float) -> float:
    """Return the circular frequency, rad/s, above which the modes of a rod, m, deform its section.

    Such modes are local; their compliance under a point load is part of the contact law.
    """
    return SECTION * shear_speed(metal) / (diameter / 2)


def impedance(metal: Material) -> float:
    """Return rho V, Pa s/m, of a half-space under a flat part; V = 3.4 c_s / (pi (1 - nu)) is Lysmer's.

    Examples
    --------
    >>> round(impedance(Material("steel", 210e9, 0.3, 7850.0)) / (7850.0 * 3208.0), 2)
    1.55
    """
    return 3.4 / (pi * (1 - metal.nu)) * sqrt(metal.rho * metal.E / (2 * (1 + metal.nu)))
