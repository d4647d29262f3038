"""From a modal impact to the outcome."""

from __future__ import annotations

from dataclasses import replace

from fem_impact.modal.assumptions import ASSUMPTIONS
from fem_impact.modal.beside import beside_solid
from fem_impact.modal.impact import ModalResult
from fem_impact.outcome import (
    Contact,
    ContactInterval,
    Energy,
    Heat,
    Markers,
    Outcome,
    RunCost,
    Unknown,
    unknown,
)
from fem_impact.outcome_keys import motion, plastic_shares, provenance, restitution, validity
from fem_impact.scene import Scene

__all__ = ["reduce"]

WITHOUT = ("rate-hardening", "radiation", "material-damping", "contact-heating")
CHOICES = Unknown("effects are weighed for the finite elements; `fem-impact check` lists them")
NOT_MESHED = Unknown("the reduced model has no elements")
NO_STRESS = Unknown("a local contact law knows no residual stress")
KEPT = Unknown("the modes of a rod are computed once and kept")


def reduce(scene: Scene, result: ModalResult) -> Outcome:
    """Return the Outcome of a modal impact."""
    rod = result.rod
    moved = motion(scene, result.V_n, result.V_t, result.Omega, rod.mass, rod.k2)
    return Outcome(
        provenance=provenance(scene, "modal", CHOICES, WITHOUT),
        validity=validity(
            scene,
            result.finished,
            _end(result),
            "the reduced model has no second mesh",
            (*ASSUMPTIONS, *beside_solid(scene)),
            [] if result.finished else ["The impact was not over at max_time."],
        ),
        motion=moved,
        restitution=restitution(scene, moved),
        energy=_energy(scene, result),
        contact=_contact(result),
        heat=unknown(Heat, "heat is followed on the finite elements only"),
        cost=_cost(result),
    )


def _end(result: ModalResult) -> str:
    if result.finished:
        return "The free flight ahead has no further contact."
    return "Reached max_time before the last separation."


def _energy(scene: Scene, result: ModalResult) -> Energy:
    E_0, vibration = result.E_0, result.vibration / result.E_0
    floor = abs(result.residual) / E_0
    plastic_rod, plastic_barrier = plastic_shares(scene, result.plastic / E_0)
    return Energy(
        E_0=E_0,
        rigid=result.kinetic / E_0,
        vibration=vibration,
        vibration_check=Unknown("the free flight is exact in modes, so there is nothing to check it against"),
        vibration_floor=floor,
        below_floor=vibration < floor,
        friction=result.friction / E_0,
        skin=Unknown("a local contact law does not say how deep it flows"),
        plastic_rod=plastic_rod,
        plastic_barrier=plastic_barrier,
        locked_rod=NO_STRESS,
        locked_barrier=NO_STRESS,
        radiated=Unknown("a local contact law sends no waves into the barrier"),
        closing=Unknown("no contact nodes close"),
        damping=Unknown("the reduced model has no material damping"),
        gravity=result.fallen / E_0 if "gravity" in scene.active else Unknown("the gravity effect is off"),
        residual=result.residual / E_0,
    )


def _contact(result: ModalResult) -> Contact:
    rows = (map(float, row) for row in result.contacts)
    return Contact(
        intervals=tuple(
            ContactInterval(start=start, end=end, impulse_n=normal, impulse_t=tangential)
            for start, end, normal, tangential in rows
        ),
        peak_force=result.force,
        markers=unknown(Markers, "the camera's markers are followed on the finite elements only"),
    )


def _cost(result: ModalResult) -> RunCost:
    return replace(
        unknown(RunCost, NOT_MESHED.reason),
        steps=result.steps,
        wall=result.wall,
        cpu=result.cpu,
        setup_wall=KEPT,
        setup_cpu=KEPT,
        peak_memory=Unknown("the march holds a few vectors; the process is larger than it"),
        min_step=result.step,
    )
