"""A CSV table that is appended to during a run, so that a killed run leaves the rows written so far."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

from fem_impact.errors import OutputPathError
from fem_impact.files.atomic import write_text
from fem_impact.tables.csv import HISTORY, Plain, csv_line, row_of


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
        text, self._waiting = "".join(self._waiting), []
        self._due = time.monotonic() + self._seconds
        if text:
            _append(self.path, text.encode("utf-8"))

    @property
    def size(self) -> int:
        """Bytes of the file with all rows so far in it."""
        self.flush()
        return self.path.stat().st_size

    @size.setter
    def size(self, wanted: int) -> None:
        """Drop what was written after a checkpoint. Raises ValueError when the file is shorter."""
        self._waiting = []
        size = self.path.stat().st_size if self.path.is_file() else 0
        if size < wanted:
            raise ValueError(f"{self.path.name} holds {size} bytes of the {int(wanted)} written before.")
        _cut_back(self.path, int(wanted))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.flush()


def _append(path: Path, data: bytes) -> None:
    size = path.stat().st_size if path.exists() else 0
    try:
        with path.open("ab", buffering=0) as file:
            written = file.write(data)
            if written != len(data):
                # a short write means a full disk; writing the rest raises the error
                file.write(data[written:])
    except OSError as error:
        _cut_back(path, size)
        why = error.strerror or str(error)
        raise OutputPathError(f"{path}: rows cannot be added ({why}); the rows before are kept.") from error


def _cut_back(path: Path, size: int) -> None:
    if path.exists():
        with path.open("r+b") as file:
            file.truncate(size)
