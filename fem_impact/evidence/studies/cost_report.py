"""What accuracy costs as a study report: the answer, error against time, tables; of a scene or the paper."""

from collections.abc import Mapping, Sequence
from statistics import median

from fem_impact.answers.cost.judge import Judged, advice, cheapest, default_sentence, front
from fem_impact.answers.cost.measure import PLACES, CostStudy, cost_tables
from fem_impact.answers.refine.extrapolate import quantity_limits
from fem_impact.answers.refine.quantities import TARGETED
from fem_impact.answers.report import Sheet, StudyReport
from fem_impact.evidence.studies.report_parts import rests_on
from fem_impact.figures.panels import Look, Mark, Panel, Picture, Series
from fem_impact.scene.fields import LEVELS
from fem_impact.tables.table import Cell, Table
from fem_impact.tables.text import plain

STUDY, FIGURE = "cost", "error-against-time"
WANTED = 0.02
"""Error that is asked for where none is named, over the scale of the quantity."""
ERRORS = (0.2, 0.1, 0.05, WANTED)
"""Errors whose price the first table tells, over the scale of the quantity."""
SHOWN = ("t5b", "t6-17", "t3-machined")
"""Sets of the figure over all sets: a short rod, the same less inclined, and a long one."""
FRONT = "front: nothing is both quicker and more accurate"
LOOKS: dict[str, tuple[str, Look, str]] = {
    "rigid": ("rigid theory", "squares", "purple"),
    "modal": ("reduced model (modal)", "diamonds", "orange"),
    "levels": ("levels, one place of the grid", "points", "blue"),
    "two places": ("levels, two places of the grid", "triangles", "green"),
}
"""Label, look and colour of each kind of setting."""


def scene_report(
    cost: CostStudy, names: Sequence[str], target: float | None = None, budget: float | None = None
) -> StudyReport:
    """Return the report of one scene; `answers` are its answer."""
    panels = [_panel(cost.settings, name, name) for name in names]
    return StudyReport(
        STUDY,
        f"What accuracy costs: {cost.scene.title}",
        [" ".join(answers(cost, names, target, budget)), *_failed(cost)],
        [_picture({cost.scene.id: cost.settings}, names, panels)],
        [Sheet(name, caption, table) for name, caption, table in cost_tables(cost, names)],
        rests_on("cost"),
    )


def answers(
    cost: CostStudy, names: Sequence[str], target: float | None = None, budget: float | None = None
) -> list[str]:
    """Return the cheapest setting for each quantity and for all together, and what the default run errs.

    One for a quantity alone is left out where it names the setting for all.
    The error that is asked for is the ``target``, `WANTED` where neither it nor a ``budget``, s, is given.
    """
    wanted = WANTED if target is None and budget is None else target
    listed = advice(cost.settings, names, wanted, budget)
    if wanted is not None:
        together = cheapest(cost.settings, names, wanted)
        for name in names if len(names) > 1 else ():
            if cheapest(cost.settings, (name,), wanted) != together:
                listed += advice(cost.settings, (name,), wanted, None)
    of_default = default_sentence(cost.settings, names)
    return [*listed, *([of_default] if of_default else [])]


def paper_report(costs: Mapping[str, CostStudy]) -> StudyReport:
    """Return the report of the measured sets, of the quantities that a target applies to."""
    answer = " ".join([*(_reached(name, costs) for name in TARGETED), _defaults(costs), *_variants(costs)])
    shown = {name: costs[name].settings for name in SHOWN if name in costs} or {
        name: cost.settings for name, cost in costs.items()
    }
    panels = [
        _panel(settings, name, f"{scene}: {name}") for scene, settings in shown.items() for name in TARGETED
    ]
    return StudyReport(
        STUDY,
        "What accuracy costs",
        [answer, *(sentence for cost in costs.values() for sentence in _failed(cost))],
        [_picture(shown, TARGETED, panels)],
        [_price_sheet(costs), _setting_sheet(costs), _level_sheet(costs)],
        rests_on("cost"),
        conclusions=[(FIGURE, answer)],
    )


def _failed(cost: CostStudy) -> list[str]:
    return [
        f"Not judged: {cost.scene.id}, {failure['setting']}: {failure['reason']}" for failure in cost.failures
    ]


def _picture(
    settings: Mapping[str, Sequence[Judged]], names: Sequence[str], panels: Sequence[Panel]
) -> Picture:
    caption = (
        "Error against computing time, both logarithmic, a point for each setting; lower and further left is "
        f"better. Below the dashed line the error is less than {100 * WANTED:g} %."
    )
    rows: list[tuple[Cell, ...]] = [
        (scene, name, setting.name, setting.cpu_s, error, name in setting.front)
        for scene, judged in settings.items()
        for name in names
        for setting in judged
        if setting.kind in LOOKS and (error := setting.error[name]) is not None
    ]
    numbers = Table.of(("scene", "quantity", "setting", "cpu_s", "error", "on_front"), rows, left=range(3))
    return Picture(FIGURE, caption, tuple(panels), 2, numbers)


def _panel(settings: Sequence[Judged], name: str, title: str) -> Panel:
    known = [setting for setting in settings if setting.error[name] and setting.kind in LOOKS]
    best = Series(FRONT, *_points(front(known, [name]), name), "line", "grey")
    series = [best]
    for kind, (label, look, colour) in LOOKS.items():
        if of := [setting for setting in known if setting.kind == kind]:
            texts = tuple(setting.name for setting in of)
            series.append(Series(label, *_points(of, name), look, colour, texts=texts))
    level = (Mark(100 * WANTED),)
    return Panel(title, "computing time, s", "error, %", tuple(series), levels=level, logarithmic=True)


def _points(settings: Sequence[Judged], name: str) -> tuple[list[float], list[float]]:
    return [setting.cpu_s for setting in settings], [
        100 * (setting.error[name] or 0.0) for setting in settings
    ]


def _quickest(cost: CostStudy, name: str, error: float) -> Judged | None:
    """Return the levels with which a wanted error is reached in the least time on two cores.

    It takes three at least, at two places of the grid.
    """
    met = [
        setting
        for setting in cost.settings
        if setting.kind == PLACES[2] and setting.levels >= LEVELS
        if (relative := setting.error[name]) is not None and relative <= error
    ]
    return min(met, key=lambda setting: setting.two_cores_s, default=None)


def _reached(name: str, costs: Mapping[str, CostStudy]) -> str:
    """Say in how many sets levels know a quantity as well as `WANTED`, and how long that takes."""
    met = [setting.two_cores_s for cost in costs.values() if (setting := _quickest(cost, name, WANTED))]
    least = " (or to 1e-4 of E_0)" if name == "E_vib" else ""
    took = f", in {plain(min(met))} to {plain(max(met))} s on two cores" if met else ""
    return f"Levels give {name} to {100 * WANTED:g} %{least} in {len(met)} of {len(costs)} sets{took}."


def _defaults(costs: Mapping[str, CostStudy]) -> str:
    """Say what the default run costs and tells over the sets."""
    runs = [setting for cost in costs.values() for setting in cost.settings if setting.default]
    if not runs:
        return "No default run tells a band."
    times = [setting.cpu_s for setting in runs]
    by_quantity = {
        name: [100 * error for setting in runs if (error := setting.error[name]) is not None]
        for name in TARGETED
    }
    medians = " and ".join(
        f"{plain(median(errors), 2)} % of {name} ({plain(min(errors), 2)} to {plain(max(errors), 2)} %)"
        for name, errors in by_quantity.items()
        if errors
    )
    return (
        f"The default run takes {plain(min(times))} to {plain(max(times))} s on one core; its bands have a "
        f"median of {medians}."
    )


def _variants(costs: Mapping[str, CostStudy]) -> list[str]:
    """Say of each change of the default run what it changes at most, and how much longer it takes."""
    by_variant: dict[str, list[tuple[Judged, Judged]]] = {}
    for cost in costs.values():
        default = next((setting for setting in cost.settings if setting.default), None)
        for setting in cost.settings:
            if setting.kind == "variant" and default is not None:
                by_variant.setdefault(setting.name, []).append((default, setting))
    sentences = []
    for name, pairs in by_variant.items():
        ratios = [setting.cpu_s / default.cpu_s for default, setting in pairs]
        changes = {
            of: [error for _, setting in pairs if (error := setting.error[of]) is not None] for of in TARGETED
        }
        most = " and ".join(
            f"{of} by at most {plain(100 * max(errors), 2)} %" for of, errors in changes.items() if errors
        )
        sentences.append(
            f"The {name} takes {plain(min(ratios), 2)} to {plain(max(ratios), 2)} times as long and changes "
            f"{most or 'nothing that has a band'} ({len(pairs)} sets)."
        )
    return sentences


def _price_sheet(costs: Mapping[str, CostStudy]) -> Sheet:
    """Return the table that says what an error costs: sets that reach it, median and worst of their times."""
    rows: list[tuple[Cell, ...]] = []
    for error in ERRORS:
        cells: list[Cell] = []
        for name in TARGETED:
            times = [
                setting.two_cores_s for cost in costs.values() if (setting := _quickest(cost, name, error))
            ]
            cells += [plain(median(times)), plain(max(times))] if times else [None, None]
            cells.append(f"{len(times)} of {len(costs)}")
        rows.append((f"{100 * error:g}", *cells))
    columns = ("median, s", "longest, s", "reached in")
    head = ("error, %", *(f"{name}: {title}" for name in TARGETED for title in columns))
    caption = (
        "For a wanted error of x % expect y s: time on two free cores of the quickest levels, three at "
        "least, at two places of the grid, whose band is at most so wide, over the sets that reach it; of "
        "E_vib in % of itself, at least of 0.5 % of E_0; e on this page is that by the tip's own arms"
    )
    return Sheet("price", caption, Table.of(head, rows, left=range(len(head))))


def _setting_sheet(costs: Mapping[str, CostStudy]) -> Sheet:
    """Return one row per set: errors and time of every setting, those of levels by their number."""
    columns = ["rigid", "modal"]
    cells: dict[str, dict[str, str]] = {}
    for name, cost in costs.items():
        row = cells.setdefault(name, {})
        for setting in (setting for setting in cost.settings if setting.kind in LOOKS):
            title = f"{setting.levels} levels" + ", two places" * (setting.kind == "two places")
            title = title if setting.levels else setting.kind
            columns += [title] if title not in columns else []
            errors = " / ".join(
                "-"
                if (e := setting.error[of]) is None
                else f"{100 * e:.2g}"
                if e < 0.995
                else f"{100 * e:.0f}"
                for of in TARGETED
            )
            row[title] = f"{errors}, {setting.cpu_s:.2g} s" + " (default)" * setting.default
    ordered = sorted(columns, key=lambda title: ("levels" in title, title))
    rows = [
        (
            name,
            *(f"{cost.limits[of].value:.3g} ± {cost.limits[of].band:.1g}" for of in TARGETED),
            *(cells[name].get(title, "") for title in ordered),
        )
        for name, cost in costs.items()
    ]
    head = ("set", *(f"{name}, limit" for name in TARGETED), *ordered)
    caption = (
        f"Errors of {' / '.join(TARGETED)} in % and processor time of each setting; limits are those of the "
        "finest levels at two places"
    )
    return Sheet("settings", caption, Table.of(head, rows, left=range(len(head))))


def _level_sheet(costs: Mapping[str, CostStudy]) -> Sheet:
    """Return one row per level at two places: what it took, what it gave, the limits with all before it."""
    rows: list[tuple[Cell, ...]] = []
    for name, cost in costs.items():
        meshes = levels.meshes if (levels := cost.levels.get(2)) else ()
        for n, level in enumerate(meshes, 1):
            limits = quantity_limits(meshes[:n])
            numbers = [
                f"{limit.value:.4f} ± {limit.band:.4f}" if (limit := limits.get(of)) else None
                for of in TARGETED
            ]
            rows.append((name, n, f"{1e3 * level.size:.3g}", f"{level.cpu_s:.3g}", level.repeats, *numbers))
    head = ("set", "level", "cells, mm", "s", "repeats", *TARGETED)
    caption = (
        "Each level at two places of the grid (the first at one): cells at the contact, processor time, how "
        "often it ran again, and what it tells with those before it"
    )
    return Sheet("levels", caption, Table.of(head, rows, left=range(len(head))))
