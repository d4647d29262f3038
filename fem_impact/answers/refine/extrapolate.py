"""Limits for vanishing element size from runs on levels of meshes, with the half-widths of their bands.

Two meshes do not determine the order of convergence that Richardson's extrapolation needs. `pair_limit`
therefore states the band of the limits of all orders from `LOWEST` up (from the mean on the finer mesh, the
limit of infinite order, to the limit of order `LOWEST`), and its middle as the limit. Where each mesh ran at
one grid offset alone, the scatter by the offset is not known, and the band is `ONE_RUN` times as wide.

A mesh holds back something of a blow that is too short for its cells (`held_back`): a face that lands flat
stops at once, the mass of its nodes loses its energy (closing loss), and the step of the stress wave makes
cells swing that are too large for it. Both fall as cells shrink everywhere, but levels have finer cells at
the contact alone and do not show it: bands must leave room for it.

Levels that agree by chance cannot know the energy of vibration better than its own two counts do
(`vibration_floor`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, log2, sqrt
from statistics import fmean, stdev

from fem_impact.answers.refine.needed import ROWS, MeshNumbers, unresolved_heat, widened
from fem_impact.answers.refine.quantities import QUANTITIES, sum_of
from fem_impact.outcome.groups import ARMS
from fem_impact.outcome.keys import Key, Unknown, or_none
from fem_impact.outcome.record import KEY_TABLE, KEYS, Outcome
from fem_impact.outcome.shares import above_modes


def held_back(run: Outcome) -> dict[str, float]:
    """Return by how much numbers of a run, by key, would change if what its cells took were motion again.

    These are all vibration and the closing loss, as a share q of E_0, where more vibrates above the modes of
    the body than in them; else nothing. By E_ln = (1 - e^2) E_c it makes e^2 larger by q (1 - e^2) / E_ln.
    """
    energy, restitution = run.energy, run.restitution
    modes, whole = or_none(energy.vibration), or_none(energy.vibration_check)
    if modes is None or whole is None or above_modes(energy) <= modes:
        return {}
    taken = whole + (or_none(energy.contact_dissipation) or 0.0)
    changes = {
        "E_r_over_E_0": taken,
        "E_vib_over_E_0": -modes,
        "W_contact_dissipation_over_E_0": -(taken - whole),
    }
    for name in ARMS:
        arms = getattr(restitution, name)
        e, lost = or_none(arms.e), or_none(arms.E_ln)
        if e is None or lost is None or lost <= 0.0:
            continue
        part = min(taken / lost, 1.0)
        more = sqrt(e**2 + part * (1 - e**2)) - e
        changes |= {f"e_{name}": more, f"E_ln_{name}_over_E_0": -part * lost}
        if (V_n := or_none(run.motion.V_n)) is not None:
            changes["V_n_m_per_s"] = more / (1 + e) * (V_n - run.motion.v_n)
    return changes


VIBRATION = KEY_TABLE["E_vib_over_E_0"]
"""Key of the quantity whose band has a floor, see `vibration_floor`."""
UNRESOLVED = Unknown("the last level did not resolve the contact")
ALONE = Unknown("one level alone tells no error")

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
# of the larger of the last two changes, each by one halving of the cells, where the last level does not
# resolve a contact's narrow side: Roache's of two grids. It holds what an order of 0.42 or more leaves
NARROW = 3.0
# of the widest band of `SHARED`, that each of them has at least: what one body or the contact takes less on a
# finer mesh, the others take. Of 44 numbers of 7 scenes beside one level more one more was held, of 140
# numbers of levels inside chains five more
SHARE = 0.5
SHARED = tuple(
    KEY_TABLE[name]
    for name in ("W_friction_over_E_0", "E_plastic_rod_over_E_0", "E_plastic_barrier_over_E_0")
)
LONE = 1.5  # of the change from a level that did not resolve its contact: that has no order, as a pair's has
# Standard error of a mean over two places half a cell apart, over that of places taken at random: they
# cancel the first harmonic of the grid. Root mean squares over nine quantities of the 13 sets: such means lay
# .40 and .50 of the latter from those of four places on 0.59 and 0.30 mm.
EVEN = 0.6


@dataclass(frozen=True, slots=True)
class MeshRuns:
    """The runs of a level, which share a mesh.

    Attributes
    ----------
    size : edge of the cells that resolve the contact, m
    runs : outcomes, one for each place of the barrier's grid, or those of a scene and its twin
    resolved, wide : whether they resolve their contact, and also across its narrow side
    rows : nodes across that side
    repeats : how often the level ran again, with more room, without thin cells or with shorter steps
    earlier : processor time, s, of each run before the last of these
    """

    size: float
    runs: list[Outcome]
    resolved: bool = True
    wide: bool = True
    rows: int = ROWS
    repeats: int = 0
    earlier: Sequence[float] = ()

    @property
    def across(self) -> int:
        """Nodes across the narrow side of the contact, `ROWS` where that is resolved."""
        return ROWS if self.wide else self.rows

    @property
    def times(self) -> list[float]:
        """Processor time, s, of each run with its repeats."""
        earlier = self.earlier or [0.0] * len(self.runs)
        return [run.cost.whole_cpu + before for run, before in zip(self.runs, earlier, strict=True)]

    @property
    def cpu_s(self) -> float:
        """Processor time, s, of all runs with their repeats."""
        return sum(self.times)

    def values(self, keys: Sequence[Key]) -> list[float]:
        """Return the sums of keys in the runs that know one of them."""
        return [value for run in self.runs if (value := sum_of(keys, run)) is not None]

    def mean(self, keys: Sequence[Key]) -> float | None:
        """Return the mean of the sums of keys, None where a run does not know it."""
        values = self.values(keys)
        return fmean(values) if len(values) == len(self.runs) else None


@dataclass(frozen=True, slots=True)
class QuantityLimit:
    """The limit of a target quantity for vanishing elements.

    Attributes
    ----------
    value, band : limit and its half-width; of a sum the sum of those of its parts
    scale : divisor of errors, in the unit of the quantity
    """

    value: float
    band: float
    scale: float

    @property
    def error(self) -> float:
        """The half-width over the scale."""
        return self.band / self.scale


def quantity_limits(levels: Sequence[MeshRuns]) -> dict[str, QuantityLimit]:
    """Return the limits of the target quantities, by name, that levels from coarse to fine give a band.

    There are none where the last level does not resolve its contact.
    """
    limits, bands = level_limits(levels)
    if isinstance(limits, Unknown) or isinstance(bands, Unknown):
        return {}
    by_name = {}
    for quantity in QUANTITIES:
        names = [key.name for key in quantity.keys if key.name in bands]
        finest = levels[-1].mean(quantity.keys)
        if names and finest is not None:
            value, band = (sum(of[name] for name in names) for of in (limits, bands))
            # the larger of limit and finest value, so that a limit near zero does not inflate the errors
            scale = quantity.scale(max(abs(value), abs(finest)), levels[-1].runs[0])
            by_name[quantity.name] = QuantityLimit(value, band, scale)
    return by_name


def level_limits(levels: Sequence[MeshRuns]) -> tuple[MeshNumbers, MeshNumbers]:
    """Return limits and half-widths, by key, of levels from coarse to fine, or why there are none.

    They need two levels, of which the last resolves the contact, and are of every banded number that all runs
    of the finest two know. Half-widths are those of `own_limits`, as far widened as a study of random scenes
    found to be needed (`fem_impact.answers.refine.needed`).
    """
    limits, bands = own_limits(levels)
    if isinstance(limits, Unknown) or isinstance(bands, Unknown):
        return limits, bands
    run = levels[-1].runs[0]
    bands = widened(limits, bands, run)
    lost = unresolved_heat(limits, bands, run, levels[-1].across)
    known, told = ({key: of[key] for key in of if key not in lost} for of in (limits, bands))
    return known, told


def own_limits(levels: Sequence[MeshRuns]) -> tuple[MeshNumbers, MeshNumbers]:
    """Return limits and half-widths, by key, that levels tell by themselves, or why there are none.

    Half-widths hold what the cells of the finest held back, see
    `held_back`; that of the vibration energy is no less than its runs allow. Shares
    that flow and friction take have half-widths alike, see `SHARE`.
    """
    if levels and not levels[-1].resolved:
        return UNRESOLVED, UNRESOLVED
    if len(levels) < 2:
        return ALONE, ALONE
    sizes, wide = zip(*((level.size, level.wide) for level in levels), strict=True)
    limits, bands = dict[str, float](), dict[str, float]()
    kept = isinstance(levels[-1].runs[0].barrier.mass, Unknown)  # a massive barrier keeps its velocity
    for key in KEYS:
        changes = key.banded and not (kept and key.path[0] == "barrier")
        means = [level.mean([key]) for level in levels] if changes else [None, None]
        if None in means[-2:]:
            continue
        # a number that a coarser level does not know changes by itself
        values = [level.values([key]) or [0.0] for level in levels]
        limits[key.name], bands[key.name] = level_limit(sizes, values, wide)
        if key is VIBRATION:
            bands[key.name] = max(bands[key.name], fmean(map(vibration_floor, levels[-1].runs)))
    taken = [key.name for key in SHARED if limits.get(key.name)]  # of 0 no share is taken: none can be lost
    for name in taken:
        bands[name] = max(bands[name], SHARE * max(bands[other] for other in taken))
    for name, change in held_back(levels[-1].runs[0]).items():
        if name in bands:
            finest = levels[-1].mean([KEY_TABLE[name]]) or 0.0
            bands[name] = max(bands[name], abs(finest + change - limits[name]))
    return limits, bands


def level_limit(
    sizes: Sequence[float], values: Sequence[Sequence[float]], resolved: Sequence[bool]
) -> tuple[float, float]:
    """Return limit and half-width of one number from its values on two or more levels from coarse to fine.

    They are those of the finest two, but two levels may agree by chance: no half-width is less than the
    change from one level to the next where both ``resolved`` the contact and ran once each, and than `HALVED`
    of any other of the last three. Where the last but one did not, nothing is extrapolated: the finest value
    stands, with `LONE` times the change to it; where the last did not, with `NARROW` times the larger of the
    last two changes by a halving.
    """
    means = [fmean(on_level) for on_level in values]
    changes = [abs(fine - coarse) for coarse, fine in pairwise(means)]
    if not resolved[-1]:
        halvings = [max(log2(coarse / fine), 1.0) for coarse, fine in pairwise(sizes)]
        by_halving = [change / times for change, times in zip(changes, halvings, strict=True)]
        return means[-1], NARROW * max(by_halving[-2:])
    if resolved[-2]:
        value, band = pair_limit(sizes[-2:], values[-2:])
    else:
        value, band = means[-1], LONE * changes[-1]
    once = min(map(len, values[-2:])) == 1
    shares = [1.0 if once and all(pair) else HALVED for pair in pairwise(resolved)]
    least = [share * change for share, change in zip(shares, changes, strict=True)]
    return value, max(band, *least[-2:])


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
    """Return the standard error of the mean over two places of the grid; 0 for one value alone."""
    return EVEN * stdev(values) / sqrt(len(values)) if len(values) > 1 else 0.0


def pair_limit(sizes: Sequence[float], values: Sequence[Sequence[float]]) -> tuple[float, float]:
    """Return the limit of a coarser and a finer mesh and its half-width.

    The band holds the limits of all orders from `LOWEST` up, since two meshes do not determine the order; the
    limit is its middle. ``values`` are those of the runs on each mesh, ``sizes`` in any unit. With one run on
    a mesh the band is `ONE_RUN` times as wide; the standard error by the scatter of several is added.

    Examples
    --------
    >>> value, half = pair_limit([2.0 ** (4 / 3), 1.0], [[1.2, 1.2], [1.1, 1.1]])
    >>> round(value, 6), round(half, 6)
    (1.05, 0.05)
    >>> round(pair_limit([2.0 ** (4 / 3), 1.0], [[1.2], [1.1]])[1], 6)
    0.15
    """
    coarse, fine = map(fmean, values)
    weight = 0.5 / ((sizes[0] / sizes[1]) ** LOWEST - 1)
    half, once = weight * (fine - coarse), min(map(len, values)) == 1
    scatter = hypot(weight * standard_error(values[0]), (1 + weight) * standard_error(values[1]))
    return fine + half, abs(half) * (ONE_RUN if once else 1.0) + scatter
