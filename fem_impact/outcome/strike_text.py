"""What is told of strikes in words and as a table."""

from collections.abc import Callable, Sequence
from math import degrees, inf

from fem_impact.outcome.keys import Num, Unknown, keys_of, known, or_none
from fem_impact.outcome.strikes import StrikeRecord, Strikes, StrikeSpread
from fem_impact.tables.table import Table
from fem_impact.tables.text import with_band

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
ROUND_OFF = 1e-9  # of the energy before the first strike, below which nothing is told
SHOWN = 12
"""Strikes that are listed where nothing says how many are certain; all of them stand in strikes.csv."""
SPREAD = ("strike", "tip", "tail", "other", "none", "time, ms", "approach, m/s")


def told(strikes: Strikes) -> list[str]:
    """Return sentences: the end, the other end's and the hardest strikes, the totals, what is certain."""
    if isinstance(strikes.each, Unknown):
        return [f"Later strikes are not known: {strikes.each.reason}."]
    count = len(strikes.each)
    return [
        f"{count} strike{'s' * (count > 1)}. {strikes.because} {_other_end(strikes)}",
        *_hardest(strikes),
        _totals(strikes),
        *_certain(strikes),
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
    rows = [_row(strikes, number, one) for number, one in enumerate(known(strikes.each)[:most], 1)]
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


def _row(strikes: Strikes, number: int, one: StrikeRecord) -> tuple[str, ...]:
    told = (_number(strikes, number, key.path[-1], scale) for key, scale in ROW.items())
    return (str(number), one.part, *told, one.fidelity)


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
    first = f"first {certain} strikes are" if certain > 1 else "first strike is"
    table = ": a table tells what strikes how often" if len(known(strikes.spread)) > certain else ""
    return [
        f"The {first} of the same part of the body in all of 64 sequences; later ones are one path of "
        f"many{table}. {strikes.holds}{between}"
    ]


def _hardest(strikes: Strikes) -> list[str]:
    """Return the hardest strike by energy, force and heat: where, how fast, what; only numbers that hold.

    Of one behind the last certain strike, only one path of many, the hardest of the certain ones is told.
    """
    each, certain = known(strikes.each), or_none(strikes.certain)
    by_energy, by_force, by_heat = (
        ("energy", strikes.hardest_energy, strikes.hardest_agree),
        ("force", strikes.hardest_force, strikes.force_agree),
        ("friction heat", strikes.hardest_heat, strikes.heat_agree),
    )
    sizes: tuple[tuple[Callable[[StrikeRecord], float], str], ...] = (
        (lambda one: one.lost, "rigid motion from {before} J to {after} J"),
        (lambda one: one.force or 0.0, "{force} N"),
        (lambda one: one.friction, "{friction} J"),
    )
    told = []
    for (name, number, agree), (size, what) in zip((by_energy, by_force, by_heat), sizes, strict=True):
        if isinstance(number, Unknown):
            continue
        first, same = "", "" if isinstance(agree, Unknown) else f", the hardest in {agree} of 64 sequences"
        if certain is not None and number > certain:
            first, same = f" not certain (strike {number} of this path{same}); of the certain ones", ""
            number = 1 + max(range(certain), key=lambda at: size(each[at]))
        fields = ("approach", "before", "after", "friction", *(["force"] if name == "force" else []))
        numbers = {field: _number(strikes, number, field) for field in fields}
        strike = f"strike {number}, {each[number - 1].part} at {numbers['approach']} m/s"
        told.append(f"Hardest by {name}:{first} {strike}: {what.format(**numbers)}{same}.")
    return told


def _time_error(strikes: Strikes) -> str:
    """Return the error of the time to the rest, or that it has none."""
    if strikes.end != "rests":
        return ""
    if isinstance(strikes.time_factor, Unknown):
        return f" (error not known: {strikes.time_factor.reason})"
    return f" (within a factor of {strikes.time_factor:.2g})"


def _totals(strikes: Strikes) -> str:
    parts: tuple[tuple[str, Num], ...] = (
        ("friction", strikes.friction),
        ("plastic", strikes.plastic),
        ("damping", strikes.damping),
        ("other", strikes.other),
        ("settled", strikes.settled),
        ("left", strikes.left),
    )
    sums = ", ".join(f"{name} {v:.3g} J" for name, v in parts if not isinstance(v, Unknown) and v)
    least = ROUND_OFF * known(strikes.each)[0].before
    half, heat = or_none(strikes.friction_half) or 0.0, or_none(strikes.friction) or 0.0
    rubbed = f" Friction with its error: {with_band(heat, half, 0.0)} J." if half > least else ""
    time = "" if isinstance(strikes.time, Unknown) else f" after {strikes.time:.4g} s{_time_error(strikes)}"
    gave = or_none(strikes.gravity) or 0.0
    gravity = f" Gravity gave {gave:.3g} J." if abs(gave) > least else ""
    ends = "The last of them" if strikes.end in ("bounces on", "loses nothing") else "The end"
    return f"{ends} comes{time}: {sums}.{gravity}{rubbed}"
