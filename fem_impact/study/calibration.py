"""The constants that would meet all measured sets at once: a calibration, never a default.

Constants shared by sets (friction of each surface state, strength of the steels and what else does not vary
between tests) are drawn over their intervals; the likelihood of each draw follows from the response surfaces,
shifted to the limit of two meshes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from fem_impact.arrays import Array
from fem_impact.study.inputs import UNCERTAIN_INPUTS
from fem_impact.study.validated import (
    COVERAGE,
    DRAWN,
    FRICTION,
    NAMES,
    SEED,
    ValidatedSet,
    scaled,
    unit_sample,
)

JUDGED = ("e", "mu", "Omega")  # the other quantities are functions of these and of the approach
EXPONENT = 16  # 2 to this power draws
FEWEST = 100.0  # effective draws that a posterior needs


@dataclass(frozen=True, slots=True)
class Residual:
    """One quantity of one set at the best constants: measured D, computed S, standard uncertainty u."""

    set: str
    quantity: str
    D: float
    S: float
    u: float

    @property
    def met(self) -> bool:
        """Whether it lies within two standard uncertainties."""
        return abs(self.S - self.D) <= COVERAGE * self.u


@dataclass(frozen=True, slots=True)
class Calibration:
    """Posterior of the shared constants.

    Attributes
    ----------
    names : of the constants
    mean, sd, best : (constants,) float64, each over its own interval from 0 to 1; NaN for mean and sd where
        fewer than `FEWEST` draws carry the weight
    draws : effective number of draws, (sum w)^2 / sum w^2 (Kish 1965)
    residuals : at the best constants
    """

    names: tuple[str, ...]
    mean: Array
    sd: Array
    best: Array
    draws: float
    residuals: tuple[Residual, ...]


def constants_of(sets: Sequence[ValidatedSet]) -> tuple[str, ...]:
    """Return the constants that sets share: friction of each surface state, and inputs that do not vary."""
    states = dict.fromkeys(f"{FRICTION}, {found.measured.surface}" for found in sets)
    return (*states, *(i.name for i in UNCERTAIN_INPUTS if not i.varies))


def calibrate(sets: Sequence[ValidatedSet]) -> Calibration:
    """Return the constants that meet the sets best, and what they leave over.

    Each set adds sum ((S - D) / u)^2 over `JUDGED`, with u of its mesh, measurement, response surface and of
    the inputs of its own (angle, contact point, speed), taken as independent.
    """
    names = constants_of(sets)
    draws = np.asarray(qmc.Sobol(len(names), rng=np.random.default_rng(SEED)).random_base2(EXPONENT))
    chi2 = np.zeros(len(draws))
    for found in sets:
        S, D, u = _judged(found, names, draws)
        chi2 += np.sum(((S - D) / u) ** 2, axis=1)
    weights = np.exp(-0.5 * (chi2 - chi2.min()))
    weights /= weights.sum()
    effective = float(1 / np.sum(weights**2))
    mean = weights @ draws if effective >= FEWEST else np.full(len(names), np.nan)
    sd = np.sqrt(weights @ (draws - mean) ** 2)
    best = draws[chi2.argmin()]
    residuals = tuple(r for found in sets for r in _residuals(found, names, best))
    return Calibration(names, mean, sd, best, effective, residuals)


def _residuals(found: ValidatedSet, names: Sequence[str], best: Array) -> list[Residual]:
    S, D, u = _judged(found, names, best[None])
    return [Residual(found.name, q, *map(float, row)) for q, *row in zip(JUDGED, D, S[0], u, strict=True)]


def _judged(found: ValidatedSet, names: Sequence[str], draws: Array) -> tuple[Array, Array, Array]:
    """Return computed `JUDGED` (n, 3) at constants (n, constants), measured ones and uncertainties (3,)."""
    at = [NAMES.index(name) for name in JUDGED]
    unit = np.full((len(draws), len(UNCERTAIN_INPUTS)), 0.5)
    for column, source in _columns(found, names):
        unit[:, column] = draws[:, source]
    compared = [found.comparisons[i] for i in at]
    u2 = np.array([c.u_num**2 + c.u_D**2 for c in compared])
    u2 += found.surface.error[at] ** 2 + _own_variance(found, names)[at]
    S = found.surface(unit)[:, at] + found.shift[at]
    return S, np.array([c.D for c in compared]), np.sqrt(u2)


def _columns(found: ValidatedSet, names: Sequence[str]) -> list[tuple[int, int]]:
    """Return pairs of a column of the surface's inputs and the constant that stands in it."""
    own = {FRICTION: f"{FRICTION}, {found.measured.surface}"}
    wanted = [own.get(i.name, i.name) for i in UNCERTAIN_INPUTS]
    return [(column, names.index(name)) for column, name in enumerate(wanted) if name in names]


def _own_variance(found: ValidatedSet, names: Sequence[str]) -> Array:
    """Return the variance (outputs,) by the inputs that are the set's own, the constants at their middles."""
    unit = scaled(found.name, unit_sample(DRAWN))
    unit[:, [column for column, _ in _columns(found, names)]] = 0.5
    return np.asarray(found.surface(unit).var(axis=0))
