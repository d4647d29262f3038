"""The constants that would meet all measured sets at once: a calibration, never a default.

Constants shared by sets (friction of each surface state, strength of the steels and what else does not vary
between tests) are drawn over their intervals; the likelihood of each draw follows from the response surfaces,
shifted to the limit of two meshes. The posterior is narrow and lies in corners of the intervals, where hardly
a draw would fall; a sequential Monte Carlo sampler leads the draws there (Del Moral, Doucet & Jasra 2006,
doi:10.1111/j.1467-9868.2006.00553.x).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.stats import qmc

from fem_impact.arrays import Array
from fem_impact.evidence.studies.inputs import UNCERTAIN_INPUTS
from fem_impact.evidence.studies.validated import (
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
DRAWS, MOVES = 2048, 12  # draws; moves of each after every rise of the likelihood's power
KEPT = 0.5  # share of the draws, by their weights, that is left at each rise (Kish 1965)


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
    mean, sd, best : (constants,) float64, each over its own interval from 0 to 1
    residuals : at the best constants
    """

    names: tuple[str, ...]
    mean: Array
    sd: Array
    best: Array
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

    def chi2(draws: Array) -> Array:
        judged = (_judged(found, names, draws) for found in sets)
        return np.asarray(sum(np.sum(((S - D) / u) ** 2, axis=1) for S, D, u in judged))

    draws = posterior(chi2, len(names))
    best = draws[chi2(draws).argmin()]
    residuals = tuple(r for found in sets for r in _residuals(found, names, best))
    return Calibration(names, draws.mean(axis=0), draws.std(axis=0), best, residuals)


def posterior(chi2: Callable[[Array], Array], size: int) -> Array:
    """Return draws (`DRAWS`, size) from exp(-chi2 / 2) over the unit cube.

    ``chi2`` takes draws (n, size) to (n,). The power of the likelihood rises from 0 to 1, each time so far
    that `KEPT` of the draws is left; these are drawn again by their weights and moved by Metropolis' rule,
    with steps as wide as they scatter, reflected at the faces of the cube.
    """
    rng, power = np.random.default_rng(SEED), 0.0
    draws = np.asarray(qmc.Sobol(size, rng=rng).random(DRAWS))
    cost = chi2(draws)
    while power < 1:
        rise = _rise(cost, 1 - power)
        power += rise
        weights = np.exp(-0.5 * rise * (cost - cost.min()))
        again = rng.choice(DRAWS, DRAWS, p=weights / weights.sum())
        draws, cost = draws[again], cost[again]
        steps = np.linalg.cholesky(2.38**2 / size * np.atleast_2d(np.cov(draws.T)) + 1e-12 * np.eye(size))
        for _ in range(MOVES):
            moved = 1 - np.abs(1 - np.abs(draws + rng.standard_normal(draws.shape) @ steps.T) % 2)
            other = chi2(moved)
            taken = rng.random(DRAWS) < np.exp(np.minimum(0.5 * power * (cost - other), 0.0))
            draws[taken], cost[taken] = moved[taken], other[taken]
    return draws


def _rise(cost: Array, most: float) -> float:
    """Return the rise of the power, at most ``most``, after which `KEPT` of the draws carries the weight."""

    def left(rise: float) -> float:
        weights = np.exp(-0.5 * rise * (cost - cost.min()))
        return float(weights.sum() ** 2 / np.sum(weights**2) / len(cost)) - KEPT

    return most if left(most) >= 0 else float(brentq(left, 0.0, most))


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
