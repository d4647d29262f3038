"""The plan of a run: what a scene calls for, decided once, before any mesh is made, and handed on."""

from __future__ import annotations

from dataclasses import dataclass

from fem_impact.case.cells import coarse_tip, thin_cells
from fem_impact.case.choose import Choice, choices, neglected, resolved
from fem_impact.case.effects.registry import EFFECTS
from fem_impact.case.effects.slots import ModelSpec, bodies_of
from fem_impact.case.layers import block_of, layer_warning, require_layers
from fem_impact.case.limits import (
    require_own_mesh,
    require_point,
    require_round,
    require_shallow,
    require_still,
    validity,
)
from fem_impact.case.mesh import require_mesh
from fem_impact.case.metals import unknowns
from fem_impact.case.plates import is_thin, require_plate, require_plate_mesh
from fem_impact.case.size import RunSize, require_memory, require_rest, run_size
from fem_impact.case.zones import Zones, require_fine_zone, require_layer, zones_of
from fem_impact.errors import UsageError, did_you_mean
from fem_impact.options import FIDELITIES
from fem_impact.physics.beam import max_time
from fem_impact.physics.contact import ContactBodies
from fem_impact.physics.plate import plate_waves
from fem_impact.scene.types import Scene


@dataclass(frozen=True, slots=True)
class Plan:
    """What a scene calls for.

    Attributes
    ----------
    scene : as stated; fidelity : rigid, modal or solid
    active : names of the effects in the model, in the order in which they enter it
    slots : what these effects fill
    bodies : rod and barrier as they touch with these effects
    """

    scene: Scene
    fidelity: str
    active: tuple[str, ...]
    slots: ModelSpec
    bodies: ContactBodies

    @property
    def zones(self) -> Zones:
        """Return the sizes of the fine zones of the meshes (solid)."""
        return zones_of(self.bodies)

    @property
    def max_time(self) -> float:
        """Return the latest time at which the run stops, s."""
        return max_time(self.bodies)

    @property
    def choices(self) -> tuple[Choice, ...]:
        """Return each effect with its number, threshold, verdict and omission error."""
        return choices(self.scene)

    @property
    def validity(self) -> tuple[str, ...]:
        """Return a sentence for each way in which the scene leaves the measured range."""
        return validity(self.bodies, self.active, self.slots.bending is not None)

    @property
    def unknown(self) -> tuple[str, ...]:
        """Return sentences on what the materials do not state."""
        return unknowns(self.scene, self.active)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return sentences on what the reader should distrust on finite elements."""
        return (
            *neglected(self.scene),
            *coarse_tip(self.bodies),
            *layer_warning(self.bodies),
            *thin_cells(self.scene),
            *self.unknown,
        )

    @property
    def size(self) -> RunSize:
        """Return about what a run of the solid fidelity takes: elements, memory, steps, time."""
        return run_size(self.slots, self.bodies, self.zones)


def plan(scene: Scene, fidelity: str = "solid") -> Plan:
    """Decide what a scene calls for.

    Raises
    ------
    UsageError
        If the fidelity is unknown.
    SceneError
        If an effect is unknown, the rod does not come towards the barrier, or the solid
        fidelity cannot hold it: an indentation as deep as the rod, a tip without a fine zone, a mesh that
        needs more memory than the machine has, a shape that cannot be meshed.
    """
    if fidelity not in FIDELITIES:
        hint = did_you_mean(fidelity, FIDELITIES, f"Use one of {', '.join(FIDELITIES)}.")
        raise UsageError("is not a fidelity.", key="fidelity", value=fidelity, remedy=hint)
    require_still(scene, fidelity)
    in_model = resolved(scene)
    require_own_mesh(scene, in_model.effects, fidelity)
    require_round(scene, fidelity)
    bodies = bodies_of(in_model)
    through = fidelity == "solid" and is_thin(bodies)
    require_plate(bodies, through)
    require_point(bodies)
    slots = ModelSpec()
    for name in in_model.effects:
        EFFECTS[name].fill(in_model, slots)
    if through:  # the mesh bends by itself: its impedance would count that twice
        slots.plate, slots.bending = None, plate_waves(bodies)[0]
    require_layers(bodies, fidelity)
    if fidelity == "solid":
        zones = zones_of(bodies)
        require_shallow(bodies)
        require_fine_zone(bodies)
        require_mesh(scene)
        if through:
            require_plate_mesh(scene, zones.base, block_of(scene, zones))
        if not slots.vibrating:
            require_rest(scene, zones)
        if slots.skin and slots.barrier_law:
            require_layer(slots.skin, zones)
        if scene.accuracy.target is None:  # a target chooses its own mesh
            require_memory(slots, bodies, zones)
    return Plan(scene, fidelity, in_model.effects, slots, bodies)
