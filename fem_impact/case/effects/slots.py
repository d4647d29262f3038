"""The parts of a model that effects switch on (its slots), and what defines an effect."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from fem_impact.case.bodies import Bodies
from fem_impact.options import FIDELITIES
from fem_impact.physics.hardening import HardeningLaw, Skin
from fem_impact.scene.sliding import SpeedTable


@dataclass(slots=True)
class ModelSpec:
    """Slots of the model; all defaults give a rigid rod with an elastic nose on a rigid frictionless plane.

    Attributes
    ----------
    vibrating : the body behind the nose is elastic
    friction : Coulomb coefficient f at rest, or None for a frictionless contact
    friction_over_speed : sliding speeds, m/s, and the factor of f at each; None where it does not change
    rod_law, barrier_law : hardening law of a body that may yield, or None
    under_laws : those of the materials under the first layer of a barrier, from the top down
    rod_skin, barrier_skin : hardened layer at the surface of a body, or None
    meshed_barrier : a block instead of the rigid plane
    radiating : the block's outer boundary lets waves out
    plate : impedance of a plate that bends and is not meshed through its thickness, N s/m, or None
    bending : phase speed, m/s, of the bending waves that leave at the edges of one that is, or None
    gravity : acceleration, m/s2, or None
    loss_factor : of the rod's vibration, or None
    contact_loss : loss factor of the contact, or None
    heat : the contact's heat is computed
    turning_frame : the rod's linear part follows its rotation
    """

    vibrating: bool = False
    friction: float | None = None
    friction_over_speed: SpeedTable | None = None
    rod_law: HardeningLaw | None = None
    barrier_law: HardeningLaw | None = None
    under_laws: tuple[HardeningLaw | None, ...] = ()
    rod_skin: Skin | None = None
    barrier_skin: Skin | None = None
    meshed_barrier: bool = False
    radiating: bool = False
    plate: float | None = None
    bending: float | None = None
    gravity: float | None = None
    loss_factor: float | None = None
    contact_loss: float | None = None
    heat: bool = False
    turning_frame: bool = False

    @property
    def barrier_laws(self) -> tuple[HardeningLaw | None, ...]:
        """The laws of all materials of the barrier, from the top down."""
        return (self.barrier_law, *self.under_laws)


def no_items(builder: Any) -> tuple[()]:
    """Return the items of an effect that fills slots alone."""
    return ()


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect: name, meaning, the number that decides whether it is needed, and the slots it fills.

    Attributes
    ----------
    name : as written in a scene
    sentence : what the user is told when it is on
    absence : what the user is told when it is off
    measure : name of the dimensionless number
    threshold : number above which the effect is needed
    source : where the number and its threshold come from
    number : returns the number for bodies with all effects in force that the scene does not force off
    fill : sets its slots in a specification, for bodies with the effects of the model
    needs : prerequisites, of which at least one must be on; empty: none
    fidelities : models that compute it. The others leave an effect of the program out, and refuse a scene
        with one of another package
    forces, impulses : return items of the finite-element model that add forces or change velocities
        (`fem_impact.solid.state`), made from its `fem_impact.solid.build.Builder`
    """

    name: str
    sentence: str
    absence: str
    measure: str
    threshold: float
    source: str
    number: Callable[[Bodies], float]
    fill: Callable[[Bodies, ModelSpec], None]
    needs: tuple[str, ...] = ()
    fidelities: tuple[str, ...] = FIDELITIES
    forces: Callable[[Any], Sequence[Any]] = no_items
    impulses: Callable[[Any], Sequence[Any]] = no_items
