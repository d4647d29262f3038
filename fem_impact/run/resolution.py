"""Check of whether the mesh of a run resolved its contact; if not, coefficients and shares are unknown."""

from __future__ import annotations

from dataclasses import fields, replace
from math import pi, sqrt
from typing import TYPE_CHECKING, Any, TypeVar

from fem_impact.outcome.groups import ARMS
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.plan.limits import ADVISED_CELLS, LEAST_CELLS, contact_radius

if TYPE_CHECKING:
    from fem_impact.outcome.groups import ArmCoefficients, Energy
    from fem_impact.solid.run import SolidResult


T = TypeVar("T", "ArmCoefficients", "Energy")
LEAST_NODES = round(pi / 2 * LEAST_CELLS**2)  # nodes of the half model in contact at its peak
ARM_LENGTHS = ("d_c", "d_d")
LEDGER = ("E_0", "vibration_floor", "below_floor", "residual")  # valid without a resolved contact


def is_resolved(result: SolidResult) -> bool:
    """Return whether enough nodes were pressed at once when the contact was widest."""
    return result.peak_nodes >= LEAST_NODES


def too_narrow(result: SolidResult) -> str:
    """Return the sentence that says how narrow the contact was and what resolves it."""
    h = result.model.geometry.tip_size
    radius = h * sqrt(2 * max(result.peak_nodes, 1) / pi)
    advised = min(radius, contact_radius(result.plan.bodies)) / ADVISED_CELLS
    return (
        f"the contact was not resolved: at its peak {result.peak_nodes} nodes of the half model were "
        f"pressed, fewer than {LEAST_NODES}, on elements of {h * 1e3:.2g} mm. Give accuracy.tip_size = "
        f'{advised * 1e3:.2g} mm or less, or accuracy.unresolved = "report"'
    )


def without(outcome: Outcome, reason: Unknown) -> Outcome:
    """Return an outcome whose coefficients, impulse ratio, shares and peak force are not known."""
    arms = {name: _blank(getattr(outcome.restitution, name), reason, ARM_LENGTHS) for name in ARMS}
    return replace(
        outcome,
        restitution=replace(outcome.restitution, mu=reason, **arms),
        energy=_blank(outcome.energy, reason, LEDGER),
        contact=replace(outcome.contact, peak_force=reason),
    )


def _blank(group: T, reason: Unknown, valid: tuple[str, ...]) -> T:
    """Return a group of numbers with all but the ``valid`` ones unknown for a reason."""
    names = [one.name for one in fields(group) if one.name not in valid]
    blank: dict[str, Any] = {n: reason for n in names if not isinstance(getattr(group, n), Unknown)}
    return replace(group, **blank)
