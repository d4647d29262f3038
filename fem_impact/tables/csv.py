"""CSV tables: one header line with the units in the names, then rows; an empty cell is unknown."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text, write_text

__all__ = ["COMPARISON", "CONTACTS", "HISTORY", "Cell", "Table", "format_row", "read_table", "write_table"]


Cell = float | int | str | None


@dataclass(frozen=True, slots=True)
class Table:
    """A table as read: text cells, numbers on demand.

    Parameters
    ----------
    columns : tuple of str
        Names from the header.
    rows : tuple of tuple of str
        Cells as written.
    source : str
        The file, for complaints.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    source: str

    def __len__(self) -> int:
        return len(self.rows)

    def texts(self, column: str) -> list[str]:
        """Return a column as texts. Raises ResultError when there is no such column."""
        if column not in self.columns:
            raise ResultError(f'{self.source}: column "{column}" is missing.')
        at = self.columns.index(column)
        return [row[at] for row in self.rows]

    def numbers(self, column: str) -> np.ndarray:
        """Return a column as ``(n_rows,) float64``, nan where the cell is empty. Raises ResultError."""
        return np.array([self._number(column, i, cell) for i, cell in enumerate(self.texts(column))])

    def _number(self, column: str, row: int, cell: str) -> float:
        try:
            return float(cell) if cell else float("nan")
        except ValueError as error:
            place = f"{self.source}: row {row + 1}, column {column}"
            raise ResultError(f'{place} = "{cell[:40]}" is not a number.') from error


def write_table(
    path: str | Path, columns: Sequence[str], rows: Iterable[Sequence[Cell] | Mapping[str, Cell]]
) -> Path:
    """Write a whole table in one step; return the path.

    Parameters
    ----------
    path : path
        The CSV file.
    columns : sequence of str
        Header; each name ends in its unit.
    rows : iterable
        Sequences in the order of ``columns``, or mappings with exactly these keys; None is an empty cell.

    Raises
    ------
    OutputPathError
        The place cannot be written.
    ValueError
        A row does not fit the columns.
    """
    lines = [format_row(columns, columns), *(format_row(row, columns) for row in rows)]
    return write_text(path, "".join(lines))


def format_row(row: Sequence[Cell] | Mapping[str, Cell], columns: Sequence[str]) -> str:
    """Return one CSV line; floats are written so that they read back exactly."""
    if isinstance(row, Mapping):
        if set(row) != set(columns):
            raise ValueError(f"a row's keys {sorted(row)} are not the columns {sorted(columns)}.")
        row = [row[name] for name in columns]
    if len(row) != len(columns):
        raise ValueError(f"a row holds {len(row)} cells, the table {len(columns)} columns.")
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow([_plain(cell) for cell in row])
    return line.getvalue()


def read_table(path: str | Path) -> Table:
    """Read a table; a last line that a killed run left unfinished is not counted.

    Raises
    ------
    ResultError
        The file is missing or empty, or a row has too few or too many cells.
    """
    text = read_text(path)
    whole = text[: text.rfind("\n") + 1]
    lines = list(_lines(whole, str(path)))
    if not lines:
        raise ResultError(f"{path}: holds no header line.")
    head, *rows = lines
    for number, row in enumerate(rows, start=1):
        if len(row) != len(head):
            raise ResultError(f"{path}: row {number} has {len(row)} cells, the header {len(head)}.")
    return Table(tuple(head), tuple(map(tuple, rows)), str(path))


def _lines(text: str, source: str) -> Iterable[list[str]]:
    try:
        return list(csv.reader(io.StringIO(text), strict=True))
    except csv.Error as error:
        raise ResultError(f"{source}: not a readable CSV table ({error}).") from error


def _plain(cell: Cell) -> Cell:
    if isinstance(cell, np.generic):
        cell = cell.item()
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
