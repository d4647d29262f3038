"""A ball over a rigid plane or a block of its own kind: the parameters and the model of two problems."""

from dataclasses import dataclass, replace
from math import ceil, cos, inf, log2, pi, sin, sqrt

import numpy as np

import meshes
from fem_impact.arrays import Array, Ints
from fem_impact.case.plates import ROWS
from fem_impact.evidence.problems import discretisation, setups
from fem_impact.evidence.problems.bodies import Block, FreeBody, body_model, placed
from fem_impact.evidence.problems.problem import Check, Solved, Values, within
from fem_impact.evidence.references.finite_sphere import INERTIA, ball_impact, oblique_ball, oblique_sphere
from fem_impact.evidence.references.hertz import HertzImpact, contact_modulus, hertz, sliding_ratio
from fem_impact.evidence.references.waves import radiated_energy
from fem_impact.fem.elements import lumped_mass
from fem_impact.solid.model import Model
from meshes import HexMesh, Zone

MARGIN = 16.0  # the block reaches so many contact radii beyond its fine zone; 8 are 0.3 % too soft
REACH = 1.3  # half-width of the fine zone over the contact radius
CONTACT = 5e-3, 0.12  # contact radii over the ball's that the reference covers


def ball_mass(p: Values) -> float:
    """Return the mass of the sphere, kg."""
    return 4 / 3 * pi * p["radius"] ** 3 * p["rho"]


def modulus(p: Values) -> float:
    """Return E* of the sphere with what it strikes, Pa."""
    E, nu = (p.get(f"barrier_{name}", p[name]) for name in ("E", "nu"))
    return contact_modulus(p["E"], p["nu"], E if p["block"] else inf, nu)


def plain_hertz(p: Values, v_n: float) -> HertzImpact:
    """Return Hertz' impact at an approach speed, m/s."""
    return hertz(modulus(p), p["radius"], ball_mass(p), v_n)


def small_contact(p: Values, share: float = 1.0) -> None:
    """Refuse a ``speed``, ``share`` of it along the normal, whose contact is no spot on the ball.

    Raises
    ------
    SceneError
        If the contact radius is out of the range of the finite ball's reference.
    """
    touch = plain_hertz(p, share * p["speed"]).radius / p["radius"]
    low, high = (p["speed"] * (limit / touch) ** 2.5 for limit in CONTACT)  # the radius goes as v^0.4
    within(p, "speed", low, high, "m/s", f"contact radii of {CONTACT[0]:g} to {CONTACT[1]:g} of the ball's.")


@dataclass(frozen=True, slots=True)
class StruckPlate:
    """A plate under a ball: thickness, m; its edges from the contact, m; speed of its bending waves, m/s."""

    thickness: float
    edges: float
    speed: float


def block_reach(radius: float, base: float) -> float:
    """Return how far the faces of a block lie from the middle of a contact of ``radius``, m."""
    return REACH * radius + max(MARGIN * radius, 2 * base)


def block_under(radius: float, base: float, levels: int, slide: float) -> HexMesh:
    """Return a block whose cells of edge ``base`` are split as often as the tip's, for a contact radius.

    The tip moves on by ``slide``, m, towards -t while it touches.
    """
    half = REACH * radius
    around = block_reach(radius, base) - half
    low, high = np.array([-half - slide, 0.0, -radius]), np.array([half, half, 0.0])
    zone = Zone(np.zeros(3), np.eye(3), low, high)
    low, high = low - around, high + around
    low[1] = high[2] = 0.0
    return meshes.block(low, high, base, [zone] * levels)


def plate_under(radius: float, base: float, levels: int, plate: StruckPlate) -> HexMesh:
    """Return the mesh of a plate, fine like `block_under`."""
    thickness, edges, half = plate.thickness, plate.edges, REACH * radius
    rows = max(ROWS, round(thickness / base))
    depth = rows * base  # before its rows are drawn to the thickness
    low, high = np.array([-half, 0.0, -radius * depth / thickness]), np.array([half, half, 0.0])
    zone = Zone(np.zeros(3), np.eye(3), low, high)
    mesh = meshes.block([-edges, 0.0, -depth], [edges, edges, 0.0], base, [zone] * levels)
    mesh = meshes.with_free_bottom(mesh)
    return meshes.with_rows_at(mesh, np.array([0.0, depth]), np.array([0.0, thickness]))


def pole_cells(p: Values, radius: float) -> tuple[int, float]:
    """Return how often the ball's cells at its pole are split for a contact radius, m, and their edge, m."""
    edge = meshes.pole_edge(p["radius"], int(p["across"]))
    levels = max(0, ceil(log2(edge * p["cells"] / radius) - 0.1))
    return levels, edge / 2**levels


def sphere_model(
    p: Values,
    touch: HertzImpact,
    v_n: float,
    v_t: float = 0.0,
    f: float = 0.0,
    plate: StruckPlate | None = None,
) -> Model:
    """Return a ball just above the barrier, fine around its pole, moving down at v_n and along t at -v_t.

    The barrier may be a ``plate`` that is meshed through its thickness.
    """
    R, across = p["radius"], int(p["across"])
    base = 2 * R / across
    levels, _ = pole_cells(p, touch.radius)
    depth, half = touch.radius, REACH * touch.radius
    fine = Zone(np.zeros(3), np.eye(3), np.array([-half, 0.0, -depth]), np.array([half, half, depth]))
    mesh = meshes.RodMesh.plain(meshes.sphere(R, across, [fine] * levels))
    points = placed(mesh.mesh.points, 0.0, 0.0)
    velocity = np.array([-v_t, 0.0, -v_n])
    block = None
    if p["block"]:
        if plate:
            under = plate_under(touch.radius, base, levels, plate)
        else:
            under = block_under(touch.radius, base, levels, v_t * touch.duration)
        # a block of the sphere's kind unless the values state another
        E, nu, rho = (p.get(f"barrier_{name}", p[name]) for name in ("E", "nu", "rho"))
        block = Block(under, base / 2**levels, E, nu, rho, bending=plate.speed if plate else None)
    denser = _denser(points, mesh.mesh.cells, p)
    metal = p["E"], p["nu"], p["rho"]
    return body_model(
        FreeBody(mesh, points, velocity, *metal, denser, friction=f, block=block, turning=f > 0)
    )


def _denser(points: Array, cells: Ints, p: Values) -> Array:
    """Return densities (cells,) over rho with which half the ball has a ball's mass, moment and centre.

    Flat cells inside the round skin lack volume, and masses at their corners lie too far out: the moment is
    1.8 % too high with 8 cells across, which takes 0.01 of a sticking ball's tangential restitution. Small
    cells where it touches lack less: its mass centre is 1.3 % of the radius too low, which friction's arm
    misses. A density that is linear in the height and the square of the distance from the centre mends all.
    """
    R, mass = p["radius"], lumped_mass(points, cells, p["rho"])
    arm = (points[cells] - np.array([0.0, 0.0, R])) / R
    middle = arm.mean(axis=1)
    shapes = np.stack([np.ones(len(cells)), (middle**2).sum(axis=1), middle[:, 2]])
    of_each = [np.ones_like(mass), arm[:, :, 0] ** 2 + arm[:, :, 2] ** 2, arm[:, :, 2]]
    sums = [[float((mass * moment).sum(axis=1) @ shape) for shape in shapes] for moment in of_each]
    weights = np.linalg.solve(sums, 0.5 * ball_mass(p) * np.array([1.0, INERTIA, 0.0]))
    return np.asarray(weights @ shapes)


RADIATED, ENERGY = 0.15, 1e-3
OF_FORCE, OF_TIME = 0.3, 0.05  # what radiating all of E_0 would take of the force, and add to the time
UNHEARD = 0.05  # of (a / R)^2, by which modes up to 20 in place of 12 c_s / R change force and time
FAR = "waves cross the block in {:.2f} of the contact time, too much of it for a boundary of slow forces"
AFTER = 1.15  # contact times that are followed


@dataclass(frozen=True, slots=True)
class SphereErrors:
    """What the mesh of a ball and its block, and what the reference leaves out, may change.

    Attributes
    ----------
    radius, touch : of the ball and its contact, m; cell : edge of the ball's cells there, m
    reach : distance of the block's faces, m; wave : way of shear waves while the contact lasts, m
    radiated : energy that a half-space would radiate over E_0, 0 on a rigid plane
    """

    radius: float
    touch: float
    cell: float
    reach: float
    wave: float
    radiated: float

    @classmethod
    def of(cls, p: Values, exact: HertzImpact) -> "SphereErrors":
        """Return those of the parameters."""
        base, touch = 2 * p["radius"] / p["across"], plain_hertz(p, p["speed"]).radius
        wave = sqrt(p["E"] / (2 + 2 * p["nu"]) / p["rho"]) * exact.duration
        E_0 = 0.5 * ball_mass(p) * p["speed"] ** 2
        radiated = radiated_energy(exact, p["E"], p["nu"], p["rho"]) / E_0 if p["block"] else 0.0
        return cls(p["radius"], touch, pole_cells(p, touch)[1], block_reach(touch, base), wave, radiated)

    @property
    def radiation(self) -> float:
        """Relative error of the radiated energy."""
        boundary = discretisation.boundary_error(self.reach, self.wave)
        return boundary + discretisation.grid_radiation_error(self.cell, self.touch)

    @property
    def force(self) -> float:
        """Relative error of the largest force.

        At the largest approach it follows the stiffness of that moment, elsewhere its mean to the power 0.4.
        """
        grid = discretisation.grid_force_error(self.cell, self.touch)
        return grid + 0.4 * discretisation.graded_error(REACH) + self._reference() + self._block(OF_FORCE)

    @property
    def time(self) -> float:
        """Relative error of the contact time; its ends are those of single nodes, within a cell.

        Nodes that join one by one make it longer, coarse cells around them shorter.
        """
        grid = discretisation.grid_force_error(self.cell, self.touch)
        mesh = max(grid, 0.4 * discretisation.graded_error(REACH))
        return mesh + self._reference() + self._block(OF_TIME)

    def _reference(self) -> float:
        """Return what the reference leaves out: faster modes than it has, a / R beyond the first order."""
        return UNHEARD * (self.touch / self.radius) ** 2

    def _block(self, share: float) -> float:
        """Return the part of what the block radiates, of which the reference knows nothing, and of its end.

        Hertz' law with the damping that radiates a small share of E_0 has a force lower by 0.3 and a time
        longer by 0.05 of that share.
        """
        if not self.radiated:
            return 0.0
        heard = self.radiated * (1 + discretisation.boundary_error(self.reach, self.wave))
        return share * heard + 0.4 * discretisation.end_error(self.touch, self.reach)


def _radiated(p: Values, strike: setups.TipImpact, errors: SphereErrors) -> Check:
    """Compare what left through the block's boundary with the half-space's, or nothing on a plane."""
    E_0, name = 0.5 * ball_mass(p) * p["speed"] ** 2, "radiated energy / E_0"
    if not p["block"]:
        return Check(name, "1", strike.radiated / E_0, 0.0, 0.0, "absolute")
    if errors.radiation > RADIATED:
        far = FAR.format(errors.reach / errors.wave)
        return Check.shown(name, "1", strike.radiated / E_0, errors.radiated, far)
    return Check(name, "1", strike.radiated / E_0, errors.radiated, errors.radiation)


def solve_hertz(p: Values) -> Solved:
    """Compare force, time and energies with a finite sphere that vibrates, and with Hertz.

    Raises
    ------
    SceneError
        If the contact is too small or too large.
    """
    small_contact(p)
    v = p["speed"]
    plain = plain_hertz(p, v)
    of_ball = contact_modulus(p["E"], p["nu"])
    exact = ball_impact(modulus(p), of_ball, p["nu"], p["radius"], ball_mass(p), v, setups.SMOOTHING)
    model = sphere_model(p, plain, v)
    strike = setups.run_strike(model, AFTER * plain.duration, plain.duration)
    errors = SphereErrors.of(p, exact)
    note = f"for a / R far below 1, here {plain.radius / p['radius']:.3f}"
    checks = (
        Check("largest force", "N", strike.force, exact.force, errors.force),
        Check("contact time", "s", strike.duration, exact.duration, errors.time),
        Check.shown("largest force, Hertz", "N", strike.force, plain.force, note),
        Check.shown("contact time, Hertz", "s", strike.duration, plain.duration, note),
        _radiated(p, strike, errors),
        Check("rebound + radiated energy / E_0", "1", strike.kept(v), 1.0, ENERGY, "absolute"),
        Check("largest energy / E_0", "1", strike.most, 1.0, ENERGY, "at most"),
    )
    return Solved(checks, strike.state.step, len(model.geometry.rod.mesh.cells))


RESTITUTION, SLIPPED = 0.02, 0.05  # of a blow that sticks
SLIDING = 0.999  # of Coulomb's ratio, from which a blow counts as sliding throughout
UNCOUPLED = 0.45  # Poisson's ratio from which pressing hardly shifts the skin on a rigid plane
COUPLED = "on a rigid plane pressing shifts the skin sideways unless nu is near 0.5"


def _sliding_errors(
    p: Values, normal: HertzImpact, leaning: float, inertia: float
) -> tuple[float, float, float]:
    """Return the errors of restitution, spin and ratio over f of a ball that slides throughout.

    Of the ratio ``leaning`` the mesh misses a share of the interface's lean (`lean_error`), on a rigid plane
    of the arm by which the pressure moves on instead. Restitution and spin follow the ratio with the impulse,
    v_n (1 + e), of which the reference takes e = 1: the block radiates, closing nodes take energy. The arm
    of friction is shorter than the radius by what the ball is pressed in, and the mesh
    has another ``inertia`` over m R^2.
    """
    v_n, v_t = p["speed"] * cos(p["angle"]), p["speed"] * sin(p["angle"])
    lost = radiated_energy(normal, p["E"], p["nu"], p["rho"]) / (0.5 * ball_mass(p) * v_n**2)
    bounce = 0.5 * (lost * p["block"] + ENERGY)
    lean_error = discretisation.lean_error(pole_cells(p, normal.radius)[1], normal.radius)
    missed = (1 - leaning / p["f"]) * lean_error
    of_ratio, given = 1 - SLIDING + missed * p["block"], p["f"] * v_n / v_t
    back = given * (2 * of_ratio + bounce)
    of_arm = normal.approach / p["radius"] + missed * (1 - p["block"])
    turned = 2 * given * (of_arm + abs(inertia / INERTIA - 1))
    return back, (back + turned) / INERTIA, of_ratio


def solve_oblique(p: Values) -> Solved:
    """Compare tangential restitution of the centre, spin and impulse ratio.

    Raises
    ------
    SceneError
        If the contact is too small or too large.
    """
    small_contact(p, cos(p["angle"]))
    v_n, v_t = p["speed"] * cos(p["angle"]), p["speed"] * sin(p["angle"])
    R, normal = p["radius"], plain_hertz(p, v_n)
    blow = (p["nu"], R, ball_mass(p), p["f"], v_n, v_t)
    plain = oblique_sphere(modulus(p), *blow)
    exact = oblique_ball(modulus(p), contact_modulus(p["E"], p["nu"]), *blow)
    model = sphere_model(p, normal, v_n, v_t, p["f"])
    strike = setups.run_strike(model, AFTER * normal.duration, normal.duration)
    m = strike.motion
    mu = (m.V_t + v_t) / (m.V_n + v_n)
    slides = exact.ratio > SLIDING * p["f"]
    pressure = 2 * modulus(p) * normal.radius / (pi * R)
    leaning = sliding_ratio(p["f"], p["nu"], p["E"] / (2 + 2 * p["nu"]), pressure) if slides else p["f"]
    ratio = leaning if slides and p["block"] else exact.ratio
    back, note = -m.V_t / v_t, f"for a / R far below 1, here {normal.radius / R:.3f}"
    # away from sliding the ratio tells the same as the restitution: v_t (1 - e_t) / (2 v_n)
    sticking = RESTITUTION, SLIPPED, RESTITUTION * v_t / (2 * v_n) / p["f"]
    near = _sliding_errors(p, normal, leaning, m.inertia / m.mass / R**2) if slides else sticking
    # the ball's theory knows of no lean; on a rigid plane, which cannot lean, the pressure moves on instead
    less = ratio / exact.ratio
    arm = 1.0 if p["block"] else leaning / p["f"]
    centre, spin = 1 - less * (1 - exact.centre_t / v_t), arm * less * exact.spin / v_t
    compared = [
        Check("tangential restitution", "1", back, centre, near[0], "absolute"),
        Check("spin R Omega / v_t", "1", -R * m.Omega / v_t, spin, near[1], "absolute"),
        Check("impulse ratio mu / f", "1", mu / p["f"], ratio / p["f"], near[2], "absolute"),
    ]
    if not (slides or p["block"] or p["nu"] >= UNCOUPLED):
        compared = [replace(check, tolerance=inf, kind="shown", note=COUPLED) for check in compared]
    checks = (
        compared[0],
        Check.shown("tangential restitution, plain", "1", back, plain.centre_t / v_t, note),
        *compared[1:],
        Check("largest energy / E_0", "1", strike.most, 1.0, 1e-3, "at most"),
    )
    return Solved(checks, strike.state.step, len(model.geometry.rod.mesh.cells))
