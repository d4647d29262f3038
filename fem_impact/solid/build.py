"""From a scene and its filled slots to a model: meshes, operators, masses, items, step.

What only some effects need is imported where it is built.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array, Ints
from fem_impact.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.fem.body import MeshedBody, make_body, nose_and_whole, slices_of, stiffness_of
from fem_impact.fem.eigen import MassStiffness, rod_modes
from fem_impact.fem.geometry import HEAVY, Geometry, build_geometry, levels_of
from fem_impact.fem.hexmodes import dummy_element
from fem_impact.fem.layout import DofLayout, MassPoints, number
from fem_impact.fem.sparse import Hanging, NodeProduct, assemble_mass, tie_operator
from fem_impact.fem.stable import stable_step
from fem_impact.physics.contact import projectile
from fem_impact.physics.hardening import Hardening
from fem_impact.solid.contact.patch import STEEP, make_patch
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.elastic import Dashpots, ElasticBlock, ElasticRod, Weight
from fem_impact.solid.frame import FixedFrame, TurningFrame, mass_centre
from fem_impact.solid.items import Force, Impulse
from fem_impact.solid.model import Model
from meshes import SKIN, HexMesh

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene
    from fem_impact.solid.elastic import ModalDamping
    from fem_impact.solid.rigid_rest import ElasticNose, RigidRest
    from fem_impact.solid.yielding import YieldingZone


START_GAP = 2e-6  # m between the lowest point and the barrier at time 0
PLAY, BAND = 0.05, 0.02  # of the contact, over the tip size, see SurfaceContact


def require_fine_zone(scene: Scene, spec: ModelSpec) -> None:
    """Refuse a tip without a fine zone where one is needed (SceneError)."""
    if levels_of(scene) == 0 and (spec.meshed_barrier or spec.rod_law is not None):
        base = scene.projectile.diameter / scene.accuracy.across
        raise SceneError(
            "leaves the tip as coarse as the rod: nothing could yield, and the barrier has no fine zone.",
            key="accuracy.tip_size",
            value=scene.accuracy.tip_size,
            remedy=f"Give at most {0.7 * base * 1e3:.2g} mm, or the barrier-rigid effect on an elastic rod.",
        )


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


@dataclass(frozen=True, slots=True)
class Block:
    """A meshed barrier and the half-space around it.

    Attributes
    ----------
    linear : the item of its linear part
    stiffness : (size, size) of all its cells, N/m
    springs, pots : (size, size), N/m, and (size,), N s/m, of the half-space
    """

    linear: ElasticBlock
    stiffness: sp.csr_matrix
    springs: sp.dia_matrix
    pots: Array


def elastic_block(body: MeshedBody, layout: DofLayout, x: Array, effect: str = "barrier-elastic") -> Block:
    """Return a meshed barrier at positions ``x`` (size,), with springs and dashpots around it."""
    from fem_impact.fem.boundary import spread_boundary

    place = layout.barrier_slice
    shifted, n = body.places - place.start, place.stop - place.start
    T = tie_operator(body.mesh.tie, shifted, n)
    m = body.material
    spring, damping = spread_boundary(body.mesh, m.E, m.nu, m.rho)
    springs, pots = sp.diags(T.T @ spring.ravel()), T.T @ damping.ravel()
    linear = stiffness_of(body, ~body.yields, n, place.start)
    K = sp.csr_matrix(linear + springs)
    K.eliminate_zeros()  # nodes inside the yielding zone have no linear part
    item = ElasticBlock(NodeProduct.of(K, shifted[~body.mesh.is_hanging], x[place]), place, effect)
    return Block(item, linear + stiffness_of(body, body.yields, n, place.start), springs, pots)


def dashpots(body: MeshedBody, layout: DofLayout, inverse_mass: Array, block: Block) -> Dashpots:
    """Return the radiating boundary of a block."""
    from fem_impact.fem.boundary import radiating_share

    place, m = layout.barrier_slice, body.material
    nearest = np.linalg.norm(body.points, axis=1) + body.mesh.is_hanging
    loaded = int(body.places[int(nearest.argmin()), 2]) - place.start
    held, K = inverse_mass[place] == 0, sp.csr_matrix(block.stiffness + block.springs)
    damping = block.pots * radiating_share(K, block.pots, held, loaded, (m.E, m.nu, m.rho))
    places = place.start + np.flatnonzero(damping)
    places = places[inverse_mass[places] > 0]
    return Dashpots(places, damping[places - place.start], inverse_mass[places])


def yielding_zone(body: MeshedBody, law: Hardening, layout: DofLayout) -> YieldingZone:
    """Return the cells that may yield as one item."""
    from fem_impact.solid.yielding import YieldingZone

    cells, m = body.mesh.cells[body.yields], body.material
    return YieldingZone.of(body.name, body.places[cells], body.points[cells], m.E, m.nu, law, layout.dummy)


def facing_skin(body: MeshedBody) -> Ints:
    """Return the skin quads (m, 4) of the finest cells, all nodes free, facing the other body."""
    quads = body.mesh.faces_with(SKIN)
    corners = body.points[quads]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    steep = normal[:, 2] / np.linalg.norm(normal, axis=1)
    facing = steep < -STEEP if body.name == "rod" else steep > STEEP
    finest = np.isin(quads, body.mesh.cells[body.mesh.finest]).all(axis=1)
    # rod quads look down: turn them so that both patches turn the same way seen from above
    found = quads[facing & finest & ~body.mesh.is_hanging[quads].any(axis=1)]
    return np.asarray(found[:, ::-1] if body.name == "rod" else found)


def surface_contact(
    bodies: list[MeshedBody], inverse_mass: Array, f: float, h: float, x: Array, conforming: bool
) -> SurfaceContact:
    """Return the contact of a rod's skin with a barrier's, whose cells are ``h`` m wide there."""
    rod, barrier = (make_patch(facing_skin(body), body.places, body.points) for body in bodies)
    if not conforming:
        return SurfaceContact.of(rod, barrier, inverse_mass, f, 0.0, BAND * h, x)
    return SurfaceContact.of(rod.rounded(x), barrier, inverse_mass, f, PLAY * h, BAND * h, x)


class Builder:
    """The parts of a scene's model; each is made when it is first asked for, from others, and kept."""

    def __init__(self, scene: Scene, spec: ModelSpec, gap: float) -> None:
        self.scene, self.spec, self.gap = scene, spec, gap

    @cached_property
    def geometry(self) -> Geometry:
        """Return the meshes."""
        return build_geometry(self.scene, self.gap, self.spec.meshed_barrier, self.spec.vibrating)

    @cached_property
    def layout(self) -> DofLayout:
        """Return the places of the unknowns."""
        return number(self.geometry.rod, self.geometry.barrier)

    @cached_property
    def rest_mass(self) -> float:
        """Return the mass, kg, of half the rigid cylinder behind the nose; 0 where the rod vibrates."""
        if self.spec.vibrating:
            return 0.0
        from fem_impact.solid.rigid_rest import rest_mass

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
        """Return the meshed bodies."""
        return [self.rod, self.barrier] if self.barrier else [self.rod]

    @cached_property
    def mass(self) -> Array:
        """Return the lumped masses (size,), kg."""
        mass = assemble_masses(self.bodies, self.layout)
        if not self.spec.vibrating:
            from fem_impact.solid.rigid_rest import POINTS

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

    @cached_property
    def v(self) -> Array:
        """Return the velocities (size,) of the masses at time 0, m/s; omega turns n towards t."""
        v, impact = np.zeros(self.layout.size), self.scene.impact
        arm = self.x[self.rod.places] - mass_centre(self.mass, self.x, self.rod.places)
        speed = np.zeros_like(arm)
        speed[:, 0] = impact.v_t + impact.omega * arm[:, 2]
        speed[:, 2] = impact.v_n - impact.omega * arm[:, 0]
        v[self.rod.places] = speed
        return v

    @cached_property
    def frame(self) -> FixedFrame | TurningFrame:
        """Return the frame of the rod's linear part."""
        x = self.x[: self.layout.rod_size]
        if self.spec.turning_frame:
            return TurningFrame.at(x, self.mass[: len(x)], self.free_nodes)
        return FixedFrame(x.copy())

    @cached_property
    def free_nodes(self) -> Ints:
        """Return the unknowns (k, 3) of the rod's nodes that do not hang."""
        return self.rod.places[~self.rod.mesh.is_hanging]

    @cached_property
    def elastic_rod(self) -> tuple[ElasticRod | ElasticNose, MassStiffness]:
        """Return the rod's linear part, and its elastic stiffness over its masses."""
        n, mesh = self.layout.rod_size, self.geometry.rod
        nose, whole = nose_and_whole(self.rod, mesh, self.drawn, self.layout)
        product, d, y = NodeProduct.of(nose, self.free_nodes), np.zeros(n), np.zeros(n)
        if not self.spec.vibrating:
            from fem_impact.solid.rigid_rest import ElasticNose

            return ElasticNose(product, self.frame, d, y), whole
        slices = slices_of(self.rod, mesh)
        return ElasticRod(slices, self.drawn, product, self.frame, self.layout, d, y), whole

    @cached_property
    def block(self) -> tuple[list[ElasticBlock], list[Dashpots], dict[str, float]]:
        """Return the items of a meshed barrier and its stable step, s, by its name; nothing without one."""
        if self.barrier is None:
            return [], [], {}
        effect = "barrier-elastoplastic" if self.spec.barrier_law else "barrier-elastic"
        block = elastic_block(self.barrier, self.layout, self.x, effect)
        inverse, share = self.inverse_mass, self.scene.accuracy.step
        step = stable_step(block.stiffness, inverse[self.layout.barrier_slice], share)
        pots = [dashpots(self.barrier, self.layout, inverse, block)] if self.spec.radiating else []
        return [block.linear], pots, {"barrier": step}

    @cached_property
    def steps(self) -> dict[str, float]:
        """Return the stable step of each body with its safety factor, s."""
        # the block first: what its assembly takes for a while, the rod's, which stays, takes up again
        _, _, steps = self.block
        _, stiffness = self.elastic_rod
        inverse = self.inverse_mass[: self.layout.rod_size]
        return steps | {"rod": stable_step(stiffness, inverse, self.scene.accuracy.step)}

    @cached_property
    def zones(self) -> list[YieldingZone]:
        """Return the zone of each body that yields."""
        laws = (self.spec.rod_law, self.spec.barrier_law)
        pairs = zip(self.bodies, laws, strict=False)
        return [yielding_zone(body, law, self.layout) for body, law in pairs if law]

    @cached_property
    def contact(self) -> PlaneContact | SurfaceContact:
        """Return the contact; a rigid section behind the nose takes none."""
        g, f = self.geometry, self.spec.friction or 0.0
        if self.barrier:
            return surface_contact(self.bodies, self.inverse_mass, f, g.tip_size, self.x, g.conforming)
        skin = g.rod.mesh.free_skin
        if not self.spec.vibrating:
            skin = np.setdiff1d(skin, g.rod.body_nodes)
        return PlaneContact(self.rod.places[skin], self.inverse_mass, f)

    def weight(self, gravity: float) -> Weight:
        """Return gravity on the rod, m/s2."""
        n, alpha = self.layout.rod_size, self.scene.impact.angle
        down = np.zeros((len(self.rod.places), 3))
        down[:, 0], down[:, 2] = -np.sin(alpha), -np.cos(alpha)
        direction = np.zeros(self.layout.size)
        direction[self.rod.places] = down
        return Weight(gravity * self.mass[:n] * direction[:n], self.x[:n].copy())

    def damping(self, loss: float) -> ModalDamping:
        """Return the damping of the rod's modes with a loss factor."""
        from fem_impact.solid.elastic import ModalDamping

        _, K = self.elastic_rod
        inverse = self.inverse_mass[: K.shape[0]]
        modes = rod_modes(K, self.mass[: K.shape[0]], inverse == 0)
        return ModalDamping.of(modes, self.frame, inverse, self.free_nodes, loss, self.steps["rod"])

    def rigid_rest(self) -> RigidRest:
        """Return the rigid body behind the nose: the nose's last section and the points behind it."""
        from fem_impact.solid.rigid_rest import POINTS, RigidRest

        rod = self.layout.rod
        places = np.concatenate([rod[self.geometry.rod.body_nodes[:, 0]], rod[-POINTS:]])
        return RigidRest(places, self.mass[places[:, 0]])

    def forces(self) -> list[Force]:
        """Return what pushes, in the order in which forces are added."""
        (linear, _), (block, _, _), gravity = self.elastic_rod, self.block, self.spec.gravity
        weight = [] if gravity is None else [self.weight(gravity)]
        return [linear, *weight, *block, *self.zones]

    def impulses(self) -> list[Impulse]:
        """Return what changes velocities, in the order of a step: the contact has the last word."""
        (_, pots, _), loss = self.block, self.spec.loss_factor
        rest = [] if self.spec.vibrating else [self.rigid_rest()]
        damping = [] if loss is None else [self.damping(loss)]
        return [*rest, *damping, *pots, self.contact]

    def model(self) -> Model:
        """Return the model."""
        steps, (linear, stiffness) = self.steps, self.elastic_rod
        return Model(
            geometry=self.geometry,
            layout=self.layout,
            mass=self.mass,
            inverse_mass=self.inverse_mass,
            drawn=self.drawn,
            forces=self.forces(),
            impulses=self.impulses(),
            rod=linear,
            zones=self.zones,
            contact=self.contact,
            hanging=Hanging.of([(body.mesh.tie, body.places) for body in self.bodies]),
            rod_stiffness=stiffness if self.spec.vibrating else None,
            steps=steps,
            start=(self.x, self.v),
        )


def build(scene: Scene, spec: ModelSpec, gap: float = START_GAP) -> Model:
    """Return the model of a scene; parts whose slot is empty are never made.

    ``gap`` is the height of the lowest point over the barrier at time 0, m; below 0 bodies overlap.

    Raises
    ------
    SceneError
        If the tip is so coarse that there is no fine zone to touch or to yield in.
    """
    require_fine_zone(scene, spec)
    return Builder(scene, spec, gap).model()
