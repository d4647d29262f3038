"""Checkpoints: the changing state of a run, written to a file and restored from it.

An item or observer declares ``moving``, the names of its attributes that a run changes and that later steps
read. Work space, which each step sets before it reads it, is left out.
"""

import hashlib
import time as clock
import zipfile
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from operator import attrgetter
from pathlib import Path
from typing import Any, ClassVar, Protocol

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.atomic import write_bytes
from fem_impact.solid.state import State


class Moving(Protocol):
    """An object with state to be stored; ``moving`` is () where there is none.

    A name may be dotted (``book.friction``). It is that of an array, a number, or a property whose setter
    takes what its getter returns.
    """

    moving: ClassVar[tuple[str, ...]]


def take_out(holders: Mapping[str, Moving]) -> dict[str, np.ndarray]:
    """Return copies of all attributes named in ``moving``, by holder and name."""
    return {
        f"{key}/{name}": np.array(attrgetter(name)(holder))
        for key, holder in holders.items()
        for name in holder.moving
    }


def put_back(holders: Mapping[str, Moving], stored: Mapping[str, np.ndarray]) -> None:
    """Set all attributes named in ``moving`` from ``stored``.

    Raises
    ------
    ValueError
        If ``stored`` holds other names, shapes or types than these holders have.
    """
    wanted = [(key, name) for key, holder in holders.items() for name in holder.moving]
    if {f"{key}/{name}" for key, name in wanted} != set(stored):
        raise ValueError("holds other parts than this run.")
    for key, name in wanted:
        *path, last = name.split(".")
        owner: Any = attrgetter(".".join(path))(holders[key]) if path else holders[key]
        now, value = getattr(owner, last), stored[f"{key}/{name}"]
        if isinstance(getattr(type(owner), last, None), property):
            setattr(owner, last, value)
        elif not isinstance(now, np.ndarray):
            setattr(owner, last, type(now)(value.item()))
        elif value.shape != now.shape or value.dtype != now.dtype:
            raise ValueError(f"holds {last} of the shape {value.shape}, not {now.shape}.")
        else:
            now[...] = value  # in place: others hold the same array


_MARK = b"fem-ckp1"
_START = len(_MARK) + hashlib.sha256().digest_size
_STAMP = "stamp"
_ROOM = 2**28  # bytes by which a checkpoint may exceed that of a new run: tables grow

# errors of reading an archive of arrays from other or damaged bytes
_BROKEN = (
    ValueError,
    TypeError,
    OSError,
    KeyError,
    EOFError,
    RuntimeError,
    MemoryError,
    zipfile.BadZipFile,
    zlib.error,
)


@dataclass(slots=True)
class Checkpoint:
    """Observer that writes a checkpoint every ``interval`` seconds; it is the last observer.

    Attributes
    ----------
    path : the file, always replaced as a whole
    stamp : scene and sources, which a run that resumes must have in common
    holders : all objects with state, by name
    interval : s of wall time
    over : returns whether an earlier observer has ended the run
    """

    path: Path
    stamp: str
    holders: Mapping[str, Moving]
    interval: float
    over: Callable[[], bool]
    every: int = 100
    due: float = field(init=False)

    def __post_init__(self) -> None:
        self.due = clock.monotonic() + self.interval

    def observe(self, state: State) -> bool:
        """Save when it is due and the run goes on."""
        if clock.monotonic() >= self.due and not self.over():
            self.save()
            self.due = clock.monotonic() + self.interval
        return False

    def save(self) -> None:
        """Write the checkpoint. Raises OutputPathError."""
        archive = BytesIO()
        np.savez(archive, **{_STAMP: np.array(self.stamp)}, **take_out(self.holders))  # type: ignore[arg-type]
        data = archive.getvalue()
        write_bytes(self.path, _MARK + hashlib.sha256(data).digest() + data)

    def restore(self) -> None:
        """Restore the state from the file.

        Raises
        ------
        ResultError
            If it is damaged, of another scene or of other sources.
        """
        try:
            largest = sum(a.nbytes for a in take_out(self.holders).values()) + _ROOM
            with self.path.open("rb") as file:
                data = file.read(largest + 1)
            body = data[_START:]
            if data[:_START] != _MARK + hashlib.sha256(body).digest() or len(data) > largest:
                raise ValueError("is damaged, or no checkpoint of this run.")
            with np.load(BytesIO(body), allow_pickle=False) as archive:
                stored = {name: archive[name] for name in archive.files}
            written = str(stored.pop(_STAMP, "")).splitlines()
            other = [line.partition(" ")[0] for line in self.stamp.splitlines() if line not in written]
            if other:
                raise ValueError(
                    f"was written with another {' and other '.join(other)}; the run cannot go on from it."
                )
            put_back(self.holders, stored)
        except _BROKEN as error:
            raise ResultError(f"{self.path}: {error} Run again without resuming to start anew.") from error
