"""One free body as a model of the solver: any mesh, held unknowns, contact with the rigid plane.

The project's scenes are rods; these problems need balls, square bars and flat faces as well. All
operators, contact, ledger and the march are the solver's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_impact.modes import RigidMotion, rigid_motion
from fem_impact.solid.contact import ContactBook, PlaneContact
from fem_impact.solid.elastic import ElasticRod
from fem_impact.solid.elements import (
    Kind,
    element_stiffness,
    isotropic_stiffness,
    lumped_mass,
)
from fem_impact.solid.frame import FixedFrame, TurningFrame
from fem_impact.solid.geometry import Geometry
from fem_impact.solid.hardening import Hardening
from fem_impact.solid.items import Force, Impulse
from fem_impact.solid.layout import Layout, number
from fem_impact.solid.masspoints import MassPoints
from fem_impact.solid.model import Model
from fem_impact.solid.slices import SliceOperator
from fem_impact.solid.sparse import Hanging, NodeProduct, assemble, assemble_mass, tie_operator
from fem_impact.solid.stable import stable_step
from fem_impact.solid.state import State
from fem_impact.solid.yielding import YieldingZone, dummy_element
from meshes import HexMesh, RodMesh

__all__ = ["Body", "body_model", "placed", "rigid_of", "unsliced"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Body:
    """A body ready to be modelled, half of it at b >= 0.

    Attributes
    ----------
    mesh : RodMesh, with or without slices; points : (n, 3) positions in (t, b, n), m
    velocity : (n, 3) at the start, m/s
    E, nu, rho : material; law : hardening of the cells that ``yields`` (m,) names
    held : (n, 3) unknowns that cannot move besides those of the symmetry plane
    friction : Coulomb's coefficient on the plane n = 0, or None for no contact at all
    turning : the linear part follows large rotations
    """

    mesh: RodMesh
    points: Array
    velocity: Array
    E: float
    nu: float
    rho: float
    kind: Kind = "incompatible"
    law: Hardening | None = None
    yields: Bools | None = None
    held: Bools | None = None
    friction: float | None = None
    turning: bool = False


def unsliced(mesh: HexMesh) -> RodMesh:
    """Return a mesh as a body without slices."""
    nothing = np.zeros((0, 0), dtype=np.int64)
    return RodMesh(mesh, nothing, nothing, 0.0, 0.0)


def placed(points: Array, angle: float, gap: float) -> Array:
    """Return points turned by ``angle``, rad, about b and set with the lowest one at n = ``gap``."""
    c, s = np.cos(angle), np.sin(angle)
    turned = points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    turned[:, 2] += gap - turned[:, 2].min()
    return np.asarray(turned)


def rigid_of(model: Model, state: State) -> RigidMotion:
    """Return the rigid part of the body's motion."""
    places = model.layout.rod[~model.geometry.rod.mesh.is_hanging]
    return rigid_motion(state.x[places], state.v[places], model.mass[places[:, 0]])


def body_model(body: Body) -> Model:
    """Return the model of one body over the rigid plane n = 0."""
    mesh, layout = body.mesh.mesh, number(body.mesh, None)
    yields = body.yields if body.yields is not None else np.zeros(len(mesh.cells), dtype=bool)
    K = element_stiffness(body.points, mesh.cells, isotropic_stiffness(body.E, body.nu), body.kind)
    nodal = lumped_mass(body.points, mesh.cells, body.rho)
    T = tie_operator(mesh.tie, layout.rod, layout.size)
    mass = assemble_mass(nodal, mesh.cells, T)
    inverse = _inverse(body, mass, layout)
    drawn = MassPoints.of_rod(body.mesh, nodal, body.rho)
    x, v = _start(body, layout, drawn)
    forces: list[Force] = [_linear(body, K, ~yields, layout, mass, x, drawn)]
    zones = _zones(body, yields, layout)
    contact = _contact(body, layout, inverse)
    impulses: list[Impulse] = [contact] if contact else []
    own = tie_operator(mesh.tie, layout.rod, layout.rod_size)
    stiffness = drawn.reduced(assemble(K, mesh.cells, own), layout.body_shape[1])
    return Model(
        geometry=Geometry(body.mesh, body.points, None, 0.0, int(mesh.level.max())),
        layout=layout,
        mass=mass,
        inverse_mass=inverse,
        drawn=drawn,
        forces=[*forces, *zones],
        impulses=impulses,
        hanging=Hanging.of([(mesh.tie, layout.rod)]),
        zones=zones,
        book=contact.book if contact else ContactBook(),
        rod_stiffness=stiffness,
        steps={"rod": stable_step(stiffness, inverse[: layout.rod_size])},
        start=(x, v),
    )


def _inverse(body: Body, mass: Array, layout: Layout) -> Array:
    inverse = np.divide(1.0, mass, out=np.zeros_like(mass), where=mass > 0)
    inverse[layout.rod[np.abs(body.points[:, 1]) < 1e-12, 1]] = 0.0
    if body.held is not None:
        inverse[layout.rod[body.held]] = 0.0
    return inverse


def _start(body: Body, layout: Layout, drawn: MassPoints) -> tuple[Array, Array]:
    x, v = np.zeros(layout.size), np.zeros(layout.size)
    x[layout.dummy] = dummy_element()
    x[layout.rod] = body.points
    v[layout.rod] = body.velocity
    for vector in (x, v):
        drawn.draw_in(layout.slices_of(vector))
    if body.held is not None:
        v[layout.rod[body.held]] = 0.0
    return x, v


def _linear(
    body: Body, K: Array, linear: Bools, layout: Layout, mass: Array, x: Array, drawn: MassPoints
) -> ElasticRod:
    """Return the linear part: slices by stencil where the mesh has them, the rest by rows."""
    mesh, n = body.mesh.mesh, layout.rod_size
    rest = linear.copy()
    rest[body.mesh.body_cells] = False
    T = tie_operator(mesh.tie, layout.rod, n)
    free = layout.rod[~mesh.is_hanging]
    product = NodeProduct.of(assemble(K[rest], mesh.cells[rest], T), free) if rest.any() else _nothing()
    frame = TurningFrame.at(x[:n], mass[:n], free) if body.turning else FixedFrame(x[:n].copy())
    return ElasticRod(_slices(body, K), drawn, product, frame, layout, np.zeros(n), np.zeros(n))


def _nothing() -> NodeProduct:
    return NodeProduct(
        np.zeros((0, 3), np.int64),
        np.zeros(1, np.int64),
        np.zeros(0, np.int32),
        np.zeros(0, np.int32),
        np.zeros((0, 9)),
        np.zeros((0, 3)),
    )


def _slices(body: Body, K: Array) -> SliceOperator:
    if not body.mesh.body_cells.size:
        none = np.zeros(0)
        return SliceOperator(np.zeros(1, np.int64), np.zeros(0, np.int64), none, none, none, none)
    return SliceOperator.of_rod(body.mesh, K)


def _zones(body: Body, yields: Bools, layout: Layout) -> list[YieldingZone]:
    if body.law is None or not yields.any():
        return []
    cells = body.mesh.mesh.cells[yields]
    return [
        YieldingZone.of("rod", layout.rod[cells], body.points[cells], body.E, body.nu, body.law, layout.dummy)
    ]


def _contact(body: Body, layout: Layout, inverse: Array) -> PlaneContact | None:
    if body.friction is None:
        return None
    return PlaneContact(layout.rod[body.mesh.mesh.free_skin], inverse, body.friction)
