"""From a scene and its filled slots to a model: meshes, operators, masses, items, step.

What only some effects need is imported where it is built.
"""

from __future__ import annotations

from collections.abc import Mapping
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


def _bodies(scene: Scene, spec: ModelSpec, geometry: Geometry, layout: DofLayout) -> list[MeshedBody]:
    rod, barrier = geometry.rod.mesh, geometry.barrier
    yields = geometry.may_yield["rod"] & (spec.rod_law is not None)
    steel, kind = scene.projectile.material, scene.accuracy.element
    found = [make_body("rod", rod, geometry.rod_points, layout.rod, steel, yields, kind)]
    _complete_mass(found[0], geometry, scene, 0.0 if spec.vibrating else _rest_mass(scene, geometry))
    if barrier is not None:
        yields = geometry.may_yield["barrier"] & (spec.barrier_law is not None)
        steel = scene.barrier.material
        found.append(make_body("barrier", barrier, barrier.points, layout.barrier, steel, yields, kind))
        if geometry.skin_rows:
            found[1].mass[:] *= skin_weight(barrier, geometry.tip_size)[:, None]
    return found


def skin_weight(barrier: HexMesh, h: float) -> Array:
    """Return the factor (m,) of the masses of a barrier's cells, ``h`` m wide at the contact.

    One as low as c h with c < `HEAVY` gets (`HEAVY` / c)^2 times its mass, and so the step of one `HEAVY` h
    high. These cells move no faster than the indentation grows.
    """
    z = barrier.points[barrier.cells][:, :, 2]
    return np.asarray(np.maximum(1.0, HEAVY * h / np.ptp(z, axis=1)) ** 2)


def _complete_mass(rod: MeshedBody, geometry: Geometry, scene: Scene, rest: float) -> None:
    """Give the nose's cells what their flat faces cut off the round skin: the true mass of the rod."""
    nose = np.ones(len(rod.mass), dtype=bool)
    nose[geometry.rod.body_cells] = False
    missing = projectile(scene).mass / 2 - rod.mass.sum() - rest
    rod.mass[nose] *= 1 + missing / rod.mass[nose].sum()


def _rest_mass(scene: Scene, geometry: Geometry) -> float:
    from fem_impact.solid.rigid_rest import rest_mass

    rod = scene.projectile
    return rest_mass(geometry.rod.body_start, rod.length, rod.diameter, rod.material.rho)


def _place_rest(mass: Array, scene: Scene, geometry: Geometry, layout: DofLayout) -> None:
    from fem_impact.solid.rigid_rest import POINTS

    mass[layout.rod[-POINTS:]] = _rest_mass(scene, geometry) / POINTS


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


def _start(
    bodies: list[MeshedBody], layout: DofLayout, scene: Scene, mass: Array, drawn: MassPoints
) -> tuple[Array, Array]:
    """Return positions and velocities of the masses at time 0; omega turns n towards t."""
    x, v = np.zeros(layout.size), np.zeros(layout.size)
    x[layout.dummy] = dummy_element()
    for body in bodies:
        x[body.places] = body.points
    drawn.draw_in(layout.slices_of(x))
    rod, impact = bodies[0], scene.impact
    arm = x[rod.places] - mass_centre(mass, x, rod.places)
    speed = np.zeros_like(arm)
    speed[:, 0] = impact.v_t + impact.omega * arm[:, 2]
    speed[:, 2] = impact.v_n - impact.omega * arm[:, 0]
    v[rod.places] = speed
    return x, v


def _elastic_rod(
    body: MeshedBody,
    geometry: Geometry,
    layout: DofLayout,
    mass: Array,
    x: Array,
    drawn: MassPoints,
    spec: ModelSpec,
) -> tuple[ElasticRod | ElasticNose, MassStiffness]:
    n, free = layout.rod_size, body.places[~body.mesh.is_hanging]
    nose, whole = nose_and_whole(body, geometry.rod, drawn, layout)
    product = NodeProduct.of(nose, free)
    frame = TurningFrame.at(x[:n], mass[:n], free) if spec.turning_frame else FixedFrame(x[:n].copy())
    if not spec.vibrating:
        from fem_impact.solid.rigid_rest import ElasticNose

        return ElasticNose(product, frame, np.zeros(n), np.zeros(n)), whole
    slices = slices_of(body, geometry.rod)
    return ElasticRod(slices, drawn, product, frame, layout, np.zeros(n), np.zeros(n)), whole


def _rest(geometry: Geometry, layout: DofLayout, mass: Array) -> RigidRest:
    """Return the rigid body behind the nose: the nose's last section and the points behind it."""
    from fem_impact.solid.rigid_rest import POINTS, RigidRest

    places = np.concatenate([layout.rod[geometry.rod.body_nodes[:, 0]], layout.rod[-POINTS:]])
    return RigidRest(places, mass[places[:, 0]])


def elastic_block(
    body: MeshedBody, layout: DofLayout, x: Array, effect: str = "barrier-elastic"
) -> tuple[ElasticBlock, sp.csr_matrix, tuple[sp.dia_matrix, Array]]:
    """Return the block's linear part, the stiffness of all its cells, and the half-space around it.

    That is springs and dashpots.
    """
    from fem_impact.fem.boundary import spread_boundary

    place = layout.barrier_slice
    shifted = body.places - place.start
    T = tie_operator(body.mesh.tie, shifted, place.stop - place.start)
    m = body.material
    spring, damping = spread_boundary(body.mesh, m.E, m.nu, m.rho)
    springs, pots = sp.diags(T.T @ spring.ravel()), T.T @ damping.ravel()
    n = place.stop - place.start
    linear = stiffness_of(body, ~body.yields, n, place.start)
    K = sp.csr_matrix(linear + springs)
    K.eliminate_zeros()  # nodes inside the yielding zone have no linear part
    block = ElasticBlock(NodeProduct.of(K, shifted[~body.mesh.is_hanging], x[place]), place, effect)
    return block, linear + stiffness_of(body, body.yields, n, place.start), (springs, pots)


def _block(
    barrier: list[MeshedBody],
    spec: ModelSpec,
    layout: DofLayout,
    x: Array,
    inverse_mass: Array,
    share: float,
) -> tuple[list[ElasticBlock], list[Dashpots], dict[str, float]]:
    """Return the items of a meshed barrier and its step; nothing without one."""
    if not barrier:
        return [], [], {}
    effect = "barrier-elastoplastic" if spec.barrier_law else "barrier-elastic"
    block, whole, outside = elastic_block(barrier[0], layout, x, effect)
    step = stable_step(whole, inverse_mass[layout.barrier_slice], share)
    pots = [dashpots(barrier[0], layout, inverse_mass, whole, outside)] if spec.radiating else []
    return [block], pots, {"barrier": step}


def dashpots(
    body: MeshedBody,
    layout: DofLayout,
    inverse_mass: Array,
    whole: sp.csr_matrix,
    outside: tuple[sp.dia_matrix, Array],
) -> Dashpots:
    """Return the radiating boundary of a block.

    ``whole`` is the stiffness of all its cells, ``outside`` springs and dashpots of the half-space around it.
    """
    from fem_impact.fem.boundary import radiating_share

    (springs, pots), place, m = outside, layout.barrier_slice, body.material
    nearest = np.linalg.norm(body.points, axis=1) + body.mesh.is_hanging
    loaded = int(body.places[int(nearest.argmin()), 2]) - place.start
    held, K = inverse_mass[place] == 0, sp.csr_matrix(whole + springs)
    damping = pots * radiating_share(K, pots, held, loaded, (m.E, m.nu, m.rho))
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


def _contact(
    bodies: list[MeshedBody], geometry: Geometry, spec: ModelSpec, x: Array, inverse_mass: Array
) -> PlaneContact | SurfaceContact:
    f = spec.friction or 0.0
    if len(bodies) == 1:
        skin = geometry.rod.mesh.free_skin
        if not spec.vibrating:  # the rigid section takes no contact
            skin = np.setdiff1d(skin, geometry.rod.body_nodes)
        return PlaneContact(bodies[0].places[skin], inverse_mass, f)
    return surface_contact(bodies, inverse_mass, f, geometry.tip_size, x, geometry.conforming)


def surface_contact(
    bodies: list[MeshedBody], inverse_mass: Array, f: float, h: float, x: Array, conforming: bool
) -> SurfaceContact:
    """Return the contact of a rod's skin with a barrier's, whose cells are ``h`` m wide there."""
    rod, barrier = (make_patch(facing_skin(body), body.places, body.points) for body in bodies)
    if not conforming:
        return SurfaceContact.of(rod, barrier, inverse_mass, f, 0.0, BAND * h, x)
    return SurfaceContact.of(rod.rounded(x), barrier, inverse_mass, f, PLAY * h, BAND * h, x)


def _weight(
    gravity: float, alpha: float, mass: Array, x: Array, rod: MeshedBody, layout: DofLayout
) -> Weight:
    down = np.zeros((len(rod.places), 3))
    down[:, 0], down[:, 2] = -np.sin(alpha), -np.cos(alpha)
    direction = np.zeros(layout.size)
    direction[rod.places] = down
    n = layout.rod_size
    return Weight(gravity * mass[:n] * direction[:n], x[:n].copy())


def _damping(
    loss: float,
    linear: ElasticRod | ElasticNose,
    K: MassStiffness,
    mass: Array,
    inverse_mass: Array,
    free: Ints,
    steps: Mapping[str, float],
) -> ModalDamping:
    from fem_impact.solid.elastic import ModalDamping

    n = K.shape[0]
    modes = rod_modes(K, mass[:n], inverse_mass[:n] == 0)
    return ModalDamping.of(modes, linear.frame, inverse_mass[:n], free, loss, steps["rod"])


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


def build(scene: Scene, spec: ModelSpec, gap: float = START_GAP) -> Model:
    """Return the model of a scene; parts whose slot is empty are never made.

    ``gap`` is the height of the lowest point over the barrier at time 0, m; below 0 bodies overlap.

    Raises
    ------
    SceneError
        If the tip is so coarse that there is no fine zone to touch or to yield in.
    """
    require_fine_zone(scene, spec)
    geometry = build_geometry(scene, gap, spec.meshed_barrier, spec.vibrating)
    layout = number(geometry.rod, geometry.barrier)
    bodies = _bodies(scene, spec, geometry, layout)
    mass = assemble_masses(bodies, layout)
    if not spec.vibrating:
        _place_rest(mass, scene, geometry, layout)
    inverse_mass = invert(mass, bodies)
    rod = bodies[0]
    drawn = MassPoints.of_rod(geometry.rod, rod.mass, rod.material.rho)
    x, v = _start(bodies, layout, scene, mass, drawn)
    # the block first: what its assembly takes for a while, the rod's, which stays, takes up again
    block, pots, steps = _block(bodies[1:], spec, layout, x, inverse_mass, scene.accuracy.step)
    linear, rod_stiffness = _elastic_rod(rod, geometry, layout, mass, x, drawn, spec)
    forces: list[Force] = [linear]
    impulses: list[Impulse] = [] if spec.vibrating else [_rest(geometry, layout, mass)]
    zones = [
        yielding_zone(b, law, layout)
        for b, law in zip(bodies, (spec.rod_law, spec.barrier_law), strict=False)
        if law
    ]
    if spec.gravity is not None:
        forces.append(_weight(spec.gravity, scene.impact.angle, mass, x, rod, layout))
    n = layout.rod_size
    steps["rod"] = stable_step(rod_stiffness, inverse_mass[:n], scene.accuracy.step)
    if spec.loss_factor is not None:
        free = rod.places[~rod.mesh.is_hanging]
        impulses.append(_damping(spec.loss_factor, linear, rod_stiffness, mass, inverse_mass, free, steps))
    forces += block
    impulses += pots
    contact = _contact(bodies, geometry, spec, x, inverse_mass)
    impulses.append(contact)
    hanging = Hanging.of([(b.mesh.tie, b.places) for b in bodies])
    return Model(
        geometry=geometry,
        layout=layout,
        mass=mass,
        inverse_mass=inverse_mass,
        drawn=drawn,
        forces=[*forces, *zones],
        impulses=impulses,
        rod=linear,
        zones=zones,
        contact=contact,
        hanging=hanging,
        rod_stiffness=rod_stiffness if spec.vibrating else None,
        steps=steps,
        start=(x, v),
    )
