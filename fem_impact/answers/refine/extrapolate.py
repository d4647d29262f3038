"""Limits for vanishing element size from runs on several meshes, with the half-widths of their bands.

Two meshes do not determine the order of convergence that Richardson's extrapolation needs. `pair_limit`
therefore states the band of the limits of all orders from `LOWEST` up (from the mean on the finer mesh, the
limit of infinite order, to the limit of order `LOWEST`), and its middle as the limit. Where each mesh ran at
one grid offset alone, the scatter by the offset is not known, and the band is `ONE_RUN` times as wide. Three
meshes or more are fitted by least squares (`limit`).

Meshes that agree by chance cannot know the energy of vibration better than its own two counts do: `floored`.
One mesh alone cannot estimate its own error: `mesh_limits` gives it no band.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product
from math import sqrt
from operator import attrgetter, itemgetter
from statistics import fmean, stdev

import numpy as np
from numpy.typing import ArrayLike

from fem_impact.answers.refine.quantities import QUANTITIES, sum_of
from fem_impact.answers.refine.ringing import held_back
from fem_impact.arrays import Array
from fem_impact.errors import RunError
from fem_impact.outcome.keys import Key, Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, KEYS, Outcome

VIBRATION = (KEY_TABLE["E_vib_over_E_0"],)
"""Keys of the quantity whose band has a floor, see `floored`."""
MeshNumbers = Mapping[str, float] | Unknown
"""Numbers by the key of an outcome that they are about, or why there are none."""
ALONE = Unknown("one mesh alone cannot estimate its own error")

# Lowest order of convergence in the band of two meshes. Over thirteen sets and nine quantities, 82 % of
# such bands contain the limit of all three meshes, and all of them do within the band of that limit; the
# band of the coarser two contains the limit of the finer two in 69 %.
LOWEST = 0.75
# Safety factor of two meshes with one run each (Roache 1994, doi:10.1115/1.2910291, takes 3 for two grids).
# Of 98 pairs of the gamma study, bands of one offset held the limit of the next finer pair in 42 (vibration)
# and 44 (e) cases, three times as wide ones in 91 and 81. So wide, bands of one offset contain the limit of
# all meshes of the 13 sets in 91 %, that of the finer two in 85 %.
ONE_RUN = 3.0
# share of a change between two levels that a band holds at least; all of it where both resolve the contact
# and ran once. t5c: e .281, .307, .304 on three levels, .312 on a fourth
HALVED = 0.5
# of the largest change, where the last level does not resolve a contact's narrow side: Roache's of two grids
NARROW = 3.0
LONE = 1.5  # of the change from a level that did not resolve its contact: that has no order, as a pair's has
# Standard error of a mean over evenly spaced offsets, over that of offsets taken at random. Even ones cancel
# the first harmonics of the grid. Root mean squares over nine quantities of the 13 sets: means of two offsets
# lay .40 and .50 of the latter from those of four on 0.59 and 0.30 mm (medians .31 and .35; on rods with
# cells twice as large .45 to .60), means of four .27 from those of eight on 0.59 mm (median .13).
EVEN = {2: 0.6, 4: 0.35}
LOWEST_FITTED, HIGHEST_FITTED = 0.5, 2.0  # orders of an accepted fit; the method is of second order
SURE, UNSURE = 1.25, 3.0  # safety factors of an accepted fit and of one with fixed orders


@dataclass(frozen=True, slots=True)
class MeshRuns:
    """The runs on one mesh.

    Attributes
    ----------
    size : edge of the cells that resolve the contact, m; 0 of a model without a mesh
    runs : outcomes, one for each offset of the barrier's grid, or those of a scene and its twin
    """

    size: float
    runs: list[Outcome]

    @classmethod
    def of(cls, runs: Iterable[Outcome]) -> MeshRuns:
        """Return runs on a mesh whose size is that of the cells at the tip."""
        outcomes = list(runs)
        return cls(or_none(outcomes[0].cost.tip_size) or 0.0, outcomes)

    def values(self, keys: Sequence[Key]) -> list[float]:
        """Return the sums of keys in the runs that know one of them."""
        return [value for run in self.runs if (value := sum_of(keys, run)) is not None]

    def mean(self, keys: Sequence[Key]) -> float | None:
        """Return the mean of the sums of keys, None where a run does not know it."""
        values = self.values(keys)
        return fmean(values) if len(values) == len(self.runs) else None


@dataclass(frozen=True, slots=True)
class ExtrapolatedValue:
    """The limit of one quantity for vanishing elements and its uncertainty.

    Attributes
    ----------
    value : limit; order : observed order of convergence, None where there is none
    uncertainty : half-width of the band of the limit, ``scatter`` included
    scale : divisor of errors, in the unit of the quantity
    scatter : standard error of the limit by the scatter over the grid offsets
    """

    value: float
    order: float | None
    uncertainty: float
    scale: float
    scatter: float = 0.0


@dataclass(frozen=True, slots=True)
class Limit:
    """A fit over three meshes or more.

    Attributes
    ----------
    value : the fit at element size 0
    band : half-width about the finest mesh's value that should hold the limit in 95 of 100 cases
    order : fitted order, None where it lies outside the accepted range and fixed orders are used
    scatter : standard deviation of the values about the fit
    """

    value: float
    order: float | None
    band: float
    scatter: float


def target_limits(meshes: Sequence[MeshRuns]) -> dict[str, ExtrapolatedValue]:
    """Return the limit from two or more meshes, by name, of every target quantity that all runs know."""
    limits, finest = {}, min(meshes, key=attrgetter("size"))
    for quantity in QUANTITIES:
        limit = extrapolated(meshes, quantity.keys)
        if limit is not None:
            # the larger of limit and finest value, so that a limit near zero does not inflate the errors
            size = max(abs(limit.value), abs(fmean(finest.values(quantity.keys))))
            limits[quantity.name] = replace(limit, scale=quantity.scale(size, finest.runs[0]))
    return limits


def mesh_limits(meshes: Sequence[MeshRuns]) -> tuple[MeshNumbers, MeshNumbers]:
    """Return limit and half-width, by key, of every banded number that all runs on the meshes know.

    One mesh alone gives the means over its grid offsets without half-widths, and one run gives neither.
    """
    banded = [key for key in KEYS if key.banded]
    if len(meshes) == 1:
        means = {key.name: mean for key in banded if (mean := meshes[0].mean([key])) is not None}
        return means if len(meshes[0].runs) > 1 else ALONE, ALONE
    limits = {key.name: limit for key in banded if (limit := extrapolated(meshes, (key,))) is not None}
    return (
        {name: limit.value for name, limit in limits.items()},
        {name: limit.uncertainty for name, limit in limits.items()},
    )


def level_limits(meshes: Sequence[MeshRuns], resolved: Sequence[bool]) -> tuple[MeshNumbers, MeshNumbers]:
    """Return limits and half-widths, by key, of two or more levels from coarse to fine, as `level_limit`.

    They are of every banded number that all runs of the finest two know. Bands hold what the cells of the
    finest held back, see `fem_impact.answers.refine.ringing`; the vibration energy's is `floored`.
    """
    sizes, limits, bands = [mesh.size for mesh in meshes], dict[str, float](), dict[str, float]()
    for key in KEYS:
        means = [mesh.mean([key]) for mesh in meshes] if key.banded else [None, None]
        if None in means[-2:]:
            continue
        # a number that a coarser level does not know changes by itself
        values = [mesh.values([key]) or [0.0] for mesh in meshes]
        limits[key.name], bands[key.name] = level_limit(sizes, values, resolved)
        if key in VIBRATION:
            bands[key.name] = floored(bands[key.name], meshes[-1].runs)
    for name, change in held_back(meshes[-1].runs[0]).items():
        if name in bands:
            own = meshes[-1].mean([KEY_TABLE[name]]) or 0.0
            bands[name] = max(bands[name], abs(own + change - limits[name]))
    return limits, bands


def level_limit(
    sizes: Sequence[float], values: Sequence[Sequence[float]], resolved: Sequence[bool]
) -> tuple[float, float]:
    """Return limit and half-width of one number from its values on two or more levels from coarse to fine.

    They are those of the finest two, but two levels may agree by chance: no half-width is less than the
    change from one level to the next where both ``resolved`` the contact and ran once each, and than `HALVED`
    of any other of the last three. Where the last but one did not, nothing is extrapolated: the finest value
    stands, with `LONE` times the change to it; where the last did not, with `NARROW` times the largest change
    of all levels. Of 113 bands of levels that resolve the contact 104 held the value of one level finer, of
    131 others 120 (22 drawn scenes, seven quantities).
    """
    means = [fmean(on_level) for on_level in values]
    changes = [abs(fine - coarse) for coarse, fine in pairwise(means)]
    if not resolved[-1]:
        return means[-1], NARROW * max(changes)
    if resolved[-2]:
        limit = limit_of(sizes[-2:], values[-2:])
        value, band = limit.value, limit.uncertainty
    else:
        value, band = means[-1], LONE * changes[-1]
    once = min(map(len, values[-2:])) == 1
    shares = [1.0 if once and all(pair) else HALVED for pair in pairwise(resolved)]
    least = [share * change for share, change in zip(shares, changes, strict=True)]
    return value, max(band, *least[-2:])


def extrapolated(meshes: Sequence[MeshRuns], keys: Sequence[Key]) -> ExtrapolatedValue | None:
    """Return the limit, with scale 1, of a sum of keys from two or more meshes; None where a run lacks it.

    The uncertainty is the scatter of the means plus, of a pair, its band, of more meshes Eca and Hoekstra's
    band less the distance of the finest mesh from the limit; that of the vibration energy is `floored`.
    """
    if any(mesh.mean(keys) is None for mesh in meshes):
        return None
    limit = limit_of([mesh.size for mesh in meshes], [mesh.values(keys) for mesh in meshes])
    if tuple(keys) != VIBRATION:
        return limit
    finest = min(meshes, key=attrgetter("size"))
    return replace(limit, uncertainty=floored(limit.uncertainty, finest.runs))


def floored(band: float, runs: Sequence[Outcome]) -> float:
    """Return a half-width, of E_0, of the vibration energy that is no less than the runs on a mesh allow."""
    return max(band, fmean(map(vibration_floor, runs)))


def vibration_floor(run: Outcome) -> float:
    """Return the half-width, of E_0, below which no band of the vibration energy of a run may be.

    It is the distance of the two independent counts of that energy, by modes and without them, or the floor
    of the energy balance if that is more. Meshes that agree by chance cannot know the energy better than
    their own two counts do.
    """
    energy = run.energy
    vibration, check = or_none(energy.vibration), or_none(energy.vibration_check)
    apart = 0.0 if vibration is None or check is None else abs(check - vibration)
    return max(apart, or_none(energy.vibration_floor) or 0.0)


def standard_error(values: Sequence[float]) -> float:
    """Return the standard error of the mean over two or four even offsets; 0 for one value alone."""
    return EVEN[len(values)] * stdev(values) / sqrt(len(values)) if len(values) > 1 else 0.0


def pair_limit(fine: float, coarse: float, ratio: float, offsets: int = 1) -> tuple[float, float]:
    """Return the limit of two meshes and its half-width; ``ratio`` is coarse over fine size.

    The band holds the limits of all orders from `LOWEST` up, since two meshes do not determine the order; the
    limit is its middle. Each value is the mean over ``offsets`` of the grid; with one the band is `ONE_RUN`
    times as wide.

    Examples
    --------
    >>> value, half = pair_limit(1.1, 1.2, 2.0 ** (4 / 3), offsets=2)
    >>> round(value, 6), round(half, 6)
    (1.05, 0.05)
    >>> round(pair_limit(1.1, 1.2, 2.0 ** (4 / 3))[1], 6)
    0.15
    """
    half = 0.5 * (fine - coarse) / (ratio**LOWEST - 1)
    return fine + half, abs(half) * (ONE_RUN if offsets == 1 else 1.0)


def limit_of(sizes: Sequence[float], values: Sequence[Sequence[float]]) -> ExtrapolatedValue:
    """Return the limit, with scale 1, from the values of several runs on each mesh; ``sizes`` in any unit.

    The standard error of the limit by the scatter of those values is the root mean square change of the
    limit when each mean is moved up or down by its standard error, in all combinations; for a pair exactly
    the root of the weighted sum of variances.
    """
    means, errors = [fmean(on_mesh) for on_mesh in values], [standard_error(on_mesh) for on_mesh in values]
    offsets = min(map(len, values))
    value, order, extrapolation = _limit(sizes, means, offsets)
    changes = [
        _limit(sizes, [v + s * e for v, s, e in zip(means, signs, errors, strict=True)], offsets)[0] - value
        for signs in product((-1.0, 1.0) if any(errors) else (0.0,), repeat=len(means))
    ]
    scatter = sqrt(fmean(change**2 for change in changes))
    return ExtrapolatedValue(value, order, extrapolation + scatter, 1.0, scatter)


def _limit(
    sizes: Sequence[float], values: Sequence[float], offsets: int
) -> tuple[float, float | None, float]:
    """Return limit, order and uncertainty by extrapolation from the mean of ``offsets`` on each mesh."""
    last, first = (values[sizes.index(extreme(sizes))] for extreme in (min, max))
    if len(sizes) == 2:
        value, half = pair_limit(last, first, max(sizes) / min(sizes), offsets)
        return value, None, half
    fitted = limit(sizes, values)
    return fitted.value, fitted.order, fitted.band - abs(fitted.value - last)


def limit(sizes: ArrayLike, values: ArrayLike) -> Limit:
    """Return limit, order and band of q(h) by least squares over at least three meshes.

    Parameters
    ----------
    sizes : (n,) float64, m, element size of each mesh of one self-similar family, in any order
    values : (n,) float64, the quantity on each mesh

    Raises
    ------
    RunError
        Fewer than three different sizes.

    Notes
    -----
    L. Eca and M. Hoekstra, J. Comput. Phys. 262 (2014) 104-130, doi:10.1016/j.jcp.2014.01.006: q_0 + a h^p
    where .5 <= p <= 2, else fixed orders with a larger safety factor; the scatter of noisy data widens
    the band. Their fit of two terms is left out: with four meshes it follows the scatter. With three meshes
    nothing is left over to tell scatter from trend, so it reads 0.

    Examples
    --------
    >>> fitted = limit([4.0, 2.0, 1.0], [1.16, 1.04, 1.01])
    >>> round(fitted.value, 6), round(fitted.order, 3), round(fitted.band, 6)
    (1.0, 2.0, 0.0125)
    """
    from scipy.optimize import minimize_scalar  # .4 s, for which no page of a run should wait

    h, q = np.asarray(sizes, float), np.asarray(values, float)
    if len(np.unique(h)) < 3:
        raise RunError(f"A limit needs three meshes or more; there are {len(np.unique(h))}.")
    h = h / h.min()
    p = minimize_scalar(
        lambda p: _least_squares(h, q, p, len(h) - 1)[2], bounds=(0.1, 4.0), method="bounded"
    ).x
    accepted = LOWEST_FITTED <= p <= HIGHEST_FITTED + 0.1
    fits = (
        [_least_squares(h, q, float(p), 3)] if accepted else [_least_squares(h, q, p, 2) for p in (1.0, 2.0)]
    )
    value, terms, scatter = min(fits, key=itemgetter(2))
    finest, spread = int(h.argmin()), (q.max() - q.min()) / (len(q) - 1)
    error, off = abs(terms[finest]), abs(q[finest] - value - terms[finest])
    if scatter < spread:
        band = (SURE if accepted else UNSURE) * error + scatter + off
    else:
        band = 3 * scatter / spread * (error + scatter + off) if spread else 0.0
    return Limit(value, float(p) if accepted else None, float(band), scatter)


def _least_squares(h: Array, q: Array, order: float, unknowns: int) -> tuple[float, Array, float]:
    """Fit q_0 + a h^order with weights 1/h, as finer meshes count for more.

    Returns q_0, the terms a h^order (n,), and the standard deviation of q about the fit.
    """
    weights = (1 / h) / (1 / h).mean()
    columns, root = np.stack([np.ones_like(h), h**order], axis=1), np.sqrt(weights)
    value, slope = np.linalg.lstsq(columns * root[:, None], q * root, rcond=None)[0]
    terms = columns[:, 1] * slope
    rest = np.sqrt(weights @ (q - value - terms) ** 2 / max(len(h) - unknowns, 1))
    return float(value), terms, float(rest) if len(h) > unknowns else 0.0
