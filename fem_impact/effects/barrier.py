"""The barrier, one choice: a rigid plane, an elastic block, or a block that yields.

The two blocks end in springs and dashpots that stand for the rest of a half-space, so that waves leave
(viscous-spring boundary; what leaves is booked as radiated).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.effects.plasticity import first_yield_ratio, hardening_of
from fem_impact.effects.spec import Effect, ModelSpec

if TYPE_CHECKING:
    from fem_impact.scene import Scene


def compliance_share(scene: Scene) -> float:
    """Return the barrier's share of the elastic contact compliance."""
    rod, plate = scene.projectile.material, scene.barrier.material
    soft_rod, soft_plate = (1 - rod.nu**2) / rod.E, (1 - plate.nu**2) / plate.E
    return soft_plate / (soft_rod + soft_plate)


def yield_ratio(scene: Scene) -> float:
    """Return the elastic peak pressure over that of first yield in the plate."""
    return first_yield_ratio(scene, scene.barrier.material)


def fill_rigid(scene: Scene, spec: ModelSpec) -> None:
    """Leave the plane."""


def fill_elastic(scene: Scene, spec: ModelSpec) -> None:
    """Mesh the block."""
    spec.meshed_barrier = True


def fill_elastoplastic(scene: Scene, spec: ModelSpec) -> None:
    """Mesh the block and let it yield."""
    spec.meshed_barrier = True
    spec.barrier_law = hardening_of(scene.barrier.material)


RIGID = Effect(
    "barrier-rigid",
    "The barrier is a rigid plane.",
    "The barrier is not rigid.",
    "barrier's share of the contact compliance",
    compliance_share,
    fill_rigid,
)
ELASTIC = Effect(
    "barrier-elastic",
    "The barrier is an elastic block; waves leave through its outer boundary.",
    "The barrier is no purely elastic block.",
    "barrier's share of the contact compliance",
    compliance_share,
    fill_elastic,
)
ELASTOPLASTIC = Effect(
    "barrier-elastoplastic",
    "The barrier is a block that yields under the contact; waves leave through its outer boundary.",
    "The barrier does not yield.",
    "elastic peak pressure over first yield of the barrier",
    yield_ratio,
    fill_elastoplastic,
)
