"""Mean, scatter and interval of a column of measurements."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Floats
from ..errors import DataError


@dataclass(frozen=True, slots=True)
class Statistic:
    """Statistics of a column of measurements.

    Attributes
    ----------
    mean, sd : float
        Mean and sample standard deviation, in the column's unit.
    low, high : float
        Student's 95 % interval of the mean.
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
