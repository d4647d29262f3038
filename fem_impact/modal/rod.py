"""The rod as its contact sees it: rigid motion, elastic modes, and how each moves the contact point."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, sin, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.body import MeshedBodies
from fem_impact.physics.contact import arms, principal_radii, projectile, section_frequency, touch_point
from fem_impact.plan.plan import plan
from fem_impact.scene.fields import ACCURACY
from fem_impact.scene.types import Accuracy, Barrier, Impact, ProjectileSpec, Scene, Surface

__all__ = ["ModalRod", "modal_rod"]


COARSEST = next(f.high for f in ACCURACY if f.key == "tip_size")  # m
AROUND = 0.4  # diameters around the contact point over which a mode is taken as affine


@dataclass(frozen=True, slots=True)
class ModalRod:
    """A rod that touches at one point of its tip, at first contact.

    Attributes
    ----------
    mass, k2 : kg, m2, of the whole rod
    centre_t, centre_n : the tip's centre of curvature from the mass centre, m
    radius : of the tip's meridian, m
    omega : (k,) rad/s
    along_t, along_n : (k,) kg^-1/2, displacement of the contact point by each mode of the whole rod
    """

    mass: float
    k2: float
    centre_t: float
    centre_n: float
    radius: float
    omega: Array
    along_t: Array
    along_n: Array


def modal_rod(scene: Scene, vibrating: bool = True) -> ModalRod:
    """Return the rod of a scene; the modes of rods of one shape and material are computed once."""
    body, alpha = projectile(scene), scene.impact.angle
    d_c, d_d = arms(scene)
    radius = principal_radii(scene)[0]
    omega, x, z = _touch(scene) if vibrating else np.zeros((3, 0))
    along_t, along_n = cos(alpha) * x + sin(alpha) * z, cos(alpha) * z - sin(alpha) * x
    return ModalRod(body.mass, body.k2, -d_c, radius - d_d, radius, omega, along_t, along_n)


def _touch(scene: Scene) -> tuple[Array, Array, Array]:
    """Return omega and the displacements (x, z) of the contact point in the rod frame, kg^-1/2."""
    points, shape, omega = _modes(_elastic(scene.projectile), scene.accuracy.across)
    rho, z = touch_point(scene)
    from_touch = points - np.array([rho, 0.0, z])
    near = np.linalg.norm(from_touch, axis=1) < AROUND * scene.projectile.diameter
    affine = np.column_stack([np.ones(near.sum()), from_touch[near][:, [0, 2]]])
    at_touch = np.linalg.pinv(affine)[0]
    kept = omega < section_frequency(scene)
    x, _, z = np.einsum("n,ncm->cm", at_touch, shape[near][:, :, kept])
    return omega[kept], x, z


def _elastic(rod: ProjectileSpec) -> ProjectileSpec:
    """Return the rod without what its modes do not depend on, so that they are found again."""
    steel = replace(rod.material, name="elastic", yield_stress=1e9, ultimate_stress=1e9)
    return replace(rod, material=steel)


@lru_cache(maxsize=32)
def _modes(rod: ProjectileSpec, across: int) -> tuple[Array, Array, Array]:
    """Return nodes (n, 3) in the rod frame, mode shapes (n, 3, k) of the whole rod, and omega (k,)."""
    scene = Scene(
        id="modes",
        title="modes of a rod on the coarse mesh",
        projectile=rod,
        barrier=Barrier(rod.material),
        surface=Surface("custom", 0.0, 0.0, 0.0, "no friction"),
        impact=Impact(0.0, -1.0, 0.0),
        effects=("vibration", "barrier-rigid"),
        accuracy=Accuracy(tip_size=min(rod.diameter / 4, COARSEST), across=across),
    )
    meshed = MeshedBodies(plan(scene))
    modes, mesh = meshed.rod_modes(), meshed.geometry.rod.mesh
    # modes are normalised with the mass of the half rod
    shape = modes.shape[meshed.free_nodes] / sqrt(2)
    return mesh.points[~mesh.is_hanging], shape, modes.omega
