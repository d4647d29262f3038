"""Sentences on the errors of a run's numbers, the same on the terminal and on the pages."""

from fem_impact.outcome.keys import Num, Unknown, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import heat_ends

HEATING = "friction + top 0.1 mm of both"
"""Label of the work that can heat the contact."""
MOTION = (
    ("impulse ratio mu", "mu", ""),
    ("V_n after", "V_n_m_per_s", "m/s"),
    ("V_t after", "V_t_m_per_s", "m/s"),
    ("Omega after", "Omega_rad_per_s", "rad/s"),
)
"""Label, key and unit of what is told of the motion after the restitution."""


def errors_said(outcome: Outcome, target_of: str | None) -> list[str]:
    """Return what a run says of the error that was asked for, or why its errors are not known.

    ``target_of``: the quantity that the scene wants an error of, None for e and E_vib.
    """
    v = outcome.validity
    if isinstance(v.accuracy_target, Unknown):
        if outcome.provenance.fidelity == "rigid" or not isinstance(outcome.half_widths, Unknown):
            return []
        return [f"error of these numbers not known: {outcome.half_widths.reason}"]
    rigid = isinstance(outcome.energy.vibration, Unknown)  # then there is no E_vib
    judged = target_of or ("e" if rigid else "e and E_vib")
    said = [
        f"asked for {_percent(v.accuracy_target)}; reached in {judged} {_percent(v.achieved_error)}, "
        f"in {_value(v.achieved_wall)} s"
    ]
    limits = or_none(v.mesh_limit) or {}
    names = (("e_edge", "e (tip's arms)"), ("E_vib_over_E_0", "E_vib/E_0"))
    together = ", ".join(f"{label} {limits[name]:.4g}" for name, label in names if name in limits)
    return [*said, f"limits of all levels: {together}"] if together else said


def floor_said(outcome: Outcome) -> list[str]:
    """Return that the vibration is below its floor, nothing where it is not."""
    if not or_none(outcome.energy.below_floor):
        return []
    return [f"vibration is below its numerical floor (fraction {_value(outcome.energy.vibration_floor)})"]


def heat_said(outcome: Outcome) -> list[str]:
    """Return between what the work that can heat the contact lies, nothing where its error is known."""
    ends = heat_ends(outcome)
    return [f"{HEATING}: no error of it is known: {ends}"] if ends else []


def _percent(value: Num) -> str:
    return f"not known: {value.reason}" if isinstance(value, Unknown) else f"{100 * value:.2g} %"


def _value(value: Num) -> str:
    return f"not known: {value.reason}" if isinstance(value, Unknown) else f"{value:.4g}"
