"""Whether rigid-body theory may be used for a rod: the drop computed with and without vibration."""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin
from typing import Any

import numpy as np

from fem_impact.assess.drop import DroppedRod
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import Outcome
from fem_impact.reference.free_modes import bending_period
from fem_impact.run.simulate import simulate
from fem_impact.scene.library import materials, surface
from fem_impact.scene.types import Barrier, Impact, ProjectileSpec, Scene

ANGLES = np.radians(np.arange(5.0, 81.0, 5.0))
FAIR, POOR = 0.02, 0.05
"""Errors of e below which the answer is yes, and from which it is no."""

EFFECTS = ("friction", "rod-plasticity", "barrier-elastoplastic", "large-rotation")


def rigid_enough(case: DroppedRod, fidelity: str = "modal") -> dict[str, Any]:
    """Compute the drop with a vibrating rod and with a rigid one, with the same contact.

    Parameters
    ----------
    case : DroppedRod
        Rod and plate are of the paper's steels; tip and plate yield.
    fidelity : "modal" or "solid"
        Model for the stated angle; "solid" takes minutes. Other angles are computed with "modal".

    Returns
    -------
    dict
        Plain JSON: both results at the stated angle, the share of vibration, T1/tau (first bending period
        over contact time), the worst angle and its fidelity, the error of e and the answers in words.
    """
    alpha = float(case.alpha)
    free, stiff = _both(case, alpha, fidelity)
    others = (angle for angle in map(float, ANGLES) if angle != alpha)
    pairs = {alpha: (free, stiff)} | {angle: _both(case, angle, "modal") for angle in others}
    errors = {angle: abs(_e(a) - _e(b)) for angle, (a, b) in pairs.items()}
    worst = max(errors, key=lambda angle: errors[angle])
    touch = known(stiff.contact.intervals)[0]
    steel, rod = materials()["rod-steel"], case.rod
    period = bending_period(steel.E, steel.nu, steel.rho, rod.length, rod.diameter / 2)
    return {
        "fidelity": fidelity,
        "with_vibration": _shown(free),
        "rigid": _shown(stiff),
        "E_vib_over_E_0": known(free.energy.vibration),
        "T1_over_tau": period / touch.duration,
        "error_of_e": errors[alpha],
        "worst_angle_rad": worst,
        "worst_fidelity": fidelity if worst == alpha else "modal",
        "worst_error_of_e": errors[worst],
        "answer": _answer(errors[alpha]),
        "answer_any_angle": _answer(errors[worst]),
    }


def _e(run: Outcome) -> float:
    return known(run.restitution.edge.e)


def _shown(run: Outcome) -> dict[str, float]:
    return {
        "e": _e(run),
        "mu": known(run.restitution.mu),
        "Omega_rad_per_s": run.motion.Omega,
        "E_r_over_E_0": known(run.energy.rigid),
        "W_friction_over_E_0": known(run.energy.friction),
    }


def _both(case: DroppedRod, angle: float, fidelity: str) -> tuple[Outcome, Outcome]:
    """Return the outcomes of the drop at an angle, rad, with and without vibration."""
    steels, rod = materials(), case.rod
    tip: Any = rod.tip
    scene = Scene(
        id="assessed-rod",
        title="a dropped rod that is assessed",
        projectile=ProjectileSpec(rod.length, rod.diameter, tip, rod.tip_radius, steels["rod-steel"]),
        barrier=Barrier(steels["plate-steel"]),
        surface=surface(case.surface),
        impact=Impact(angle, -case.speed * cos(angle), -case.speed * sin(angle)),
        effects=EFFECTS,
    )
    vibrating = replace(scene, effects=("vibration", *EFFECTS))
    return simulate(vibrating, fidelity), simulate(scene, fidelity)


def _answer(error: float) -> str:
    if error < FAIR:
        return "yes"
    return "yes, if the stated error is allowed" if error < POOR else "no"
