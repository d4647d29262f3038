"""What moved over time in the reduced model, as the history.csv of a run: forces, energies, motion."""

from __future__ import annotations

from pathlib import Path

from fem_impact.case.case import Case
from fem_impact.files.atomic import write_text
from fem_impact.modal.impact import ModalResult
from fem_impact.modal.motion import (
    BASE_ROW,
    F_N_ROW,
    F_T_ROW,
    FLOW_ROW,
    GRAVITY_ROW,
    HELD_ROW,
    PLATE_ROW,
    RATE_ROW,
    RIGID_ROW,
    RUB_ROW,
    SPIN_ROW,
    STRAIN_ROW,
    T_ROW,
    V_N_ROW,
    V_T_ROW,
)
from fem_impact.run.common import rod_flows
from fem_impact.tables.history import HISTORY
from fem_impact.tables.table import Table

CONTACT = "E_contact_J"
"""What Hertz' contact and its tangential springs hold: of both bodies, so an account of its own."""


def write_history(case: Case, result: ModalResult, path: Path) -> None:
    """Write one row every few steps, with the columns of finite elements; velocities are the scene's.

    Accounts that the reduced model does not have are 0. The residual is what a row's energies lack of the
    first row's.
    """
    record, barrier = result.record, case.scene.barrier
    zero = 0.0 * record[:, T_ROW]
    plastic = record[:, FLOW_ROW]
    in_rod = rod_flows(case)
    columns = dict.fromkeys(HISTORY, zero) | {
        "time_s": record[:, T_ROW],
        "force_n_N": record[:, F_N_ROW],
        "force_t_N": record[:, F_T_ROW],
        "contact_nodes": (record[:, F_N_ROW] > 0).astype(int),
        "E_kinetic_rod_J": record[:, RIGID_ROW] + record[:, RATE_ROW],
        "E_strain_rod_J": record[:, STRAIN_ROW],
        "E_plastic_rod_J": plastic if in_rod else zero,
        "E_plastic_barrier_J": zero if in_rod else plastic,
        "E_kinetic_barrier_J": record[:, BASE_ROW],
        "W_friction_J": record[:, RUB_ROW],
        "E_gravity_J": -record[:, GRAVITY_ROW],
        "V_n_m_per_s": record[:, V_N_ROW] + barrier.v_n,
        "V_t_m_per_s": record[:, V_T_ROW] + barrier.v_t,
        "Omega_rad_per_s": record[:, SPIN_ROW],
        CONTACT: record[:, HELD_ROW],
    }
    if case.slots.plate:
        columns["W_plate_J"] = record[:, PLATE_ROW]
    total = sum((column for name, column in columns.items() if name.endswith("_J")), zero)
    columns["residual_J"] = total[:1] - total
    write_text(
        path, Table.of(tuple(columns), zip(*(c.tolist() for c in columns.values()), strict=True)).csv()
    )
