"""What moves in a run: every holder names it, and one place takes it out and puts it back.

An item or observer declares ``moving``, the names of its attributes that a run changes and that later steps
read. What each step sets anew before it is read (work space) is left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter
from typing import Any, ClassVar, Protocol

import numpy as np

__all__ = ["Moving", "put_back", "take_out"]


class Moving(Protocol):
    """Anything whose moving part can be stored; () when nothing moves.

    A name may be dotted (``book.friction``) and stands for an array, a number, or a property that takes what
    it gave.
    """

    moving: ClassVar[tuple[str, ...]]


def take_out(holders: Mapping[str, Moving]) -> dict[str, np.ndarray]:
    """Return copies of everything that moves, by holder and name."""
    return {
        f"{key}/{name}": np.array(attrgetter(name)(holder))
        for key, holder in holders.items()
        for name in holder.moving
    }


def put_back(holders: Mapping[str, Moving], stored: Mapping[str, np.ndarray]) -> None:
    """Set everything that moves.

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
        owner = attrgetter(".".join(path))(holders[key]) if path else holders[key]
        _set(owner, last, stored[f"{key}/{name}"])


def _set(owner: Any, name: str, value: np.ndarray) -> None:
    now = getattr(owner, name)
    if isinstance(getattr(type(owner), name, None), property):
        setattr(owner, name, value)
    elif not isinstance(now, np.ndarray):
        setattr(owner, name, type(now)(value.item()))
    elif value.shape != now.shape or value.dtype != now.dtype:
        raise ValueError(f"holds {name} of the shape {value.shape}, not {now.shape}.")
    else:
        now[...] = value
