"""Mean, scatter and interval of a column of measurements, and how columns correlate."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import hypot

import numpy as np

from ..inputs import ArrayLike, DataError, Floats


@dataclass(frozen=True, slots=True)
class Statistic:
    """Statistics of a column of measurements.

    Attributes
    ----------
    mean, sd : float
        Mean and sample standard deviation, in the column's unit.
    low, high : float
        Student's 95 % interval of the mean, with twice what all tests share.
    n : int
        Number of tests.
    systematic : float
        Standard uncertainty that all tests share, such as that of the instrument.
    """

    mean: float
    sd: float
    low: float
    high: float
    n: int
    systematic: float = 0.0

    @property
    def spread(self) -> float:
        """Standard deviation of single tests, with what they share."""
        return hypot(self.sd, self.systematic)


def statistic(values: ArrayLike, level: float = 0.95) -> Statistic:
    """Mean, scatter and interval of one column.

    Parameters
    ----------
    values : (n,) array_like
        At least two measurements.
    level : float
        Confidence of the interval of the mean.

    Examples
    --------
    >>> s = statistic([1.0, 2.0, 3.0])
    >>> f"{s.mean} {s.sd} [{s.low:.3f}, {s.high:.3f}] n = {s.n}"
    '2.0 1.0 [-0.484, 4.484] n = 3'
    """
    x = np.asarray(values, dtype=np.float64)
    if x.ndim != 1 or x.size < 2:
        raise DataError(f"a scatter needs at least two measurements in one column, got shape {x.shape}")
    return of_mean(float(x.mean()), float(x.std(ddof=1)), x.size, level)


def of_mean(mean: float, sd: float, n: int, level: float = 0.95) -> Statistic:
    """Statistics from a mean and the standard deviation of n single measurements.

    Parameters
    ----------
    mean, sd : float
        In the column's unit.
    n : int
        At least two.
    level : float
        Confidence of the interval of the mean.

    Examples
    --------
    >>> of_mean(2.0, 1.0, 3) == statistic([1.0, 2.0, 3.0])
    True
    """
    from scipy.special import stdtrit  # here, as a run of the solver needs the rest of this package only

    half = float(stdtrit(n - 1, (1 + level) / 2)) * sd / n**0.5
    return Statistic(mean, sd, mean - half, mean + half, n)


def covariance_of_means(columns: Mapping[str, Floats], names: Sequence[str]) -> Floats:
    """Covariance (k, k) of the means of k columns (n,), from how they vary together between tests.

    Examples
    --------
    >>> covariance_of_means({"e": np.array([1.0, 2.0, 3.0])}, ["e"])
    array([[0.33333333]])
    """
    rows = np.array([columns[name] for name in names])
    return np.asarray(np.atleast_2d(np.cov(rows)) / rows.shape[1])


@dataclass(frozen=True, slots=True)
class Correlation:
    """Pearson's correlation of two columns.

    Attributes
    ----------
    r : float
        Correlation coefficient.
    low, high : float
        Fisher's 95 % interval.
    p : float
        Two-sided probability of so large an r if there were none (Student's t).
    n : int
        Number of tests.
    """

    r: float
    low: float
    high: float
    p: float
    n: int

    @property
    def is_significant(self) -> bool:
        """Whether the interval leaves out zero."""
        return self.low > 0 or self.high < 0


def correlation(x: ArrayLike, y: ArrayLike, level: float = 0.95) -> Correlation:
    """Correlate two columns of at least four tests.

    Two coefficients worked out from the same velocities share their errors, so that a significant r
    need not be physics.

    Examples
    --------
    >>> c = correlation([1, 2, 3, 4, 5], [2.0, 1.9, 4.1, 3.9, 6.0])
    >>> f"r = {c.r:.3f}, {c.low:.2f} to {c.high:.2f}, p = {c.p:.3f}"
    'r = 0.931, 0.27 to 1.00, p = 0.022'
    """
    from scipy.special import ndtri, stdtr  # here, as a run of the solver needs the rest of this package only

    a, b = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if a.shape != b.shape or a.ndim != 1 or a.size < 4:
        raise DataError(f"a correlation needs two columns of at least 4 tests, got {a.shape} and {b.shape}")
    if np.ptp(a) == 0 or np.ptp(b) == 0:
        raise DataError("a column that does not vary correlates with nothing")
    r, n = float(np.clip(np.corrcoef(a, b)[0, 1], -1.0, 1.0)), a.size
    with np.errstate(divide="ignore"):
        z, half = np.arctanh(r), ndtri((1 + level) / 2) / np.sqrt(n - 3)
        p = 2 * stdtr(n - 2, -abs(r) * np.sqrt((n - 2) / (1 - np.float64(r) ** 2)))
    return Correlation(r, float(np.tanh(z - half)), float(np.tanh(z + half)), float(p), n)


def correlations(columns: Mapping[str, ArrayLike]) -> dict[tuple[str, str], Correlation]:
    """Correlate every pair of the named columns."""
    return {(a, b): correlation(columns[a], columns[b]) for a, b in combinations(columns, 2)}
