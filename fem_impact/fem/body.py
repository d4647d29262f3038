"""A meshed body and its stiffness, assembled without ever keeping all element matrices."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.fem.eigen import MassStiffness, RodModes, rod_modes
from fem_impact.fem.elements import Kind, element_stiffness, lame_constants, lumped_mass
from fem_impact.fem.geometry import HEAVY, POINTS, Geometry, build_geometry, rest_mass
from fem_impact.fem.hexmodes import dummy_element
from fem_impact.fem.layout import DofLayout, MassPoints, number
from fem_impact.fem.slices import SliceOperator
from fem_impact.fem.sparse import assemble, assemble_mass, tie_operator
from fem_impact.physics.contact import projectile
from fem_impact.plan.plan import Plan
from meshes import HexMesh, RodMesh

HEIGHT = 2e-6  # m of the rod's lowest point over the barrier where it is meshed


class Elastic(Protocol):
    """What an operator needs of a material: E, Pa; nu; rho, kg/m3."""

    @property
    def E(self) -> float: ...  # noqa: D102
    @property
    def nu(self) -> float: ...  # noqa: D102
    @property
    def rho(self) -> float: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class MeshedBody:
    """One meshed body ready for assembly.

    Attributes
    ----------
    points, places : (n, 3), positions in the barrier frame and unknowns of all nodes
    yields : (m,) cells that may yield; element : kind of the others
    mass : (m, 8) lumped
    """

    name: str
    mesh: HexMesh
    points: Array
    places: Ints
    material: Elastic
    yields: Bools
    element: Kind
    mass: Array


def make_body(
    name: str,
    mesh: HexMesh,
    points: Array,
    places: Ints,
    material: Elastic,
    yields: Bools,
    element: Kind = "incompatible",
) -> MeshedBody:
    """Return a body with its masses; ``element`` is that of cells that cannot yield."""
    mass = lumped_mass(points, mesh.cells, material.rho)
    return MeshedBody(name, mesh, points, places, material, yields, element, mass)


def stiffness_of(body: MeshedBody, chosen: Bools, size: int, shift: int = 0) -> sp.csr_matrix:
    """Return the stiffness of ``chosen`` cells over ``size`` unknowns, those from ``shift`` on."""
    T = tie_operator(body.mesh.tie, body.places - shift, size)
    lame, cells = lame_constants(body.material.E, body.material.nu), body.mesh.cells
    elastic = assemble(body.points, cells[chosen & ~body.yields], lame, body.element, T)
    return elastic + assemble(body.points, cells[chosen & body.yields], lame, "bbar", T)


def slices_of(body: MeshedBody, rod: RodMesh) -> SliceOperator:
    """Return the operator of the rod's slices, all like the first."""
    m, first = body.material, body.mesh.cells[rod.body_cells[:, 0]]
    K = element_stiffness(body.points, first, lame_constants(m.E, m.nu), body.element)
    return SliceOperator.of_rod(rod, K)


def nose_and_whole(
    body: MeshedBody, rod: RodMesh, drawn: MassPoints, layout: DofLayout
) -> tuple[sp.csr_matrix, MassStiffness]:
    """Return the rod's stiffness over its free unknowns: of cells neither sliced nor yielding, and of all.

    The second is that over the masses.
    """
    sliced, n = np.zeros(len(body.mesh.cells), dtype=bool), layout.rod_size
    sliced[rod.body_cells] = True
    nose = stiffness_of(body, ~sliced & ~body.yields, n)
    rest = stiffness_of(body, sliced | body.yields, n)
    return nose, drawn.reduced((nose, rest), layout.body_shape[1])


def skin_weight(barrier: HexMesh, h: float) -> Array:
    """Return the factor (m,) of the masses of a barrier's cells, ``h`` m wide at the contact.

    One as low as c h with c < `HEAVY` gets (`HEAVY` / c)^2 times its mass, and so the step of one `HEAVY` h
    high. These cells move no faster than the indentation grows.
    """
    z = barrier.points[barrier.cells][:, :, 2]
    return np.asarray(np.maximum(1.0, HEAVY * h / np.ptp(z, axis=1)) ** 2)


def assemble_masses(bodies: list[MeshedBody], layout: DofLayout) -> Array:
    """Return the lumped masses (size,), kg."""
    mass = np.zeros(layout.size)
    for body in bodies:
        T = tie_operator(body.mesh.tie, body.places, layout.size)
        mass += assemble_mass(body.mass, body.mesh.cells, T)
    return mass


def invert(mass: Array, bodies: list[MeshedBody]) -> Array:
    """Invert; nothing moves through the symmetry plane."""
    inverse = np.divide(1.0, mass, out=np.zeros_like(mass), where=mass > 0)
    for body in bodies:
        inverse[body.places[np.abs(body.points[:, 1]) < 1e-12, 1]] = 0.0
    return inverse


class MeshedBodies:
    """The meshed bodies of a plan, their masses and places; each part is made when asked for, and kept."""

    def __init__(self, plan: Plan) -> None:
        self.plan, self.scene, self.spec = plan, plan.scene, plan.slots

    @cached_property
    def geometry(self) -> Geometry:
        """Return the meshes."""
        return build_geometry(
            self.scene, self.plan.zones, HEIGHT, self.spec.meshed_barrier, self.spec.vibrating
        )

    @cached_property
    def layout(self) -> DofLayout:
        """Return the places of the unknowns."""
        return number(self.geometry.rod, self.geometry.barrier)

    @cached_property
    def rest_mass(self) -> float:
        """Return the mass, kg, of half the rigid cylinder behind the nose; 0 where the rod vibrates."""
        if self.spec.vibrating:
            return 0.0
        rod = self.scene.projectile
        return rest_mass(self.geometry.rod.body_start, rod.length, rod.diameter, rod.material.rho)

    @cached_property
    def rod(self) -> MeshedBody:
        """Return the meshed rod of true mass: its nose's cells get what flat faces cut off the round skin."""
        g, yields = self.geometry, self.geometry.may_yield["rod"] & (self.spec.rod_law is not None)
        steel, kind = self.scene.projectile.material, self.scene.accuracy.element
        rod = make_body("rod", g.rod.mesh, g.rod_points, self.layout.rod, steel, yields, kind)
        nose = np.ones(len(rod.mass), dtype=bool)
        nose[g.rod.body_cells] = False
        missing = projectile(self.scene).mass / 2 - rod.mass.sum() - self.rest_mass
        rod.mass[nose] *= 1 + missing / rod.mass[nose].sum()
        return rod

    @cached_property
    def barrier(self) -> MeshedBody | None:
        """Return the barrier if it is meshed."""
        g, mesh = self.geometry, self.geometry.barrier
        if mesh is None:
            return None
        yields = g.may_yield["barrier"] & (self.spec.barrier_law is not None)
        steel, kind = self.scene.barrier.material, self.scene.accuracy.element
        barrier = make_body("barrier", mesh, mesh.points, self.layout.barrier, steel, yields, kind)
        if g.skin_rows:
            barrier.mass[:] *= skin_weight(mesh, g.tip_size)[:, None]
        return barrier

    @cached_property
    def bodies(self) -> list[MeshedBody]:
        """Return the rod, and the barrier if it is meshed."""
        return [self.rod, self.barrier] if self.barrier else [self.rod]

    @cached_property
    def mass(self) -> Array:
        """Return the lumped masses (size,), kg."""
        mass = assemble_masses(self.bodies, self.layout)
        if not self.spec.vibrating:
            mass[self.layout.rod[-POINTS:]] = self.rest_mass / POINTS
        return mass

    @cached_property
    def inverse_mass(self) -> Array:
        """Return (size,), 1/kg, 0 where nothing may move."""
        return invert(self.mass, self.bodies)

    @cached_property
    def drawn(self) -> MassPoints:
        """Return where the rod's masses sit."""
        return MassPoints.of_rod(self.geometry.rod, self.rod.mass, self.rod.material.rho)

    @cached_property
    def x(self) -> Array:
        """Return the positions (size,) of the masses at time 0, m."""
        x = np.zeros(self.layout.size)
        x[self.layout.dummy] = dummy_element()
        for body in self.bodies:
            x[body.places] = body.points
        self.drawn.draw_in(self.layout.slices_of(x))
        return x

    def move_rod(self, t: float, n: float) -> None:
        """Move the rod at time 0 along t and n, m."""
        self.x[self.rod.places[:, [0, 2]]] += t, n
        self.geometry.rod_points[:, [0, 2]] += t, n

    @cached_property
    def free_nodes(self) -> Ints:
        """Return the unknowns (k, 3) of the rod's nodes that do not hang."""
        return self.rod.places[~self.rod.mesh.is_hanging]

    @cached_property
    def rod_stiffness(self) -> tuple[sp.csr_matrix, MassStiffness]:
        """Return the stiffness of the nose's elastic cells, and that of the whole rod over its masses."""
        return nose_and_whole(self.rod, self.geometry.rod, self.drawn, self.layout)

    def rod_modes(self) -> RodModes:
        """Return the free modes of the rod."""
        n = self.layout.rod_size
        return rod_modes(self.rod_stiffness[1], self.mass[:n], self.inverse_mass[:n] == 0)
