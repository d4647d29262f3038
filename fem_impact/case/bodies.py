"""Projectile and barrier of a scene under a list of effects: what follows from both, worked out once."""

from dataclasses import dataclass
from functools import cached_property
from math import cos, sin

import numpy as np

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.physics.beam import bending_period, latest_time, ovalling_period, stretching_period
from fem_impact.physics.contact import ContactEstimate, ContactPair, Plate
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.material import Material
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.sliding import SpeedTable
from fem_impact.scene.types import Scene
from meshes import SKIN, HexMesh
from rigid import Body

WEAKEST = 1e-3
"""Energy that a strike brings along its normal, over the most with which one of its sequence began, below
which it does not rebound, where restitutions follow from the contact law: slow strikes lose nothing by it."""
SAME_PLACE = 1e-6  # of the length, as far as nodes of a user's mesh may lie from where they touch


@dataclass(frozen=True, eq=False)
class LaterStrike:
    """How a body that has struck before touches again.

    Attributes
    ----------
    contact : both as they touch; of its tail, of the body turned over
    alpha : angle between its axis and the barrier's normal, rad, of any size
    lowest : (x, z), m, from its tip, of its lowest place
    """

    contact: ContactPair
    alpha: float
    lowest: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Bodies:
    """Projectile and barrier of a scene under effects that are all listed; numbers are made at first use.

    Attributes
    ----------
    scene : as stated; what it says of effects does not count
    effects : names of the effects in force
    later : how they touch in a strike after the first; None: as the scene says
    struck : material that stands for the layers of a barrier; None: the first one alone
    spans : as of their contact, see `ContactPair`
    """

    scene: Scene
    effects: tuple[str, ...]
    later: LaterStrike | None = None
    struck: Material | None = None
    spans: bool = False

    @property
    def rod(self) -> ProjectileSpec:
        """The projectile as stated."""
        return self.scene.projectile

    @property
    def barrier(self) -> Barrier:
        """The barrier as stated."""
        return self.scene.barrier

    @cached_property
    def body(self) -> Body:
        """The rigid projectile."""
        return self.scene.projectile.rigid_body

    @cached_property
    def contact(self) -> ContactPair:
        """Both as they touch."""
        if self.later is not None:
            return self.later.contact
        barrier, seen = self.scene.barrier, self.scene.relative
        steel, h = barrier.material, barrier.thickness
        return ContactPair(
            body=self.body,
            angle=seen.angle,
            v_n=seen.v_n,
            v_t=seen.v_t,
            omega=seen.omega,
            rod=self.scene.projectile.material,
            barrier=self.struck or barrier.struck,
            rod_yields="rod-plasticity" in self.effects,
            barrier_yields="barrier-elastoplastic" in self.effects,
            compliant="barrier-rigid" not in self.effects,
            f=self.friction if "friction" in self.effects else 0.0,
            barrier_mass=barrier.mass,
            barrier_inertia=barrier.inertia,
            centre_offset=barrier.centre_offset,
            plate=Plate(steel.E, steel.nu, steel.rho, h) if barrier.bends and h is not None else None,
            spans=self.spans,
        )

    @property
    def metals(self) -> dict[str, Material]:
        """The materials that touch, by body."""
        return {"rod": self.contact.rod, "barrier": self.contact.barrier}

    def metal_at(self, z: float) -> tuple[Material, bool]:
        """Return the projectile's material at ``z``, m, from its tip, and whether it may yield there."""
        parts = [part for part in self.rod.segments if z <= part.to] or list(self.rod.segments[-1:])
        if not parts or parts[0] == self.rod.segments[0]:
            return self.contact.rod, self.contact.rod_yields
        return parts[0].material, False

    @cached_property
    def friction(self) -> float:
        """The Coulomb coefficient of the face that touches first, whether friction acts or not."""
        stated, rod = self.scene.surface.friction, self.rod
        if not rod.faces:
            return stated
        half, angle, skin = self._own_half, self.scene.impact.angle, self._own_half.face_tag == SKIN
        height = half.points[:, 2] * cos(angle) - half.points[:, 0] * sin(angle)
        there = (height <= height.min() + SAME_PLACE * rod.length)[half.faces].all(axis=1) & skin
        if not there.any():  # no face lies on the barrier
            touching = self._at_contact[half.faces].sum(axis=1) * skin
            # of an edge that lies along the barrier the faces on both sides, not those beside its ends
            there = touching >= min(2, touching.max())
        return float(rod.face_friction(stated)[there].max())

    @cached_property
    def friction_over_speed(self) -> SpeedTable | None:
        """The factor of friction over the sliding speed, None where it is one.

        Its pressure is that of the estimated contact, its temperature that before the impact.
        """
        law = self.scene.surface.sliding_law
        return law.over_speed(self.estimate.pressure, self.scene.heating.ambient) if law else None

    @cached_property
    def touching_cells(self) -> Ints:
        """The numbers of the cells of a mesh of its own at the place that touches first."""
        return np.flatnonzero(self._at_contact[self._own_half.cells].any(axis=1))

    @property
    def _own_half(self) -> HexMesh:
        mesh = self.rod.own_mesh
        assert mesh is not None, "only a mesh has cells of its own"
        return mesh.half()

    @cached_property
    def _at_contact(self) -> Bools:
        """Which nodes (n,) of the half of a mesh of its own stand at the place that touches first."""
        half, (x, z) = self._own_half, self.body.contact_point(self.scene.impact.angle)
        away = np.hypot(half.points[:, 0] - float(x), half.points[:, 2] - float(z))
        return np.asarray(away <= max(float(away.min()), SAME_PLACE * self.rod.length))

    @property
    def estimate(self) -> ContactEstimate:
        """The estimated size of the first contact."""
        return self.contact.estimate

    @cached_property
    def bending_period(self) -> float:
        """The first free-free bending period of the projectile, s."""
        return bending_period(self.scene.projectile)

    @cached_property
    def stretching_period(self) -> float:
        """The first longitudinal period of the projectile, s."""
        return stretching_period(self.scene.projectile)

    @cached_property
    def ovalling_period(self) -> float:
        """The period of the ovalling of a hollow projectile's wall, s; 0 of a solid one."""
        return ovalling_period(self.scene.projectile)

    @cached_property
    def max_time(self) -> float:
        """The latest time at which a run stops, s: stated, or as `latest_time` has it."""
        max_time = self.scene.accuracy.max_time
        return latest_time(self.scene.projectile, self.estimate.duration) if max_time is None else max_time

    @property
    def mesh_inclination(self) -> float:
        """The angle, rad, between the axis of the projectile's mesh and the barrier's normal.

        It is that of the impact, but a ball has no axis: it is meshed with its pole at the contact.
        """
        return self.first_inclination if self.later is None else self.later.alpha

    @property
    def first_inclination(self) -> float:
        """The same, rad, in the first strike, for which the mesh was made."""
        return 0.0 if self.scene.projectile.is_ball else self.scene.impact.angle

    @cached_property
    def lowest_point(self) -> Array:
        """The projectile's lowest point (3,) in the frame of its mesh, m."""
        rho, z = self.later.lowest if self.later else self.body.contact_point(self.mesh_inclination)
        return np.array([float(rho), 0.0, float(z)])
