"""One free body as a model of the solver, for what no scene says: all else of the problems are scenes.

These are a bar that flows as a whole (``taylor``), a rigid cone that is driven (``hardness``), a plate that
is meshed through although it is thick beside its contact (``thin-plate``), and balls whose skin is finer and
rounder, whose masses are mended and whose block has more rows around its contact than those of a scene
(``hertz``, ``oblique-sphere``). A scene's ball touches as well, but its moment of inertia is 2 % (8 cells
across) and 1.3 % (16) too large, and so is its spin too small; a block under it radiates 4.0 % too much where
3.0 % are allowed. Operators, contact, ledger and the march are the solver's.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from fem_impact.arrays import Array, Bools
from fem_impact.fem.body import MeshedBody, assemble_masses, invert, make_body, nose_and_whole, slices_of
from fem_impact.fem.eigen import MassStiffness
from fem_impact.fem.geometry import Geometry
from fem_impact.fem.hexmodes import dummy_element
from fem_impact.fem.layout import DofLayout, MassPoints, number
from fem_impact.fem.sliding import speed_table
from fem_impact.fem.sparse import Hanging, NodeProduct
from fem_impact.fem.stable import stable_step
from fem_impact.physics.hardening import Hardening
from fem_impact.solid import build
from fem_impact.solid.block import dashpots, elastic_block, plate_dashpots
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.elastic import ElasticRod
from fem_impact.solid.frame import FixedFrame, TurningFrame
from fem_impact.solid.ground import Ground
from fem_impact.solid.model import Model
from fem_impact.solid.state import Force, Impulse
from meshes import HexMesh, RodMesh


@dataclass(frozen=True, slots=True)
class Block:
    """The barrier under a body: a half-space around the origin, its top at n = 0.

    Attributes
    ----------
    mesh : as fine as the body around the contact; its outer faces carry on as springs and dashpots
    size : cell edge at the contact, m
    E, nu, rho : material; law : hardening of its finest cells, or None where it stays elastic
    bending : of a plate meshed through its thickness, the phase speed of the waves that leave its edges, m/s
    """

    mesh: HexMesh
    size: float
    E: float
    nu: float
    rho: float
    law: Hardening | None = None
    bending: float | None = None


@dataclass(frozen=True, slots=True)
class FreeBody:
    """A body ready to be modelled, half of it at b >= 0.

    Attributes
    ----------
    mesh : RodMesh, with or without slices; points : (n, 3) positions in (t, b, n), m
    velocity : (n, 3), or (3,) of all points, at the start, m/s
    E, nu, rho : material; law : hardening of the cells that ``yields`` (m,) names
    denser : (m,) or (1,) density of each cell over rho
    friction : Coulomb's coefficient, or None for no contact at all
    block : what it strikes, or None for the rigid plane n = 0
    turning : the linear part follows large rotations
    driven : it keeps its velocity whatever pushes it, a rigid body on a block
    """

    mesh: RodMesh
    points: Array
    velocity: Array
    E: float
    nu: float
    rho: float
    denser: Array = field(default_factory=lambda: np.ones(1))
    law: Hardening | None = None
    yields: Bools | None = None
    friction: float | None = None
    block: Block | None = None
    turning: bool = False
    driven: bool = False


def placed(points: Array, angle: float, gap: float) -> Array:
    """Return points turned by ``angle``, rad, about b and set with the lowest one at n = ``gap``."""
    c, s = np.cos(angle), np.sin(angle)
    turned = points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    turned[:, 2] += gap - turned[:, 2].min()
    return np.asarray(turned)


def body_model(body: FreeBody) -> Model:
    """Return the model of one body over the rigid plane n = 0, or over its block."""
    block = body.block
    layout = number(body.mesh, block.mesh if block else None)
    mesh, yields = body.mesh.mesh, body.yields
    yields = np.zeros(len(mesh.cells), dtype=bool) if yields is None else yields
    rod = make_body("rod", mesh, body.points, layout.rod, body, yields)
    parts = [replace(rod, mass=rod.mass * body.denser[:, None])]
    if block:
        yields = block.mesh.finest & (block.law is not None)
        parts.append(make_body("barrier", block.mesh, block.mesh.points, layout.barrier, block, yields))
    mass = assemble_masses(parts, layout)
    inverse = invert(mass, parts)
    if body.driven:
        inverse[: layout.rod_size] = 0.0
    drawn = MassPoints.of_rod(body.mesh, parts[0].mass, body.rho)
    x, v = np.zeros(layout.size), np.zeros(layout.size)
    x[layout.dummy] = dummy_element()
    for part in parts:
        x[part.places] = part.points
    v[layout.rod] = body.velocity
    for vector in (x, v):
        drawn.condense(layout.slices_of(vector))
    zones = [
        build.yielding_zone(part, law, layout)
        for part, law in zip(parts, (body.law, block.law if block else None), strict=False)
        if law and part.yields.any()
    ]
    linear, stiffness = _linear(body, parts[0], layout, mass, x, drawn)
    forces: list[Force] = [linear, *zones]
    impulses: list[Impulse] = []
    n, place = layout.rod_size, layout.barrier_slice
    steps = {} if body.driven else {"rod": stable_step(stiffness, inverse[:n])}
    if block:
        around = elastic_block(parts[1], layout, x, bending=block.bending)
        steps["barrier"] = stable_step(around.stiffness, inverse[place])
        forces.append(around.linear)
        if block.bending:
            impulses.append(plate_dashpots(layout, inverse, around))
        else:
            impulses.append(dashpots(parts[1], layout, inverse, around))
    if contact := _contact(body, parts, inverse, x):
        impulses.append(contact)
    return Model(
        geometry=Geometry(body.mesh, body.points, block.mesh if block else None, 0.0, 0.0),
        layout=layout,
        mass=mass,
        inverse_mass=inverse,
        added_mass=np.zeros_like(mass),
        scaling=1.0,
        drawn=drawn,
        forces=forces,
        impulses=impulses,
        rod=linear,
        zones=zones,
        contact=contact,
        ground=Ground.of(layout, np.zeros(2)),
        hanging=Hanging.of([(part.mesh.tie, part.places) for part in parts]),
        rod_stiffness=stiffness,
        steps=steps,
        start=(x, v),
    )


def _linear(
    body: FreeBody, part: MeshedBody, layout: DofLayout, mass: Array, x: Array, drawn: MassPoints
) -> tuple[ElasticRod, MassStiffness]:
    """Return the linear part, slices by stencil where there are any, the rest by rows; and the stiffness."""
    n, free = layout.rod_size, layout.rod[~part.mesh.is_hanging]
    nose, whole = nose_and_whole(part, body.mesh, drawn, layout)
    frame = TurningFrame.at(x[:n], mass[:n], free) if body.turning else FixedFrame(x[:n].copy())
    slices = slices_of(part, body.mesh)
    rod = ElasticRod(slices, drawn, NodeProduct.of(nose, free), frame, layout, np.zeros(n), np.zeros(n))
    return rod, whole


def _contact(
    body: FreeBody, parts: list[MeshedBody], inverse: Array, x: Array
) -> PlaneContact | SurfaceContact | None:
    if body.friction is None:
        return None
    if body.block is None:
        skin = body.mesh.mesh.free_skin
        return PlaneContact(parts[0].places[skin], inverse, np.full(len(skin), body.friction))
    conforming, f = body.block.law is not None, np.full(len(parts[0].points), body.friction)
    return build.surface_contact(parts, inverse, f, speed_table(None), body.block.size, x, conforming)
