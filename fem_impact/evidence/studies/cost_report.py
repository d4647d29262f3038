"""What accuracy costs as a study report: the answer, error against time, tables; of a scene or the paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import NamedTuple

from fem_impact.answers.cost.document import cost_tables
from fem_impact.answers.cost.judge import Judged, advice, best_group, cheapest, default_sentence, front
from fem_impact.answers.cost.measure import CostStudy
from fem_impact.answers.refine.quantities import TARGETED
from fem_impact.answers.report import Sheet, StudyReport
from fem_impact.figures.panels import Look, Mark, Panel, Picture, Series
from fem_impact.tables.table import Cell, Table
from fem_impact.tables.text import plain

STUDY, FIGURE = "cost", "error-against-time"
WANTED = 0.02
"""Error that is asked for where none is named, over the scale of the quantity."""
ERRORS = (0.1, 0.05, WANTED, 0.01)
"""Errors whose price the first table tells, over the scale of the quantity."""
SHOWN = ("t5b", "t6-17", "t3-machined")
"""Sets of the figure over all sets: a short rod, the same less inclined, and a long one."""
FRONT = "front: nothing is both quicker and more accurate; what ran at one place of the grid left out"
LOOKS: dict[str, tuple[str, Look, str]] = {
    "rigid": ("rigid theory", "squares", "purple"),
    "modal": ("reduced model (modal)", "diamonds", "orange"),
    "mesh": ("finite elements, one mesh", "points", "blue"),
    "extrapolated": ("finite elements, several meshes extrapolated", "triangles", "green"),
    "numerics": ("other elements or half the step", "crosses", "vermilion"),
    "default": ("default run", "rings", "ink"),
    "full": ("default run without savings", "squares", "brown"),
}
"""Label, look and colour of each kind of setting."""
GUIDE = (
    "The error of a setting is its distance from the limit for vanishing elements plus the uncertainty of "
    "that limit; of several meshes it is the band of their own extrapolation where that is smaller.",
    "Errors are divided by the value of the quantity, at least by 0.05 of e and by 0.5 % of E_0 of an "
    "energy: 2 % of E_vib are then at least 1e-4 of E_0.",
    "A time is the processor time of all runs of a setting with their set-up, on one core; two free cores "
    "take half of it where a setting has several runs.",
    "A mesh is run at several places of the barrier's grid (four, the third and finer ones at two), and "
    "their mean counts; several meshes are also judged by two places of each, which take half the time and "
    "scatter more; the default run, with its savings or without, and those with other elements or steps have "
    "one place: their error may be small by chance, so they are neither on the front nor chosen for a wanted "
    "error.",
    "Without savings no small elements are made heavier, but those of the thin rows at the surface "
    "(`accuracy.mass_scaling = 1`), and the finest cells fill all of the zone that may yield "
    '(`accuracy.fine_zone = "even"`).',
)


class Group(NamedTuple):
    """The best several meshes of a set for one quantity, and whether their band meets `WANTED`."""

    cells: tuple[Cell, ...]
    seconds: float
    met: bool


def scene_report(
    cost: CostStudy, names: Sequence[str], target: float | None = None, budget: float | None = None
) -> StudyReport:
    """Return the report of one scene; `answers` are its answer."""
    failed = [f"Not judged: {one['setting']}: {one['reason']}" for one in cost.failures]
    panels = [_panel(cost.settings, name, name) for name in names]
    return StudyReport(
        STUDY,
        f"What accuracy costs: {cost.scene.title}",
        [" ".join(answers(cost, names, target, budget)), *failed],
        [_picture({cost.scene.id: cost.settings}, names, panels)],
        [Sheet(name, caption, table) for name, caption, table in cost_tables(cost, names)],
        GUIDE,
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
    told = default_sentence(cost.settings, names)
    return [*listed, *([told] if told else [])]


def paper_report(costs: Mapping[str, CostStudy]) -> StudyReport:
    """Return the report of the measured sets, of the quantities that a target applies to."""
    groups = {
        name: [_best(cost, quantity) for quantity in TARGETED]
        for name, cost in costs.items()
        if any(one.band for one in cost.settings)
    }
    reached = map(_reached, TARGETED, zip(*groups.values(), strict=True))
    answer = " ".join([*reached, _defaults(costs), _savings(costs)]).strip()
    shown = {name: costs[name].settings for name in SHOWN if name in costs} or {
        name: cost.settings for name, cost in costs.items()
    }
    panels = [
        _panel(settings, name, f"{scene}: {name}") for scene, settings in shown.items() for name in TARGETED
    ]
    failed = [
        f"Not judged: {one['setting']}: {one['reason']}" for cost in costs.values() for one in cost.failures
    ]
    return StudyReport(
        STUDY,
        "What accuracy costs",
        [answer, *failed],
        [_picture(shown, TARGETED, panels)],
        [_price_sheet(costs), _group_sheet(groups), _setting_sheet(costs)],
        GUIDE,
        conclusions=[(FIGURE, answer)],
    )


def _picture(
    settings: Mapping[str, Sequence[Judged]], names: Sequence[str], panels: Sequence[Panel]
) -> Picture:
    caption = (
        "Error against computing time, both logarithmic, a point for each setting; lower and further left is "
        f"better. Below the dashed line the error is less than {100 * WANTED:g} %."
    )
    rows: list[tuple[Cell, ...]] = [
        (scene, name, one.name, one.cpu_s, error, name in one.front)
        for scene, judged in settings.items()
        for name in names
        for one in judged
        if one.kind in LOOKS and (error := one.error[name]) is not None
    ]
    numbers = Table.of(("scene", "quantity", "setting", "cpu_s", "error", "on_front"), rows, left=range(3))
    return Picture(FIGURE, caption, tuple(panels), 2, numbers)


def _panel(settings: Sequence[Judged], name: str, title: str) -> Panel:
    known = [one for one in settings if one.error[name] and one.kind in LOOKS]
    best = Series(FRONT, *_points(front(known, [name]), name), "line", "grey")
    kinds = [_series([one for one in known if one.kind == kind], name, kind) for kind in LOOKS]
    level = (Mark(100 * WANTED),)
    series = (best, *(one for one in kinds if one.texts))
    return Panel(title, "computing time, s", "error, %", series, levels=level, logarithmic=True)


def _series(settings: Sequence[Judged], name: str, kind: str) -> Series:
    label, look, colour = LOOKS[kind]
    texts = tuple(one.name for one in settings)
    return Series(label, *_points(settings, name), look, colour, texts=texts)


def _points(settings: Sequence[Judged], name: str) -> tuple[list[float], list[float]]:
    return [one.cpu_s for one in settings], [100 * (one.error[name] or 0.0) for one in settings]


def _best(cost: CostStudy, name: str) -> Group:
    """Return the best several meshes for a quantity; their band is bold where it meets `WANTED`."""
    group = best_group(cost.settings, (name,), WANTED)
    assert group is not None  # sets with one mesh are left out
    limit = cost.limits[name]
    both = group.band[name] * limit.scale + limit.uncertainty
    off = abs((group.value[name] or 0.0) - limit.value) / both if both else 0.0
    value = f"{group.value[name] or 0.0:.4f} ± {group.band[name] * limit.scale:.4f}"
    met = group.band[name] <= WANTED
    band = f"**{_percent(group.band[name])}**" if met else _percent(group.band[name])
    sizes = group.name.removeprefix("solid ").replace(" mm extrapolated", "")
    shown = f"{band} ({_percent(group.scatter[name])})"
    return Group((value, shown, sizes, f"{off:.1f}", f"{group.two_cores_s:.3g}"), group.two_cores_s, met)


def _reached(name: str, groups: Sequence[Group]) -> str:
    """Say in how many sets several meshes know a quantity as well as `WANTED`, and how long that takes."""
    met = [group.seconds for group in groups if group.met]
    least = " (or to 1e-4 of E_0)" if name == "E_vib" else ""
    took = f", in {plain(min(met))} to {plain(max(met))} s on two cores" if met else ""
    return (
        f"Two or three meshes together give {name} to {100 * WANTED:g} %{least} in {len(met)} of "
        f"{len(groups)} sets{took}."
    )


def _defaults(costs: Mapping[str, CostStudy]) -> str:
    """Say what the default run costs and errs over the sets; nothing where it was not run."""
    runs = [one for cost in costs.values() for one in cost.settings if one.kind == "default"]
    if not runs:
        return ""
    times = [one.cpu_s for one in runs]
    errors = {
        name: [100 * error for one in runs if (error := one.error[name]) is not None] for name in TARGETED
    }
    told = " and ".join(
        f"{plain(median(found), 2)} % in {name} ({plain(min(found), 2)} to {plain(max(found), 2)} %)"
        for name, found in errors.items()
        if found
    )
    return (
        f"One default run takes {plain(min(times))} to {plain(max(times))} s on one core; over the sets its "
        f"error has a median of {told}."
    )


def _savings(costs: Mapping[str, CostStudy]) -> str:
    """Say what the savings of the default run save and change; nothing where that was not measured."""
    kinds = [(cost, {one.kind: one for one in cost.settings}) for cost in costs.values()]
    both = [(cost, of["default"], of["full"]) for cost, of in kinds if {"default", "full"} <= set(of)]
    if not both:
        return ""
    ratios = [full.cpu_s / default.cpu_s for _, default, full in both]
    changed = {
        name: max(
            100 * abs((full.value[name] or 0.0) - (default.value[name] or 0.0)) / cost.limits[name].scale
            for cost, default, full in both
        )
        for name in TARGETED
    }
    told = " and ".join(f"{name} by at most {plain(change, 2)} %" for name, change in changed.items())
    return (
        f"Without its savings it takes {plain(min(ratios), 2)} to {plain(max(ratios), 2)} times as long "
        f"({len(both)} sets); they change {told}."
    )


def _price_sheet(costs: Mapping[str, CostStudy]) -> Sheet:
    """Return the table that says what an error costs: sets that reach it, median and worst of their times."""
    listed = [cost for cost in costs.values() if any(one.band for one in cost.settings)]
    rows: list[tuple[Cell, ...]] = []
    for error in ERRORS:
        cells: list[Cell] = []
        for name in TARGETED:
            best = [best_group(cost.settings, (name,), error) for cost in listed]
            times = [one.two_cores_s for one in best if one and one.band[name] <= error]
            cells += [plain(median(times)), plain(max(times))] if times else [None, None]
            cells.append(f"{len(times)} of {len(listed)}")
        rows.append((f"{100 * error:g}", *cells))
    columns = ("median, s", "longest, s", "reached in")
    head = ("error, %", *(f"{name}: {title}" for name in TARGETED for title in columns))
    caption = (
        "For x % of error expect y s: wall time on two free cores of the quickest several meshes whose band "
        "is at most so wide, over the sets that reach it; of E_vib in % of itself, at least of 0.5 % of E_0; "
        "e on this page is that by the tip's own arms"
    )
    return Sheet("price", caption, Table.of(head, rows, left=range(len(head))))


def _group_sheet(groups: Mapping[str, Sequence[Group]]) -> Sheet:
    columns = ("value", "band, % (scatter)", "meshes, mm", "off", "s on two cores")
    head = ("set", *(f"{name}: {title}" for name in TARGETED for title in columns))
    rows = [(name, *(cell for group in found for cell in group.cells)) for name, found in groups.items()]
    caption = (
        f"The quickest two or three meshes with a band of {100 * WANTED:g} % (bold) or, where there are "
        "none, the finest two; off: distance from the limit of all meshes over the sum of both bands, above "
        "1 where they contradict each other"
    )
    return Sheet("meshes", caption, Table.of(head, rows, left=range(len(head))))


def _setting_sheet(costs: Mapping[str, CostStudy]) -> Sheet:
    # in order of cost, without extrapolations and settings that leave an effect out
    kinds = ("rigid", "modal", "default", "full", "mesh", "numerics")
    named = {one.name: one for cost in costs.values() for one in cost.settings if one.kind in kinds}
    columns = sorted(named, key=lambda name: (kinds.index(named[name].kind), -(named[name].tip_size_m or 0)))
    head = ("set", *(f"{name}, limit" for name in TARGETED), *columns)
    rows = [
        (
            name,
            *(f"{cost.limits[of].value:.3g} ± {cost.limits[of].uncertainty:.1g}" for of in TARGETED),
            *(_setting_cell(cost.settings, column) for column in columns),
        )
        for name, cost in costs.items()
    ]
    caption = f"Errors of {' / '.join(TARGETED)} in %, ± their scatter, and processor time of each setting"
    return Sheet("settings", caption, Table.of(head, rows, left=range(len(head))))


def _setting_cell(settings: Sequence[Judged], name: str) -> str:
    """Return errors with scatter, %, and processor time of a setting; empty where it was not run."""
    setting = next((one for one in settings if one.name == name), None)
    if setting is None:
        return ""
    errors = []
    for quantity in TARGETED:
        error, scatter = setting.error[quantity], setting.scatter.get(quantity)
        shown = "-" if error is None else _percent(error)
        errors.append(shown if scatter is None else f"{shown} ± {_percent(scatter)}")
    return f"{' / '.join(errors)}, {setting.cpu_s:.2g} s"


def _percent(error: float) -> str:
    return f"{100 * error:.2g}" if error < 0.995 else f"{100 * error:.0f}"
