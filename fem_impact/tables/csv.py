"""Lines of CSV files, and the columns of the tables that a run writes; an empty cell is unknown."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import TypeVar

Plain = float | int | str | None
"""A cell of a CSV file."""
C = TypeVar("C")


def row_of(row: Sequence[C] | Mapping[str, C], names: Sequence[str]) -> list[C]:
    """Return the cells of a row, given in order or by name. Raises ValueError when it does not fit."""
    if isinstance(row, Mapping):
        if set(row) != set(names):
            raise ValueError(f"a row's keys {sorted(row)} are not the columns {sorted(names)}.")
        return [row[name] for name in names]
    if len(row) != len(names):
        raise ValueError(f"a row holds {len(row)} cells, the table {len(names)} columns.")
    return list(row)


def csv_line(cells: Sequence[Plain]) -> str:
    """Return one line; floats are written so that they read back exactly."""
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow([_written(cell) for cell in cells])
    return line.getvalue()


def _written(cell: Plain) -> Plain:
    # a number of numpy gives a plain one; numpy itself is not imported for a list of scenes
    cell = getattr(cell, "item", lambda: cell)()
    if isinstance(cell, bool):
        return str(cell).lower()
    if isinstance(cell, str):
        # one row, one line: a table cut off by a kill must stay readable up to its last line end
        return cell.replace("\r", " ").replace("\n", " ")
    return repr(cell) if isinstance(cell, float) else cell


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
