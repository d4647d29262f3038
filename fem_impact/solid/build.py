"""Build the model of a case: meshes, operators, masses, items, stable steps.

Modules that only some effects need are imported where they are used.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.arrays import Array, Bools
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import EFFECTS
from fem_impact.fem.body import Elastic, MeshedBodies, MeshedBody, slices_of
from fem_impact.fem.eigen import MassStiffness, rod_modes
from fem_impact.fem.geometry import POINTS, Geometry
from fem_impact.fem.layout import DofLayout
from fem_impact.fem.sliding import speed_table
from fem_impact.fem.sparse import Hanging, NodeProduct
from fem_impact.fem.stable import stable_step
from fem_impact.fem.uneven import uneven
from fem_impact.physics.hardening import HardeningLaw
from fem_impact.physics.viscous import LinearSolid, linear_solid
from fem_impact.solid.contact.moving_plane import MovingPlane
from fem_impact.solid.contact.patch import facing_skin, make_patch
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.points import make_points
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.elastic import ElasticRod, Weight
from fem_impact.solid.frame import FixedFrame, TurningFrame, mass_centre
from fem_impact.solid.ground import Ground
from fem_impact.solid.model import Model
from fem_impact.solid.state import Force, Impulse
from meshes import SKIN, RodMesh, face_at, owners
from rigid import Faceted

if TYPE_CHECKING:
    from fem_impact.solid.block import ElasticBlockParts
    from fem_impact.solid.elastic import ModalDamping
    from fem_impact.solid.foundation import FoundationSprings
    from fem_impact.solid.rigid_rest import RigidRest
    from fem_impact.solid.yielding import YieldingZone

START_GAP = 1e-10  # m, so small that contact begins in the first step, before gravity or spin acts
PLAY, BAND = 0.05, 0.02  # over the tip size, see `SurfaceContact`
Stage = Callable[[Geometry], None]


def yielding_zone(
    body: MeshedBody,
    law: HardeningLaw,
    layout: DofLayout,
    strength: Array | None = None,
    part: tuple[Elastic, Bools] | None = None,
) -> YieldingZone:
    """Return the item of a body's cells that may yield, their flow stress times ``strength`` (m, 8).

    ``part`` is the material and the mask (m,) of the cells that are meant, all of them unless stated.
    """
    from fem_impact.solid.yielding import YieldingZone

    m, chosen = part or (body.material, body.yields)
    cells = np.flatnonzero(body.yields & chosen)
    nodes = body.mesh.cells[cells]
    dof, points, full = body.places[nodes], body.points[nodes], body.yielding == "full"
    return YieldingZone.of(body.name, dof, points, m.E, m.nu, law, layout.dummy, full, strength, cells)


def surface_contact(
    bodies: list[MeshedBody],
    inverse_mass: Array,
    f: Array,
    over_speed: Array,
    h: float,
    x: Array,
    conforming: bool,
) -> SurfaceContact:
    """Return the contact of a rod's skin with a barrier's, whose cells are ``h`` m wide there.

    ``f`` (n,) are the Coulomb coefficients of the rod's nodes at rest, ``over_speed`` is a `speed_table`.
    """
    skins = [facing_skin(body) for body in bodies]
    rod, barrier = (
        make_patch(skin, body.places, body.points) for skin, body in zip(skins, bodies, strict=True)
    )
    rod, play = (rod.rounded(x), PLAY * h) if conforming else (rod, 0.0)
    f = f[np.unique(skins[0])]
    return SurfaceContact.of(rod, barrier, inverse_mass, f, over_speed, play, BAND * h, x)


class Builder:
    """The parts of a case's model; each is made at its first use and cached.

    ``stage`` is called once the meshes stand and before each body is assembled; what it raises ends the work.
    """

    def __init__(
        self, case: Case, gap: float, mesh: RodMesh | None = None, stage: Stage = lambda _: None
    ) -> None:
        self.case, self.scene, self.spec, self.stage = case, case.scene, case.slots, stage
        self.meshed = MeshedBodies(case, mesh)
        stage(self.meshed.geometry)
        # the rod comes down without rotation until the skins are a ``gap`` apart, and goes one cell at most
        # along t, where it comes down almost tangentially
        height, h = self.contact.clearance(self.meshed.x) - gap, self.meshed.geometry.tip_size
        slid = case.contact.sliding * height / case.contact.approach
        self.meshed.move_rod(min(max(slid, -h), h), -height)

    @cached_property
    def v(self) -> Array:
        """Return the velocities (size,) of the mass points at time 0, m/s; omega is positive from n to t."""
        v, impact = np.zeros(self.meshed.layout.size), self.scene.relative
        places, x = self.meshed.rod.places, self.meshed.x
        arm = x[places] - mass_centre(self.meshed.mass, x, places)
        v[places[:, 0]] = impact.v_t + impact.omega * arm[:, 2]
        v[places[:, 2]] = impact.v_n - impact.omega * arm[:, 0]
        return v

    @cached_property
    def frame(self) -> FixedFrame | TurningFrame:
        """Return the frame of the rod's linear part; a rigid rest turns, and its nose must follow it."""
        x = self.meshed.x[: self.meshed.layout.rod_size]
        if self.spec.turning_frame or not self.spec.vibrating:
            return TurningFrame.at(x, self.meshed.mass[: len(x)], self.meshed.free_nodes)
        return FixedFrame(x.copy())

    @cached_property
    def elastic_rod(self) -> tuple[ElasticRod, MassStiffness]:
        """Return the rod's linear part, and its elastic stiffness over its mass points, N/m."""
        n, mesh = self.meshed.layout.rod_size, self.meshed.geometry.rod
        self.stage(self.meshed.geometry)
        nose, whole = self.meshed.rod_stiffness
        product, d, y = NodeProduct.of(nose, self.meshed.free_nodes), np.zeros(n), np.zeros(n)
        linear = slices_of(self.meshed.rod, mesh), self.meshed.drawn, product
        effect = "vibration" if self.spec.vibrating else "nose"
        return ElasticRod(*linear, self.frame, self.meshed.layout, d, y, effect), whole

    @cached_property
    def block_parts(self) -> ElasticBlockParts:
        """Return the operators of a meshed barrier."""
        from fem_impact.solid.block import elastic_block

        assert self.meshed.barrier is not None, "the barrier is meshed"
        effect = "barrier-elastoplastic" if any(self.spec.barrier_laws) else "barrier-elastic"
        where, g = (self.meshed.layout, self.meshed.x), self.meshed.geometry
        return elastic_block(self.meshed.barrier, *where, effect, self.spec.bending, g.middle, g.half)

    @cached_property
    def ground(self) -> Ground:
        """Return the motion of the barrier as a whole."""
        turns = len(self.meshed.layout.turn) > 0
        return Ground.of(self.meshed.layout, self.meshed.rest_of_barrier.centre if turns else np.zeros(2))

    @cached_property
    def block(self) -> tuple[list[Force], list[Impulse], dict[str, float]]:
        """Return the items of a meshed barrier and its stable step, s, under its name; empty without one."""
        if self.meshed.barrier is None:
            return [], [], {}
        from fem_impact.solid.block import dashpots, plate_dashpots

        self.stage(self.meshed.geometry)
        block, layout = self.block_parts, self.meshed.layout
        inverse, share = self.meshed.inverse_mass, self.scene.accuracy.step
        step = stable_step(block.stiffness, inverse[layout.barrier_slice], share)
        if self.scene.barrier.mass is not None:
            step = self.foundation_step(step)
        lasts = self.case.zones.lasts or self.case.estimate.duration
        pots = [dashpots(self.meshed.barrier, layout, inverse, block, lasts)] if self.spec.radiating else []
        if self.spec.bending:
            pots = [plate_dashpots(layout, inverse, block)]
        if not self.ground.turns:
            return [block.linear], [*pots], {"barrier": step}
        from fem_impact.solid.turning import TurningBlock, TurningDashpots

        ground, place = self.ground, layout.barrier_slice
        linear = TurningBlock.of(block.linear.stiffness, place, ground, block.linear.effect)
        turning = [TurningDashpots.of(p.places, p.damping, inverse, ground, place.start) for p in pots]
        return [linear], [*turning], {"barrier": step}

    def foundation_step(self, block: float) -> float:
        """Return the stable step of a block with its foundation, s, from that of a ``block`` without one."""
        from fem_impact.solid.turning import foundation_step

        layout, inverse = self.meshed.layout, self.meshed.inverse_mass
        moves = np.zeros(3)  # no angle where it does not turn
        moves[: 2 + len(layout.turn)] = inverse[[*layout.foundation[[0, 2]], *layout.turn]]
        springs, x = self.block_parts.springs.diagonal(), self.meshed.x[layout.barrier_slice]
        return foundation_step(block, self.scene.accuracy.step, springs, self.ground, moves, x)

    @cached_property
    def foundation(self) -> list[FoundationSprings]:
        """Return the springs between a block and a foundation that does not turn, if there are both."""
        if self.meshed.barrier is None or self.scene.barrier.mass is None or self.ground.turns:
            return []
        from fem_impact.solid.foundation import FoundationSprings

        stiffness, effect = self.block_parts.springs.diagonal(), self.block_parts.linear.effect
        return [FoundationSprings.of(stiffness, self.meshed.layout, self.meshed.x, effect)]

    @cached_property
    def steps(self) -> dict[str, float]:
        """Return the stable step of each body with its safety factor, s."""
        # the block first: the memory that its assembly frees is used again for the rod's stiffness
        _, _, steps = self.block
        _, stiffness = self.elastic_rod
        inverse = self.meshed.inverse_mass[: self.meshed.layout.rod_size]
        step = stable_step(stiffness, inverse, self.scene.accuracy.step)
        return steps | {"rod": step / sqrt(self.viscous.stiffest if self.viscous else 1.0)}

    @cached_property
    def viscous(self) -> LinearSolid | None:
        """Return the law of a rod that is viscous."""
        loss = self.scene.projectile.material.loss_factor
        if self.spec.contact_loss is None or not loss:
            return None
        return linear_solid(loss, self.case.estimate.duration)

    @cached_property
    def zones(self) -> list[YieldingZone]:
        """Return the zone of each body that yields, of each of its materials."""
        zones, laws = [], ((self.spec.rod_law,), self.spec.barrier_laws)
        for body, of_parts in zip(self.meshed.bodies, laws, strict=False):
            for part, law in zip(body.parts, of_parts, strict=False):
                if law and ((part[1] & body.yields).any() or len(body.parts) == 1):
                    strength = self.strength(body, part[1])
                    zones.append(yielding_zone(body, law, self.meshed.layout, strength, part))
        return zones

    def strength(self, body: MeshedBody, here: Bools) -> Array | None:
        """Return the factor of the flow stress (m, 8) of a part's yielding cells, None without a layer."""
        skin = self.spec.rod_skin if body.name == "rod" else self.spec.barrier_skin
        if skin is None:
            return None
        from fem_impact.solid.skin import below_outline, strengths

        under = -body.points[:, 2]
        if body.name == "rod":
            rod = self.case.bodies.body
            assert not isinstance(rod, Faceted), "the case refuses a hardened layer on a mesh of its own"
            outline = np.vstack([rod.meridian(), [rod.diameter / 2, rod.length]])
            under = below_outline(self.meshed.geometry.rod.mesh.points, outline)
        return strengths(body.mesh.cells[body.yields & here], under, skin)

    @cached_property
    def contact(self) -> PlaneContact | MovingPlane | SurfaceContact:
        """Return the contact; the rigid section behind the nose of a rigid rod has no part in it."""
        g, f = self.meshed.geometry, self.friction
        over_speed = speed_table(self.spec.friction_over_speed)
        if self.meshed.barrier:
            place = g.barrier_size, self.meshed.x, g.conforming
            return surface_contact(self.meshed.bodies, self.meshed.inverse_mass, f, over_speed, *place)
        skin = g.rod.mesh.free_skin
        if not self.spec.vibrating:
            skin = np.setdiff1d(skin, g.rod.body_nodes)
        nodes, inverse = self.meshed.rod.places[skin], self.meshed.inverse_mass
        if self.scene.barrier.mass is not None:
            return MovingPlane(nodes, self.ground, inverse, f[skin], make_points(len(nodes), over_speed))
        return PlaneContact(nodes, inverse, f[skin], over_speed)

    @cached_property
    def friction(self) -> Array:
        """Return the Coulomb coefficient (n,) of each node of the rod's mesh.

        Between faces of several states of their surface the largest counts.
        """
        mesh, rod = self.meshed.geometry.rod.mesh, self.scene.projectile
        f = np.full(len(mesh.points), self.spec.friction or 0.0)
        if self.spec.friction is None or not rod.faces:
            return f
        assert mesh.region is not None and rod.own_mesh is not None, (
            "the cells of a mesh of its own are numbered"
        )
        half, quads = rod.own_mesh.half(), mesh.faces_with(SKIN)
        cell = mesh.region[owners(mesh)[mesh.face_tag == SKIN]]
        at = face_at(mesh.points[quads].mean(axis=1), cell, half.points, half.faces, owners(half))
        f[quads] = 0.0
        np.maximum.at(f, quads, rod.face_friction(self.spec.friction)[at, None])
        return f

    def weight(self, gravity: float) -> Weight:
        """Return the rod's weight under the acceleration ``gravity``, m/s2."""
        n, alpha = self.meshed.layout.rod_size, self.scene.impact.vertical
        down, places = np.zeros(self.meshed.layout.size), self.meshed.rod.places
        down[places[:, 0]], down[places[:, 2]] = -np.sin(alpha), -np.cos(alpha)
        return Weight(gravity * self.meshed.mass[:n] * down[:n], self.meshed.x[:n].copy())

    def damping(self, loss: float) -> ModalDamping:
        """Return the damping of the rod's modes with the loss factor ``loss``."""
        from fem_impact.solid.elastic import ModalDamping

        _, K = self.elastic_rod
        inverse = self.meshed.inverse_mass[: K.shape[0]]
        modes = rod_modes(K, self.meshed.mass[: K.shape[0]], inverse == 0)
        return ModalDamping.of(modes, self.frame, inverse, self.meshed.free_nodes, loss, self.steps["rod"])

    def rigid_rest(self) -> RigidRest:
        """Return the rigid body behind the nose: the nose's last section and the points behind it."""
        from fem_impact.solid.rigid_rest import RigidRest

        rod = self.meshed.layout.rod
        places = np.concatenate([rod[self.meshed.geometry.rod.body_nodes[:, 0]], rod[-POINTS:]])
        return RigidRest(places, self.meshed.mass[places[:, 0]])

    def forces(self) -> list[Force]:
        """Return the items that add forces, in their order."""
        (linear, _), (block, _, _), gravity = self.elastic_rod, self.block, self.spec.gravity
        weight = [] if gravity is None else [self.weight(gravity)]
        own = [item for name in self.case.active for item in EFFECTS[name].forces(self)]
        maxwell = []
        if self.viscous:
            from fem_impact.solid.viscous import MaxwellCells

            maxwell = [MaxwellCells.of(linear, self.viscous)]
        return [linear, *maxwell, *weight, *block, *self.foundation, *self.zones, *own]

    def impulses(self) -> list[Impulse]:
        """Return the items that change velocities, in their order, which ends with the contact."""
        (_, pots, _), loss = self.block, self.spec.loss_factor
        rest = [] if self.spec.vibrating else [self.rigid_rest()]
        damping = [] if loss is None or self.viscous else [self.damping(loss)]
        own = [item for name in self.case.active for item in EFFECTS[name].impulses(self)]
        return [*rest, *damping, *pots, *own, *self.contacts()]

    def contacts(self) -> list[Impulse]:
        """Return the contact, within the frame of a plate that bends."""
        if self.spec.plate is None or isinstance(self.contact, MovingPlane):
            return [self.contact]
        from fem_impact.solid.foundation import on_plate

        return on_plate(self.contact, int(self.meshed.layout.foundation[2]), self.spec.plate)

    def model(self) -> Model:
        """Return the model."""
        steps, (linear, stiffness) = self.steps, self.elastic_rod
        return Model(
            geometry=self.meshed.geometry,
            layout=self.meshed.layout,
            mass=self.meshed.mass,
            inverse_mass=self.meshed.inverse_mass,
            added_mass=self.meshed.added_mass,
            scaling=self.meshed.scaled_rod[1],
            drawn=self.meshed.drawn,
            forces=self.forces(),
            impulses=self.impulses(),
            rod=linear,
            zones=self.zones,
            contact=self.contact,
            ground=self.ground,
            hanging=Hanging.of([(body.mesh.tie, body.places) for body in self.meshed.bodies]),
            rod_stiffness=stiffness if self.spec.vibrating else None,
            steps=steps,
            start=(self.meshed.x, self.v),
            uneven=uneven(self.meshed),
        )


def build(
    case: Case, gap: float = START_GAP, mesh: RodMesh | None = None, stage: Stage = lambda _: None
) -> Model:
    """Return the model of a scene; parts whose slot is empty are never made.

    ``gap`` is the least height of the rod's skin over the barrier's at time 0, m; below 0 bodies overlap. A
    rod that has struck before keeps its ``mesh``. ``stage``: see `Builder`.

    Raises
    ------
    SceneError
        If the tip is so coarse that there is no fine zone to touch or to yield in.
    """
    return Builder(case, gap, mesh, stage).model()
