"""The slots of a model that effects fill; an empty slot is a part that is never built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fem_impact.physics.beam_impact import BeamImpact, strike
from fem_impact.physics.contact import ContactBodies

if TYPE_CHECKING:
    from fem_impact.physics.hardening import Hardening
    from fem_impact.scene.types import Scene


@dataclass(slots=True)
class ModelSpec:
    """What the model is made of, beyond a rod with an elastic nose on a rigid frictionless plane.

    Attributes
    ----------
    vibrating : the body behind the nose is elastic
    friction : Coulomb coefficient f, or None for a frictionless contact
    rod_law, barrier_law : hardening of what may yield
    meshed_barrier : a block instead of the rigid plane
    radiating : the block's outer boundary lets waves out
    gravity : acceleration, m/s2, or None
    loss_factor : of the rod's vibration, or None
    heat : the contact's heat is watched
    turning_frame : the rod's linear part follows its rotation
    """

    vibrating: bool = False
    friction: float | None = None
    rod_law: Hardening | None = None
    barrier_law: Hardening | None = None
    meshed_barrier: bool = False
    radiating: bool = False
    gravity: float | None = None
    loss_factor: float | None = None
    heat: bool = False
    turning_frame: bool = False


@dataclass(frozen=True, slots=True)
class Harm:
    """What leaving an effect out changes, about: e, and E_vib as a fraction of E_0."""

    e: float
    E_vib: float


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect: its name, what it does, the number that says whether it matters, how it enters.

    Attributes
    ----------
    name : as written in a scene
    sentence : what the user is told when it is on
    absence : what the user is told when it is off
    measure : name of the dimensionless number
    threshold : number above which the effect is needed
    source : where the number and its threshold come from
    number : computes it from a scene that lists its effects, none chosen by "auto"
    fill : fills its slots
    harm : what a scene loses without the effect, computed from the scene; None: told by two quick impacts
    needs : the effect means nothing unless one of these is on; none: it stands alone
    """

    name: str
    sentence: str
    absence: str
    measure: str
    threshold: float
    source: str
    number: Callable[[Scene], float]
    fill: Callable[[Scene, ModelSpec], None]
    harm: Callable[[Scene], Harm] | None = None
    needs: tuple[str, ...] = ()


def bodies_of(scene: Scene) -> ContactBodies:
    """Return the bodies at the contact of a scene that lists the effects of its model."""
    active = scene.effects
    return ContactBodies(
        scene,
        rod_yields="rod-plasticity" in active,
        barrier_yields="barrier-elastoplastic" in active,
        compliant="barrier-rigid" not in active,
        f=scene.surface.friction if "friction" in active else 0.0,
    )


def quick_impact(scene: Scene) -> BeamImpact:
    """Return about what an impact comes to, of a scene that lists the effects of its model."""
    return strike(
        bodies_of(scene),
        vibrating="vibration" in scene.effects,
        rate="rate-hardening" in scene.effects,
        gravity="gravity" in scene.effects,
    )
