"""The strikes of a body from its first to its rest: as an outcome holds them, in words and as tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees, inf
from typing import TYPE_CHECKING

from fem_impact.errors import UsageError
from fem_impact.outcome.keys import Num, Unknown, group, keys_of, known, nearest_key, or_none
from fem_impact.tables.table import Table
from fem_impact.tables.text import with_band

if TYPE_CHECKING:
    import pandas

PHASED = "e", "mu", "friction", "vibration", "force"
"""Numbers of a strike that the phase of what vibrates before it changes, as told under NAME_phase."""
NO_ERROR = (
    "no error is known of the loss factor of vibration in flight, of what the balance leaves, of dents and "
    "of gauges; a rigid strike has no force"
)
"""Why W_damping_J, E_vib_before_J, E_other_J, dents, gauges and some forces have no half-width."""
NO_FORCE = Unknown("a rigid impact without duration has no force")


@group
class StrikeRecord:
    """One strike: when, where, with which motion before and after, and what each account got of it."""

    time: float
    fidelity: str
    part: str
    x: float
    z: float
    along: float
    alpha: float
    approach: float
    sliding: float
    v_n: float
    v_t: float
    omega: float
    V_n: float
    V_t: float
    Omega: float
    e: float
    mu: float
    impulse_n: float
    impulse_t: float
    force: float | None
    dent: float | None
    highest: float | None
    lowest: float | None
    before: float
    after: float
    friction: float
    plastic: float
    damping: float
    vibration: float
    taken: float
    other: float
    e_phase: float
    mu_phase: float
    friction_phase: float
    vibration_phase: float
    force_phase: float

    @property
    def lost(self) -> float:
        """Energy that the rigid motion lost, J."""
        return self.before - self.after


@group
class StrikeSpread:
    """What strikes as one of the first strikes in sequences over the stated intervals of what comes in."""

    number: int
    tip: int
    tail: int
    other: int
    none: int
    time_low: float
    time_high: float
    approach_low: float
    approach_high: float
    half_widths: Mapping[str, float]


@group
class Strikes:
    """All strikes of a body that is followed beyond its first impact, and where its energy went."""

    until: str
    each: tuple[StrikeRecord, ...] | Unknown
    end: str | Unknown
    because: str | Unknown
    time: Num
    time_factor: Num
    way: Num
    hardest_energy: int | Unknown
    hardest_force: int | Unknown
    hardest_heat: int | Unknown
    other_end: Num
    certain: int | Unknown
    spread: tuple[StrikeSpread, ...] | Unknown
    holds: str | Unknown
    hardest_agree: int | Unknown
    force_agree: int | Unknown
    heat_agree: int | Unknown
    other_end_low: Num
    other_end_high: Num
    gravity: Num
    friction: Num
    friction_half: Num
    plastic: Num
    damping: Num
    other: Num
    settled: Num
    left: Num
    residual: Num

    def half_width(self, number: int, name: str) -> Num:
        """Return the half-width of a number of a strike, from 1, by its key, or why there is none.

        Raises
        ------
        UsageError
            Strikes have no such number.
        """
        keys = tuple(keys_of(StrikeRecord))
        names = [one.name for one in keys]
        if name not in names:
            hint = nearest_key(name, keys, f"Give one of {', '.join(names)}.")
            raise UsageError("is no number of a strike.", key="name=", value=name, remedy=hint)
        if isinstance(self.spread, Unknown):
            return self.spread
        if isinstance(self.certain, Unknown) or number > self.certain:
            return Unknown(f"it is not certain what strike {number} is of: see strikes_spread")
        half = self.spread[number - 1].half_widths.get(name)
        return Unknown(NO_ERROR) if half is None else half

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a row a strike, with the columns of its JSON (ResultError: there are none)."""
        import pandas

        columns = tuple(keys_of(StrikeRecord))
        rows = [[one.of(strike) for one in columns] for strike in known(self.each)]
        return pandas.DataFrame(rows, columns=[one.name for one in columns])


def other_end(each: Sequence[StrikeRecord], length: float) -> Num:
    """Return the largest speed at which the other end strikes over that of the first strike."""
    if each[0].part == "surface":
        return Unknown("a ball has no other end")
    first = each[0].z < 0.5 * length
    others = [one.approach for one in each if (one.z < 0.5 * length) != first and one.part in ("tip", "tail")]
    if not others:
        return Unknown("the other end does not strike by itself")
    return max(others) / each[0].approach


def hardest(values: Sequence[float]) -> int:
    """Return the number, from 1, of the largest value."""
    return 1 + max(range(len(values)), key=lambda at: values[at])


def hardest_force(each: Sequence[StrikeRecord]) -> int | Unknown:
    """Return the number, from 1, of the strike with the largest force; unknown if a faster one has none."""
    if all(one.force is None for one in each):
        return NO_FORCE
    number = hardest([-1.0 if one.force is None else one.force for one in each])
    faster = [
        n for n, one in enumerate(each, 1) if one.force is None and one.approach > each[number - 1].approach
    ]
    if faster:
        return Unknown(f"strike {faster[0]}, which is faster, is one without duration, and has no force")
    return number


HEAD = ("", "part", "time, ms", "angle, deg", "approach, m/s", "e", "mu", "left, J", "friction, J", "model")
ROW = {
    key: {"time": 1e3, "alpha": degrees(1.0)}.get(key.path[-1], 1.0)
    for key in keys_of(StrikeRecord)
    if key.path[-1] in ("time", "alpha", "approach", "e", "mu", "after", "friction")
}
"""Numbers of a row, and what they are multiplied by."""
SIGNED = "alpha", "mu"
"""Those that may be below 0."""
KEYS = {key.path[-1]: key.name for key in keys_of(StrikeRecord)}
PAST_ENDS = 1e-3  # of e, beyond 0 and 1, that is told
ROUND_OFF = 1e-9  # of the energy before the first strike, below which nothing is told
AGREED = 32  # of 64 sequences, in which a strike is the hardest at least to be named as it without doubt
SHOWN = 12
"""Strikes that are listed where none is certain or nothing tells how many are; all stand in strikes.csv."""
SPREAD = ("strike", "tip", "tail", "other", "none", "time, ms", "approach, m/s")


def told(strikes: Strikes) -> list[str]:
    """Return sentences: the end, the totals, the other end's and the hardest strikes, what is certain."""
    if isinstance(strikes.each, Unknown):
        return [f"Later strikes are not known: {strikes.each.reason}."]
    count = len(strikes.each)
    return [
        f"{count} strike{'s' * (count > 1)}. {strikes.because}",
        _totals(strikes),
        _other_end(strikes),
        *_hardest(strikes),
        *_certain(strikes),
        *_given_back(strikes.each),
    ]


def _given_back(each: Sequence[StrikeRecord]) -> list[str]:
    """Say of an e below 0 or above 1 where it comes from; nothing where there is none."""
    numbers = [str(n) for n, one in enumerate(each, 1) if one.e < -PAST_ENDS or one.e > 1.0 + PAST_ENDS]
    if not numbers:
        return []
    strikes = f"strike{'s' * (len(numbers) > 1)} {', '.join(numbers[:SHOWN])}"
    return [
        f"e below 0 or above 1 in {strikes}: a body that still vibrates gives that energy back to its motion "
        "as it strikes, or takes more up; the energy balance is kept."
    ]


def levels_told(levels: Sequence[Strikes]) -> str:
    """Say how far the strikes of the last two levels of meshes differ, nothing where there are no two."""
    each = [one.each for one in levels[-2:] if not isinstance(one.each, Unknown)]
    if len(each) < 2:
        return ""
    coarse, fine = each
    changes = [
        f"strike {number} {a.approach:.3g} to {b.approach:.3g} m/s with e {a.e:.3g} to {b.e:.3g}"
        for number, (a, b) in enumerate(zip(coarse, fine, strict=False), 1)
        if a.fidelity == b.fidelity == "solid" and a.part == b.part
    ]
    return f"From the last level of meshes but one to the last: {', '.join(changes)}." if changes else ""


def strikes_table(strikes: Strikes, most: int | None = None) -> Table:
    """Return a row for each of the first strikes, numbers with their half-widths."""
    rows = []
    for number, one in enumerate(known(strikes.each)[:most], 1):
        numbers = (_number(strikes, number, key.path[-1], scale) for key, scale in ROW.items())
        rows.append((str(number), one.part, *numbers, one.fidelity))
    return Table.of(HEAD, rows, left=(1, 9))


def spread_table(spread: Sequence[StrikeSpread]) -> Table:
    """Return a row a strike: what strikes in how many sequences, when and how fast in nine tenths of them."""
    rows = [
        (
            *(str(count) for count in (one.number, one.tip, one.tail, one.other, one.none)),
            f"{1e3 * one.time_low:.3g} to {1e3 * one.time_high:.3g}",
            f"{one.approach_low:.3g} to {one.approach_high:.3g}",
        )
        for one in spread
    ]
    return Table.of(SPREAD, rows)


def _number(strikes: Strikes, number: int, field: str, scale: float = 1.0) -> str:
    """Return a number of a strike times ``scale``, with its half-width where that is known."""
    value = getattr(known(strikes.each)[number - 1], field)
    half = or_none(strikes.half_width(number, KEYS[field]))
    low = -inf if field in SIGNED else 0.0
    return with_band(scale * value, scale * half, low) if half else f"{scale * value + 0.0:.4g}"


def _other_end(strikes: Strikes) -> str:
    """Return how much faster the other end strikes than the first did."""
    ratio = strikes.other_end
    if isinstance(ratio, Unknown):
        return f"{ratio.reason[0].upper()}{ratio.reason[1:]}."
    return f"The other end strikes {ratio:.3g} times as fast as the first strike came."


def _certain(strikes: Strikes) -> list[str]:
    """Return how many strikes are certain and what that holds, or why nothing is known of it."""
    certain, ends = strikes.certain, (strikes.other_end_low, strikes.other_end_high)
    if isinstance(certain, Unknown):
        return [f"Errors of the strikes are not known: {certain.reason}."]
    between_ends = [f"{end:.3g}" for end in ends if not isinstance(end, Unknown)]
    between = (
        f" The other end strikes {' to '.join(between_ends)} times as fast as the first strike came."
        if len(between_ends) == 2
        else ""
    )
    first = f"The first {certain} strikes are" if certain > 1 else "The first strike is"
    later = "later ones are"
    if certain == 0:
        first, later = "Not even the first strike is", "all strikes told are"
    table = ": a table tells what strikes how often" if len(known(strikes.spread)) > certain else ""
    return [
        f"{first} of the same part of the body in all of 64 sequences; {later} one path of many{table}. "
        f"{strikes.holds}{between}"
    ]


def _hardest(strikes: Strikes) -> list[str]:
    """Return the hardest strike by energy, force and heat: where, how fast, what; only numbers that hold.

    Of one behind the last certain strike, only one path of many, the hardest of the certain ones is told
    where there are any.
    """
    each, certain = known(strikes.each), or_none(strikes.certain)
    lost, rubbed = [one.lost for one in each], [one.friction for one in each]
    forces, told = [one.force or 0.0 for one in each], []
    motion = "rigid motion from {before} J to {after} J"
    for name, number, agree, sizes, what in (
        ("energy", strikes.hardest_energy, strikes.hardest_agree, lost, motion),
        ("force", strikes.hardest_force, strikes.force_agree, forces, "{force} N"),
        ("friction heat", strikes.hardest_heat, strikes.heat_agree, rubbed, "{friction} J"),
    ):
        if isinstance(number, Unknown) or sizes[number - 1] <= ROUND_OFF * each[0].before:
            continue  # no strike has any
        first, same = "", "" if isinstance(agree, Unknown) else f", the hardest in {agree} of 64 sequences"
        if not isinstance(agree, Unknown) and agree < AGREED:
            first = " not certain;"
        if agree == 0:
            same = ", in none of the 64 sequences of the reduced model that hold its errors"
        if certain is not None and number > certain:
            first = " not certain;"
            if certain:
                first, same = f" not certain (strike {number} of this path{same}); of the certain ones", ""
                number = hardest(sizes[:certain])
        fields = ("approach", "before", "after", "friction", *(["force"] if name == "force" else []))
        numbers = {field: _number(strikes, number, field) for field in fields}
        strike = f"strike {number}, {each[number - 1].part} at {numbers['approach']} m/s"
        told.append(f"Hardest by {name}:{first} {strike}: {what.format(**numbers)}{same}.")
    return told


def _totals(strikes: Strikes) -> str:
    """Return when the last strike comes, and what the energy has become by then."""
    parts: tuple[tuple[str, Num], ...] = (
        ("friction", strikes.friction),
        ("plastic", strikes.plastic),
        ("damping", strikes.damping),
        ("other", strikes.other),
        ("settled", strikes.settled),
    )
    sums = ", ".join(f"{name} {v:.3g} J" for name, v in parts if not isinstance(v, Unknown) and v)
    before = known(strikes.each)[0].before
    least = ROUND_OFF * before
    half, heat = or_none(strikes.friction_half) or 0.0, or_none(strikes.friction) or 0.0
    rubbed = f" Friction with its error: {with_band(heat, half, 0.0)} J." if half > least else ""
    factor, error = strikes.time_factor, ""
    if strikes.end == "rests" and isinstance(factor, Unknown):
        error = f" (error not known: {factor.reason})"
    elif strikes.end == "rests":
        error = f" (within a factor of {factor:.2g})"
    time = "" if isinstance(strikes.time, Unknown) else f" after {strikes.time:.4g} s{error}"
    gave = or_none(strikes.gravity) or 0.0
    came = f"{before:.3g} J before the first strike"
    came += f" and {gave:.3g} J from gravity" if abs(gave) > least else ""
    left = strikes.left if isinstance(strikes.left, Unknown) or strikes.left > least else 0.0
    kept = "" if isinstance(left, Unknown) else f" the body keeps {left:.3g} J, vibration included;"
    ends = "The last of them" if strikes.end in ("bounces on", "loses nothing") else "The end"
    return f"{ends} comes{time}. Of {came}{kept} the rest: {sums or 'nothing'}.{rubbed}"
