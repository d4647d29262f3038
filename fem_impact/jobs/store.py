"""Store of answers by the key of the job, in one SQLite file that only the process of the study writes."""

import hashlib
import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fem_impact.errors import OutputPathError, ResultError
from fem_impact.files.atomic import make_directory
from fem_impact.jobs.job import Answer, Work

STORE = "store.sqlite"
_TABLE = """
CREATE TABLE IF NOT EXISTS answers (
  key TEXT PRIMARY KEY, name TEXT, fidelity TEXT, tip_size_m REAL, outcome TEXT, reason TEXT, wall_s REAL,
  checksum TEXT
)
"""
_INSERT = "INSERT OR REPLACE INTO answers VALUES (?, ?, ?, ?, ?, ?, ?, ?)"
PATIENCE = 30.0  # s to wait while another process reads or writes
# remedies for faults of the place by SQLite's primary result code; any other fault is a damaged file
_PLACE = {
    sqlite3.SQLITE_FULL: "Free some space.",
    sqlite3.SQLITE_BUSY: "Close the program that uses it.",
    sqlite3.SQLITE_LOCKED: "Close the program that uses it.",
    **dict.fromkeys(
        (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_IOERR),
        "Check that its place can be read and written, or choose another place.",
    ),
}


class Store:
    """The answers in a file; made by `Store.open`."""

    def __init__(self, path: Path, base: sqlite3.Connection) -> None:
        self._path, self._base = path, base

    @classmethod
    @contextmanager
    def open(cls, path: Path) -> "Iterator[Store]":
        """Open the file, make it if it is not there, and close it at the end.

        Raises
        ------
        OutputPathError
            The file cannot be made.
        ResultError
            The file is no store, or damaged.
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

    def get(self, job: Work[object]) -> tuple[str, str] | None:
        """Return text of the result and reason of a failure, None if there is no answer.

        Raises
        ------
        ResultError
            The stored answer does not match its checksum.
        """
        key = job.key
        with _named(self._path):
            rows = self._base.execute("SELECT outcome, reason, checksum FROM answers WHERE key = ?", (key,))
            row = rows.fetchone()
        if row is None:
            return None
        outcome, reason, checksum = row
        if checksum != _checksum(key, outcome, reason):
            raise ResultError(f"{job.name}: its stored answer does not match its checksum.")
        return outcome, reason

    def put(self, job: Work[object], answer: Answer) -> None:
        """Keep an answer."""
        row = (job.key, job.name, *job.kind, answer.outcome, answer.reason, answer.wall_s)
        with _named(self._path), self._base:
            self._base.execute(_INSERT, (*row, _checksum(job.key, answer.outcome, answer.reason)))


def _checksum(key: str, outcome: object, reason: object) -> str:
    """Return the SHA-256 of key and answer; a damaged row may hold values of any type."""
    return hashlib.sha256(json.dumps([key, outcome, reason], default=repr).encode()).hexdigest()


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Raise OutputPathError for a fault of the place, ResultError for a damaged file."""
    try:
        yield
    except (sqlite3.Error, UnicodeDecodeError) as error:  # the library quotes a spoiled name in its message
        code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT)
        remedy = _PLACE.get(code & 0xFF)
        if remedy and code != sqlite3.SQLITE_IOERR_SHORT_READ:
            raise OutputPathError(f"{path}: cannot be used ({error}). {remedy}") from error
        problem = f"{path}: is damaged ({error}). Move it away; its results are computed again."
        raise ResultError(problem) from error
