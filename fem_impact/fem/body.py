"""Meshed bodies: positions, numbering, lumped masses and stiffness.

Element matrices are assembled in batches and never stored all at once.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import sqrt
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.case.case import Case
from fem_impact.case.plates import widening
from fem_impact.fem.eigen import MassStiffness, RodModes, rod_modes
from fem_impact.fem.elements import Kind, element_stiffness, lame_constants, lumped_mass
from fem_impact.fem.geometry import POINTS, Geometry, build_geometry, material_numbers
from fem_impact.fem.hexmodes import dummy_element
from fem_impact.fem.layout import DofLayout, MassPoints, number
from fem_impact.fem.mass_scaling import LEAST, crossing_times, mass_factors, reference_time, scaled_rod
from fem_impact.fem.rest import RestOfBarrier, rest_of
from fem_impact.fem.slices import SliceOperator
from fem_impact.fem.sparse import assemble, assemble_mass, tie_operator
from fem_impact.physics.contact import pressure_speed
from fem_impact.scene.material import Material
from meshes import OUTER, HexMesh, RodMesh
from rigid import Turned

HEIGHT = 2e-6  # m of the rod's lowest point over the barrier where it is meshed


class Elastic(Protocol):
    """Elastic constants and density of a material: E, Pa; nu; rho, kg/m3."""

    @property
    def E(self) -> float: ...  # noqa: D102
    @property
    def nu(self) -> float: ...  # noqa: D102
    @property
    def rho(self) -> float: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class MeshedBody:
    """One meshed body with the data that assembly needs.

    Attributes
    ----------
    points : (n, 3) node positions in the barrier frame, m
    places : (n, 3) int64, indices of the node unknowns in the flat vectors
    yields : (m,) bool, cells that may yield
    element, yielding : element types of the cells that cannot yield, and of those that may
    mass : (m, 8) lumped masses of each cell at its nodes, kg
    others : materials of cells that are not of ``material``, each with the mask (m,) of its cells
    touching : (m,) bool, cells that may touch the other body, the finest unless stated
    """

    name: str
    mesh: HexMesh
    points: Array
    places: Ints
    material: Elastic
    yields: Bools
    element: Kind
    mass: Array
    yielding: Kind = "bbar"
    others: tuple[tuple[Material, Bools], ...] = ()
    touching: Bools | None = None

    @property
    def parts(self) -> list[tuple[Elastic, Bools]]:
        """Return each material with the mask (m,) of its cells."""
        own = np.ones(len(self.mesh.cells), dtype=bool)
        for _, cells in self.others:
            own &= ~cells
        return [(self.material, own), *self.others]


def make_body(
    name: str,
    mesh: HexMesh,
    points: Array,
    places: Ints,
    material: Elastic,
    yields: Bools,
    element: Kind = "incompatible",
    yielding: Kind = "bbar",
) -> MeshedBody:
    """Return a body with its lumped masses, and the types of cells that cannot yield and that may."""
    mass = lumped_mass(points, mesh.cells, material.rho)
    return MeshedBody(name, mesh, points, places, material, yields, element, mass, yielding)


def of_materials(body: MeshedBody, which: Ints, materials: Sequence[Material]) -> MeshedBody:
    """Return a body, masses included, whose cells (m,) are of ``which`` of ``materials``; 0 is its own."""
    others = tuple((material, which == k) for k, material in enumerate(materials) if k)
    for material, here in others:
        body.mass[here] *= material.rho / body.material.rho
    return replace(body, others=others)


def crossing_of(body: MeshedBody, own: Material) -> Array:
    """Return the time (m,), s, in which a pressure wave crosses each cell of a body of materials."""
    crossing = crossing_times(body.mesh, body.points, own)
    for material, here in body.others:
        crossing[here] *= pressure_speed(own) / pressure_speed(material)
    return crossing


def stiffness_of(body: MeshedBody, chosen: Bools, size: int, shift: int = 0) -> sp.csr_matrix:
    """Return the stiffness (size, size), N/m, of the cells in the mask ``chosen`` (m,).

    Row 0 is the unknown with index ``shift`` in the flat vectors.
    """
    T, cells = tie_operator(body.mesh.tie, body.places - shift, size), body.mesh.cells

    def part(material: Elastic, here: Bools) -> sp.csr_matrix:
        lame = lame_constants(material.E, material.nu)
        elastic = assemble(body.points, cells[here & ~body.yields], lame, body.element, T)
        return elastic + assemble(body.points, cells[here & body.yields], lame, body.yielding, T)

    first, *rest = (part(material, chosen & here) for material, here in body.parts)
    return sum(rest, first)


def slices_of(body: MeshedBody, rod: RodMesh) -> SliceOperator:
    """Return the stiffness operator of the rod's slices, built from the first, which all others equal."""
    if not rod.body_cells.size:
        return SliceOperator.none()
    m = next(material for material, here in body.parts if here[rod.body_cells[0, 0]])
    first = body.mesh.cells[rod.body_cells[:, 0]]
    K = element_stiffness(body.points, first, lame_constants(m.E, m.nu), body.element)
    return SliceOperator.of_rod(rod, K)


def nose_and_whole(
    body: MeshedBody, rod: RodMesh, drawn: MassPoints, layout: DofLayout
) -> tuple[sp.csr_matrix, MassStiffness]:
    """Return two stiffnesses of the rod, N/m.

    The first is that of the elastic nose cells (neither in a slice nor yielding) over the free unknowns of
    the nodes, the second that of all cells over the unknowns of the mass points.
    """
    sliced, n = np.zeros(len(body.mesh.cells), dtype=bool), layout.rod_size
    sliced[rod.body_cells] = True
    nose = stiffness_of(body, ~sliced & ~body.yields, n)
    rest = stiffness_of(body, sliced | body.yields, n)
    return nose, drawn.reduced((nose, rest), layout.body_shape[1])


def assemble_masses(bodies: list[MeshedBody], layout: DofLayout) -> Array:
    """Return the lumped masses (size,), kg."""
    mass = np.zeros(layout.size)
    for body in bodies:
        T = tie_operator(body.mesh.tie, body.places, layout.size)
        mass += assemble_mass(body.mass, body.mesh.cells, T)
    return mass


def invert(mass: Array, bodies: list[MeshedBody]) -> Array:
    """Return 1 / mass (size,), 1/kg; 0 where there is no mass and for motion through the symmetry plane."""
    inverse = np.divide(1.0, mass, out=np.zeros_like(mass), where=mass > 0)
    for body in bodies:
        inverse[body.places[np.abs(body.points[:, 1]) < 1e-12, 1]] = 0.0
    return inverse


class MeshedBodies:
    """Meshes, numbering and masses of a case's bodies; each part is made at its first use and cached.

    A rod that has struck before keeps its ``mesh``.
    """

    def __init__(self, case: Case, mesh: RodMesh | None = None) -> None:
        self.case, self.scene, self.spec, self.mesh = case, case.scene, case.slots, mesh

    @cached_property
    def geometry(self) -> Geometry:
        """Return the meshes."""
        meshed = HEIGHT, self.spec.meshed_barrier, self.spec.vibrating
        return build_geometry(self.case.bodies, self.case.zones, *meshed, self.mesh)

    @cached_property
    def layout(self) -> DofLayout:
        """Return the numbering of the unknowns."""
        gives_way = self.scene.barrier.mass is not None or self.spec.plate is not None
        turns = self.scene.barrier.inertia is not None
        return number(self.geometry.rod, self.geometry.barrier, gives_way, turns)

    @cached_property
    def rest_mass(self) -> float:
        """Return the mass, kg, of half the rigid body behind the nose; 0 where the rod vibrates."""
        if self.spec.vibrating:
            return 0.0
        body, rod = self.case.bodies.body, self.geometry.rod
        if rod.rest_share:
            return body.mass * rod.rest_share / 2
        return body.moments_behind(rod.body_start)[0] / 2

    @cached_property
    def materials(self) -> dict[str, Material]:
        """Return the materials of the meshed bodies; of several, that which touches."""
        rod, barrier = self.scene.projectile.material, self.scene.barrier.struck
        return {"rod": rod, "barrier": barrier} if self.spec.meshed_barrier else {"rod": rod}

    @cached_property
    def reference_time(self) -> float:
        """Return the time, s, in which a wave crosses the finest cells, of the fastest material."""
        fastest = max((m for _, m in self.scene.barrier.strata), key=pressure_speed)
        barrier = {"barrier": fastest} if self.spec.meshed_barrier else {}
        return reference_time(self.case.zones, {"rod": self.materials["rod"], **barrier})

    @cached_property
    def true_rod(self) -> MeshedBody:
        """Return the meshed rod with its exact mass.

        The mass that the flat faces of the mesh cut off the round skin is spread over the cells there.
        """
        g, yields = self.geometry, self.geometry.may_yield["rod"] & (self.spec.rod_law is not None)
        steel, accuracy = self.materials["rod"], self.scene.accuracy
        kinds = accuracy.element, accuracy.yielding_element
        rod = make_body("rod", g.rod.mesh, g.rod_points, self.layout.rod, steel, yields, *kinds)
        spec = self.scene.projectile
        rod = of_materials(rod, material_numbers(spec, g.rod.mesh), spec.materials)
        rod, z = replace(rod, touching=g.touching), g.rod.mesh.points[g.rod.mesh.cells, 2].mean(axis=1)
        cut = np.any([(z > low) & (z < high) for low, high in g.rod.on_surface], axis=0)
        missing = self.case.bodies.body.mass / 2 - rod.mass.sum() - self.rest_mass
        if cut.any():
            rod.mass[cut] *= 1 + missing / rod.mass[cut].sum()
        return rod

    @cached_property
    def scaled_rod(self) -> tuple[MeshedBody, float]:
        """Return the rod with the masses of the run, and the mass scaling in force."""
        rod, crossing = self.true_rod, crossing_of(self.true_rod, self.materials["rod"])
        reference = self.reference_time
        place, wanted = rod.points[rod.mesh.cells], self.scene.accuracy.mass_scaling
        zones, bodies = self.case.zones, self.case.bodies
        long = zones.edges > 0 and widening(bodies, zones.base) > 1  # it takes many steps
        least = LEAST if long and wanted > 1 else 1.0
        nose = np.ones(len(place), dtype=bool)  # cells that are in no slice
        nose[self.geometry.rod.body_cells] = False
        mass, scaling = scaled_rod(rod.mass, place, nose, crossing, reference, wanted, least)
        return replace(rod, mass=mass), scaling

    @property
    def rod(self) -> MeshedBody:
        """Return the rod with the masses of the run."""
        return self.scaled_rod[0]

    @cached_property
    def true_barrier(self) -> MeshedBody | None:
        """Return the barrier with its true masses if it is meshed."""
        g, mesh = self.geometry, self.geometry.barrier
        if mesh is None:
            return None
        steel, accuracy = self.materials["barrier"], self.scene.accuracy
        kinds, elastic = (accuracy.element, accuracy.yielding_element), np.zeros(len(mesh.cells), dtype=bool)
        body = make_body("barrier", mesh, mesh.points, self.layout.barrier, steel, elastic, *kinds)
        ends, layers = zip(*self.scene.barrier.strata, strict=True)
        which = np.searchsorted(ends, -mesh.points[mesh.cells, 2].mean(axis=1))
        body = of_materials(body, which, layers)
        flows = [here for (_, here), law in zip(body.parts, self.spec.barrier_laws, strict=False) if law]
        return replace(body, yields=g.may_yield["barrier"] & np.any([elastic, *flows], axis=0))

    @cached_property
    def barrier(self) -> MeshedBody | None:
        """Return the barrier with the masses of the run if it is meshed; thin rows gain mass in any case."""
        body, scaling = self.true_barrier, self.scaled_rod[1]
        if body is None or (scaling == 1 and not self.geometry.skin_rows):
            return body
        crossing = crossing_of(body, self.materials["barrier"])
        wanted = self.reference_time * sqrt(scaling)
        return replace(body, mass=body.mass * mass_factors(crossing, wanted)[:, None])

    @cached_property
    def added_mass(self) -> Array:
        """Return the masses of the run less the true ones (size,), kg."""
        true = [self.true_rod, self.true_barrier] if self.true_barrier else [self.true_rod]
        pairs = zip(self.bodies, true, strict=True)
        return assemble_masses([replace(a, mass=a.mass - b.mass) for a, b in pairs], self.layout)

    @cached_property
    def bodies(self) -> list[MeshedBody]:
        """Return the rod, and the barrier if it is meshed."""
        return [self.rod, self.barrier] if self.barrier else [self.rod]

    @cached_property
    def mass(self) -> Array:
        """Return the lumped masses (size,), kg, and the inertia of a turning barrier's foundation, kg m2."""
        mass = assemble_masses(self.bodies, self.layout)
        if not self.spec.vibrating:
            mass[self.layout.rod[-POINTS:]] = self.rest_mass / POINTS
        if self.scene.barrier.mass is not None:
            rest = self.rest_of_barrier
            mass[self.layout.foundation], mass[self.layout.turn] = rest.mass, rest.inertia
        return mass

    @cached_property
    def rest_of_barrier(self) -> RestOfBarrier:
        """Return what a free barrier has beside its block."""
        place, block = self.layout.barrier_slice, [self.barrier] if self.barrier else []
        mass = assemble_masses(block, self.layout)
        return rest_of(self.scene.barrier, mass[place], self.x[place])

    @cached_property
    def inverse_mass(self) -> Array:
        """Return the inverse lumped masses (size,), 1/kg, 0 where an unknown is fixed."""
        inverse = invert(self.mass, self.bodies)
        inverse[self.layout.foundation[1:2]] = 0.0  # symmetry
        if self.barrier and self.scene.barrier.boundary == "fixed":
            inverse[self.barrier.places[np.unique(self.barrier.mesh.faces_with(OUTER))]] = 0.0
        return inverse

    @cached_property
    def drawn(self) -> MassPoints:
        """Return the mass points of the rod's slices."""
        rod, body = self.scene.projectile, self.case.bodies.body
        tail = rod.segments[-1].material if rod.segments else rod.material
        bore = float(body.inner_radius(np.array(rod.length))) if isinstance(body, Turned) else 0.0
        return MassPoints.of_rod(self.geometry.rod, self.rod.mass, tail.rho, bore=bore)

    @cached_property
    def x(self) -> Array:
        """Return the positions (size,) of the mass points at time 0, m."""
        x = np.zeros(self.layout.size)
        x[self.layout.dummy] = dummy_element()
        for body in self.bodies:
            x[body.places] = body.points
        self.drawn.condense(self.layout.slices_of(x))
        return x

    def move_rod(self, t: float, n: float) -> None:
        """Shift the rod's start position by ``t`` and ``n``, m."""
        self.x[self.rod.places[:, [0, 2]]] += t, n
        self.geometry.rod_points[:, [0, 2]] = self.unmoved[:, [0, 2]] + (t, n)

    @cached_property
    def unmoved(self) -> Array:
        """Return the rod's positions (n, 3), m, before `move_rod`.

        Its stiffness is computed there, so that rods over all places of the barrier's grid share their modes.
        """
        return self.geometry.rod_points.copy()

    @cached_property
    def free_nodes(self) -> Ints:
        """Return the unknowns (k, 3) of the rod's free nodes, those that do not hang."""
        return self.rod.places[~self.rod.mesh.is_hanging]

    @cached_property
    def rod_stiffness(self) -> tuple[sp.csr_matrix, MassStiffness]:
        """Return both stiffnesses of the rod, N/m, see `nose_and_whole`."""
        unmoved = replace(self.rod, points=self.unmoved)
        return nose_and_whole(unmoved, self.geometry.rod, self.drawn, self.layout)

    def rod_modes(self) -> RodModes:
        """Return the free modes of the rod."""
        n = self.layout.rod_size
        return rod_modes(self.rod_stiffness[1], self.mass[:n], self.inverse_mass[:n] == 0)
