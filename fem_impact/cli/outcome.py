"""The summary of a run on standard output."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

from fem_impact.cli.common import headed
from fem_impact.outcome.groups import Energy
from fem_impact.outcome.keys import Num, Unknown, known, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import ABOVE, ADDED, EnergyShare, above_modes, shares
from fem_impact.run.common import strikes_again
from fem_impact.tables.text import wrapped

_MOTION = (
    ("impulse ratio mu", "mu", ""),
    ("V_n after", "V_n_m_per_s", "m/s"),
    ("V_t after", "V_t_m_per_s", "m/s"),
    ("Omega after", "Omega_rad_per_s", "rad/s"),
)
_BARRIER = (
    ("V_n of the barrier after", "V_bn_m_per_s", "m/s"),
    ("V_t of the barrier after", "V_bt_m_per_s", "m/s"),
)
_TURNED = (("Omega of the barrier after", "barrier_Omega_rad_per_s", "rad/s"),)
HEATING = "friction + top 0.1 mm of both"
"""Label of the work that can heat the contact."""
_IF_ON = ("damping", "contact", "plate", "barrier")
"""Shares that are left out where they are not known: their effects are off."""


def print_outcome(outcome: Outcome, out: Path, own_tests: bool = False) -> None:
    """Print the motion after impact, where the energy went, and every warning.

    ``own_tests``: the scene names tests of the user's own, with whose arms e is worked out if they state any.
    """
    lines = [headed(outcome.provenance.scene_id, outcome.provenance.scene_title), ""]
    stated = outcome.restitution.tests_state_arms
    arms = ("tests'" if own_tests else "paper's", "e_paper") if stated else ("tip's", "e_edge")
    restitution = (f"restitution e ({arms[0]} arms)", arms[1], "")
    barrier = outcome.barrier
    moved = any(or_none(v) != 0 for v in (barrier.v_bn, barrier.v_bt, barrier.V_bn, barrier.V_bt))
    turned = or_none(barrier.Omega_b) is not None
    rows = (restitution, *_MOTION, *(_BARRIER if moved else ()), *(_TURNED if turned else ()))
    lines += [_motion(outcome, *row) for row in rows]
    of = "" if isinstance(outcome.validity.mesh_limit, Unknown) else ", on the finest mesh"
    if not outcome.validity.finished:
        of = ", at the stop of this unfinished run"
    gravity = or_none(ADDED.of(outcome.energy))
    added = "" if gravity is None else f", to which gravity added {100 * gravity:.3f} %"
    lines += ["", *wrapped(f"of the initial energy, E_0 = {_number(outcome.energy.E_0)} J{added}{of}:")]
    listed = _listed(outcome)
    lines += [_share(label, value) for label, value in listed.items()]
    lines += [_share("not accounted for", outcome.energy.residual)]
    lines += ["", _share(HEATING, outcome.energy.skin)]
    if or_none(outcome.energy.below_floor):
        floor = _value(outcome.energy.vibration_floor)
        lines += [f"  vibration is below its numerical floor (fraction {floor})"]
    lines += _accuracy(outcome)
    motion = {label: KEY_TABLE[name].of(outcome) for label, name, _ in rows}
    lines += _unknown({**motion, **listed, HEATING: outcome.energy.skin})
    v = outcome.validity
    notes = (*v.assumptions, *v.outside, *v.warnings, *_again(outcome))
    lines += ["", *(line for sentence in notes for line in wrapped(f"note: {sentence}"))]
    sys.stdout.write("\n".join([*lines, f"results: {out}"]) + "\n")


def _again(outcome: Outcome) -> list[str]:
    """Return that the rod strikes again later, of a finished run whose velocities are known."""
    V_n, V_bn = or_none(outcome.motion.V_n), or_none(outcome.barrier.V_bn)
    if V_n is None or V_bn is None or not outcome.validity.finished:
        return []
    return [told] if (told := strikes_again(V_n - V_bn).strip()) else []


def _listed(outcome: Outcome) -> dict[str, Num]:
    """Return the shares of E_0 in this run by their labels."""
    energy, listed = outcome.energy, dict[str, Num]()
    for share in shares("terminal"):
        name, value = share.key.path[-1], share.of(energy)
        if not (isinstance(value, Unknown) and name in _IF_ON):
            listed[_label(share, energy)] = value
        if name == "vibration" and (above := above_modes(energy)):
            listed[ABOVE] = above
    return listed


def _label(share: EnergyShare, energy: Energy) -> str:
    """Return the label of a share; a body in which nothing yields has no residual stress."""
    body = share.key.path[-1].removeprefix("locked_")
    elastic = share.label.startswith("residual") and getattr(energy, f"plastic_{body}") == 0.0
    return f"elastic energy left in {body}" if elastic else share.label


def _accuracy(outcome: Outcome) -> list[str]:
    """Return expected and achieved error and time of a run whose setting a target error chose."""
    v = outcome.validity
    if isinstance(v.accuracy_target, Unknown):
        return []
    both = (("expected", v.expected_error, v.expected_wall), ("achieved", v.achieved_error, v.achieved_wall))
    lines = ["", f"asked for {_percent(v.accuracy_target)}: {known(v.accuracy_setting)}"]
    judged = "e" if isinstance(outcome.energy.vibration, Unknown) else "e and E_vib"  # a rigid rod has none
    for label, error, wall in both:
        lines += [f"  {label} error of {judged} {_percent(error)}, time {_value(wall)} s"]
    limits = or_none(v.mesh_limit) or {}
    names = (("e_edge", "e (tip's arms)"), ("E_vib_over_E_0", "E_vib/E_0"))
    told = ", ".join(f"{label} {_number(limits[name])}" for name, label in names if name in limits)
    return [*lines, f"  all runs together: {told}"] if told else lines


def _percent(value: Num) -> str:
    return f"not known: {value.reason}" if isinstance(value, Unknown) else f"{100 * value:.2g} %"


def _motion(outcome: Outcome, label: str, name: str, unit: str) -> str:
    value, band = outcome.estimate(KEY_TABLE[name])
    spread = f" +- {_number(band)}" if band is not None else ""
    told = "not known" if isinstance(value, Unknown) else f"{_number(value)}{spread} {unit}"
    return f"  {label:<30} {told}".rstrip()


def _share(label: str, share: Num) -> str:
    text = f"{'not known':>11}" if isinstance(share, Unknown) else f"{100 * share:9.3f} %"
    return f"  {label:<30} {text.replace('-0.000', ' 0.000')}"


def _unknown(listed: Mapping[str, Num]) -> list[str]:
    """Return why shares are not known, each reason once."""
    named: dict[str, list[str]] = {}
    for label, value in listed.items():
        if isinstance(value, Unknown):
            named.setdefault(value.reason, []).append(label)
    notes = [wrapped(f"not known ({'; '.join(labels)}): {reason}", "  ") for reason, labels in named.items()]
    return [line for lines in ([""], *notes) for line in lines] if notes else []


def _value(value: Num) -> str:
    return f"not known: {value.reason}" if isinstance(value, Unknown) else _number(value)


def _number(value: float) -> str:
    return f"{value:.4g}"
