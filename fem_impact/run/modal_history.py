"""What moved over time in the reduced model, as the history.csv of a run: forces, energies, motion."""

from pathlib import Path
from sys import float_info

from fem_impact.case.case import Case
from fem_impact.files.atomic import write_text
from fem_impact.modal.impact import ModalResult
from fem_impact.modal.motion import ROW
from fem_impact.run.common import plastic_shares
from fem_impact.tables.history import HISTORY
from fem_impact.tables.table import Table

CONTACT = "E_contact_J"
"""What Hertz' contact and its tangential springs hold: of both bodies, so an account of its own."""


def plastic_works(case: Case, result: ModalResult) -> tuple[float, float]:
    """Return the plastic work of rod and barrier, J."""
    return plastic_shares(case, result.plastic, result.skin - result.friction)


def write_history(case: Case, result: ModalResult, path: Path) -> None:
    """Write one row every few steps, with the columns of finite elements; velocities are the scene's.

    Accounts that the reduced model does not have are 0. The residual is what a row's energies lack of the
    first row's.
    """
    record, barrier = result.record, case.scene.barrier
    zero = 0.0 * record[:, ROW.time]
    in_rod, in_barrier = (work / max(result.plastic, float_info.min) for work in plastic_works(case, result))
    columns = dict.fromkeys(HISTORY, zero) | {
        "time_s": record[:, ROW.time],
        "force_n_N": record[:, ROW.force_n],
        "force_t_N": record[:, ROW.force_t],
        "contact_nodes": (record[:, ROW.force_n] > 0).astype(int),
        "E_kinetic_rod_J": record[:, ROW.rigid] + record[:, ROW.vibration],
        "E_strain_rod_J": record[:, ROW.strain],
        "E_plastic_rod_J": in_rod * record[:, ROW.plastic],
        "E_plastic_barrier_J": in_barrier * record[:, ROW.plastic],
        "E_kinetic_barrier_J": record[:, ROW.barrier],
        "W_friction_J": record[:, ROW.friction],
        "W_damping_J": record[:, ROW.viscous],
        "W_radiated_J": record[:, ROW.waves],
        "E_gravity_J": -record[:, ROW.gravity],
        "V_n_m_per_s": record[:, ROW.V_n] + barrier.v_n,
        "V_t_m_per_s": record[:, ROW.V_t] + barrier.v_t,
        "Omega_rad_per_s": record[:, ROW.Omega],
        CONTACT: record[:, ROW.contact],
    }
    if case.slots.plate:
        columns["W_plate_J"] = record[:, ROW.plate]
    total = sum((column for name, column in columns.items() if name.endswith("_J")), zero)
    columns["residual_J"] = total[:1] - total
    write_text(
        path, Table.of(tuple(columns), zip(*(c.tolist() for c in columns.values()), strict=True)).csv()
    )
