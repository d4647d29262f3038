"""A meshed body and its stiffness, assembled without ever keeping all element matrices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.fem.eigen import MassStiffness
from fem_impact.fem.elements import Kind, element_stiffness, isotropic_stiffness, lumped_mass
from fem_impact.fem.layout import DofLayout, MassPoints
from fem_impact.fem.slices import SliceOperator
from fem_impact.fem.sparse import assemble, tie_operator
from meshes import HexMesh, RodMesh


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
    C, cells = isotropic_stiffness(body.material.E, body.material.nu), body.mesh.cells
    elastic = assemble(body.points, cells[chosen & ~body.yields], C, body.element, T)
    return elastic + assemble(body.points, cells[chosen & body.yields], C, "bbar", T)


def slices_of(body: MeshedBody, rod: RodMesh) -> SliceOperator:
    """Return the operator of the rod's slices, all like the first."""
    m, first = body.material, body.mesh.cells[rod.body_cells[:, 0]]
    K = element_stiffness(body.points, first, isotropic_stiffness(m.E, m.nu), body.element)
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
