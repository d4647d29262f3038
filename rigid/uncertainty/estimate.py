"""Error bounds of a measurement, and an estimate with its interval."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite, sqrt

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Floats
from ..errors import DataError

MOTION = ("v_n", "v_t", "V_n", "V_t", "Omega")


@dataclass(frozen=True, slots=True)
class Errors:
    """Errors common to all tests of a set, as bounds (+-) of a rectangular distribution.

    Attributes
    ----------
    contact : float
        Of each arm of the contact point, m.
    tracking : float
        Of each velocity, as a fraction (the paper: less than 2 %).
    """

    contact: float = 0.5e-3
    tracking: float = 0.02

    def __post_init__(self) -> None:
        for name in ("contact", "tracking"):
            value = getattr(self, name)
            if not (isfinite(value) and value >= 0):
                raise DataError(f"{name} is a bound and must not be negative, got {value}")

    @property
    def contact_sd(self) -> float:
        """Standard deviation of an arm, m."""
        return self.contact / sqrt(3)

    @property
    def tracking_sd(self) -> float:
        """Standard deviation of a velocity, as a fraction."""
        return self.tracking / sqrt(3)


@dataclass(frozen=True, slots=True)
class Estimate:
    """One coefficient of a set.

    Attributes
    ----------
    value : float
        Worked out from the mean velocities.
    sd : float
        Its standard uncertainty.
    low, high : float
        95 % interval.
    parts : mapping of str to float
        Standard uncertainty by source: scatter, contact, tracking.
    """

    value: float
    sd: float
    low: float
    high: float
    parts: Mapping[str, float]


def stack_tests(motion: Mapping[str, ArrayLike]) -> Floats:
    """Stack v_n, v_t, V_n, V_t, Omega as (5, n); refuse less than two tests."""
    missing = [name for name in MOTION if name not in motion]
    if missing:
        raise DataError(f"the motion lacks {', '.join(missing)}; it needs {', '.join(MOTION)}")
    rows = np.stack(np.broadcast_arrays(*(np.asarray(motion[k], dtype=np.float64) for k in MOTION)))
    if rows.ndim != 2 or rows.shape[1] < 2:
        raise DataError(f"an uncertainty needs at least two tests, got shape {rows.shape[1:]}")
    return rows
