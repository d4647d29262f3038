"""Names and colours of the energy accounts over time."""

from __future__ import annotations

from dataclasses import dataclass

from fem_impact.figures.style import PALETTE

__all__ = ["RUNNING", "Account"]


@dataclass(frozen=True, slots=True)
class Account:
    """One column of history.csv, its label and its colour."""

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
