"""The report of the study: how often what was told held, changes by vibration, and how runs ended."""

from collections.abc import Iterator, Mapping, Sequence
from math import inf, log
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas

from fem_impact.answers.report import Sheet, StudyReport
from fem_impact.answers.verdict.criteria import LIMITED
from fem_impact.answers.verdict.vibration import (
    CHANGED,
    Pair,
    difference,
    modal_pair,
    scale_of_change,
    unfinished,
)
from fem_impact.case.case import Case
from fem_impact.case.measured import summary
from fem_impact.evidence.studies.coverage import judge
from fem_impact.evidence.studies.coverage.level_bands import level_bands
from fem_impact.evidence.studies.coverage.run import DEFAULT, FINER, FINEST, MODAL, MOST, NEXT, TWINS
from fem_impact.evidence.studies.coverage.scenes import DrawnScene
from fem_impact.evidence.studies.report_parts import frame_rows
from fem_impact.figures.panels import Mark, Panel, Picture, Series
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.run.modal import closed
from fem_impact.run.modal_error import FACTORS, TOLD, Place, place_of, unheard
from fem_impact.scene.read import read_dict
from fem_impact.scene.types import Scene
from fem_impact.tables.table import Cell, Column, Table
from fem_impact.tables.text import plain

KNOWN = 0.06
"""Widest half-width of finite elements that tells an error of a change by vibration."""
SUMS: Mapping[str, Mapping[str, float]] = {
    "e": {"e": 1.0},
    "energy": {"E_lt": -1.0, "E_ln": -1.0},
    "friction": {"friction": 1.0},
}
"""The numbers of `CHANGED` as sums of what the costs of the measured sets store."""
Changes = Mapping[str, tuple[float, float]]
"""Change by vibration and half-width by finite elements, by the numbers of `CHANGED`."""


def changes(scenes: Sequence[DrawnScene], results: judge.Results) -> Sheet:
    """Return where each scene stands that ran with a twin, and by how much the changes by vibration differ.

    A copy, of two seeds, stands in ``fem_impact/case/data/changes.csv``: by it the reduced model's error of a
    change is told. Changes that finite elements know within `KNOWN` count.
    """
    rows: list[tuple[Cell, ...]] = []
    with TemporaryDirectory() as folder:
        drawn = (
            (one.name, one.scene(Path(folder)), results[one.name, TWINS].changes)
            for one in scenes
            if (one.name, TWINS) in results
        )
        for name, scene, solid in (*drawn, *_of_sets()):
            pair = modal_pair(scene)
            errors = [_error(pair, of, solid) for of in CHANGED]
            if any(error is not None for error in errors):
                numbers = *place_of(Case(scene, "modal"), pair[0]), *errors
                rows.append((name, *(None if one is None else round(one, 5) for one in numbers)))
    caption = "Where scenes with a twin stand, and changes by vibration: reduced model less finite elements"
    return Sheet("changes", caption, Table.of(("scene", *Place._fields, *CHANGED), rows), shown=False)


def _error(pair: Pair, of: str, solid: Changes) -> float | None:
    """Return by how much the reduced model's change is off, over its scale; None where it is not known."""
    value, half = solid.get(of, (0.0, inf))
    if half > KNOWN or unfinished(pair, of):
        return None
    change = difference(pair, of)
    return (change - value) / scale_of_change(change)


def _of_sets() -> Iterator[tuple[str, Scene, Changes]]:
    """Yield the measured sets with the changes that their stored default runs show."""
    for name, stored in summary()["scenes"].items():
        run = next(one for one in stored["settings"] if one["default"])
        stiff = next(one for one in stored["settings"] if one["name"] == "default run without vibration")
        value, error = run["value"], run["error"]
        solid = {
            of: (
                sum(sign * (value[part] - stiff["value"][part]) for part, sign in parts.items()),
                abs(sum(sign * error[part] * abs(value[part]) for part, sign in parts.items())),
            )
            for of, parts in SUMS.items()
        }
        yield name, read_dict(stored["scene"]), solid


MEANT = {
    judge.LEVELS: "the band of a default run holds the limit of a run with one level more",
    judge.LEVELS_TWO: "the band of a default run holds the limit of a run with two levels more",
    judge.REDUCED: "the half-width of the reduced model holds finite elements",
}
SHOWN = ("n", "inside", "inside_finest", "share", "low", "high", "half", "error", "needed")
HEAD = (
    Column("n"),
    Column("inside"),
    Column("inside_finest", "inside, value on its finest mesh"),
    Column("share", digits=3),
    Column("low", "95 % low", digits=3),
    Column("high", "95 % high", digits=3),
    Column("half", "median half-width", digits=2),
    Column("error", "median error", digits=2),
    Column("needed", "factor to hold as meant", digits=2),
)
NUMBERS = ("finished", "strikes again")  # ends of runs that gave numbers
WORST = 30  # misses that the page shows
LONGEST = 160  # letters of a reason
SMALL = 0.02  # of a number's unit: a miss by less is a small one
WORST_FAMILIES = 3  # families that held least often, which are named
MOST_OFF = 0.5  # widest half-width of finite elements, over the number, that tells a ratio of both models


def report_of(scenes: Sequence[DrawnScene], results: judge.Results, seed: int) -> StudyReport:
    """Return the study of scenes, drawn by a seed, and their results."""
    errors, taken = judge.told_errors(scenes, results), judge.times(scenes, results)
    ended = judge.ends(scenes, results, DEFAULT)
    by_quantity = judge.coverage(errors, ["told", "quantity"])
    by_family = judge.coverage(errors, ["told", "family"])
    sentences = [
        *_held(by_quantity),
        *_causes(errors, by_family),
        *_times(taken),
        _ended(ended),
        *_reduced(judge.ends(scenes, results, MODAL)),
    ]
    pictures = [_shares(by_quantity, by_family), _ratios(errors)] if len(errors) else []
    cpu = sum(result.cpu_s for result in results.values())
    return StudyReport(
        "coverage",
        "How often a told error holds",
        sentences,
        pictures,
        [
            _sheet("coverage", "By told error and quantity", by_quantity, ("told", "quantity")),
            _sheet("families", "By told error and family, all quantities", by_family, ("told", "family")),
            _sheet(
                "families-by-quantity",
                "By told error, family and quantity",
                judge.coverage(errors, ["told", "family", "quantity"]),
                ("told", "family", "quantity"),
                shown=False,
            ),
            _misses(errors),
            _ends(ended),
            _reasons(ended),
            _pairs(scenes, results),
            level_bands(scenes, results),
            changes(scenes, results),
            _all("errors", "Every told error beside the truth", errors),
            _all("times", "Every told time beside the time taken, s", taken),
            _all("ended", "Every default run: how it ended", ended),
        ],
        [
            f"Scenes drawn with seed {seed}; each family of projectiles as often as every other."
            + " The reduced model tells its errors by scenes of other seeds.",
            "The truth is a finer run of the same program: it knows no error that all meshes share.",
            f"A default run was broken off after {MOST[DEFAULT]:g} s of processor time, one with one level "
            f"more after {MOST[FINER]:g} s, with two after {MOST[FINEST]:g} s. A run with one level more "
            f"followed where the default one took at most {NEXT[FINER][1]:g} s, one with two where that took "
            f"at most {NEXT[FINEST][1]:g} s: dear scenes are counted and lack a pair.",
            f"A number that is zero by physics on both sides, such as mu without friction, is left out. All "
            f"runs together took {cpu / 60:.0f} minutes of processor time.",
        ],
        conclusions=[("coverage", sentence) for sentence in sentences],
    )


def _held(table: pandas.DataFrame) -> list[str]:
    """Return a sentence on each told error."""
    sentences = []
    for told, group in table.groupby("told", sort=False) if len(table) else ():
        parts = ", ".join(f"{row.quantity} {row.inside} of {row.n}" for row in group.itertuples())
        aim = judge.AIM[told]
        below = [row.quantity for row in group.itertuples() if row.high < aim]
        judged = f"; surely below {aim:.0%}: {', '.join(below)}" if below else ""
        sentences.append(f"{told} ({MEANT[told]}, meant for {aim:.0%}): {parts}{judged}.")
    return sentences


def _causes(errors: pandas.DataFrame, by_family: pandas.DataFrame) -> list[str]:
    """Return a sentence on the bands of levels that do not hold, by causes that can be counted."""
    sentences = []
    for told, group in errors[errors["told"] != judge.REDUCED].groupby("told", sort=False):
        missed = group[~group["inside"]]
        zero, small = (missed["half"] == 0.0).sum(), (missed["error"] < SMALL * missed["unit"]).sum()
        low = by_family[by_family["told"] == told].nsmallest(WORST_FAMILIES, "share")
        families = ", ".join(f"{row.family} {row.inside} of {row.n}" for row in low.itertuples())
        sentences.append(
            f"{told}: {len(missed)} of {len(group)} bands do not hold. Of these {zero} had a half-width of 0 "
            f"and {small} are off by less than {SMALL:.0%} of the number's unit (1, and of spins the speed "
            f"over the radius of gyration). Bands hold least often of: {families}."
        )
    return sentences


def _times(table: pandas.DataFrame) -> list[str]:
    """Return how often told times held."""
    return [
        f"{told}: met in {int(group['inside'].sum())} of {len(group)} runs, "
        f"{int((group['taken'] > group['most']).sum())} took longer; its most is "
        f"{plain(float((group['most'] / group['least']).median()), 2)} times its least in the median."
        for told, group in table.groupby("told", sort=False)
    ]


def _ended(table: pandas.DataFrame) -> str:
    counts = table["end"].value_counts()
    parts = ", ".join(f"{count} {end}" for end, count in counts.items())
    bare, numbers = int(table["bare"].sum()), int(table["end"].isin(NUMBERS).sum())
    return f"Of {len(table)} default runs: {parts}. Of the {numbers} with numbers {bare} tell no error of e."


def _reduced(table: pandas.DataFrame) -> list[str]:
    """Return how the runs of the reduced model ended."""
    counts = ", ".join(f"{count} {end}" for end, count in table["end"].value_counts().items())
    return [f"Of {len(table)} runs of the reduced model: {counts}."] if len(table) else []


def _sheet(
    name: str, caption: str, table: pandas.DataFrame, by: tuple[str, ...], *, shown: bool = True
) -> Sheet:
    """Return a table of `coverage`."""
    head = (*(Column(one, left=True) for one in by), *HEAD)
    rows = _cells(table.reindex(columns=[*by, *SHOWN]))
    return Sheet(name, caption, Table(head, tuple(rows)), shown)


def _misses(errors: pandas.DataFrame) -> Sheet:
    """Return the numbers of bands that do not hold their truth, the worst first."""
    missed = errors[~errors["inside"] & (errors["told"] != judge.REDUCED)]
    missed = missed.assign(ratio=missed["error"] / missed["half"]).sort_values("ratio", ascending=False)
    rows = _cells(missed[["scene", "told", "quantity", "value", "half", "truth", "ratio"]])
    head = ("scene", "told", "quantity", "value", "half-width", "truth", "error over half-width")
    table = Table.of(head, rows, left=(0, 1, 2))
    caption = "Bands that do not hold a finer run, the worst first"
    return Sheet("misses", caption, table, brief=Table.of(head, rows[:WORST], left=(0, 1, 2)))


def _ends(table: pandas.DataFrame) -> Sheet:
    """Return how many default runs of each family ended how."""
    found = [*table["end"].value_counts().index]
    rows = [
        (family, len(group), *(int((group["end"] == end).sum()) for end in found), group["cpu_s"].median())
        for family, group in table.groupby("family", sort=False)
    ]
    head = ("family", "scenes", *found, "median CPU, s")
    return Sheet("ends", "How default runs ended", Table.of(head, rows))


def _reasons(table: pandas.DataFrame) -> Sheet:
    """Return the reason of each default run that gave no numbers."""
    without = table[~table["end"].isin(NUMBERS)]
    rows = [(row.scene, row.end, row.reason[:LONGEST]) for row in without.itertuples()]
    table = Table.of(("scene", "end", "reason"), rows, left=(0, 1, 2))
    return Sheet("reasons", "Default runs without numbers", table)


def _pairs(scenes: Sequence[DrawnScene], results: judge.Results) -> Sheet:
    """Return where each scene of both models stands, and by how much they differ over the scale.

    A copy stands in ``fem_impact/case/data/pairs.csv``: by it the reduced model tells its error. A scene that
    touches as none of the stored ones does is left out.
    """
    rows: list[tuple[Cell, ...]] = []
    left_out: list[str] = []
    with TemporaryDirectory() as folder:
        for scene in scenes:
            modal, solid = judge.of_reduced(scene, results)
            if modal is not None and solid is not None:
                if reasons := unheard(modal):
                    left_out.append(" and ".join(reasons))
                    continue
                case = Case.of(scene.scene(Path(folder)), "modal")
                told = (*(judge.reduced_error(modal, solid, key) for key in TOLD), *_ratios_of(case, solid))
                numbers = *place_of(case, modal), *told
                rows.append((scene.name, *(None if one is None else round(one, 5) for one in numbers)))
    caption = "Where scenes of both models stand, and reduced model less finite elements over the scale"
    if left_out:
        counts = ", ".join(f"{left_out.count(reason)} for {reason}" for reason in sorted({*left_out}))
        caption += f"; {len(left_out)} scenes left out, unlike the stored ones by kind: {counts}"
    return Sheet("pairs", caption, Table.of(("scene", *Place._fields, *TOLD, *FACTORS), rows), shown=False)


def _ratios_of(case: Case, solid: Outcome) -> Iterator[float | None]:
    """Yield the logarithm of reduced model over finite elements in each of `FACTORS`, None: not known."""
    result = closed(case, recorded=True)
    for name in FACTORS:
        of = next(one for one in LIMITED.values() if one.column == name)
        truth = or_none(of.of_solid(solid)) or 0.0
        half = solid.estimate(name)[1] if name in KEY_TABLE else 0.0
        value = of.of_reduced(case, result) if half is not None and half <= MOST_OFF * truth else 0.0
        yield log(value / truth) if min(value, truth) > 0.0 else None


def _all(name: str, caption: str, table: pandas.DataFrame) -> Sheet:
    """Return a table that is written and not shown."""
    return Sheet(name, caption, Table.of(tuple(map(str, table.columns)), _cells(table)), shown=False)


def _cells(table: pandas.DataFrame) -> list[tuple[Cell, ...]]:
    """Return the rows of a table; over a half-width of zero there is no ratio."""
    return frame_rows(table.replace([np.inf, -np.inf], np.nan))


def _shares(by_quantity: pandas.DataFrame, by_family: pandas.DataFrame) -> Picture:
    """Return shares inside with their Wilson intervals, by quantity and by family, a panel a told error."""
    panels = [
        _share_panel(f"{told}, by {column}", group, column, judge.AIM[told])
        for column, table in (("quantity", by_quantity), ("family", by_family))
        for told, group in table.groupby("told", sort=False)
    ]
    caption = (
        "Share of truths inside what was told, with 95 % Wilson intervals; the line is at what is meant."
    )
    return Picture("coverage", caption, tuple(panels), columns=2)


def _share_panel(title: str, table: pandas.DataFrame, column: str, aim: float) -> Panel:
    rows = np.arange(len(table), dtype=float)
    low, high = table["low"].to_numpy(float), table["high"].to_numpy(float)
    series = (
        Series("95 % Wilson", (low + high) / 2, rows, "interval", 0, (high - low) / 2),
        Series("share inside", table["share"].to_numpy(float), rows, "points", 1),
    )
    names = tuple(f"{name} ({n})" for name, n in zip(table[column], table["n"], strict=True))
    return Panel(title, "share inside", "", series, (Mark(aim),), rows=names, x_range=(0.0, 1.05))


def _ratios(errors: pandas.DataFrame) -> Picture:
    """Return the distribution of error over told half-width, a panel a told error, a curve a quantity."""
    panels = []
    for told, group in errors.groupby("told", sort=False):
        curves = []
        for at, name in enumerate(judge.KEYS):
            ratio = group.loc[(group["quantity"] == name) & (group["half"] > 0)].eval("error / half")
            values = np.sort(ratio.to_numpy(float))
            shares = np.arange(1, len(values) + 1) / max(len(values), 1)
            curves.append(Series(name, values, shares, "line", at))
        label = "error over told half-width"
        panels.append(Panel(str(told), label, "share below", tuple(curves), (Mark(1.0),), x_range=(0.0, 3.0)))
    return Picture("ratios", "Errors beside what was told; left of the line it held.", tuple(panels))
