"""Uncertainty of e, mu and e_m worked out from measured velocities: to first order, and by random draws."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite, sqrt

import numpy as np

from .coefficients import coefficients
from .inputs import ArrayLike, DataError, Floats

MOTION = ("v_n", "v_t", "V_n", "V_t", "Omega")


def _names(motion: Mapping[str, ArrayLike]) -> tuple[str, ...]:
    """Return the velocities of tests by name, with the spin omega before where it is given."""
    return (*MOTION, "omega") if "omega" in motion else MOTION


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
    """Stack v_n, v_t, V_n, V_t, Omega, and omega if given, as (5 or 6, n); refuse less than two tests."""
    missing = [name for name in MOTION if name not in motion]
    if missing:
        raise DataError(f"the motion lacks {', '.join(missing)}; it needs {', '.join(MOTION)}")
    rows = np.stack(np.broadcast_arrays(*(np.asarray(motion[k], dtype=np.float64) for k in _names(motion))))
    if rows.ndim != 2 or rows.shape[1] < 2:
        raise DataError(f"an uncertainty needs at least two tests, got shape {rows.shape[1:]}")
    return rows


STEP = float(np.finfo(np.float64).eps) ** (1 / 3)


def sensitivities(
    formula: Callable[..., Mapping[str, Floats]], at: Mapping[str, Floats]
) -> dict[str, dict[str, Floats]]:
    """Return the derivatives d(output)/d(input) of every output of `formula`.

    Parameters
    ----------
    formula : callable
        Takes the inputs by keyword and gives outputs by name.
    at : mapping of str to float64
        Inputs; arrays are differentiated entry by entry.

    Returns
    -------
    dict of dict of float64
        ``result[output][input]``, exact to about ten digits for smooth formulas.

    Examples
    --------
    >>> slope = sensitivities(lambda x, y: {"z": x * y**2}, {"x": np.array(2.0), "y": np.array(3.0)})
    >>> f"{slope['z']['x']:.6f} {slope['z']['y']:.6f}"
    '9.000000 12.000000'
    """
    result: dict[str, dict[str, Floats]] = {}
    for name, value in at.items():
        step = STEP * np.maximum(np.abs(value), 1e-3)
        high, low = (formula(**{**at, name: value + sign * step}) for sign in (1, -1))
        for output in high:
            result.setdefault(output, {})[name] = (high[output] - low[output]) / (2 * step)
    return result


ARMS = ("d_c", "d_d")


def first_order(
    motion: Mapping[str, ArrayLike], *, d_c: float, d_d: float, k2: float, errors: Errors | None = None
) -> dict[str, Estimate]:
    """Coefficients of the mean motion with their uncertainty, propagated linearly.

    The scatter of the velocities enters with their covariance (V_n, V_t and Omega vary together), divided
    by the number of tests; contact point and tracking are common to all tests and do not
    average out. Where the moment arm d_c - mu d_d nearly vanishes e_m is ill-conditioned, and its bar
    says so (to first order: `bootstrap` shows how skewed it is).

    Parameters
    ----------
    motion : mapping of str to (n,) array_like
        v_n, v_t, V_n, V_t (m/s), Omega (rad/s); n >= 2. Spin omega before (rad/s), 0 where it is not given.
    d_c, d_d : float
        Arms, m.
    k2 : float
        Squared radius of gyration, m2.
    errors : Errors, optional
        +-0.5 mm and +-2 % unless given.

    Returns
    -------
    dict of str to Estimate
        For e, mu and e_m.
    """
    from scipy.special import stdtrit  # here, as a run of the solver needs the rest of this package only

    errors = errors or Errors()
    rows, names = stack_tests(motion), _names(motion)
    n = rows.shape[1]
    mean = dict(zip(names, rows.mean(axis=1), strict=True))
    at = {k: np.asarray(v, dtype=np.float64) for k, v in {**mean, "d_c": d_c, "d_d": d_d}.items()}
    values = {name: float(value) for name, value in coefficients(**at, k2=k2)._asdict().items()}
    slopes = sensitivities(lambda **x: coefficients(**x, k2=k2)._asdict(), at)
    estimates = {}
    for name, value in values.items():
        g = np.array([slopes[name][by] for by in names])
        scatter = float(np.sqrt(max(g @ np.cov(rows) @ g, 0.0) / n))
        contact = errors.contact_sd * float(np.hypot(*(slopes[name][arm] for arm in ARMS)))
        tracking = errors.tracking_sd * float(np.linalg.norm(g * rows.mean(axis=1)))
        fixed = float(np.hypot(contact, tracking))
        half = float(np.hypot(stdtrit(n - 1, 0.975) * scatter, 1.96 * fixed))
        parts = {"scatter": scatter, "contact": contact, "tracking": tracking}
        sd = float(np.hypot(scatter, fixed))
        estimates[name] = Estimate(value, sd, value - half, value + half, parts)
    return estimates


SOURCES = ("scatter", "contact", "tracking")


def bootstrap(
    motion: Mapping[str, ArrayLike],
    *,
    d_c: float,
    d_d: float,
    k2: float,
    errors: Errors | None = None,
    samples: int = 4000,
    seed: int = 0,
) -> dict[str, Estimate]:
    """Coefficients of the mean motion with percentile intervals: a parametric bootstrap.

    Each sample draws means of the tests (`drawn_means`), one contact point and one tracking error of each
    velocity within `errors`. Samples that no impact has are left out: the body does not approach the barrier,
    or is pulled by it. Parameters as in `first_order`; `parts` holds half the width of the central 68 % with
    that source alone, which stays finite where e_m has no variance.

    Returns
    -------
    dict of str to Estimate
        For e, mu and e_m; `sd` is that half width with all sources together.
    """
    errors = errors or Errors()
    rows, names, rng = stack_tests(motion), _names(motion), np.random.default_rng(seed)
    mean = dict(zip(names, rows.mean(axis=1), strict=True))
    values = coefficients(**mean, d_c=d_c, d_d=d_d, k2=k2)._asdict()

    def draw(*sources: str) -> dict[str, Floats]:
        """Coefficients of random repetitions of the set, (samples,) each."""
        alone = np.repeat(rows.mean(axis=1)[:, None], samples, axis=1)
        means = drawn_means(rows, samples, rng) if "scatter" in sources else alone
        tracking = errors.tracking if "tracking" in sources else 0.0
        means = means * (1.0 + tracking * rng.uniform(-1, 1, means.shape))
        shift = (errors.contact if "contact" in sources else 0.0) * rng.uniform(-1, 1, (2, samples))
        possible = (means[0] < 0) & (means[2] > means[0])  # v_n, V_n
        motions = dict(zip(names, means[:, possible], strict=True))
        arms = dict(zip(ARMS, np.array([[d_c], [d_d]]) + shift[:, possible], strict=True))
        return coefficients(**motions, **arms, k2=k2)._asdict()

    draws = {name: draw(name) for name in SOURCES}
    together = draw(*SOURCES)
    estimates = {}
    for name, value in values.items():
        low, high = np.percentile(together[name], [2.5, 97.5])
        parts = {source: _half_width(drawn[name]) for source, drawn in draws.items()}
        estimates[name] = Estimate(float(value), _half_width(together[name]), float(low), float(high), parts)
    return estimates


def drawn_means(rows: Floats, samples: int, rng: np.random.Generator) -> Floats:
    """Return means (k, samples) that the measured tests leave possible, of k quantities of n tests (k, n).

    They are drawn from Student's distribution with the covariance of the means and n - 1 degrees of freedom
    (JCGM 101, 6.4.9), so that few tests leave more possible: tests drawn with replacement scatter too little,
    and their 95 % interval held 74 % of three tests.
    """
    n = rows.shape[1]
    spread = np.cov(rows) / n
    normal = rng.multivariate_normal(np.zeros(len(rows)), spread, samples, check_valid="ignore").T
    wider = normal * np.sqrt((n - 1) / rng.chisquare(n - 1, samples))
    means: Floats = rows.mean(axis=1)[:, None] + wider
    return means


def _half_width(drawn: Floats) -> float:
    """Half the width of the central 68.27 %."""
    low, high = np.percentile(drawn, [15.865, 84.135])
    return float(high - low) / 2
