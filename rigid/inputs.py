"""What the formulas of this package take and return, and the errors for what they refuse."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike as ArrayLike
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]


def floats(*values: ArrayLike) -> tuple[Floats, ...]:
    """Each value as a float64 array of its own shape (numpy broadcasts in the formula)."""
    return tuple(np.asarray(v, dtype=np.float64) for v in values)


class RigidError(ValueError):
    """An input that rigid-body impact theory cannot take."""


class ShapeError(RigidError):
    """A projectile that cannot be turned on a lathe."""


class TooLongError(ShapeError):
    """A part of a projectile that is longer than the whole."""


class ImpactError(RigidError):
    """An impact that cannot happen, or whose equations have no solution."""


class DataError(RigidError):
    """Measured data that are missing, or too few for what is asked of them."""


def refuse(bad: Any, message: str, values: Any, error: type[RigidError] = ImpactError) -> None:
    """Raise `error` where `bad` holds, naming the first offending value and its place.

    Parameters
    ----------
    bad : bool or array of bool
        True where the input cannot be used.
    message : str
        What is wrong and what to do, with ``{value}`` where the number belongs.
    values : array_like
        The quantity that is checked, broadcastable to the shape of `bad`.
    error : type of RigidError
        The class to raise.
    """
    bad = np.asarray(bad)
    if not bad.any():
        return
    place = np.unravel_index(int(np.argmax(bad)), bad.shape)
    value = np.broadcast_to(np.asarray(values), bad.shape)[place]
    where = f" (impact {', '.join(str(int(i)) for i in place)})" if place else ""
    raise error(message.format(value=f"{value:.3g}") + where)
