"""From the end of a finite-element run to the quantities of the study: the flat Outcome record."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

import rigid
from fem_impact.effects import Choice, choices, neglected
from fem_impact.errors import RunError
from fem_impact.estimates import coarse_tip
from fem_impact.heating import flash, halves, heat_keys
from fem_impact.markers import replay
from fem_impact.outcome import Outcome
from fem_impact.outcome.keys import HEATING
from fem_impact.outcome_keys import NO_TARGET, Values, coefficient_keys, explained, motion_keys, provenance

if TYPE_CHECKING:
    from fem_impact.scene import Scene
    from fem_impact.solid.run import SolidResult

VIBRATING = (
    "E_lt_less_vibration_over_E_0",
    "E_vib_over_E_0",
    "E_vib_floor_over_E_0",
    "E_vib_below_floor",
    "E_vib_check_over_E_0",
)
RESIDUAL_LIMIT = 1e-4  # of E_0: above it the run failed
RINGING, LEAST = 0.1, 1e-4  # of E_vib and of E_0: so much above the modes is told


def reduce(scene: Scene, result: SolidResult) -> Outcome:
    """Return the Outcome of a run; what cannot be known is null with its reason.

    Raises
    ------
    RunError
        If the run ended before the rod touched the barrier: there is no impact to reduce.
    """
    if not result.model.book.intervals:
        past = f"{result.time * 1e6:.3g} us, {result.steps} steps"
        raise RunError(f"There was no contact in {past}. {result.reason}")
    open_ledger = _open_ledger(result)
    finished = result.finished and not open_ledger
    values = provenance(
        scene,
        "solid",
        finished,
        open_ledger or result.reason,
        warnings=[*_doubts(result), *neglected(scene), *coarse_tip(scene)],
    )
    values["effect_choices"] = [_told(choice, result.shares) for choice in choices(scene)]
    values |= _motion(scene, result)
    coefficients, reasons = coefficient_keys(scene, values)
    values |= coefficients | _energies(result, values) | _markers(result, values) | _cost(result)
    values |= _heat(result, values)
    reasons |= NO_TARGET | {
        "W_damping_over_E_0": "the material-damping effect is off",
        "W_gravity_over_E_0": "the gravity effect is off",
        "E_hourglass_over_E_0": "fully integrated elements have no hourglass modes",
        "bands": "one mesh alone has no band: run the study, or a second tip size",
    }
    if result.vibration_check is None:
        reasons["E_vib_check_over_E_0"] = (
            "the strain that the last forces release was not found"
            if result.finished
            else "the run ended before the last separation was certain"
        )
    if result.heat is None:
        reasons |= dict.fromkeys((k.name for k in HEATING), "the contact-heating effect is off")
    if "vibration" not in scene.active:
        reasons |= dict.fromkeys(VIBRATING, "the vibration effect is off: the rod is rigid behind its nose")
    return explained(values, reasons)


def _doubts(result: SolidResult) -> list[str]:
    return [*result.warnings, *_ringing(result), *_unresolved(result)]


def _ringing(result: SolidResult) -> list[str]:
    """Tell of vibration above the modes where it is not small beside theirs."""
    vibration, E_0 = result.flight.energy, result.E_0
    above = sum(result.vibration_check or (vibration,)) - vibration
    if above <= max(RINGING * vibration, LEAST * E_0):
        return []
    return [
        f"E_vib lacks {above / E_0:.1e} of E_0 that vibrates above its {len(result.flight.a)} modes and that "
        "E_vib_check holds: fine cells of the tip ring by themselves, or the blow was too short for modes. "
        "Compare twice the accuracy.across, or another accuracy.tip_size or grid_shift."
    ]


def _unresolved(result: SolidResult) -> list[str]:
    """Tell which effects' shares of the run time are not known, and why."""
    names = [name for name, share in result.shares.items() if share is None]
    if not names:
        return []
    return [
        f"The share of the run time of {', '.join(names)} is not known: it was too short for the processor's "
        "clock beside the rest."
    ]


def _told(choice: Choice, shares: Mapping[str, float | None]) -> dict[str, Any]:
    """Return a choice with the measured share of its own items, where it has any, for the expected one."""
    told = choice.told()
    return told | {"share": shares.get(choice.name, told["share"])}


def _open_ledger(result: SolidResult) -> str:
    share = result.worst / result.E_0
    if share <= RESIDUAL_LIMIT:
        return ""
    return f"The energy ledger misses {share:.1e} of E_0, more than {RESIDUAL_LIMIT:g}: do not use this run."


def _motion(scene: Scene, result: SolidResult) -> Values:
    """Return velocities before and after; gravity's share of the fall since time 0 is taken out."""
    alpha, motion = scene.impact.angle, result.motion
    fall = rigid.GRAVITY * result.time if "gravity" in scene.active else 0.0
    V_n, V_t = motion.V_n + fall * np.cos(alpha), motion.V_t + fall * np.sin(alpha)
    return motion_keys(scene, V_n, V_t, motion.Omega, motion.mass, motion.inertia / motion.mass)


def _energies(result: SolidResult, values: Values) -> Values:
    a, E_0 = result.accounts, result.E_0
    V_n, V_t, Omega = (values[k] for k in ("V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s"))
    kept = rigid.kinetic_energy(V_n, V_t, Omega, mass=values["mass_kg"], k2=values["k_squared_m2"])
    vibration, floor = result.flight.energy, result.worst
    check = result.vibration_check
    shares = {
        "E_r": float(kept),
        "E_vib": vibration,
        "E_vib_floor": floor,
        "W_friction": a["friction"],
        "W_skin": a["friction"] + result.skin_share * a["plastic_barrier"],
        "E_plastic_rod": a["plastic_rod"],
        "E_plastic_barrier": a["plastic_barrier"],
        "E_locked_rod": a["strain_rod"] - (check[1] if check else result.flight.strain),
        "E_locked_barrier": a["strain_barrier"] + a["kinetic_barrier"],
        "W_radiated": a["radiated"],
        "W_closing": a["closing"],
        "residual": a["residual"],
    }
    if "material-damping" in result.scene.active:
        shares["W_damping"] = a["damping"]
    if "gravity" in result.scene.active:
        shares["W_gravity"] = float(kept) - result.motion.kinetic - a["gravity"]
    if result.model.rod_stiffness is None:
        shares["E_locked_rod"] += a["kinetic_rod"] - result.motion.kinetic  # the nose rings a little
        del shares["E_vib"], shares["E_vib_floor"]
    found: Values = {f"{name}_over_E_0": float(value / E_0) for name, value in shares.items()}
    found["E_vib_check_over_E_0"] = None if check is None else sum(check) / E_0
    below = None if result.model.rod_stiffness is None else bool(vibration < floor)
    return found | {"E_0_J": E_0, "E_vib_below_floor": below}


def _heat(result: SolidResult, values: Values) -> Values:
    """Return flash temperature and bound, and rigid theory's friction loss less the vibration in it."""
    watch, vibration = result.heat, values.get("E_vib_over_E_0")
    if watch is None or not watch.power:
        return {}
    power, patch, speed = (np.array(values) for values in (watch.power, watch.patch, watch.speed))
    flux = np.divide(power, patch, out=np.zeros_like(power), where=patch > 0)
    found = flash(np.array(watch.t), flux, np.sqrt(patch / np.pi), speed, *halves(result.scene))
    keys = heat_keys(result.scene, found, float(power.max()), float(flux.max()), float(patch.max()))
    share = None if vibration is None else values["E_lt_edge_over_E_0"] - vibration
    return keys | {"E_lt_less_vibration_over_E_0": share}


def _markers(result: SolidResult, values: Values) -> Values:
    marked = replay(result, values["V_n_m_per_s"], values["V_t_m_per_s"])
    return {
        "marker_V_n_m_per_s": marked.V_n,
        "marker_V_t_m_per_s": marked.V_t,
        "marker_Omega_rad_per_s": marked.Omega,
        "marker_V_cn_m_per_s": marked.V_cn,
        "marker_V_ct_m_per_s": marked.V_ct,
        "contacts": [
            {
                "start_s": i.start,
                "end_s": i.end,
                "impulse_n_Ns": float(i.impulse_n),
                "impulse_t_Ns": float(i.impulse_t),
            }
            for i in result.model.book.intervals
        ],
    }


def _cost(result: SolidResult) -> Values:
    g, cost = result.model.geometry, result.cost
    rod, barrier = len(g.rod.mesh.cells), len(g.barrier.cells) if g.barrier is not None else 0
    return {
        "peak_force_N": result.peak_force,
        "steps": result.steps,
        "element_steps": result.steps * (rod + barrier),
        "elements_rod": rod,
        "elements_barrier": barrier,
        "elements_yielding": sum(z.count for z in result.model.zones),
        "wall_s": cost.wall,
        "cpu_s": cost.cpu,
        "setup_wall_s": cost.setup_wall,
        "setup_cpu_s": cost.setup_cpu,
        "peak_memory_MB": cost.memory_MB,
        "min_step_s": cost.smallest_step,
        "tip_size_m": g.tip_size,
    }
