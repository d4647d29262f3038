"""Errors of a model beside measurements in the terms of ASME V&V 20, of one number and of several at once."""

from dataclasses import dataclass
from math import hypot

import numpy as np

from fem_impact.arrays import Array
from fem_impact.outcome.keys import Num, Unknown

COVERAGE = 2.0  # E +- 2 u_val, the interval of the model's error (V&V 20, section 6)


@dataclass(frozen=True, slots=True)
class Comparison:
    """One quantity of one set in the terms of V&V 20, each in the unit of the quantity.

    Attributes
    ----------
    S, D : computed value, the limit of the levels at the nominal inputs; measured mean
    u_num : half of the half-width of its band
    u_input : root mean square change over the uncertain inputs, each uniform over its interval, from the
        nominal ones: they stand at the end of some intervals
    u_D : standard error of the mean, and of the tracked velocities
    scatter : verdict by the 95 % interval of the mean and the scatter of the tests (`compare.verdict`)
    """

    set: str
    quantity: str
    S: float
    D: float
    u_num: float
    u_input: float
    u_D: float
    scatter: str = ""

    @property
    def E(self) -> float:
        """Comparison error S - D."""
        return self.S - self.D

    @property
    def u_val(self) -> float:
        """Standard uncertainty of the comparison error."""
        return hypot(self.u_num, self.u_input, self.u_D)

    @property
    def interval(self) -> tuple[float, float]:
        """Interval of the model's error, E +- 2 u_val."""
        return self.E - COVERAGE * self.u_val, self.E + COVERAGE * self.u_val

    @property
    def in_error(self) -> bool:
        """Whether the interval of the model's error leaves out zero."""
        low, high = self.interval
        return not low <= 0 <= high

    @property
    def verdict(self) -> str:
        """Return whether the comparison shows an error of the model."""
        low, high = self.interval
        if not self.in_error:
            return "no error shown"
        return f"model too {'high' if low > 0 else 'low'} by at least {min(abs(low), abs(high)):.2g}"


TERMS = ("S", "D", "E", "u_num", "u_input", "u_D")
ERRORS = ("number", "model S", "tests D", "S - D", "u_num", "u_input", "u_D", "verdict")
"""Attributes of a `Comparison` and the words of its table."""
# of the correlations of the errors: below it, one of them follows from the others as far as is known
LEAST_EIGENVALUE = 1e-4
NOT_APART = Unknown("the tests and the uncertain inputs are too few to tell how these numbers vary apart")


def joint(E: Array, C: Array) -> tuple[float, float]:
    """Return Mahalanobis' distance squared of errors, and the probability of a larger one without error.

    Parameters
    ----------
    E : (k,) errors S - D of numbers that do not follow from each other
    C : (k, k) covariance of their uncertainties, so that numbers which one input moves together count once

    Examples
    --------
    >>> D2, p = joint(np.array([2.0, 2.0]), np.array([[1.0, 0.9], [0.9, 1.0]]))
    >>> f"{D2:.2f} {p:.2f}"
    '4.21 0.12'
    """
    from scipy.stats import chi2

    distance = float(E @ np.linalg.solve(C, E))
    return distance, float(chi2.sf(distance, len(E)))


def joint_or_why(E: Array, C: Array, tests: float) -> tuple[Num, Num]:
    """Return what `joint` does of errors (k,) and their covariance (k, k), or why it says nothing.

    The scatter of so many single ``tests`` spans one direction less than there are.
    """
    u = np.sqrt(np.diag(C))
    if len(E) >= tests or not u.all() or np.linalg.eigvalsh(C / np.outer(u, u))[0] < LEAST_EIGENVALUE:
        return NOT_APART, NOT_APART
    return joint(E, C)
