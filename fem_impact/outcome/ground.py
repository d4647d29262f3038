"""Kinetic energies as seen from the ground, beside shares that are those seen from a moving barrier."""

from collections.abc import Sequence

from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import Outcome


def moves(outcome: Outcome) -> bool:
    """Return whether the barrier moves before the impact, so that E_0 is another one than on the ground."""
    return any(or_none(v) for v in (outcome.barrier.v_bn, outcome.barrier.v_bt))


def on_the_ground(outcome: Outcome) -> str:
    """Say what 0.5 m v^2 of both bodies is on the ground, before and after the impact.

    The energy of turning is left out; a barrier without a mass keeps its speed and has none to tell.
    """
    rod, barrier = outcome.motion, outcome.barrier
    told = []
    for called, mass, before, names in (
        ("the rod", rod.mass, (rod.v_n, rod.v_t), ("V_n_m_per_s", "V_t_m_per_s")),
        ("the barrier", barrier.mass, (barrier.v_bn, barrier.v_bt), ("V_bn_m_per_s", "V_bt_m_per_s")),
    ):
        if not isinstance(mass, Unknown):
            after = [or_none(outcome.estimate(name)[0]) for name in names]
            end = "what is not known" if None in after else f"{_energy(mass, after):.4g} J"
            told.append(f"{called} has {_energy(mass, before):.4g} J before and {end} after")
    return f"On the ground, 0.5 m v^2: {'; '.join(told)}."


def _energy(mass: float, velocity: Sequence[float | None]) -> float:
    return 0.5 * mass * sum((v or 0.0) ** 2 for v in velocity)
