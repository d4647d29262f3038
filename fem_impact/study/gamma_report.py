"""Findings, pictures and tables of the gamma study."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from fem_impact.figures.lines import Mark, Panel, Series
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import Num, known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.study.document import Picture, Sheet, StudyReport
from fem_impact.study.rods import BODY, MAP_NOTES, PAPER_RODS, STATES, Drop
from fem_impact.tables.table import Cell, Table
from rigid import LIMIT, slenderness

X = "gamma, m^-0.3815"
MARKS = (
    *(Mark(float(slenderness(l, BODY)), w) for w, l in PAPER_RODS.items()),
    Mark(LIMIT, "limit of Eq 29"),
)


@dataclass(frozen=True, slots=True)
class Measure:
    """A quantity of an outcome: its name in tables, and its factor in figures (100 for per cent)."""

    name: str
    of: Callable[[Outcome], Num]
    factor: float = 1.0


VIBRATION = Measure("E_vib_over_E_0", lambda run: run.energy.vibration, 100.0)
RESTITUTION = Measure("e_edge", lambda run: run.restitution.edge.e)
MU = Measure("mu", lambda run: run.restitution.mu)
CONTACTS = Measure("contacts", lambda run: float(len(known(run.contact.intervals))))
FRICTION = Measure("W_friction_over_E_0", lambda run: run.energy.friction, 100.0)
PLASTIC = Measure("plastic", lambda run: run.energy.plastic, 100.0)

DRAWN = {
    "vibration, % of E_0": VIBRATION,
    "e": RESTITUTION,
    "contacts": CONTACTS,
    "friction, % of E_0": FRICTION,
    "plastic work, % of E_0": PLASTIC,
}
COMPARED = {"e": RESTITUTION, "mu": MU, "vibration/E_0": VIBRATION, "friction/E_0": FRICTION}
SOLID, FIRST = (
    "solid-",
    "first-",
)  # before a drop's name: its finite-element job, the one cut at a second contact
Curve = tuple[list[float], list[float]]
KINDS = {False: "elastic", True: "yielding"}


@dataclass(frozen=True, slots=True)
class Maps:
    """Drops of the fine line, of the map and of the anchors (modal and solid), and all results."""

    line: Sequence[Drop]
    grid: Sequence[Drop]
    anchors: Sequence[Drop]
    results: Results

    def value(self, drop: Drop, measure: Measure, prefix: str = "") -> float | None:
        """Return a quantity of a drop; None where its run failed or has no value."""
        run = self.results.get(f"{prefix}{drop.name}")
        return or_none(measure.of(run)) if isinstance(run, Outcome) else None

    def worst(self) -> list[Drop]:
        """Return, per rod, speed, friction and yielding, the drop at the angle that vibrates most."""
        groups: dict[tuple[float | bool, ...], list[Drop]] = {}
        for drop in self.grid:
            key = (drop.length, drop.diameter, drop.speed, drop.friction, drop.yields)
            groups.setdefault(key, []).append(drop)
        return [max(group, key=lambda d: self.value(d, VIBRATION) or 0.0) for group in groups.values()]


def among(drops: Iterable[Drop], **values: float | bool) -> list[Drop]:
    """Return the drops whose attributes have the given values."""
    return [d for d in drops if all(getattr(d, name) == value for name, value in values.items())]


def study_report(maps: Maps, tip: float) -> StudyReport:
    """Return the study."""
    by = [_by(maps, "diameter", 1e3, "mm", speed=2.1), _by(maps, "speed", 1.0, "m/s", diameter=BODY)]
    pictures = [*_line_pictures(maps), _second_picture(maps), _worst_picture(maps), *by]
    rods = [d for d in among(maps.anchors, angle=45.0) if d.length in PAPER_RODS.values()]
    mapped = [*maps.line, *maps.grid]
    sheets = [
        _anchor_sheet(maps),
        Sheet("rods", "The paper's rods (modes)", _points(maps, rods)),
        Sheet("worst", "The angle that vibrates most", _points(maps, maps.worst()), shown=False),
        Sheet("map", "Every point of the maps (modes)", _points(maps, mapped), shown=False),
    ]
    peaks, back, away = _peaks(maps), _given_back(maps), _differences(maps)
    anchored = f"Anchors: finite elements of {tip * 1e3:g} mm at the tip, one mesh, so without a mesh band."
    return StudyReport(
        "gamma",
        "Vibration against slenderness",
        [*peaks, *back, *away],
        pictures,
        sheets,
        [*MAP_NOTES, anchored],
        ["modal", "thornton", "slenderness"],
        [
            *(("line-elastic", sentence) for sentence in peaks[:1]),
            *(("line-yielding", sentence) for sentence in peaks[-1:]),
            *(("second-contacts", sentence) for sentence in back),
            *(("line-yielding", sentence) for sentence in away),
        ],
    )


def _curve(maps: Maps, drops: Iterable[Drop], measure: Measure, prefix: str = "") -> Curve:
    """Return gamma and a quantity, times its factor, of the drops that have a value."""
    values = [(drop.gamma, maps.value(drop, measure, prefix)) for drop in drops]
    points = [(gamma, measure.factor * value) for gamma, value in values if value is not None]
    return [gamma for gamma, _ in points], [value for _, value in points]


def _line_pictures(maps: Maps) -> list[Picture]:
    made = []
    for yields, kind in KINDS.items():
        shown = {label: m for label, m in DRAWN.items() if yields or m is not PLASTIC}
        panels = tuple(_line_panel(maps, yields, label, measure) for label, measure in shown.items())
        caption = (
            f"{kind.capitalize()} contact, 19 mm rods at 45 degrees and 2.1 m/s: modes (lines) and finite "
            "elements (rings); the paper's rods are marked."
        )
        made.append(Picture(f"line-{kind}", caption, panels))
    return made


def _line_panel(maps: Maps, yields: bool, label: str, measure: Measure) -> Panel:
    series = []
    for at, (state, f) in enumerate(STATES.items()):
        same = among(maps.line, friction=f, yields=yields)
        series.append(Series(f"{state}, f = {f:g}", *_curve(maps, same, measure), "line", at))
        anchored = among(maps.anchors, friction=f, yields=yields, angle=45.0)
        gamma, value = _curve(maps, anchored, measure, SOLID)
        if gamma:
            series.append(Series(f"{state}, finite elements", gamma, value, "rings", at))
    return Panel(label.split(",")[0], X, label, tuple(series), MARKS)


def _second_picture(maps: Maps) -> Picture:
    panels = []
    for yields, kind in KINDS.items():
        same = among(maps.line, friction=0.0, yields=yields)
        end = Series("after the last contact", *_curve(maps, same, VIBRATION))
        gamma, first = [d.gamma for d in same], [100 * _after_first(maps, d) for d in same]
        before = Series("after the first contact", gamma, first, "dashed")
        panels.append(Panel(f"{kind}, frictionless", X, "vibration, % of E_0", (before, end), MARKS))
    return Picture("second-contacts", "What later contacts give back to the rigid motion.", tuple(panels))


def _after_first(maps: Maps, drop: Drop) -> float:
    """Return E_vib/E_0 after the first contact: of the cut run, or of the full run with one contact only."""
    known_values = (maps.value(drop, VIBRATION, prefix) for prefix in (FIRST, ""))
    return next((value for value in known_values if value is not None), float("nan"))


def _worst_picture(maps: Maps) -> Picture:
    panels = []
    for yields, kind in KINDS.items():
        series = []
        for at, (state, f) in enumerate(STATES.items()):
            chosen = among(maps.worst(), diameter=BODY, speed=2.1, friction=f, yields=yields)
            series.append(Series(state, *_curve(maps, chosen, VIBRATION), "line", at))
        panels.append(Panel(f"{kind}, worst angle", X, "vibration, % of E_0", tuple(series), MARKS))
    return Picture(
        "worst-angle", "At the angle of the map that vibrates most, 19 mm, 2.1 m/s.", tuple(panels)
    )


def _by(maps: Maps, name: str, scale: float, unit: str, **fixed: float) -> Picture:
    """Return vibration at 45 degrees by diameter or speed, frictionless elastic and machined yielding."""
    panels = []
    for yields, state in ((False, "frictionless"), (True, "machined")):
        same = among(maps.grid, angle=45.0, friction=STATES[state], yields=yields, **fixed)
        series = [
            Series(f"{value * scale:g} {unit}", *_curve(maps, among(same, **{name: value}), VIBRATION))
            for value in sorted({getattr(drop, name) for drop in same})
        ]
        title = f"{KINDS[yields]}, {state}"
        panels.append(Panel(title, X, "vibration, % of E_0", tuple(series), MARKS))
    return Picture(f"by-{name}", f"Vibration at 45 degrees by {name}.", tuple(panels))


def _peaks(maps: Maps) -> list[str]:
    """Return, per kind of contact and surface state, gamma of the largest vibration at 45 degrees."""
    sentences = []
    for yields, kind in KINDS.items():
        for state, f in STATES.items():
            same = among(maps.line, friction=f, yields=yields)
            gamma, share = _curve(maps, same, VIBRATION)
            if gamma:
                top = int(np.argmax(share))
                last = f", and {share[-1]:.2g} % at gamma {gamma[-1]:.0f}" if gamma[top] < gamma[-1] else ""
                sentences.append(
                    f"{kind}, {state}, 45 degrees: vibration is largest at gamma {gamma[top]:.0f} with "
                    f"{share[top]:.2g} % of E_0{last}."
                )
    return sentences


def _given_back(maps: Maps) -> list[str]:
    """Return how many drops touch again, and how much vibration that returns to the rigid motion."""
    twice = [d for d in maps.line if maps.value(d, VIBRATION, FIRST) is not None]
    if not twice:
        return []
    back = [(_after_first(maps, d) - (maps.value(d, VIBRATION) or 0.0), d) for d in twice]
    most, drop = max(back, key=lambda pair: pair[0])
    giving = sum(value > 0 for value, _ in back)
    return [
        f"Of {len(maps.line)} drops at 45 degrees {len(twice)} touch again; in {giving} of these the later "
        f"contacts give vibration back, at most {100 * most:.2g} % of E_0 (gamma {drop.gamma:.0f}, "
        f"{KINDS[drop.yields]}, f = {drop.friction:g})."
    ]


def _differences(maps: Maps) -> list[str]:
    """Return the differences between modal and finite-element results over the anchors."""
    sentences = []
    for quantity, measure in COMPARED.items():
        pairs = [(maps.value(d, measure), maps.value(d, measure, SOLID)) for d in maps.anchors]
        away = [m - s for m, s in pairs if m is not None and s is not None]
        if away:
            sentences.append(
                f"{quantity}: modes less finite elements over {len(away)} anchors: mean "
                f"{np.mean(away):+.3f}, root mean square {np.linalg.norm(away) / len(away) ** 0.5:.3f}, "
                f"largest {max(away, key=abs):+.3f}."
            )
    return sentences


def _anchor_sheet(maps: Maps) -> Sheet:
    measures = {**COMPARED, "contacts": CONTACTS}
    rows: list[list[Cell]] = []
    for drop in maps.anchors:
        pairs = [maps.value(drop, measure, p) for measure in measures.values() for p in ("", SOLID)]
        rows.append([drop.gamma, KINDS[drop.yields], drop.friction, drop.angle, *pairs])
    pairs_head = [f"{name}_{fidelity}" for name in measures for fidelity in ("modal", "solid")]
    head = ("gamma", "contact", "f", "angle_deg", *pairs_head)
    return Sheet("anchors", "Modes beside finite elements", Table.of(head, rows))


def _points(maps: Maps, drops: Iterable[Drop]) -> Table:
    """Return one row per drop: its parameters and its quantities."""
    listed = (VIBRATION, RESTITUTION, MU, CONTACTS, FRICTION, PLASTIC)
    head = ("gamma", "diameter_m", "length_m", "speed_m_per_s", "angle_deg", "f", "contact")
    rows: list[list[Cell]] = []
    for d in drops:
        values = [maps.value(d, measure) for measure in listed]
        rows.append([d.gamma, d.diameter, d.length, d.speed, d.angle, d.friction, KINDS[d.yields], *values])
    return Table.of((*head, *(measure.name for measure in listed)), rows)
