"""Keys of an outcome that every fidelity fills in the same way: provenance, motion, coefficients."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import rigid
from fem_impact.contact_law import softer
from fem_impact.estimates import arms, projectile
from fem_impact.outcome import Outcome, installed_versions, utc_now
from fem_impact.scene import validity
from rigid.experiments import measured_set

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = [
    "NO_TARGET",
    "Values",
    "coefficient_keys",
    "explained",
    "motion_keys",
    "plastic_keys",
    "provenance",
]

Values = dict[str, Any]

NO_TARGET = dict.fromkeys(
    (
        *("accuracy_target", "accuracy_setting", "expected_error", "expected_wall_s"),
        *("achieved_error", "achieved_wall_s", "extrapolated"),
    ),
    "the scene gives a mesh, not the error it allows",
)
"""Reasons of a run that no target chose."""

ROUND_OFF = 1e-9  # a moment impulse over that of the normal impulse at arm d_d: below it there is none
UNDETERMINED = "the contact point does not approach, or no moment acts about the mass centre: 0 / 0"


def provenance(
    scene: Scene,
    fidelity: str,
    finished: bool,
    stopped_because: str,
    assumptions: Iterable[str] = (),
    warnings: Iterable[str] = (),
    without: Iterable[str] = (),
) -> Values:
    """Return where a record comes from and how far to trust it; ``without`` are effects it does not know."""
    return {
        "fidelity": fidelity,
        "scene_id": scene.id,
        "scene_title": scene.title,
        "scene_digest": scene.digest(),
        "created_utc": utc_now(),
        "versions": installed_versions(),
        "finished": finished,
        "stopped_because": stopped_because,
        "effects": [name for name in scene.active if name not in without],
        "assumptions": list(assumptions),
        "validity": list(validity(scene)),
        "warnings": list(warnings),
    }


def explained(values: Values, reasons: Mapping[str, str]) -> Outcome:
    """Return the record; of the reasons those of what is not known."""
    return Outcome(values, {key: why for key, why in reasons.items() if values.get(key) is None})


def motion_keys(scene: Scene, V_n: float, V_t: float, Omega: float, mass: float, k2: float) -> Values:
    """Return motion before and after (m/s, rad/s, gravity removed) and the rod's constants (kg, m2)."""
    impact, (d_c, d_d) = scene.impact, arms(scene)
    body = {"d_c": d_c, "d_d": d_d, "k2": k2, "omega": impact.omega}
    e = float(rigid.restitution(impact.v_n, V_n, Omega, d_c, impact.omega))
    mu_c = rigid.critical_ratio(impact.v_n, impact.v_t, e=e, **body)
    return {
        "v_n_m_per_s": impact.v_n,
        "v_t_m_per_s": impact.v_t,
        "V_n_m_per_s": float(V_n),
        "V_t_m_per_s": float(V_t),
        "Omega_rad_per_s": float(Omega),
        "mu": float(rigid.impulse_ratio(impact.v_n, impact.v_t, V_n, V_t)),
        "mu_c": float(mu_c),
        "friction_f": scene.surface.friction if "friction" in scene.active else 0.0,
        "alpha_rad": impact.angle,
        "mass_kg": mass,
        "k_squared_m2": k2,
        "gamma_per_m0_3815": projectile(scene).gamma,
    }


def coefficient_keys(scene: Scene, motion: Values) -> tuple[Values, dict[str, str]]:
    """Return the coefficients with the three sets of arms, and why a set of arms is missing."""
    values: Values = {}
    reasons: dict[str, str] = {}
    for name, pair in _arm_sets(scene, motion).items():
        if pair is None:
            missing = "the scene repeats no measured set, so no table gives its arms"
            reasons |= dict.fromkeys(_arm_keys(name), missing)
        else:
            values |= _with_arms(name, pair, scene.impact.omega, motion)
            reasons |= {key: UNDETERMINED for key in _arm_keys(name) if values[key] is None}
    return values, reasons


def plastic_keys(scene: Scene, share: float) -> Values:
    """Return the plastic work of both bodies: the law lets only the softer one yield."""
    soft = softer(scene)
    in_rod = soft is not None and soft == scene.projectile.material and "rod-plasticity" in scene.active
    return {
        "E_plastic_rod_over_E_0": share if in_rod else 0.0,
        "E_plastic_barrier_over_E_0": 0.0 if in_rod else share,
    }


def _arm_sets(scene: Scene, motion: Values) -> dict[str, tuple[float, float] | None]:
    """Return (d_c, d_d) of the paper, the edge geometry and the centre of impulse.

    The centre of the impulse is the point at the height of the geometric contact where the moment
    impulse vanishes: d_c = (k^2 (Omega - omega) + d_d (V_t - v_t)) / (V_n - v_n), so e_m = -1.
    """
    d_c, d_d = arms(scene)
    gained_n = motion["V_n_m_per_s"] - motion["v_n_m_per_s"]
    gained_t = motion["V_t_m_per_s"] - motion["v_t_m_per_s"]
    spin = motion["k_squared_m2"] * (motion["Omega_rad_per_s"] - scene.impact.omega)
    paper = measured_set(scene.measured).arms if scene.measured else None
    return {
        "paper": (float(paper.d_c), float(paper.d_d)) if paper else None,
        "edge": (d_c, d_d),
        "impulse": ((spin + d_d * gained_t) / gained_n, d_d),
    }


def _arm_keys(name: str) -> list[str]:
    shares = [f"E_{kind}_{name}_over_E_0" for kind in ("ln", "lt")]
    return [f"d_c_{name}_m", f"d_d_{name}_m", f"e_{name}", f"e_m_{name}", *shares]


def _with_arms(name: str, pair: tuple[float, float], omega: float, values: Values) -> Values:
    """Return the keys of one set of arms; what it leaves undetermined is None."""
    v_n, v_t, V_n, V_t, Omega = (
        values[k] for k in ("v_n_m_per_s", "v_t_m_per_s", "V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s")
    )
    (d_c, d_d), k2 = pair, values["k_squared_m2"]
    body = {"d_c": d_c, "d_d": d_d, "k2": k2, "omega": omega}
    lost = rigid.losses(v_n, v_t, V_n, V_t, Omega, **body, mass=values["mass_kg"]).fractions()
    e = e_m = None
    if v_n + d_c * omega < 0:
        e, _, e_m = (float(c) for c in rigid.coefficients(v_n, v_t, V_n, V_t, Omega, **body))
        moment = d_c * (V_n - v_n) - d_d * (V_t - v_t) + k2 * omega
        e_m = e_m if abs(moment) > ROUND_OFF * d_d * (V_n - v_n) else None
    numbers = [*pair, e, e_m, float(lost.E_ln), float(lost.E_lt)]
    return dict(zip(_arm_keys(name), numbers, strict=True))
