"""Results by content address in one SQLite file, written by the study's own process only."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fem_impact.errors import OutputPathError, ResultError
from fem_impact.files.atomic import make_directory
from fem_impact.jobs.job import Answer, Job, Kind

__all__ = ["STORE", "Store"]


STORE = "store.sqlite"
_TABLE = """
CREATE TABLE IF NOT EXISTS results (
  key TEXT PRIMARY KEY, name TEXT, fidelity TEXT, tip_size_m REAL, outcome TEXT, reason TEXT, wall_s REAL
)
"""
PATIENCE = 30.0  # s to wait for another study that writes


class Store:
    """The results in a file; made by `Store.open`."""

    def __init__(self, path: Path, base: sqlite3.Connection) -> None:
        self._path, self._base = path, base

    @classmethod
    @contextmanager
    def open(cls, path: Path) -> Iterator[Store]:
        """Open the file, make it if it is not there, and close it at the end.

        Raises
        ------
        OutputPathError
            It cannot be made.
        ResultError
            It is no store, or damaged.
        """
        make_directory(path.parent)
        try:
            base = sqlite3.connect(path, timeout=PATIENCE)
        except sqlite3.Error as error:
            raise OutputPathError(f"{path}: cannot be opened ({error}).") from error
        try:
            with _named(path):
                # one commit a result: it outlives a killed process without waiting for the disk
                base.execute("PRAGMA journal_mode=WAL")
                base.execute("PRAGMA synchronous=NORMAL")
                base.execute(_TABLE)
            yield cls(path, base)
        finally:
            base.close()

    def get(self, key: str) -> tuple[str, str] | None:
        """Return outcome text (which carries its own checksum) and reason, None if there is no result."""
        with _named(self._path):
            found = self._base.execute("SELECT outcome, reason FROM results WHERE key = ?", (key,)).fetchone()
        return found and (str(found[0]), str(found[1]))

    def put(self, job: Job, answer: Answer) -> None:
        """Keep an answer."""
        row = (job.key, job.name, *job.kind, answer.outcome, answer.reason, answer.wall_s)
        with _named(self._path), self._base:
            self._base.execute("INSERT OR REPLACE INTO results VALUES (?, ?, ?, ?, ?, ?, ?)", row)

    def costs(self) -> dict[Kind, list[float]]:
        """Return the wall times, s, of the finished jobs of each kind, of whatever program."""
        words = "SELECT fidelity, tip_size_m, wall_s FROM results WHERE reason = ''"
        found: dict[Kind, list[float]] = {}
        with _named(self._path):
            for fidelity, size, wall in self._base.execute(words):
                found.setdefault((fidelity, size), []).append(wall)
        return found


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Tell a full or locked disk from a damaged file."""
    try:
        yield
    except sqlite3.OperationalError as error:
        words = f"{path}: cannot be used ({error}). Free some space, or close what uses it."
        raise OutputPathError(words) from error
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:  # a spoiled name in the words of the library
        words = f"{path}: is damaged ({error}). Move it away; its results are computed again."
        raise ResultError(words) from error
