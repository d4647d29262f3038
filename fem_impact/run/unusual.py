"""Sentences on numbers of an outcome that an impact on a resting barrier does not give by itself."""

from fem_impact.case.case import Case
from fem_impact.case.plates import DEEP, pressed_part
from fem_impact.case.record import ContactRecord
from fem_impact.outcome.groups import Energy, Provenance, Restitution, RodMotion
from fem_impact.outcome.keys import or_none
from fem_impact.physics.contact import ContactPair
from fem_impact.run.common import RESIDUAL_LIMIT

PLOUGHING = 1.1  # largest mu over f that the slope of a crater explains
ROUND_OFF = 1e-9  # of e
LEAST_RATIO = 0.01  # mu allowed where f is 0
CONFIRM = " Confirm it with cells of half the size (accuracy.tip_size, or one level more)."


def unusual(
    provenance: Provenance, motion: RodMotion, restitution: Restitution, energy: Energy, contact: ContactPair
) -> tuple[str, ...]:
    """Return a sentence on each of e, mu and E_r, empty where it is in the range of a plain impact."""
    of_e = _on_restitution(provenance, motion, restitution, contact)
    return of_e, _on_ratio(provenance, motion, restitution), _on_rigid(energy)


def pierced(case: Case, record: ContactRecord, dent: float) -> str:
    """Say how far a dent, m deep, and flow reach through a plate or first layer; nothing if hardly."""
    part, thick = pressed_part(case.scene.barrier)
    if thick is None or record.barrier is None or dent <= DEEP * thick:
        return ""
    deep = min(float(-record.barrier.flowed[:, 2].min(initial=0.0)) / thick, 1.0)
    most = float(record.barrier.strain.max(initial=0.0))
    return (
        f"The dent that stays is {dent * 1e3:.2g} mm deep, {dent / thick:.2g} of the {part}'s "
        f"{thick * 1e3:.3g} mm; cells of this mesh flow down to {deep:.2g} of its thickness, by up to "
        f"{most:.2g} of plastic strain. That it tears or is pierced is left out."
    )


def _on_restitution(
    provenance: Provenance, motion: RodMotion, restitution: Restitution, contact: ContactPair
) -> str:
    """Say where the kinematic restitution gets its speed from, if it is not within 0 to 1."""
    e, meshed = or_none(restitution.edge.e), provenance.fidelity == "solid"
    if e is None or -ROUND_OFF <= e <= 1 + RESIDUAL_LIMIT:
        return ""
    names = {"friction": motion.friction > 0, "bending": "vibration" in provenance.effects}
    names |= {"gravity": "gravity" in provenance.effects, "turning": provenance.fidelity != "rigid"}
    causes = " or ".join(name for name, possible in names.items() if possible)
    if e < 0:
        why = "while the contact point, with the arms at first contact, still approaches"
        return f"e = {e:.3g} is below 0: the tip lifts off by {causes}, {why}.{CONFIRM * meshed}"
    if not causes:
        return f"e = {e:.5g} is above 1, and nothing in the model explains that: do not use this run."
    mesh = f", or the mesh did.{CONFIRM}" if meshed else "."
    came, slid = contact.approach, abs(contact.sliding)
    return (
        f"e = {e:.5g} is above 1: {causes} gave the contact point speed along the normal beside its approach "
        f"at {came:.2g} m/s (it slides at {slid:.2g} m/s), so that e does not measure what the contact "
        f"loses{mesh}"
    )


def _on_ratio(provenance: Provenance, motion: RodMotion, restitution: Restitution) -> str:
    mu, f = or_none(restitution.mu), motion.friction
    if mu is None or abs(mu) <= PLOUGHING * f + LEAST_RATIO:
        return ""
    mesh = f", or by the mesh.{CONFIRM}" if provenance.fidelity == "solid" else "."
    return (
        f"mu = {mu:.3g} is beyond f = {f:g} by more than ploughing gives: the tip was held by the form of "
        f"its crater{mesh}"
    )


def _on_rigid(energy: Energy) -> str:
    rigid, gravity = or_none(energy.rigid), or_none(energy.gravity) or 0.0
    if rigid is None or rigid <= 1 + RESIDUAL_LIMIT:
        return ""
    if rigid <= 1 + gravity + RESIDUAL_LIMIT:
        return f"E_r is {rigid:.4g} of E_0: gravity gave the rod {gravity:.2g} of it while it touched."
    return f"E_r is {rigid:.4g} of E_0, more than the rod brought: distrust every share."
