"""Errors of a model beside measurements in the terms of ASME V&V 20, of one number and of several at once."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, inf, sqrt

import numpy as np

from fem_impact.arrays import Array
from fem_impact.outcome.keys import Num, Unknown
from fem_impact.run.tests import MeasuredTests, tests_freedom

COVERAGE = 2.0  # E +- 2 u_val, the interval of the model's error if u_val is known well (V&V 20, section 6)
LEVEL = 0.05
"""Probability of a distance so large without an error of the model, below which a set is rejected."""
FOLLOWS = (
    ("V_n", {"e", "Omega"}),
    ("V_t", {"e", "mu", "Omega"}),
    ("V_t", {"V_n", "mu"}),
    ("e_t", {"e", "mu", "Omega"}),
    ("e_t", {"V_t"}),
    ("E_ln_over_E_0", {"e"}),
    ("E_lt_over_E_0", {"e", "mu", "Omega"}),
    ("E_r_over_E_0", {"e", "mu", "Omega"}),
)
"""Numbers, and others from which they follow, so that they are no further evidence in a joint statement."""


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
    dof : degrees of freedom of u_val, few where the scatter of few tests makes most of it (`freedom`)
    """

    set: str
    quantity: str
    S: float
    D: float
    u_num: float
    u_input: float
    u_D: float
    scatter: str = ""
    dof: float = inf

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
        """Interval of the model's error, E +- 2 u_val; with Student's factor as likely for few tests."""
        half = COVERAGE * self.u_val
        if self.dof < inf:
            from scipy.special import ndtr, stdtrit

            half = float(stdtrit(self.dof, ndtr(COVERAGE))) * self.u_val
        return self.E - half, self.E + half

    @property
    def in_error(self) -> bool:
        """Whether the interval of the model's error leaves out zero."""
        low, high = self.interval
        return not low <= 0 <= high

    @property
    def verdict(self) -> str:
        """Return whether the comparison shows an error of the model."""
        low, high = self.interval
        if self.u_val == 0:
            return "not judged: nothing is uncertain"
        if not self.in_error:
            return "no error shown"
        return f"model too {'high' if low > 0 else 'low'} by at least {min(abs(low), abs(high)):.2g}"


TERMS = ("S", "D", "E", "u_num", "u_input", "u_D")
ERRORS = ("number", "model S", "tests D", "S - D", "u_num", "u_input", "u_D", "verdict")
"""Attributes of a `Comparison` and the words of its table."""
# of the correlations of the errors: below it, one of them follows from the others as far as is known
LEAST_EIGENVALUE = 1e-4
NOT_APART = Unknown("the tests and the uncertain inputs are too few to tell how these numbers vary apart")


def independent(names: Sequence[str]) -> list[int]:
    """Return the places of numbers that do not follow from others among them.

    Examples
    --------
    >>> independent(["e", "mu", "Omega", "V_t"]), independent(["e", "V_t"])
    ([0, 1, 2], [0, 1])
    """
    follow = {name for name, others in FOLLOWS if others <= {*names}}
    return [at for at, name in enumerate(names) if name not in follow]


def freedom(C: Array, scatter: Array, dof: float) -> float:
    """Return the degrees of freedom of a covariance of which a part is estimated from few tests.

    That is after Welch and Satterthwaite, of several numbers as Krishnamoorthy and Yu 2004
    (doi:10.1016/j.spl.2003.10.012) write it: those of the tests where they make all of C, infinite where they
    make nothing of it.

    Parameters
    ----------
    C, scatter : (k, k) covariance of errors, and the part of it by the scatter of tests
    dof : degrees of freedom of that part

    Examples
    --------
    >>> freedom(np.eye(1), np.eye(1), 4.0), freedom(np.eye(2), 0.5 * np.eye(2), 4.0)
    (4.0, 16.0)
    """
    k, part = len(C), np.linalg.solve(C, scatter)
    size = float(np.trace(part @ part) + np.trace(part) ** 2)
    return (k + k**2) * dof / size if size > 0 else inf


def compared_with(
    tests: MeasuredTests, name: str, S: float, u_num: float, u_input: float, set: str
) -> Comparison:
    """Return the comparison of a computed number S with that ``name`` of tests, ``set`` by their own name."""
    of_tests = tests.covariance([name])
    C = of_tests + u_num**2 + u_input**2
    dof = freedom(C, tests.scatter([name]), tests_freedom(tests, [name])) if C.any() else inf
    D = tests.statistics()[name].mean
    return Comparison(set, name, S, D, u_num, u_input, sqrt(of_tests[0, 0]), dof=dof)


def joint(E: Array, C: Array, dof: float = inf) -> tuple[float, float]:
    """Return Mahalanobis' distance squared of errors, and the probability of a larger one without error.

    Parameters
    ----------
    E : (k,) errors S - D of numbers that do not follow from each other
    C : (k, k) covariance of their uncertainties, so that numbers which one input moves together count once
    dof : degrees of freedom of C, k or more: the distance follows Hotelling's distribution

    Examples
    --------
    >>> D2, p = joint(np.array([2.0, 2.0]), np.array([[1.0, 0.9], [0.9, 1.0]]))
    >>> f"{D2:.2f} {p:.2f}"
    '4.21 0.12'
    """
    from scipy.special import chdtrc, fdtrc

    k, distance = len(E), float(E @ np.linalg.solve(C, E))
    if dof == inf:
        return distance, float(chdtrc(k, distance))
    rest = dof - k + 1
    return distance, float(fdtrc(k, rest, distance * rest / (dof * k)))


def joint_or_why(E: Array, C: Array, scatter: Array, dof: float) -> tuple[Num, Num]:
    """Return what `joint` does of errors (k,) and their covariance (k, k), or why it says nothing.

    ``scatter`` and ``dof`` are as of `freedom`. The scatter of tests spans as many directions.
    """
    u = np.sqrt(np.diag(C))
    if len(E) > dof or not u.all() or np.linalg.eigvalsh(C / np.outer(u, u))[0] < LEAST_EIGENVALUE:
        return NOT_APART, NOT_APART
    return joint(E, C, freedom(C, scatter, dof))
