"""The plan of a run: what a scene calls for, decided once, before any mesh is made, and handed on."""

from __future__ import annotations

from dataclasses import dataclass

from fem_impact.effects.registry import EFFECTS
from fem_impact.effects.slots import ModelSpec, bodies_of
from fem_impact.errors import UsageError, did_you_mean
from fem_impact.physics.contact import ContactBodies
from fem_impact.plan.choose import Choice, choices, neglected, resolved
from fem_impact.plan.limits import coarse_tip, require_approach, require_shallow, validity
from fem_impact.plan.zones import Zones, require_fine_zone, zones_of
from fem_impact.scene.types import FIDELITIES, Scene

__all__ = ["Plan", "plan"]


@dataclass(frozen=True, slots=True)
class Plan:
    """What a scene calls for.

    Attributes
    ----------
    scene : as stated; fidelity : rigid, modal or solid
    active : names of the effects in the model, in the order in which they enter it
    slots : what these effects fill
    bodies : rod and barrier as they touch with these effects
    zones : sizes of the fine zones of the meshes (solid)
    """

    scene: Scene
    fidelity: str
    active: tuple[str, ...]
    slots: ModelSpec
    bodies: ContactBodies
    zones: Zones

    @property
    def choices(self) -> tuple[Choice, ...]:
        """Return each effect with its number, threshold, verdict and omission error."""
        return choices(self.scene)

    @property
    def validity(self) -> tuple[str, ...]:
        """Return a sentence for each way in which the scene leaves the measured range."""
        return validity(self.scene, self.active)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return sentences on what the reader should distrust."""
        return (*neglected(self.scene), *coarse_tip(self.bodies))


def plan(scene: Scene, fidelity: str = "solid") -> Plan:
    """Decide what a scene calls for.

    Raises
    ------
    UsageError
        If the fidelity is unknown.
    SceneError
        If an effect is unknown, the rod does not come towards the barrier, or the solid
        fidelity cannot hold it: an indentation as deep as the rod, a tip without a fine zone.
    """
    if fidelity not in FIDELITIES:
        hint = did_you_mean(fidelity, FIDELITIES, f"Use one of {', '.join(FIDELITIES)}.")
        raise UsageError("is not a fidelity.", key="fidelity", value=fidelity, remedy=hint)
    in_model = resolved(scene)
    bodies = bodies_of(in_model)
    require_approach(scene)
    if fidelity == "solid":
        require_shallow(bodies)
        require_fine_zone(bodies)
    return Plan(scene, fidelity, in_model.effects, _filled(in_model), bodies, zones_of(bodies))


def _filled(scene: Scene) -> ModelSpec:
    slots = ModelSpec()
    for name in scene.effects:
        EFFECTS[name].fill(scene, slots)
    return slots
