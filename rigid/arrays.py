"""What every formula of this package takes and gives: float64, any shape, broadcast together."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]


def floats(*values: ArrayLike) -> tuple[Floats, ...]:
    """Give each value as a float64 array, unbroadcast (numpy broadcasts in the formula itself)."""
    return tuple(np.asarray(v, dtype=np.float64) for v in values)
