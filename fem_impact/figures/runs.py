"""Pictures of runs: force and energies over time, waves, shares of E_0, strikes, model beside measurement."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from fem_impact.arrays import Array
from fem_impact.figures.panels import Look, Mark, Panel, Picture, Series, ShadedInterval, ShadedMap
from fem_impact.figures.still import draw, percent
from fem_impact.files.waves import Waves, read_waves
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import ABOVE, ACCOUNTS, OF_SOME, EnergyShare, above_modes, shares
from fem_impact.outcome.strikes import StrikeRecord
from fem_impact.tables.table import COMPARISON, Table
from rigid.strikes import FlightState, Outline

SHOWN = 3
"""Strikes that the path shows at most: later ones lie on each other."""
FRAMES = 3  # between two strikes
ARC = 0.1  # rad between points of an arc
FREE = 0.02
"""Height, over the width of the body, by which a flight may miss the next strike; more is no free flight."""


def path_picture(each: Sequence[StrikeRecord], shape: Outline, gravity: tuple[float, float]) -> Picture:
    """Return the body at its strikes and in the flights between them, as a stroboscope shows it.

    Parameters
    ----------
    each : strikes from the first on
    shape : outline of the body about its mass centre
    gravity : accelerations out of -n and -t, m/s2
    """
    shown, line = each[:SHOWN], body_line(shape)
    states = [state_at(one, shape) for one in shown]
    flights = [
        before.flown(share * (after.time - before.time), *gravity)
        for before, after in pairwise(
            state._replace(V_n=one.V_n, V_t=one.V_t, Omega=one.Omega)
            for state, one in zip(states, shown, strict=True)
        )
        if flies(before, after, gravity, shape)
        for share in np.linspace(0.0, 1.0, FRAMES + 2)[1:-1].tolist()
    ]
    struck, flown = _bodies(line, states), _bodies(line, flights)
    places = Series(
        "place of the strike",
        [1e3 * one.along for one in shown],
        [0.0] * len(shown),
        "triangles",
        "vermilion",
        texts=tuple(f"strike {k}: {one.part}, {one.approach:.3g} m/s" for k, one in enumerate(shown, 1)),
    )
    bodies = (Series("in flight", *flown, "thin", "grey"), Series("at a strike", *struck, "line", "ink"))
    title = f"first {len(shown)} of {len(each)} strikes" if len(each) > len(shown) else ""
    panel = Panel(title, "along the barrier, mm", "over the barrier, mm", (*bodies, places), equal=True)
    caption = "The body at its strikes and at even times between them; flights alone are shown in between."
    return Picture("path", caption, (panel,), 1)


def tail_picture(curve: tuple[Sequence[float], Sequence[float]], own: tuple[float, float]) -> Picture:
    """Return how many times as fast as the first the other end strikes over the inclination, rad.

    ``curve`` is that of a rigid body, ``own`` the place of a run.
    """
    lines = (
        Series("rigid theory, other values as stated", np.degrees(curve[0]), curve[1], "line", "ink"),
        Series("this run", [np.degrees(own[0])], [own[1]], "triangles", "vermilion"),
    )
    panel = Panel(
        "", "angle between axis and normal, degrees", "speed of the other end over the first", lines
    )
    caption = (
        "The hardest strike of the other end beside the first strike; above 1 the other end comes faster."
    )
    return Picture("other-end", caption, (panel,), 1)


def accounts_picture(each: Sequence[StrikeRecord]) -> Picture:
    """Return where the energy is after each strike, J, stacked."""
    number = np.arange(1, len(each) + 1)
    fallen = np.cumsum([0.0, *(then.before - one.after for one, then in pairwise(each))])
    sums = {
        "friction": ("green", np.cumsum([one.friction for one in each])),
        "plastic": ("vermilion", np.cumsum([one.plastic for one in each])),
        "damping and other": ("sand", np.cumsum([one.damping + one.other for one in each])),
        "vibration": ("night", np.array([one.vibration for one in each])),
        "motion": ("blue", np.array([one.after for one in each])),
        "height": ("sky", fallen.max() - fallen),
    }
    areas = tuple(Series(name, number, values, "area", colour) for name, (colour, values) in sums.items())
    panel = Panel("", "strike", "energy, J", areas)
    caption = (
        "Energy after each strike. Height: over the strike at which the mass centre is lowest, "
        "less friction between strikes."
    )
    return Picture("strikes", caption, (panel,), 1)


def state_at(one: StrikeRecord, shape: Outline) -> FlightState:
    """Return the body at a strike; ways count from the first place of contact."""
    d_c, d_d = shape.corners[shape.lowest(one.alpha, one.omega)].arms(one.alpha)
    return FlightState(one.time, d_d, one.along + d_c, one.alpha, one.v_n, one.v_t, one.omega)


def flies(before: FlightState, after: FlightState, gravity: tuple[float, float], shape: Outline) -> bool:
    """Return whether a body flew freely from one strike to the next, rather than pivot or slide."""
    end = before.flown(after.time - before.time, *gravity)
    near = FREE * shape.widest
    return abs(end.height - after.height) < near and abs(end.along - after.along) < near


def body_line(shape: Outline) -> Array:
    """Return the closed outline (k, 2), (x, z), m, about the mass centre."""
    places = [
        one.place(angle)
        for one in shape.corners
        for angle in (
            np.linspace(one.low, one.high, 2 + ceil((one.high - one.low) / ARC)).tolist()
            if one.radius
            else [one.low]
        )
    ]
    return np.array([*places, places[0]])


def placed(line: Array, state: FlightState) -> Array:
    """Return an outline (k, 2), (x, z), m, about the mass centre as it lies along and over the barrier, m."""
    c, s = np.cos(state.alpha), np.sin(state.alpha)
    return np.column_stack([state.along + line @ (c, s), state.height + line @ (-s, c)])


def _bodies(line: Array, states: Sequence[FlightState]) -> tuple[Array, Array]:
    """Return all bodies as one line with gaps, along and over the barrier, mm."""
    gap = np.full((1, 2), np.nan)
    rows = [part for state in states for part in (1e3 * placed(line, state), gap)]
    along, over = np.concatenate(rows or [gap[:0]]).T
    return along, over


FORCE_COLUMNS = ("time_s", "force_n_N", "force_t_N")
MOST = 800
"""Times of a curve that are drawn at most; the CSV beside the figure has all."""


def force_picture(history: Table, contacts: Sequence[ContactInterval]) -> Picture:
    """Return normal and tangential contact force on the whole projectile, contact intervals shaded.

    Raises
    ------
    ResultError
        A column is missing or holds no numbers.
    """
    time, normal, tangential = (history.numbers(name) for name in FORCE_COLUMNS)
    series = (
        Series("normal (out of the barrier)", time * 1e6, normal / 1e3, "line", "blue"),
        Series("tangential (up the slope)", time * 1e6, tangential / 1e3, "dashed", "vermilion"),
    )
    intervals = [ShadedInterval(c.start * 1e6, c.end * 1e6, f"{c.impulse_n:.3g} N s") for c in contacts]
    panel = Panel("", "time, µs", "contact force on the projectile, kN", series, intervals=tuple(intervals))
    caption = "Contact force on the whole projectile; contact intervals shaded, with their normal impulse."
    numbers = Table.of(FORCE_COLUMNS, zip(time, normal, tangential, strict=True))
    return Picture("force", caption, (panel,), 1, numbers)


def ledger_picture(history: Table, e_0: float) -> Picture:
    """Return the energy accounts over time as stacked areas, fractions of E_0, ``e_0`` J.

    Raises
    ------
    ResultError
        A column is missing or holds no numbers.
    """
    time = history.numbers("time_s")
    accounts = [*ACCOUNTS, *(account for account in OF_SOME if account.column in history.names)]
    shares = {account: history.numbers(account.column) / e_0 for account in accounts}
    gravity = history.numbers("E_gravity_J") / e_0
    worst = float(np.abs(history.numbers("residual_J")).max(initial=0.0)) / e_0
    drawn = np.unique(np.linspace(0, max(len(time) - 1, 0), min(len(time), MOST)).astype(int))
    ends = [percent(float(share[-1])) if len(share) else "-" for share in shares.values()]
    areas = [
        Series(f"{account.label}  {end}", 1e6 * time[drawn], share[drawn], "area", account.colour)
        for (account, share), end in zip(shares.items(), ends, strict=True)
    ]
    total = "E_0 less gravity's potential" if np.any(np.abs(gravity) > 1e-9) else "E_0"
    whole = Series(total, 1e6 * time[drawn], 1.0 - gravity[drawn], "dashed", "ink")
    title = f"largest residual {worst:.1e} of E_0"
    panel = Panel(title, "time, µs", "fraction of E_0", (*areas, whole), y_range=(0.0, 1.05))
    names = [account.column.removesuffix("_J") + "_over_E_0" for account in shares]
    columns = ("time_s", *names, "E_gravity_over_E_0", "worst_residual_over_E_0")
    rows = zip(time, *shares.values(), gravity, np.full(len(time), worst), strict=True)
    caption = (
        "Ledger: each account as a fraction of E₀; the number beside a name is its last value. "
        "Strain energies include that of residual stress."
    )
    return Picture("ledger", caption, (panel,), 1, Table.of(columns, rows))


WAVE_COLUMNS = ("time_s", "position_m", "stretch", "bending")
ROWS = 240
"""Times that are drawn and written beside the figure; waves.h5 has all."""

AFTER = 4
"""Lengths of the rod that a stretching wave runs in the part after the run."""

QUIETEST = 0.01
"""Least range of a panel's colours, share of that of the other: less is numerical noise."""

NAMES = ("stretch: mean strain of each section", "bending: strain of the side facing the barrier")
ALONG = "position along the axis from the tip, mm"
CAPTION = (
    "Position along the axis against time: the mean strain of each section, and the part by which "
    "the side facing the barrier differs from it. Dashed: where a front from the contact would be."
)


def waves_picture(waves: Waves) -> Picture:
    """Return stretch and bending strain along the axis over time, and where fronts from the contact would be.

    The time axis ends four lengths of the rod, run by a stretching wave, after the run.
    """
    until = waves.end + (AFTER * waves.transit if waves.ringing else 0.0)
    times = np.linspace(0.0, until, ROWS)
    fronts = (
        _front(waves, "bar wave √(E/ρ)", waves.speed, 4),
        _front(waves, "fastest bending waves", waves.bending_speed, 2),
    )
    parts = waves.strain(times)
    tops = [1e6 * float(np.percentile(np.abs(part), 99.8)) for part in parts]
    flight = waves.ringing is not None and waves.ringing.start < times[-1]
    levels = (Mark(1e6 * waves.end, "free ringing, by modes"),) if flight else ()
    panels = []
    for strain, top, title, front in zip(parts, tops, NAMES, fronts, strict=True):
        limit = max(top, QUIETEST * max(tops), 1e-9)
        label = "axial strain, µm/m (red: tension)"
        shaded = ShadedMap(1e3 * waves.position, 1e6 * times, 1e6 * strain, limit, label)
        panel = Panel(title, ALONG, "time, µs", (front,), levels=levels, shaded=shaded)
        x_range, y_range = (0.0, 1e3 * waves.length), (0.0, 1e6 * float(times[-1]))
        panels.append(replace(panel, x_range=x_range, y_range=y_range))
    columns = (*np.meshgrid(times, waves.position, indexing="ij"), *parts)
    rows = zip(*(column.ravel() for column in columns), strict=True)
    numbers = Table.of(WAVE_COLUMNS, [[float(f"{x:.6g}") for x in row] for row in rows])
    return Picture("waves", CAPTION, tuple(panels), 2, numbers)


def draw_waves(result_dir: str | Path, out: str | Path | None = None) -> Path:
    """Draw the x-t picture of a run, `waves_picture`, and write its numbers beside it as CSV.

    Parameters
    ----------
    result_dir : folder of a run with waves.h5 (finite elements, ``save.strain_samples`` 1 or more)
    out : .png or .svg file; ``waves.svg`` in the folder unless given

    Raises
    ------
    ResultError
        The folder holds no waves.h5, or a damaged one.
    OutputPathError
        The place cannot be written.
    """
    folder = Path(result_dir)
    return draw(waves_picture(read_waves(folder / "waves.h5")), folder / "waves.svg" if out is None else out)


def _front(waves: Waves, words: str, speed: float, passes: int) -> Series:
    """Return the line of a front that runs at ``speed``, m/s, along ``passes`` lengths of the rod."""
    turns = np.arange(passes + 1)
    place, time = 1e3 * waves.length * (turns % 2), 1e6 * waves.length / speed * turns
    return Series(f"{words}, {speed:.0f} m/s", place, time, "dashed", "ink")


UNSEEN = 1e-5
"""Fraction of E_0 below which a bar is not drawn."""

AXIS = "share of E_0, %"


def partition_picture(outcome: Outcome) -> Picture:
    """Return the known shares of E_0 after the last separation, of two meshes their limits and bands.

    Shares that are not known are left out (the record holds the reasons).
    """
    listed = [share for share in shares("figure") if not isinstance(share.of(outcome.energy), Unknown)]
    rows = [
        (
            share.label,
            share.key.name.removesuffix("_over_E_0"),
            known(outcome.estimate(share.key)[0]),
            share.colour,
            _label(share, outcome),
        )
        for share in listed
    ]
    if above := above_modes(outcome.energy):
        at = [row[0] for row in rows].index("vibration") + 1
        rows.insert(at, (ABOVE, "E_vib_above_modes", above, rows[at - 1][3], percent(above)))
    labels, names, values, colours, texts = zip(*rows, strict=True) if rows else ((),) * 5
    # bars below UNSEEN are 0: the number beside a negative one would cover its name
    widths = [100.0 * value if abs(value) > UNSEEN else 0.0 for value in values]
    bars = tuple(
        Series("", [width], [at], "bars", colour, texts=(text,))
        for at, (width, colour, text) in enumerate(zip(widths, colours, texts, strict=True))
    )
    right = 1.3 * max([*widths, 1e-3])  # leaves room for the numbers
    panel = Panel("", AXIS, "", bars, rows=labels, x_range=(min([0.0, *widths]), right))
    numbers = Table.of(("account", "fraction_of_E_0"), zip(names, values, strict=True))
    return Picture("partition", "Shares of E₀ after the last separation.", (panel,), 1, numbers)


def _label(share: EnergyShare, outcome: Outcome) -> str:
    energy = outcome.energy
    if share.key.path[-1] == "vibration" and or_none(energy.below_floor):
        return f"below floor ({percent(or_none(energy.vibration_floor) or 0.0)})"
    return f"{outcome.told(share.key, 100.0)} %".replace("+-", "±")


def study_partition_picture(rows: Sequence[Outcome]) -> Picture:
    """Return one stacked bar a run, shares that are not known left white."""
    listed, at = shares("figure"), range(len(rows))
    fractions = {share: [or_none(share.of(row.energy)) for row in rows] for share in listed}
    bars = tuple(
        Series(share.label, [100.0 * (part or 0.0) for part in parts], at, "bars", share.colour)
        for share, parts in fractions.items()
    )
    names = tuple(row.provenance.scene_id for row in rows)
    panel = Panel("", AXIS, "", bars, rows=names, x_range=(0.0, 103.0))
    columns = ("scene_id", *(share.key.name for share in listed))
    numbers = Table.of(columns, zip(names, *fractions.values(), strict=True))
    caption = "Shares of E₀ after the last separation; a white part is not known."
    return Picture("partition", caption, (panel,), 1, numbers)


def comparison_picture(rows: Sequence[Mapping[str, Any]]) -> Picture:
    """Return measured means with their 95 % intervals, and the model with its two-mesh band.

    ``rows`` are those of ``comparison`` in study.json; null values are left out of the picture, and
    quantities that nobody measured.
    """
    quantities, sets = ([*dict.fromkeys(row[name] for row in rows)] for name in ("quantity", "set"))
    groups = ([row for row in rows if row["quantity"] == name] for name in quantities)
    panels = [
        _compared(group, sets) for group in groups if any(row["measured_mean"] is not None for row in group)
    ]
    numbers = Table.of(COMPARISON, [[row[name] for name in COMPARISON] for row in rows])
    caption = (
        "Measured means with 95 % intervals of the mean and standard deviations; the model with its "
        "two-mesh band where two meshes were run."
    )
    return Picture("comparison", caption, tuple(panels), 4, numbers)


def quantity_title(row: Mapping[str, Any]) -> str:
    """Return the quantity of a row of ``comparison`` with its unit."""
    unit = "" if row["unit"] in ("", "-") else f", {row['unit']}"
    return f"{row['quantity']}{unit}"


def _compared(rows: Sequence[Mapping[str, Any]], sets: list[str]) -> Panel:
    at = np.array([sets.index(row["set"]) for row in rows])
    mean, sd, low, high, model, band = (
        np.array([np.nan if row[name] is None else row[name] for row in rows], float)
        for name in ("measured_mean", "measured_sd", "measured_low", "measured_high", "model", "band")
    )
    above = at - 0.16
    interval: tuple[Look, str] = ("interval", "ink")
    series = (
        Series("± one standard deviation", mean, above, "spread", "grey", sd),
        Series("95 % interval of the mean", (low + high) / 2, above, *interval, (high - low) / 2),
        Series("measured mean", mean, above, "points", "ink"),
        Series("model, two-mesh band", model, at + 0.16, "diamonds", "vermilion", band),
    )
    return Panel(quantity_title(rows[0]), "", "", series, rows=tuple(sets))
