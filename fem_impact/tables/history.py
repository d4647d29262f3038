"""Reader of the history.csv of a run, which refuses a file that was damaged or changed."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.digests import check_digest
from fem_impact.tables.csv import HISTORY
from fem_impact.tables.table import Table, read_csv

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
