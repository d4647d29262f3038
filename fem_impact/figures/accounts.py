"""Names and colours of the energy accounts, the same in every figure."""

from __future__ import annotations

from dataclasses import dataclass

from fem_impact.figures.style import PALETTE

__all__ = ["FINAL", "RUNNING", "Account"]


@dataclass(frozen=True, slots=True)
class Account:
    """One share of the energy: its key in the table or record, its label and its colour."""

    key: str
    label: str
    colour: str


RUNNING = (
    Account("E_kinetic_rod_J", "kinetic, rod", PALETTE["blue"]),
    Account("E_strain_rod_J", "strain, rod", PALETTE["sky"]),
    Account("E_plastic_rod_J", "plastic, rod", PALETTE["purple"]),
    Account("W_friction_J", "friction", PALETTE["green"]),
    Account("E_plastic_barrier_J", "plastic, barrier", PALETTE["vermilion"]),
    Account("E_strain_barrier_J", "strain, barrier", PALETTE["orange"]),
    Account("E_kinetic_barrier_J", "kinetic, barrier", PALETTE["sand"]),
    Account("W_radiated_J", "radiated", PALETTE["yellow"]),
    Account("W_damping_J", "damping", PALETTE["night"]),
    Account("W_closing_J", "contact closing", PALETTE["grey"]),
)
"""Accounts of history.csv, bottom to top; gravity and the residual are not areas."""

FINAL = (
    Account("E_r_over_E_0", "rigid motion", PALETTE["blue"]),
    Account("E_vib_over_E_0", "vibration", PALETTE["night"]),
    Account("E_locked_rod_over_E_0", "locked in, rod", PALETTE["sky"]),
    Account("E_plastic_rod_over_E_0", "plastic, rod", PALETTE["purple"]),
    Account("W_friction_over_E_0", "friction", PALETTE["green"]),
    Account("E_plastic_barrier_over_E_0", "plastic, barrier", PALETTE["vermilion"]),
    Account("E_locked_barrier_over_E_0", "locked in, barrier", PALETTE["orange"]),
    Account("W_radiated_over_E_0", "radiated", PALETTE["yellow"]),
    Account("W_damping_over_E_0", "damping", PALETTE["sand"]),
    Account("W_closing_over_E_0", "contact closing", PALETTE["grey"]),
)
"""Accounts of an outcome: where E_0 is after the last separation."""
