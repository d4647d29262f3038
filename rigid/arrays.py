"""Arrays of the package: float64 of any shape, broadcast together."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]


def floats(*values: ArrayLike) -> tuple[Floats, ...]:
    """Each value as a float64 array of its own shape (numpy broadcasts in the formula)."""
    return tuple(np.asarray(v, dtype=np.float64) for v in values)
