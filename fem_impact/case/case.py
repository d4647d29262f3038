"""The case of a scene: what it calls for, compiled once before any mesh is made, and handed on."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from fem_impact.case import followed, limits
from fem_impact.case.bodies import Bodies, LaterStrike
from fem_impact.case.cells import coarse_tip, thin_cells
from fem_impact.case.choose import Decision, all_effects, choices, decide, neglected, require_approach
from fem_impact.case.effects.fill import filled
from fem_impact.case.effects.loss import require_closed_form
from fem_impact.case.effects.registry import AUTO, NAMES, check_effects
from fem_impact.case.effects.skin import NOT_RIGID, require_skins
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.case.elastic_only import require_crushing_named
from fem_impact.case.layers import as_one, block_of, require_heavier, require_layers, thin_layer
from fem_impact.case.mesh import require_gauge, require_mesh
from fem_impact.case.metals import require_solid, unknowns
from fem_impact.case.plates import is_thin, require_plate, require_plate_mesh, too_thin
from fem_impact.case.record import ContactRecord
from fem_impact.case.recorded import AnyZones, recorded_zones, unresolved_skins
from fem_impact.case.size import RunSize, require_memory, require_rest, run_size
from fem_impact.case.zones import Zones, require_fine_zone, zones_of
from fem_impact.errors import SceneError, UsageError, did_you_mean
from fem_impact.options import FIDELITIES
from fem_impact.outcome.groups import EffectChoice, Limitation, limitations
from fem_impact.physics.contact import ContactEstimate, ContactPair
from fem_impact.physics.plate import plate_waves
from fem_impact.scene.types import Scene

# after the last touch: bending periods, and durations of the contact, within which one impact touches again
PERIODS, DURATIONS = 1.5, 2.0


def before_other_end(later: float) -> str:
    """Return why an impact ended before the strike of the other end, which comes so much, s, later."""
    return (
        f"The rod's other end strikes {later * 1e3:.2g} ms later: this is the motion before, and "
        '`impact.until = "rest"` follows the body on.'
    )


@dataclass(frozen=True, eq=False)
class Case:
    """What a scene calls for; each part is worked out when it is first asked for, and kept.

    `Case.of` also refuses what the fidelity cannot compute.

    Attributes
    ----------
    scene : as stated
    fidelity : rigid, modal or solid
    record : where the bodies touched and flowed in a coarser run, or may at first; the zones of the meshes
        follow it. Without one they follow the estimate of one contact
    later : how the bodies touch in a strike after the first, None in the first
    dent : fine zones of the strike on whose dent a later one lands; None: it has its own
    """

    scene: Scene
    fidelity: str = "solid"
    record: ContactRecord | None = None
    later: LaterStrike | None = None
    dent: AnyZones | None = None

    @classmethod
    def of(cls, scene: Scene, fidelity: str = "solid", record: ContactRecord | None = None) -> "Case":
        """Return the case of a scene that the fidelity can compute.

        Raises
        ------
        UsageError
            If the fidelity is unknown.
        SceneError
            If an effect is unknown, or of another package and not of this fidelity, if the rod does not come
            towards the barrier, or the solid fidelity cannot hold it: an indentation as deep as the rod, a
            tip without a fine zone, a mesh that needs more memory than the machine has, a shape that has no
            mesh.
        """
        if fidelity not in FIDELITIES:
            hint = did_you_mean(fidelity, FIDELITIES, f"Use one of {', '.join(FIDELITIES)}.")
            raise UsageError("is not a fidelity.", key="fidelity=", value=fidelity, remedy=hint)
        case = cls(scene, fidelity, record)
        try:
            case._require_held()
        except SceneError as error:
            raise error.worded(scene.projectile.named) from None
        return case

    def _require_held(self) -> None:
        """Refuse a scene that the fidelity cannot hold (SceneError)."""
        scene, fidelity = self.scene, self.fidelity
        require_crushing_named(scene)
        require_solid(scene)
        followed.require_still(scene.barrier, fidelity)
        followed.require_followed(scene)
        limits.require_own_mesh(self.bodies, fidelity)
        require_plate(self.bodies, self.meshed_through)
        limits.require_first_part(self.bodies)
        if fidelity != "rigid":
            limits.require_elastic_parts(self.bodies)
        if self.record is None:
            limits.require_point(self.bodies, fidelity)
        slots = self.slots
        require_layers(self.bodies, fidelity)
        require_skins(self.bodies, fidelity)
        require_closed_form(self.bodies, slots, fidelity)
        limits.require_shallow(self.bodies)
        if fidelity == "modal" and slots.vibrating:
            require_mesh(scene.projectile, scene.across)  # its modes are those of a mesh
        if fidelity != "solid":
            return
        followed.require_carried(scene, slots)
        if self.record is None:
            require_fine_zone(self.bodies)
        require_mesh(scene.projectile, scene.across)
        require_gauge(scene)
        if self.meshed_through:
            require_plate_mesh(self.bodies, self.zones.base, block_of(self.bodies, self.zones))
        if slots.meshed_barrier:
            require_heavier(self.bodies, self._estimated)
        if not slots.vibrating:
            require_rest(self.bodies, self._estimated)
        self.require_memory()
        if "modal" in dict(scene.strikes.stated):
            Case.of(scene, "modal")  # which computes later strikes

    def require_memory(self) -> None:
        """Refuse a mesh that needs more memory than there is (SceneError)."""
        if self.scene.accuracy.target is None:  # a target chooses its own mesh
            require_memory(self.slots, self.bodies, self._estimated)

    @cached_property
    def decision(self) -> Decision:
        """What is decided of each effect: number, needed, in force.

        Raises
        ------
        SceneError
            If the scene names an effect that is none, none or two barriers, or one without what it needs, or
            if the contact point does not come towards the barrier: the numbers of the effects are of an
            approach.
        """
        return decide(self._whole)

    @cached_property
    def active(self) -> tuple[str, ...]:
        """The effects in the model, in the order in which they enter it (SceneError: as of `decision`)."""
        if AUTO not in self.scene.effects:
            return self._whole.effects
        return tuple(name for name in NAMES if name in self.decision.on)

    @cached_property
    def _whole(self) -> Bodies:
        """The bodies with all effects in force that the scene does not force off (SceneError: as above)."""
        bodies = Bodies(self.scene, all_effects(self.scene.effects), self.later)
        require_approach(bodies)
        check_effects(self.scene.effects)
        return bodies

    @cached_property
    def bodies(self) -> Bodies:
        """The bodies with the effects in the model; the reduced model takes one material for layers."""
        whole = self._whole
        bodies = whole if whole.effects == self.active else Bodies(self.scene, self.active, self.later)
        if self.fidelity == "modal" and self.scene.projectile.own_mesh:
            bodies = replace(bodies, spans=True)
        if self.fidelity == "modal" and self.scene.barrier.layers:
            bodies = replace(bodies, struck=as_one(bodies))
        return bodies

    @property
    def contact(self) -> ContactPair:
        """Projectile and barrier as they touch first."""
        return self.bodies.contact

    @property
    def estimate(self) -> ContactEstimate:
        """The estimated size of the first contact."""
        return self.bodies.contact.estimate

    @cached_property
    def meshed_through(self) -> bool:
        """Whether a plate that bends is meshed through its thickness."""
        return self.fidelity == "solid" and is_thin(self.bodies)

    @cached_property
    def slots(self) -> ModelSpec:
        """What the effects fill."""
        slots = filled(self.bodies, self.active, self.fidelity)
        if self.meshed_through:  # the mesh bends by itself: its impedance would count that twice
            slots.plate, slots.bending = None, plate_waves(self.contact)[0]
        return slots

    @cached_property
    def zones(self) -> AnyZones:
        """The fine zones of the meshes (solid)."""
        if self.dent is not None:
            return self.dent
        return self._estimated if self.record is None else recorded_zones(self.bodies, self.record)

    @cached_property
    def _estimated(self) -> Zones:
        """The fine zones about the estimated contact, by which size and memory of a run are estimated."""
        return zones_of(self.bodies)

    @property
    def max_time(self) -> float:
        """The latest time at which the run stops, s."""
        return self.bodies.max_time

    @property
    def one_impact(self) -> float:
        """Time, s, within which what touches again belongs to the same impact: vibration has brought it back.

        Of 190 runs of drawn scenes by finite elements and the reduced model 16 touched again: 4 within 0.9
        bending periods, 12 after 14 to 600, where another part of the body came down, a later strike.
        """
        return max(PERIODS * self.bodies.bending_period, DURATIONS * self.estimate.duration)

    @cached_property
    def choices(self) -> tuple[EffectChoice, ...]:
        """Each effect with its number, threshold and verdict."""
        return choices(self.scene, self.decision)

    @cached_property
    def limitations(self) -> tuple[Limitation, ...]:
        """What limits trust in any run of the case, before it is run."""
        of_scene = limits.scene_limitations(self.bodies, self.slots.bending is not None)
        meshed = self.fidelity == "solid"
        of_scene += limitations("model", *too_thin(self.bodies, meshed))
        unstated = limitations(
            "input",
            *unknowns(self.bodies),
            limits.assumed_part(self.scene.projectile.own_mesh),
            limits.unused(self.scene, self.fidelity),
        )
        if not meshed:
            skin = NOT_RIGID if "machined-skin" in self.active else ""
            return self.said((*of_scene, *limitations("model", skin), *unstated))
        one_mesh = self.record is not None or self.scene.accuracy.levels == 1
        of_mesh = (
            *limitations("input", *neglected(self.choices)),
            *limitations("model", thin_layer(self.bodies)),
            *limitations(
                "resolution",
                coarse_tip(self.bodies) if self.record is None else "",  # a record shows its width
                thin_cells(self.scene.projectile),
                # of levels only a mesh that follows a record is known
                *(unresolved_skins(self.slots, self.zones) if one_mesh else ()),
            ),
        )
        return self.said((*of_scene, *of_mesh, *unstated))

    def said(self, of: Iterable[Limitation]) -> tuple[Limitation, ...]:
        """Return limitations whose sentences call the body what it is."""
        return tuple(replace(one, text=self.scene.projectile.named(one.text)) for one in of)

    @cached_property
    def size(self) -> RunSize:
        """About what a run of the solid fidelity takes: elements, memory, steps, time."""
        return run_size(self.slots, self.bodies, self._estimated)
