"""From a modal impact to the flat Outcome record."""

from __future__ import annotations

from fem_impact.modal.assumptions import ASSUMPTIONS
from fem_impact.modal.beside import beside_solid
from fem_impact.modal.impact import ModalResult
from fem_impact.outcome import KEYS, Outcome
from fem_impact.outcome.keys import HEATING
from fem_impact.outcome_keys import (
    NO_TARGET,
    Values,
    coefficient_keys,
    explained,
    motion_keys,
    plastic_keys,
    provenance,
)
from fem_impact.scene import Scene

__all__ = ["reduce"]

WITHOUT = ("rate-hardening", "radiation", "material-damping", "contact-heating")
NOT_MESHED = "the reduced model has no elements"
REASONS = {
    "E_vib_check_over_E_0": "the free flight is exact in modes, so there is nothing to check it against",
    "E_locked_rod_over_E_0": "a local contact law knows no residual stress",
    "E_locked_barrier_over_E_0": "a local contact law knows no residual stress",
    "W_radiated_over_E_0": "a local contact law sends no waves into the barrier",
    "W_skin_over_E_0": "a local contact law does not say how deep it flows",
    "W_closing_over_E_0": "no contact nodes close",
    "effect_choices": "effects are weighed for the finite elements; `fem-impact check` lists them",
    "W_gravity_over_E_0": "the gravity effect is off",
    "W_damping_over_E_0": "the reduced model has no material damping",
    "E_hourglass_over_E_0": NOT_MESHED,
    **dict.fromkeys(
        (key.name for key in KEYS if key.name.startswith("marker_")),
        "the camera's markers are followed on the finite elements only",
    ),
    **dict.fromkeys((key.name for key in HEATING), "heat is followed on the finite elements only"),
    "bands": "the reduced model has no second mesh",
    **dict.fromkeys(
        ("element_steps", "elements_rod", "elements_barrier", "elements_yielding", "tip_size_m"), NOT_MESHED
    ),
    **dict.fromkeys(("setup_wall_s", "setup_cpu_s"), "the modes of a rod are computed once and kept"),
    "peak_memory_MB": "the march holds a few vectors; the process is larger than it",
}  # fmt: skip


def reduce(scene: Scene, result: ModalResult) -> Outcome:
    """Return the Outcome of a modal impact; what it cannot know is null with its reason."""
    warnings = [] if result.finished else ["The impact was not over at max_time."]
    assumed = (*ASSUMPTIONS, *beside_solid(scene))
    values = provenance(scene, "modal", result.finished, _end(result), assumed, warnings, WITHOUT)
    rod = result.rod
    values |= motion_keys(scene, result.V_n, result.V_t, result.Omega, rod.mass, rod.k2)
    coefficients, reasons = coefficient_keys(scene, values)
    values |= coefficients | _energies(scene, result) | _contact(result)
    values |= {
        "steps": result.steps,
        "wall_s": result.wall,
        "cpu_s": result.cpu,
        "min_step_s": result.step,
    }
    return explained(values, NO_TARGET | REASONS | reasons)


def _end(result: ModalResult) -> str:
    if result.finished:
        return "The free flight ahead has no further contact."
    return "Reached max_time before the last separation."


def _energies(scene: Scene, result: ModalResult) -> Values:
    kept = result.kinetic / result.E_0
    floor = abs(result.residual) / result.E_0
    vibration = result.vibration / result.E_0
    return {
        "E_0_J": result.E_0,
        "E_r_over_E_0": kept,
        "E_vib_over_E_0": vibration,
        "E_vib_floor_over_E_0": floor,
        "E_vib_below_floor": vibration < floor,
        "W_friction_over_E_0": result.friction / result.E_0,
        "residual_over_E_0": result.residual / result.E_0,
        "W_gravity_over_E_0": result.fallen / result.E_0 if "gravity" in scene.active else None,
        **plastic_keys(scene, result.plastic / result.E_0),
    }


def _contact(result: ModalResult) -> Values:
    names = ("start_s", "end_s", "impulse_n_Ns", "impulse_t_Ns")
    rows = [dict(zip(names, map(float, row), strict=True)) for row in result.contacts]
    return {"contacts": rows, "peak_force_N": result.force}
