"""Uncertainty of e, mu and e_m to first order."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Floats
from ..coefficients import coefficients
from .estimate import MOTION, Errors, Estimate, stack_tests
from .propagate import sensitivities

ARMS = ("d_c", "d_d")


def first_order(
    motion: Mapping[str, ArrayLike],
    *,
    d_c: float,
    d_d: float,
    k2: float,
    errors: Errors | None = None,
) -> dict[str, Estimate]:
    """Coefficients of the mean motion with their uncertainty, propagated linearly.

    The scatter of the velocities enters with their covariance (V_n, V_t and Omega vary together), divided
    by the number of tests; contact point and tracking are common to all tests and do not
    average out. Where the moment arm d_c - mu d_d nearly vanishes e_m is ill-conditioned, and its bar
    says so (to first order: `bootstrap` shows how skewed it is).

    Parameters
    ----------
    motion : mapping of str to (n,) array_like
        v_n, v_t, V_n, V_t (m/s), Omega (rad/s); n >= 2.
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
    errors = errors or Errors()
    rows = stack_tests(motion)
    mean = dict(zip(MOTION, rows.mean(axis=1), strict=True))
    at = {k: np.asarray(v, dtype=np.float64) for k, v in {**mean, "d_c": d_c, "d_d": d_d}.items()}
    values = coefficients(**at, k2=k2)._asdict()
    slopes = sensitivities(lambda **x: coefficients(**x, k2=k2)._asdict(), at)
    return {name: _estimate(float(value), slopes[name], rows, errors) for name, value in values.items()}


def _estimate(value: float, slope: Mapping[str, Floats], rows: Floats, errors: Errors) -> Estimate:
    """Estimate with the root sum of squares of the three sources."""
    from scipy.special import stdtrit  # here, as a run of the solver needs the rest of this package only

    n = rows.shape[1]
    g = np.array([slope[name] for name in MOTION])
    arms = np.array([slope[name] for name in ARMS])
    parts = {
        "scatter": float(np.sqrt(max(g @ np.cov(rows) @ g, 0.0) / n)),
        "contact": errors.contact_sd * float(np.hypot(*arms)),
        "tracking": errors.tracking_sd * float(np.linalg.norm(g * rows.mean(axis=1))),
    }
    fixed = float(np.hypot(parts["contact"], parts["tracking"]))
    half = float(np.hypot(stdtrit(n - 1, 0.975) * parts["scatter"], 1.96 * fixed))
    return Estimate(value, float(np.hypot(parts["scatter"], fixed)), value - half, value + half, parts)
