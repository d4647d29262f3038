"""Checks of field data for their writer and reader; each raises ValueError that says what is wrong."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np


def check_mesh(points: np.ndarray, cells: np.ndarray) -> None:
    """Refuse points that are not finite ``(n, 3)`` and cells that are not ``(m, 8)`` numbers of points."""
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points must have shape (n, 3), not {points.shape}.")
    if cells.ndim != 2 or cells.shape[1] != 8:
        raise ValueError(f"cells must have shape (m, 8), not {cells.shape}.")
    check_finite("points", points)
    if cells.dtype.kind not in "iu":
        raise ValueError(f"cells must be whole numbers, not {cells.dtype}.")
    if cells.size and not (0 <= cells.min() and cells.max() < len(points)):
        raise ValueError(f"cells name points {cells.min()} to {cells.max()}, there are {len(points)}.")


def check_times(times: np.ndarray, count: int) -> None:
    """Refuse times that are not ``(count,)`` finite numbers, each later than the one before."""
    if times.shape != (count,):
        raise ValueError(f"times of {count} frames are stated, there are {times.shape}.")
    check_finite("times", times)
    if not (np.diff(times) > 0).all():
        at = int(np.argmin(np.diff(times) > 0)) + 1
        raise ValueError(f"the time of frame {at}, {times[at]:.6g} s, is not after {times[at - 1]:.6g} s.")


def check_rows(kind: str, count: int, data: Mapping[str, np.ndarray]) -> None:
    """Refuse data whose number of rows is not that of the points or cells of the mesh."""
    for name, values in data.items():
        if len(np.atleast_1d(values)) != count:
            raise ValueError(f"{kind} data {name} has shape {np.shape(values)}, the mesh {count} {kind}s.")


def check_finite(name: str, values: np.ndarray) -> None:
    """Refuse what are no numbers, or NaN, or infinite."""
    if values.dtype.kind not in "fiu":
        raise ValueError(f"{name} must be numbers, not {values.dtype}.")
    if not np.isfinite(values).all():
        raise ValueError(f"{name} holds {int((~np.isfinite(values)).sum())} values that are not finite.")
