"""What a run did not resolve, its contact or its last separation, is unknown."""

from __future__ import annotations

from dataclasses import fields, replace
from math import pi, sqrt
from typing import TYPE_CHECKING, Any, TypeVar

from fem_impact.case.cells import LEAST, advice, contact_edge, contact_radius, kind
from fem_impact.outcome.groups import ARMS, Heat, Markers, Readings
from fem_impact.outcome.keys import Unknown, unknown
from fem_impact.outcome.record import Outcome
from fem_impact.physics.contact_law import begins_to_yield

if TYPE_CHECKING:
    from fem_impact.case.bodies import Bodies
    from fem_impact.outcome.groups import ArmCoefficients, BarrierMotion, Energy, RodMotion
    from fem_impact.solid.run import SolidResult


T = TypeVar("T", "ArmCoefficients", "BarrierMotion", "Energy", "Heat", "RodMotion")
ARM_LENGTHS = ("d_c", "d_d")
NOT_RESOLVED = "the contact was not resolved:"
# of E_0, at most lost in closing: the measured sets lose 0.0001 to 0.0006, drawn scenes up to 0.004
LOST = 0.02
AFTER, AFTER_BARRIER = ("V_n", "V_t", "Omega"), ("V_bn", "V_bt", "Omega_b")
LEDGER = ("E_0", "vibration_floor", "below_floor", "residual")  # valid without a resolved contact


def unresolved(result: SolidResult) -> str:
    """Return why the contact was not resolved and what resolves it, an empty string where it was.

    One row of nodes is pressed as hard as its cells are large: levels of it agree, and see no flow where
    finer ones do.
    """
    bodies = result.case.bodies
    h = contact_edge(bodies)
    if result.peak_nodes < least_nodes(bodies):
        # how narrow the contact was when the force was largest, and what resolves it
        radius = h * sqrt(2 * max(result.peak_nodes, 1) / pi)
        too_narrow = (
            f"at its peak {result.peak_nodes} nodes of the half model were pressed, fewer than "
            f"{least_nodes(bodies)}, on elements of {h * 1e3:.2g} mm. "
            f"{advice(bodies, min(radius, contact_radius(bodies)))}"
        )
        return f'{NOT_RESOLVED} {too_narrow}, or accuracy.unresolved = "report"'
    if result.record.rows == 1 and begins_to_yield(bodies.contact):
        return (
            f"{NOT_RESOLVED} it is one row of nodes wide on elements of {h * 1e3:.2g} mm, whose size sets "
            f"its pressure, and the estimated contact yields. {advice(bodies, h / 2)}, or "
            'accuracy.unresolved = "report"'
        )
    lost = result.accounts["contact_dissipation"] / result.E_0
    if lost > LOST:
        half = 0.5e3 * result.model.geometry.tip_size
        return (
            f"{NOT_RESOLVED} its nodes lost {100 * lost:.2g} % of E_0 when they met the barrier, more than "
            f"{100 * LOST:g} %, and that loss belongs to the mesh. "
            f'Give accuracy.tip_size = {half:.2g} mm or less, or accuracy.unresolved = "report"'
        )
    return ""


def least_nodes(bodies: Bodies) -> int:
    """Return the nodes of the half model that a resolved contact presses at once: half a disc of cells."""
    return round(pi / 2 * LEAST[kind(bodies)] ** 2)


def without(outcome: Outcome, reason: Unknown) -> Outcome:
    """Return an outcome that does not know what a contact gives which is not resolved.

    These are the motion after the impact, coefficients, impulse ratio, shares, peak force and heat. Times and
    impulses of contact stay, as a record of what the mesh did.
    """
    left = _without_after(outcome, reason)
    return replace(
        left,
        energy=_blank(outcome.energy, reason, _others(outcome.energy, LEDGER)),
        contact=replace(left.contact, peak_force=reason),
        heat=outcome.heat if isinstance(outcome.heat.power, Unknown) else unknown(Heat, reason.reason),
    )


def without_end(outcome: Outcome, why: str) -> Outcome:
    """Return an outcome without what rests on the last separation, which a run did not reach, and ``why``.

    These are the motion after the impact, coefficients, losses and impulse ratio; the energies stay, as those
    at the stop.
    """
    reason = Unknown(f"the run did not finish: {why}")
    left = _without_after(outcome, reason)
    return replace(
        left,
        restitution=replace(left.restitution, mu_c=reason),
        heat=_blank(outcome.heat, reason, ("less_vibration",)),
    )


def without_coefficients(outcome: Outcome, reason: Unknown) -> Outcome:
    """Return an outcome that knows neither coefficients of restitution nor the losses by them."""
    of_arms = {name: getattr(outcome.restitution, name) for name in ARMS}
    arms = {name: _blank(arm, reason, _others(arm, ARM_LENGTHS)) for name, arm in of_arms.items()}
    return replace(outcome, restitution=replace(outcome.restitution, **arms))


def _without_after(outcome: Outcome, reason: Unknown) -> Outcome:
    """Return an outcome that knows neither the motion after the impact nor what follows from it."""
    outcome = without_coefficients(outcome, reason)
    coefficients, barrier = outcome.restitution, outcome.barrier
    moved = () if isinstance(barrier.mass, Unknown) else AFTER_BARRIER
    markers, readings = unknown(Markers, reason.reason), unknown(Readings, reason.reason)
    return replace(
        outcome,
        motion=_blank(outcome.motion, reason, AFTER),
        barrier=_blank(barrier, reason, moved),
        restitution=replace(coefficients, mu=reason),
        contact=replace(outcome.contact, markers=markers, readings=readings),
    )


def _others(group: ArmCoefficients | Energy, valid: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the numbers of a group but the ``valid`` ones."""
    return tuple(field.name for field in fields(group) if field.name not in valid)


def _blank(group: T, reason: Unknown, names: tuple[str, ...]) -> T:
    """Return a group of numbers in which those of ``names`` that were known are unknown for a reason."""
    blank: dict[str, Any] = {n: reason for n in names if not isinstance(getattr(group, n), Unknown)}
    return replace(group, **blank)
