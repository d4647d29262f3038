"""What must hold of the outcome of every physical scene, however it ended."""

from __future__ import annotations

from collections.abc import Iterator

from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import Outcome

LEDGER = 1e-4  # of E_0
ROUND_OFF = 1e-9  # of E_0
LOWEST_E, HIGHEST_E = 0.0, 1.05  # kinematic restitution that needs no explanation
STRIKES_AGAIN = "strikes again later", "other end strikes"
UNRESOLVED = "the contact was not resolved"


def faults(outcome: Outcome) -> list[str]:
    """Return a sentence for each rule that an outcome breaks; a run that did not finish claims nothing."""
    return [*_of_finished(outcome)] if outcome.validity.finished else []


def is_resolved(outcome: Outcome) -> bool:
    """Return whether the outcome gives its numbers."""
    return not isinstance(outcome.restitution.mu, Unknown)


def _of_finished(outcome: Outcome) -> Iterator[str]:
    if abs(outcome.energy.residual) > LEDGER:
        yield f"the ledger misses {outcome.energy.residual:.1e} of E_0"
    away = outcome.motion.V_n - outcome.barrier.V_bn
    if away <= 0 and not any(words in outcome.validity.stopped_because for words in STRIKES_AGAIN):
        yield f"its mass centre goes into the barrier at {-away:.3g} m/s"
    yield from _of_resolved(outcome) if is_resolved(outcome) else _of_unresolved(outcome)


def _of_unresolved(outcome: Outcome) -> Iterator[str]:
    energy = outcome.energy
    given = (outcome.restitution.edge.e, energy.rigid, energy.vibration, energy.friction, energy.plastic)
    if not all(isinstance(value, Unknown) for value in given):
        yield "gives numbers of a contact that it did not resolve"
    if not any(UNRESOLVED in reason for reason in outcome.reasons.values()):
        yield "does not say why it gives no numbers"


def _of_resolved(outcome: Outcome) -> Iterator[str]:
    energy = outcome.energy
    gravity, friction, vibration = (
        or_none(value) or 0.0 for value in (energy.gravity, energy.friction, energy.vibration)
    )
    if friction < -ROUND_OFF:
        yield f"friction gives {-friction:.1e} of E_0"
    if vibration < -ROUND_OFF:
        yield f"vibration is {vibration:.1e} of E_0"
    kept = (or_none(energy.rigid) or 0.0) + vibration
    if kept > 1 + gravity + LEDGER:
        yield f"the rod keeps {kept:.5f} of E_0, gravity gives {gravity:.5f}"
    total = shares(outcome)
    if abs(total - 1 - gravity) > LEDGER:
        yield f"the shares sum to {total:.5f} of E_0, gravity gives {gravity:.5f}"
    yield from _of_restitution(outcome)


def shares(outcome: Outcome) -> float:
    """Return the sum of where the energy went, of E_0; a rigid nose's ringing is in what is locked in."""
    energy = outcome.energy
    vibration = energy.vibration if isinstance(energy.vibration_check, Unknown) else energy.vibration_check
    parts = (energy.rigid, vibration, energy.friction, energy.plastic_rod, energy.plastic_barrier)
    rest = (
        energy.locked_rod,
        energy.locked_barrier,
        energy.radiated,
        energy.contact_dissipation,
        energy.damping,
    )
    others = (energy.plate, energy.barrier, energy.contact)
    return sum(or_none(part) or 0.0 for part in (*parts, *rest, *others)) + energy.residual


def _of_restitution(outcome: Outcome) -> Iterator[str]:
    """A number that no blow on a resting barrier gives by itself is explained on the outcome."""
    e, mu, f = or_none(outcome.restitution.edge.e), or_none(outcome.restitution.mu), outcome.motion.friction
    rigid, told = or_none(outcome.energy.rigid), {words[:3] for words in texts(outcome.validity.limitations)}
    if e is not None and not LOWEST_E <= e <= HIGHEST_E and "e =" not in told:
        yield f"e = {e:.4g} without a word"
    if mu is not None and abs(mu) > 1.2 * f + 0.02 and "mu " not in told:
        yield f"mu = {mu:.4g} at f = {f:.4g} without a word"
    if rigid is not None and rigid > 1 + LEDGER and "E_r" not in told:
        yield f"E_r = {rigid:.5f} without a word"
