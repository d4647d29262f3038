"""What a mesh holds back of a blow that is too short for its cells.

A face that lands flat stops at once. The mass of its nodes loses its energy then (closing loss), and the step
of the stress wave makes cells swing that are too large for it. Both fall as cells shrink everywhere, but
levels have finer cells at the contact alone and do not show it: bands must leave room for it.
"""

from math import sqrt

from fem_impact.outcome.groups import ARMS
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import above_modes


def held_back(run: Outcome) -> dict[str, float]:
    """Return by how much numbers of a run, by key, would change if what its cells took were motion again.

    These are all vibration and the closing loss, as a share q of E_0, where more vibrates above the modes of
    the body than in them; else nothing. By E_ln = (1 - e^2) E_c it makes e^2 larger by q (1 - e^2) / E_ln.
    """
    energy, restitution = run.energy, run.restitution
    modes, whole = or_none(energy.vibration), or_none(energy.vibration_check)
    if modes is None or whole is None or above_modes(energy) <= modes:
        return {}
    taken = whole + (or_none(energy.closing) or 0.0)
    changes = {"E_r_over_E_0": taken, "E_vib_over_E_0": -modes, "W_closing_over_E_0": -(taken - whole)}
    for name in ARMS:
        arms = getattr(restitution, name)
        e, lost = or_none(arms.e), or_none(arms.E_ln)
        if e is None or lost is None or lost <= 0.0:
            continue
        part = min(taken / lost, 1.0)
        more = sqrt(e**2 + part * (1 - e**2)) - e
        changes |= {f"e_{name}": more, f"E_ln_{name}_over_E_0": -part * lost}
        if (V_n := or_none(run.motion.V_n)) is not None:
            changes["V_n_m_per_s"] = more / (1 + e) * (V_n - run.motion.v_n)
    return changes
