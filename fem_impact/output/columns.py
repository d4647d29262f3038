"""Columns of the tables that runs and studies write; the unit is the last part of a name."""

from __future__ import annotations

__all__ = ["COMPARISON", "CONTACTS", "HISTORY"]

HISTORY = (
    "time_s",
    "force_n_N",
    "force_t_N",
    "contact_nodes",
    "E_kinetic_rod_J",
    "E_strain_rod_J",
    "E_plastic_rod_J",
    "E_kinetic_barrier_J",
    "E_strain_barrier_J",
    "E_plastic_barrier_J",
    "W_friction_J",
    "W_closing_J",
    "W_radiated_J",
    "W_damping_J",
    "E_gravity_J",
    "residual_J",
    "V_n_m_per_s",
    "V_t_m_per_s",
    "Omega_rad_per_s",
)
"""One row every few steps: whole rod, dissipations positive."""

CONTACTS = ("start_s", "end_s", "impulse_n_Ns", "impulse_t_Ns")
"""One row a contact interval: impulses on the whole rod."""

COMPARISON = (
    "set",
    "quantity",
    "unit",
    "model",
    "band",
    "measured_mean",
    "measured_sd",
    "measured_low",
    "measured_high",
    "n",
    "verdict",
)
"""One row a quantity of a measured set; low and high bound the 95 % interval of the mean."""
