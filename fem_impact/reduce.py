"""From the end of a run to the quantities of the study: the flat Outcome record."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import rigid
from fem_impact.estimates import projectile
from fem_impact.markers import replay
from fem_impact.outcome import Outcome, installed_versions, utc_now
from fem_impact.scene import validity
from rigid.experiments import measured_set

if TYPE_CHECKING:
    from fem_impact.scene import Scene
    from fem_impact.solid.run import SolidResult

Values = dict[str, Any]

RESIDUAL_LIMIT = 1e-4  # of E_0: above it the run failed


def reduce(scene: Scene, result: SolidResult) -> Outcome:
    """Return the Outcome of a run; what cannot be known is null with its reason."""
    motion = _motion(scene, result)
    values = _provenance(scene, result) | motion | _body(scene, result, motion)
    reasons: dict[str, str] = {}
    for name, arms in _arm_sets(scene, motion, result.motion.inertia / result.motion.mass).items():
        if arms is None:
            reasons |= dict.fromkeys(
                _arm_keys(name), "the scene repeats no measured set, so no table gives its arms"
            )
        else:
            values |= _with_arms(name, arms, values)
    values |= _energies(result, values) | _markers(result, values) | _cost(scene, result)
    reasons |= {
        "W_damping_over_E_0": "no material damping is modelled",
        "E_hourglass_over_E_0": "fully integrated elements have no hourglass modes",
        "bands": "one mesh alone has no band: run the study, or a second tip size",
    }
    if result.vibration_check is None:
        reasons["E_vib_check_over_E_0"] = "the run ended before the last separation was certain"
    return Outcome(values, {k: v for k, v in reasons.items() if values.get(k) is None})


def _provenance(scene: Scene, result: SolidResult) -> Values:
    open_ledger = _open_ledger(result)
    return {
        "fidelity": "solid",
        "scene_id": scene.id,
        "scene_title": scene.title,
        "scene_digest": scene.digest(),
        "created_utc": utc_now(),
        "versions": installed_versions(),
        "finished": result.finished and not open_ledger,
        "stopped_because": open_ledger or result.reason,
        "effects": list(scene.effects),
        "validity": list(validity(scene)),
        "warnings": list(result.warnings),
    }


def _open_ledger(result: SolidResult) -> str:
    share = result.worst / result.E_0
    if share <= RESIDUAL_LIMIT:
        return ""
    return f"The energy ledger misses {share:.1e} of E_0, more than {RESIDUAL_LIMIT:g}: do not use this run."


def _motion(scene: Scene, result: SolidResult) -> Values:
    """Return velocities before and after; gravity's share of the fall since time 0 is taken out."""
    impact, alpha = scene.impact, scene.impact.angle
    fall = rigid.GRAVITY * result.time if "gravity" in scene.effects else 0.0
    V_n, V_t = result.motion.V_n + fall * np.cos(alpha), result.motion.V_t + fall * np.sin(alpha)
    return {
        "v_n_m_per_s": impact.v_n,
        "v_t_m_per_s": impact.v_t,
        "V_n_m_per_s": float(V_n),
        "V_t_m_per_s": float(V_t),
        "Omega_rad_per_s": result.motion.Omega,
        "mu": float(rigid.impulse_ratio(impact.v_n, impact.v_t, V_n, V_t)),
        "friction_f": scene.surface.friction if "friction" in scene.effects else 0.0,
        "alpha_rad": alpha,
    }


def _body(scene: Scene, result: SolidResult, motion: Values) -> Values:
    rod, impact = projectile(scene), scene.impact
    d_c, d_d = rod.arms(impact.angle)
    k2 = result.motion.inertia / result.motion.mass
    e = float(rigid.restitution(impact.v_n, motion["V_n_m_per_s"], result.motion.Omega, d_c, impact.omega))
    mu_c = rigid.critical_ratio(impact.v_n, impact.v_t, e=e, d_c=d_c, d_d=d_d, k2=k2)
    return {
        "mass_kg": result.motion.mass,
        "k_squared_m2": k2,
        "gamma_per_m0_3815": rod.gamma,
        "mu_c": float(mu_c),
    }


def _arm_sets(scene: Scene, motion: Values, k2: float) -> dict[str, tuple[float, float] | None]:
    """Return (d_c, d_d) of the paper, the edge geometry and the centre of impulse.

    The centre of the impulse is the point at the height of the geometric contact where the moment
    impulse vanishes: d_c = (k^2 (Omega - omega) + d_d (V_t - v_t)) / (V_n - v_n), so e_m = -1.
    """
    d_c, d_d = (float(d) for d in projectile(scene).arms(scene.impact.angle))
    gained_n = motion["V_n_m_per_s"] - motion["v_n_m_per_s"]
    gained_t = motion["V_t_m_per_s"] - motion["v_t_m_per_s"]
    spin = k2 * (motion["Omega_rad_per_s"] - scene.impact.omega)
    paper = measured_set(scene.measured).arms if scene.measured else None
    return {
        "paper": (float(paper.d_c), float(paper.d_d)) if paper else None,
        "edge": (d_c, d_d),
        "impulse": ((spin + d_d * gained_t) / gained_n, d_d),
    }


def _arm_keys(name: str) -> list[str]:
    shares = [f"E_{kind}_{name}_over_E_0" for kind in ("ln", "lt")]
    return [f"d_c_{name}_m", f"d_d_{name}_m", f"e_{name}", f"e_m_{name}", *shares]


def _with_arms(name: str, arms: tuple[float, float], values: Values) -> Values:
    velocities = [
        values[k] for k in ("v_n_m_per_s", "v_t_m_per_s", "V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s")
    ]
    body = {"d_c": arms[0], "d_d": arms[1], "k2": values["k_squared_m2"]}
    found = rigid.coefficients(*velocities, **body)
    lost = rigid.losses(*velocities, **body, mass=values["mass_kg"]).fractions()
    numbers: list[Any] = [*arms, found.e, found.e_m, lost.E_ln, lost.E_lt]
    return {key: float(number) for key, number in zip(_arm_keys(name), numbers, strict=True)}


def _energies(result: SolidResult, values: Values) -> Values:
    a, E_0 = result.accounts, result.E_0
    V_n, V_t, Omega = (values[k] for k in ("V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s"))
    kept = rigid.kinetic_energy(V_n, V_t, Omega, mass=values["mass_kg"], k2=values["k_squared_m2"])
    vibration, floor = result.flight.energy, result.worst
    shares = {
        "E_r": float(kept),
        "E_vib": vibration,
        "E_vib_floor": floor,
        "W_friction": a["friction"],
        "E_plastic_rod": a["plastic_rod"],
        "E_plastic_barrier": a["plastic_barrier"],
        "E_locked_rod": a["strain_rod"] - result.flight.strain,
        "E_locked_barrier": a["strain_barrier"] + a["kinetic_barrier"],
        "W_radiated": a["radiated"],
        "W_closing": a["closing"],
        "residual": a["residual"],
    }
    found: Values = {f"{name}_over_E_0": float(value / E_0) for name, value in shares.items()}
    check = result.vibration_check
    found["E_vib_check_over_E_0"] = None if check is None else check / E_0
    return found | {"E_0_J": E_0, "E_vib_below_floor": bool(vibration < floor)}


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


def _cost(scene: Scene, result: SolidResult) -> Values:
    g, cost = result.model.geometry, result.cost
    rod, barrier = len(g.rod.mesh.cells), len(g.barrier.cells) if g.barrier is not None else 0
    return {
        "steps": result.steps,
        "element_steps": result.steps * (rod + barrier),
        "elements_rod": rod,
        "elements_barrier": barrier,
        "elements_yielding": sum(z.count for z in result.model.zones),
        "wall_s": cost.wall,
        "cpu_s": cost.cpu,
        "peak_memory_MB": cost.memory_MB,
        "min_step_s": cost.smallest_step,
        "tip_size_m": g.tip_size,
    }


def write_contacts(outcome: Outcome, out: Path) -> None:
    """Write contacts.csv of a run."""
    from fem_impact.output import CONTACTS, write_table

    write_table(out / "contacts.csv", CONTACTS, outcome["contacts"])
