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


def first_only(name: str) -> str:
    """Return the name of the job that stops at a drop's second contact."""
    return f"first-{name}"


def study_report(maps: Maps, tip: float) -> StudyReport:
    """Return the study."""
    by = [_by(maps, "diameter", 1e3, "mm"), _by(maps, "speed", 1.0, "m/s")]
    pictures = [*_line_pictures(maps), _second_picture(maps), _worst_picture(maps), *by]
    worst = Sheet("worst", "The angle that vibrates most", _points(maps, maps.worst()), shown=False)
    sheets = [_anchor_sheet(maps), _rod_sheet(maps), worst, _map_sheet(maps)]
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
        shown = {w: m for w, m in DRAWN.items() if yields or m is not PLASTIC}
        panels = tuple(_line_panel(maps, yields, words, measure) for words, measure in shown.items())
        caption = (
            f"{kind.capitalize()} contact, 19 mm rods at 45 degrees and 2.1 m/s: modes (lines) and finite "
            "elements (rings); the paper's rods are marked."
        )
        made.append(Picture(f"line-{kind}", caption, panels))
    return made


def _line_panel(maps: Maps, yields: bool, words: str, measure: Measure) -> Panel:
    series = []
    for at, (state, f) in enumerate(STATES.items()):
        same = [d for d in maps.line if d.friction == f and d.yields == yields]
        series.append(Series(f"{state}, f = {f:g}", *_curve(maps, same, measure), "line", at))
        anchored = [d for d in maps.anchors if (d.friction, d.yields, d.angle) == (f, yields, 45.0)]
        gamma, value = _curve(maps, anchored, measure, "solid-")
        if gamma:
            series.append(Series(f"{state}, finite elements", gamma, value, "rings", at))
    return Panel(words.split(",")[0], X, words, tuple(series), MARKS)


def _second_picture(maps: Maps) -> Picture:
    panels = []
    for yields, kind in KINDS.items():
        same = [d for d in maps.line if d.friction == 0.0 and d.yields == yields]
        end = Series("after the last contact", *_curve(maps, same, VIBRATION))
        first = [(d.gamma, 100 * _after_first(maps, d)) for d in same]
        before = Series("after the first contact", [g for g, _ in first], [v for _, v in first], "dashed")
        panels.append(Panel(f"{kind}, frictionless", X, "vibration, % of E_0", (before, end), MARKS))
    return Picture("second-contacts", "What later contacts give back to the rigid motion.", tuple(panels))


def _after_first(maps: Maps, drop: Drop) -> float:
    """Return E_vib/E_0 after the first contact: of the cut run, or of the full run with one contact only."""
    cut = maps.value(drop, VIBRATION, "first-")
    end = maps.value(drop, VIBRATION)
    return cut if cut is not None else end if end is not None else float("nan")


def _worst_picture(maps: Maps) -> Picture:
    panels = []
    for yields, kind in KINDS.items():
        series = []
        for at, (state, f) in enumerate(STATES.items()):
            chosen = [
                d
                for d in maps.worst()
                if (d.diameter, d.speed) == (BODY, 2.1) and (d.friction, d.yields) == (f, yields)
            ]
            series.append(Series(state, *_curve(maps, chosen, VIBRATION), "line", at))
        panels.append(Panel(f"{kind}, worst angle", X, "vibration, % of E_0", tuple(series), MARKS))
    return Picture(
        "worst-angle", "At the angle of the map that vibrates most, 19 mm, 2.1 m/s.", tuple(panels)
    )


def _by(maps: Maps, name: str, scale: float, unit: str) -> Picture:
    """Return vibration at 45 degrees by diameter or speed, frictionless elastic and machined yielding."""
    other = "speed" if name == "diameter" else "diameter"
    panels = []
    for yields, state in ((False, "frictionless"), (True, "machined")):
        same = [d for d in maps.grid if (d.angle, d.friction, d.yields) == (45.0, STATES[state], yields)]
        same = [d for d in same if getattr(d, other) == (BODY if other == "diameter" else 2.1)]
        series = [
            Series(f"{value * scale:g} {unit}", *_curve(maps, drops, VIBRATION))
            for value, drops in _grouped(same, name).items()
        ]
        title = f"{KINDS[yields]}, {state}"
        panels.append(Panel(title, X, "vibration, % of E_0", tuple(series), MARKS))
    return Picture(f"by-{name}", f"Vibration at 45 degrees by {name}.", tuple(panels))


def _grouped(drops: Iterable[Drop], name: str) -> dict[float, list[Drop]]:
    groups: dict[float, list[Drop]] = {}
    for drop in drops:
        groups.setdefault(getattr(drop, name), []).append(drop)
    return dict(sorted(groups.items()))


def _peaks(maps: Maps) -> list[str]:
    """Return, per kind of contact and surface state, gamma of the largest vibration at 45 degrees."""
    sentences = []
    for yields, kind in KINDS.items():
        for state, f in STATES.items():
            same = [d for d in maps.line if d.friction == f and d.yields == yields]
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
    twice = [d for d in maps.line if maps.value(d, VIBRATION, "first-") is not None]
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
        pairs = [(maps.value(d, measure), maps.value(d, measure, "solid-")) for d in maps.anchors]
        away = [m - s for m, s in pairs if m is not None and s is not None]
        if away:
            sentences.append(
                f"{quantity}: modes less finite elements over {len(away)} anchors: mean "
                f"{np.mean(away):+.3f}, root mean square {np.linalg.norm(away) / len(away) ** 0.5:.3f}, "
                f"largest {max(away, key=abs):+.3f}."
            )
    return sentences


def _anchor_sheet(maps: Maps) -> Sheet:
    rows: list[list[Cell]] = []
    for drop in maps.anchors:
        pairs = [maps.value(drop, measure, p) for measure in COMPARED.values() for p in ("", "solid-")]
        counts = [maps.value(drop, CONTACTS, p) for p in ("", "solid-")]
        rows.append([drop.gamma, KINDS[drop.yields], drop.friction, drop.angle, *pairs, *counts])
    pairs_head = [f"{w}_{p}" for w in COMPARED for p in ("modal", "solid")]
    head = ("gamma", "contact", "f", "angle_deg", *pairs_head, "contacts_modal", "contacts_solid")
    return Sheet("anchors", "Modes beside finite elements", Table.of(head, rows))


def _rod_sheet(maps: Maps) -> Sheet:
    """Return the modal results of those anchors at 45 degrees that are the paper's rods."""
    rods = [d for d in maps.anchors if d.length in PAPER_RODS.values() and d.angle == 45.0]
    return Sheet("rods", "The paper's rods (modes)", _points(maps, rods))


def _map_sheet(maps: Maps) -> Sheet:
    return Sheet(
        "map", "Every point of the maps (modes)", _points(maps, [*maps.line, *maps.grid]), shown=False
    )


def _points(maps: Maps, drops: Iterable[Drop]) -> Table:
    """Return one row per drop: its parameters and its quantities."""
    listed = (VIBRATION, RESTITUTION, MU, CONTACTS, FRICTION, PLASTIC)
    head = ("gamma", "diameter_m", "length_m", "speed_m_per_s", "angle_deg", "f", "contact")
    rows = [_row(d, [maps.value(d, measure) for measure in listed]) for d in drops]
    return Table.of((*head, *(measure.name for measure in listed)), rows)


def _row(d: Drop, values: list[float | None]) -> list[Cell]:
    return [d.gamma, d.diameter, d.length, d.speed, d.angle, d.friction, KINDS[d.yields], *values]
