"""Uncertainty of e, mu and e_m by resampling, without any linearisation."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Floats
from ..coefficients import coefficients
from .estimate import MOTION, Errors, Estimate, stack_tests

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
    """Coefficients of the mean motion with percentile intervals.

    Each sample draws the tests anew with replacement, one contact point and one tracking error of each
    velocity within `errors`. Parameters as in `first_order`; `parts` holds half the width of the central 68 %
    with that source alone, which stays finite where e_m has no variance.

    Returns
    -------
    dict of str to Estimate
        For e, mu and e_m; `sd` is that half width with all sources together.
    """
    errors = errors or Errors()
    rows, rng = stack_tests(motion), np.random.default_rng(seed)

    def draw(*sources: str) -> dict[str, Floats]:
        """Coefficients of random repetitions of the set, (samples,) each."""
        means = _resampled(rows, samples, rng) if "scatter" in sources else rows.mean(axis=1)[:, None]
        tracking = errors.tracking if "tracking" in sources else 0.0
        means = means * (1.0 + tracking * rng.uniform(-1, 1, (len(rows), samples)))
        shift = (errors.contact if "contact" in sources else 0.0) * rng.uniform(-1, 1, (2, samples))
        motions = dict(zip(MOTION, means, strict=True))
        return coefficients(**motions, d_c=d_c + shift[0], d_d=d_d + shift[1], k2=k2)._asdict()

    draws = {name: draw(name) for name in SOURCES}
    together = draw(*SOURCES)
    mean = dict(zip(MOTION, rows.mean(axis=1), strict=True))
    estimates = {}
    for name, value in coefficients(**mean, d_c=d_c, d_d=d_d, k2=k2)._asdict().items():
        low, high = np.percentile(together[name], [2.5, 97.5])
        parts = {source: _half_width(drawn[name]) for source, drawn in draws.items()}
        estimates[name] = Estimate(float(value), _half_width(together[name]), float(low), float(high), parts)
    return estimates


def _resampled(rows: Floats, samples: int, rng: np.random.Generator) -> Floats:
    """Means (5, samples) of the tests drawn anew with replacement; one sample's tests are held at a time."""
    n = rows.shape[1]
    means = np.empty((len(rows), samples))
    for sample in range(samples):
        means[:, sample] = rows @ np.bincount(rng.integers(n, size=n), minlength=n) / n
    return means


def _half_width(drawn: Floats) -> float:
    """Half the width of the central 68.27 %."""
    low, high = np.percentile(drawn, [15.865, 84.135])
    return float(high - low) / 2
