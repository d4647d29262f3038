"""The history.csv of a run: its columns, appended to during a run, and read back with checks."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np

from fem_impact.errors import OutputPathError, ResultError
from fem_impact.files.atomic import check_digest, write_text
from fem_impact.tables.table import Plain, Table, csv_line, read_csv, row_of

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
    "W_contact_dissipation_J",
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


class HistoryWriter:
    """Append rows to a CSV table in batches.

    Parameters
    ----------
    path : path
        The file; an older one is replaced by a header at once.
    columns : sequence of str
        Header; each name ends in its unit.
    batch : int
        Rows kept back at most before they are written.
    seconds : float
        Longest time a row is kept back, in s, looked at on each append.
    go_on : bool
        Keep the rows of an older file; set `size` to drop those written after a checkpoint.

    Raises
    ------
    OutputPathError
        The place cannot be written or the disk is full; the rows written before stay readable.
    """

    def __init__(
        self,
        path: str | Path,
        columns: Sequence[str] = HISTORY,
        batch: int = 64,
        seconds: float = 2.0,
        go_on: bool = False,
    ) -> None:
        self.path = Path(path)
        self.columns = tuple(columns)
        self._batch, self._seconds = batch, seconds
        self._waiting: list[str] = []
        if not go_on:
            write_text(self.path, csv_line(self.columns))
        self._due = time.monotonic() + seconds

    def append(self, row: Sequence[Plain] | Mapping[str, Plain]) -> None:
        """Take one row, in the order of the columns or by name. Raises ValueError if it does not fit."""
        self._waiting.append(csv_line(row_of(row, self.columns)))
        if len(self._waiting) >= self._batch or time.monotonic() >= self._due:
            self.flush()

    def flush(self) -> None:
        """Write the rows that wait. Raises OutputPathError."""
        data, self._waiting = "".join(self._waiting).encode("utf-8"), []
        self._due = time.monotonic() + self._seconds
        if not data:
            return
        size = self.path.stat().st_size if self.path.exists() else 0
        try:
            with self.path.open("ab", buffering=0) as file:
                written = file.write(data)
                if written != len(data):
                    # a short write means a full disk; writing the rest raises the error
                    file.write(data[written:])
        except OSError as error:
            _cut_back(self.path, size)
            why = error.strerror or str(error)
            kept = "the rows before are kept."
            raise OutputPathError(f"{self.path}: rows cannot be added ({why}); {kept}") from error

    @property
    def size(self) -> int:
        """Bytes of the file with all rows so far in it."""
        self.flush()
        return self.path.stat().st_size

    @size.setter
    def size(self, written: int) -> None:
        """Drop what was written after a checkpoint. Raises ValueError when the file is shorter."""
        self._waiting = []
        size = self.path.stat().st_size if self.path.is_file() else 0
        if size < written:
            raise ValueError(f"{self.path.name} holds {size} bytes of the {int(written)} written before.")
        _cut_back(self.path, int(written))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.flush()


def _cut_back(path: Path, size: int) -> None:
    if path.exists():
        with path.open("r+b") as file:
            file.truncate(size)


CLOSES = 1e-9
"""Largest difference of the sum of a row's energies from that of the first row, share of that sum."""


def read_history(path: str | Path) -> Table:
    """Return the table of history.csv.

    Of a finished run it is the file that the run wrote, by its digest. The energies of a row and its
    residual add up to the energy at the start, by the definition of the residual.

    Raises
    ------
    ResultError
        The file is missing or not the run's, a column is missing or holds what is no number, times do not
        rise, or the energies of a row do not add up.
    """
    if Path(path).is_dir():
        raise ResultError(f"{path}: is a directory. Name the file in it: {Path(path) / 'history.csv'}.")
    check_digest(Path(path))
    table = read_csv(path)
    numbers = {name: table.numbers(name) for name in dict.fromkeys((*HISTORY, *table.names))}
    for name, values in numbers.items():
        _refuse(~np.isfinite(values), f"column {name} is empty", path)
    time = numbers["time_s"]
    _refuse(np.diff(time, prepend=-np.inf) <= 0.0, "its time is not after that of the row before", path)
    total = sum((values for name, values in numbers.items() if name.endswith("_J")), np.zeros(len(time)))
    wrong = np.abs(total - total[:1]) > CLOSES * np.abs(total[:1])
    _refuse(wrong, "its energies do not add up; the file was damaged or changed", path)
    return table


def _refuse(wrong: np.ndarray, problem: str, path: str | Path) -> None:
    if wrong.any():
        raise ResultError(f"{path}: row {int(np.argmax(wrong)) + 1}: {problem}.")
