"""The rod as its contact sees it: rigid motion, elastic modes, and how each moves the contact point."""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, log, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.mesh import require_mesh
from fem_impact.fem.body import MeshedBodies
from fem_impact.modal.motion import Sites
from fem_impact.modal.sites import nearest_skin, rotated, settle, sites_of, skin
from fem_impact.physics.contact import section_frequency
from fem_impact.physics.contact_law import begins_to_yield
from fem_impact.physics.wedge import wedge_compliance
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.fields import ACCURACY
from fem_impact.scene.impact import Impact
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.types import Accuracy, Scene
from rigid import Faceted

COARSEST = next(f.high for f in ACCURACY if f.key == "tip_size")  # m
AT_REST = 100.0  # rad in the time of a contact, of a mode that follows the force as if at rest
AROUND = 0.4  # diameters around the contact point over which a mode is taken as affine


@dataclass(frozen=True, slots=True)
class ModalRod:
    """A rod at first contact, and where it may touch.

    Attributes
    ----------
    mass, k2 : kg, m2, of the whole rod
    omega : (k,) rad/s
    sites : curves and corners of its outline, with the displacement by each mode of the whole rod
    first : the site that touches first, of which a single place does, or -1
    """

    mass: float
    k2: float
    omega: Array
    sites: Sites
    first: int

    @property
    def arm(self) -> tuple[float, float]:
        """(t, n), m, from the mass centre to what touches first."""
        return skin(self.sites, self.first, 0.0)

    def energies(self, q: Array, rate: Array) -> Array:
        """Return the energy of each mode (k,), J, of amplitudes, sqrt(kg) m, and rates, sqrt(kg) m/s."""
        return np.asarray(0.5 * (rate**2 + (self.omega * q) ** 2))

    @property
    def flexibility(self) -> float:
        """Of the modes under a force along n at what touches first, m/N."""
        return float((self.sites.along_n[self.first] ** 2 / self.omega**2).sum())


class FreeModes(NamedTuple):
    """Free elastic modes of a projectile, symmetric about its plane of motion, of the half y >= 0.

    Attributes
    ----------
    points : (n, 3), m, nodes in the rod frame: x and y across, z along the axis from the tip
    shape : (n, 2, k), kg^-1/2, displacements along x and z, normed to the mass of the whole rod
    omega : (k,) rad/s, ascending
    """

    points: Array
    shape: Array
    omega: Array

    def __repr__(self) -> str:
        low, high = self.frequency[[0, -1]]
        return f"FreeModes({len(self.omega)} from {low:.4g} Hz to {high:.4g} Hz, at {len(self.points)} nodes)"

    @property
    def frequency(self) -> Array:
        """Frequencies (k,), Hz."""
        return np.asarray(self.omega / (2 * pi))


def modes(scene: Scene) -> FreeModes:
    """Return the free modes of a scene's projectile by finite elements; those found once are kept.

    Raises
    ------
    SceneError
        The projectile cannot be meshed.
    """
    return FreeModes(*_modes(_elastic(scene.projectile), scene.across))


def modal_rod(bodies: Bodies, vibrating: bool = True) -> ModalRod:
    """Return the rod of a scene; the modes of rods of one shape and material are computed once.

    A rod of which the side x < 0 comes down first is the mirror image of one that is inclined as much the
    other way, exactly: modes from a mesh are symmetric but for their round-off.
    """
    pair, body = bodies.contact, bodies.body
    alpha, side = abs(pair.angle), pair.side
    rounds = body.curves(side) if isinstance(body, Faceted) else body.rounds()
    places = nearest_skin(rounds, alpha)
    omega, moved = np.zeros(0), np.zeros((len(places), 2, 0))
    if vibrating:
        own = side if isinstance(body, Faceted) else 1.0  # at -1 all is of the mirror image of the rod
        spec, across = _elastic(bodies.rod), bodies.scene.across
        of_rod = np.array([_moved_place(spec, across, own * x, z) for x, z in places.tolist()])
        omega, moved = _modes(spec, across)[2], of_rod * np.array([[own], [1.0]])
    sites = sites_of(rounds, (body.x_c, body.z_c), pair.angle, *rotated(alpha, moved[:, 0], moved[:, 1]))
    first = -1
    if not pair.lands_flat:
        (d_c, d_d), radius = pair.arms, pair.principal_radii[0]
        heights = [skin(sites, s, 0.0)[1] for s in range(len(places))]
        first = int(np.argmin(heights))
        settle(sites, first, 0.0, radius, (-d_c, radius - d_d))
    return ModalRod(body.mass, body.k2, *_with_edges(bodies, omega, sites), first)


def _with_edges(bodies: Bodies, omega: Array, sites: Sites) -> tuple[Array, Sites]:
    """Return frequencies and sites with two stiff modes more at each sharp edge: how it gives way by itself.

    Beyond the half width a of the contact and the radius R of the edge, up to about the half length b of the
    contact, the body is a wedge and gives way by more than the half-space of the contact law: by the excess
    of `wedge_compliance` times ln(4 b / max(a, R)) / (pi b E') along the bisector and across it, with
    E' = E / (1 - nu^2), as a half-space does by that logarithm (Johnson 1985, Contact Mechanics, 4.2). So
    a push across the barrier moves an edge along it, too. The modes are so high that they follow the force.
    A contact that yields presses on metal that flows, and a part that lands flat, or so nearly that all of it
    may touch, has a law of its own.
    """
    pair = bodies.contact
    if pair.lands_flat or pair.all_may_touch or begins_to_yield(pair):
        return omega, sites
    metal, size, count = pair.rod, pair.estimate, len(sites.begin) - 1
    highest = min(section_frequency(metal, bodies.rod.diameter), AT_REST / size.duration)
    modes: list[tuple[int, float, float]] = []  # site, and its displacement along t and n
    for s in range(count):
        arcs = slice(int(sites.begin[s]), int(sites.begin[s + 1]))
        low, high = float(sites.low[arcs][0]), float(sites.high[arcs][-1])
        blunt = max(size.a_t, float(sites.radius[arcs].max()))
        if high - low >= pi or blunt >= size.a_b:
            continue
        length = log(4.0 * size.a_b / blunt) / (pi * size.a_b * metal.E / (1.0 - metal.nu**2))
        upright = 0.5 * (low + high)  # turn at which the bisector stands on the barrier
        along, across = (
            highest * sqrt((times - 1.0) * length) for times in wedge_compliance(0.5 * (pi - high + low))
        )
        modes += [(s, -along * sin(upright), along * cos(upright))]
        modes += [(s, across * cos(upright), across * sin(upright))]
    if not modes:
        return omega, sites
    t, n = np.zeros((2, count, len(modes)))
    for k, (s, moved_t, moved_n) in enumerate(modes):
        t[s, k], n[s, k] = moved_t, moved_n
    t, n = np.hstack([sites.along_t, t]), np.hstack([sites.along_n, n])
    return np.append(omega, np.full(len(modes), highest)), sites._replace(along_t=t, along_n=n)


@lru_cache(maxsize=256)
def _moved_place(rod: ProjectileSpec, across: int, x: float, z: float) -> Array:
    """Return what the modes of a rod move a place by, (2, k), kg^-1/2: as affine around it, by least squares.

    Places at which an edge ends are asked for again at each inclination.
    """
    points, shape, _ = _modes(rod, across)
    away = (points - np.array([x, 0.0, z])) / (AROUND * rod.diameter)
    distance, reach = (away**2).sum(axis=1), 1.0
    while True:
        near = np.flatnonzero(distance < reach)
        affine = np.column_stack([np.ones(len(near)), away[near][:, [0, 2]]])
        if np.linalg.matrix_rank(affine) == 3:
            break
        reach *= 2.0  # a mesh of the user's own may be so coarse
    weights = affine @ np.linalg.solve(affine.T @ affine, np.array([1.0, 0.0, 0.0]))
    return np.asarray(np.tensordot(weights, shape[near], axes=1))


def _elastic(rod: ProjectileSpec) -> ProjectileSpec:
    """Return the rod without what its modes do not depend on, so that they are found again."""

    def elastic(metal: Material) -> Material:
        return Material("elastic", metal.E, metal.nu, metal.rho)

    segments = tuple(replace(part, material=elastic(part.material)) for part in rod.segments)
    return replace(rod, material=elastic(rod.material), segments=segments)


@lru_cache(maxsize=32)
def _modes(rod: ProjectileSpec, across: int) -> tuple[Array, Array, Array]:
    """Return nodes (n, 3) in the rod frame, mode shapes x, z (n, 2, k) of the whole rod, and omega (k,).

    Modes above the section's own frequency are left out: their compliance is part of the contact law.
    """
    scene = Scene(
        id="modes",
        title="modes of a rod on the coarse mesh",
        projectile=rod,
        barrier=Barrier(rod.material),
        surface=Surface("custom", 0.0, 0.0, 0.0, "no friction"),
        impact=Impact(0.0, -1.0, 0.0),
        effects=("vibration", "barrier-rigid"),
        accuracy=Accuracy(tip_size=min(rod.diameter / 4, COARSEST), across=across, mass_scaling=1.0),
    )
    # nothing strikes: a body is refused for its mesh, and not for how it would touch
    require_mesh(rod, scene.across)
    case = Case(scene)
    if rod.own_mesh is None:
        case.require_memory()
    meshed = MeshedBodies(case)
    modes, mesh = meshed.rod_modes(), meshed.geometry.rod.mesh
    low = modes.omega < section_frequency(rod.material, rod.diameter)
    # modes are normalised with the mass of the half rod
    shape = modes.shape[meshed.free_nodes][:, ::2, low] / sqrt(2)
    return mesh.points[~mesh.is_hanging], np.ascontiguousarray(shape), modes.omega[low]
