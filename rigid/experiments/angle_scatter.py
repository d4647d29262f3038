"""Scatter of the short rod's losses against the angle: the tests of each set drawn with replacement."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..coefficients import Coefficients
from ..losses import PredictedLosses, predicted_losses
from .angles import angle_sets, at_angle


def drawn_losses(alpha: ArrayLike, samples: int = 1000, seed: int = 0) -> PredictedLosses:
    """Losses of `loss_against_angle` for random repetitions of the five sets.

    Parameters
    ----------
    alpha : (n,) array_like
        Inclinations, rad, from 17 to 60 degrees.
    samples : int
        Repetitions; in each, the tests of every set are drawn with replacement.
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
    ['0.91', '0.94']
    """
    x, rng = np.asarray(alpha, dtype=np.float64), np.random.default_rng(seed)
    columns = []
    for measured in angle_sets():
        recomputed = measured.recomputed()
        rows = np.stack([recomputed[name] for name in Coefficients._fields])
        chosen = rng.integers(rows.shape[1], size=(samples, rows.shape[1]))
        columns.append(rows[:, chosen].mean(axis=2))
    means = np.stack(columns, axis=-1)  # of e, mu and e_m, (3, samples, 5)
    angles = np.array([s.alpha for s in angle_sets()])
    weights = np.stack([np.interp(x, angles, unit) for unit in np.eye(len(angles))])  # of each set, (5, n)
    given: dict[str, Any] = {name: means[i] @ weights for i, name in enumerate(Coefficients._fields)}
    arms = at_angle(x)
    body: dict[str, Any] = {"d_c": arms.d_c, "d_d": arms.d_d, "k2": angle_sets()[0].k2, "mass": 2.0}
    return predicted_losses(-np.cos(x), -np.sin(x), **given, **body)
