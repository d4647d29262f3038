"""The short rod against the angle of the barrier: means, critical ratio, and losses by Eq 23-25 with scatter.

Five sets of the 0.08 m rod dropped at about 2.1 m/s: 17, 25, 37, 60 degrees (Table 6) and 45 (Table 5, b).
"""

from typing import Any, NamedTuple

import numpy as np

from ..coefficients import Coefficients
from ..inputs import ArrayLike, DataError, Floats, refuse
from ..losses import PredictedLosses, predicted_losses
from ..massive import critical_ratio
from ..uncertainty import drawn_means
from .sets import MeasuredSet, measured_set

IDS = ("t6-17", "t6-25", "t6-37", "t5b", "t6-60")


class AtAngle(NamedTuple):
    """Mean coefficients and arms (m) of the short rod at each angle."""

    e: Floats
    mu: Floats
    e_m: Floats
    d_c: Floats
    d_d: Floats


def angle_sets() -> tuple[MeasuredSet, ...]:
    """Five sets in the order of their angle."""
    return tuple(measured_set(id) for id in IDS)


def at_angle(alpha: ArrayLike) -> AtAngle:
    """Interpolate the measured means linearly in the angle.

    Parameters
    ----------
    alpha : array_like
        Inclination, rad, between 17 and 60 degrees: nothing was measured outside.

    Examples
    --------
    >>> f"{at_angle(np.radians(41.0)).e:.3f}"
    '0.335'
    """
    x, sets = np.asarray(alpha, dtype=np.float64), angle_sets()
    angles = np.array([s.alpha for s in sets])
    outside = ~((x >= angles[0]) & (x <= angles[-1]))
    refuse(outside, "the short rod was measured from 17 to 60 degrees, not at {value} rad", x, DataError)
    statistics = [s.statistics() for s in sets]
    means = [[of_set[name].mean for of_set in statistics] for name in ("e", "mu", "e_m")]
    arms = [[float(s.arms[i]) for s in sets] for i in (0, 1)]
    return AtAngle(*(np.interp(x, angles, column)[()] for column in (*means, *arms)))


def loss_against_angle(alpha: ArrayLike) -> PredictedLosses:
    """Losses as fractions of E_0 from Eq 23-25 with interpolated coefficients (the curves of Fig 7).

    Parameters and limits as in `at_angle`; the result does not depend on speed or mass.
    """
    v_n, v_t = -np.cos(alpha), -np.sin(alpha)
    k2 = angle_sets()[0].k2
    return predicted_losses(v_n, v_t, **at_angle(alpha)._asdict(), k2=k2, mass=2.0)


def critical_ratio_against_angle(e_m: float | None = -1.0) -> tuple[Floats, Floats]:
    """Critical ratio at the five angles, beside the mean measured ratio (Fig 5).

    Parameters
    ----------
    e_m : float or None
        Moment restitution; None takes the mean measured one of each set.

    Returns
    -------
    mu_c, mu : (5,) float64
        In the order of `angle_sets`.
    """
    rows = [(s, s.statistics()) for s in angle_sets()]
    column = {k: np.array([m[k].mean for _, m in rows]) for k in ("v_n", "v_t", "e", "mu", "e_m")}
    d_c, d_d = np.array([[float(x) for x in s.arms] for s, _ in rows]).T
    moment = column["e_m"] if e_m is None else e_m
    motion = column["v_n"], column["v_t"]
    mu_c = critical_ratio(*motion, e=column["e"], e_m=moment, d_c=d_c, d_d=d_d, k2=rows[0][0].k2)
    return mu_c, column["mu"]


def drawn_losses(alpha: ArrayLike, samples: int = 1000, seed: int = 0) -> PredictedLosses:
    """Losses of `loss_against_angle` for random repetitions of the five sets.

    Parameters
    ----------
    alpha : (n,) array_like
        Inclinations, rad, from 17 to 60 degrees.
    samples : int
        Repetitions; in each, the means of every set are drawn with `rigid.uncertainty.drawn_means`.
    seed : int
        Of the random numbers.

    Returns
    -------
    PredictedLosses
        Fractions of E_0, (samples, n) float64 each.

    Examples
    --------
    >>> lost = drawn_losses(np.radians([45.0]))
    >>> total = lost.E_ln + lost.E_lt
    >>> [f"{p:.2f}" for p in np.percentile(total, [2.5, 97.5])]
    ['0.90', '0.94']
    """
    x, sets, rng = np.asarray(alpha, dtype=np.float64), angle_sets(), np.random.default_rng(seed)
    tests = [s.recomputed() for s in sets]
    rows = [np.stack([of_set[name] for name in Coefficients._fields]) for of_set in tests]
    columns = [drawn_means(one, samples, rng) for one in rows]
    means = np.stack(columns, axis=-1)  # of e, mu and e_m, (3, samples, 5)
    angles = np.array([s.alpha for s in sets])
    weights = np.stack([np.interp(x, angles, unit) for unit in np.eye(len(angles))])  # of each set, (5, n)
    given: dict[str, Any] = {name: means[i] @ weights for i, name in enumerate(Coefficients._fields)}
    arms = at_angle(x)
    body: dict[str, Any] = {"d_c": arms.d_c, "d_d": arms.d_d, "k2": sets[0].k2, "mass": 2.0}
    return predicted_losses(-np.cos(x), -np.sin(x), **given, **body)
