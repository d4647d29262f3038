"""Figures of the gamma study."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from fem_impact.arrays import Array
from fem_impact.evidence.studies.gamma_findings import Curves, plain_line
from fem_impact.evidence.studies.gamma_points import VIBRATION, Point, among
from fem_impact.evidence.studies.gamma_tables import KINDS
from fem_impact.evidence.studies.rods import BODY, PAPER_RODS, STATES
from fem_impact.figures.panels import Look, Mark, Panel, Picture, Series
from fem_impact.outcome.shares import shares
from rigid import LIMIT, slenderness

GAMMA, SHARE = "gamma, m^-0.3815", "vibration, % of E_0"
MARKS = (
    *(Mark(float(slenderness(length, BODY)), name) for name, length in PAPER_RODS.items()),
    Mark(LIMIT, "limit of Eq 29"),
)
USUAL = {"diameter": BODY, "speed": 2.1, "law": "tensile"}  # of the curve: m, m/s, flow curve
LABELS: dict[str, tuple[str, Callable[[Any], str]]] = {
    "diameter": ("diameter", lambda d: f"{d * 1e3:g} mm"),
    "speed": ("speed", lambda v: f"{v:g} m/s"),
    "law": ("flow curve", lambda law: f"from {'ultimate stress' if law == 'tensile' else law}"),
}
Place = Callable[[Point], float | None]


def curve_picture(curves: Curves, caption: str) -> Picture:
    """Return vibration over gamma and over T1/tau, and the shares of E_0; elastic left, yielding right."""
    panels = [
        *(_over_gamma(curves, yields) for yields in KINDS),
        *(_over_group(curves, yields) for yields in KINDS),
        *(_partition(curves, yields) for yields in KINDS),
    ]
    return Picture("vibration", caption, tuple(panels))


def later_picture(curves: Curves) -> Picture:
    """Return vibration after the first and after the last contact."""
    panels = []
    for yields, kind in KINDS.items():
        points = plain_line(curves, yields)
        first = [p.own if p.first is None else p.first for p in points]
        gamma = [p.drop.gamma for p in points]
        series = (
            Series("after the first contact", gamma, _percent(first), "rings", 1),
            Series("after the last contact", gamma, _percent([p.own for p in points]), "joined", 0),
        )
        panels.append(Panel(f"{kind}, {_state(points)}", GAMMA, SHARE, series, MARKS))
    caption = "What later contacts give back to the rigid motion or take from it; each point on its own mesh."
    return Picture("later-contacts", caption, tuple(panels))


def others_picture(curves: Curves) -> Picture:
    """Return vibration by diameter, speed and flow curve over gamma, and of three rods over the angle."""
    panels = [_by(curves, yields, name) for name in ("diameter", "speed") for yields in KINDS]
    panels += [_by_angle(curves, yields) for yields in KINDS]
    panels += [_by(curves, True, "law")]
    caption = (
        "Other diameters, speeds, inclinations, and the flow curve from hardness instead of the ultimate "
        "stress: elastic frictionless, yielding machined."
    )
    return Picture("other-inputs", caption, tuple(panels))


def _over_gamma(curves: Curves, yields: bool) -> Panel:
    series = [_state_series(curves, yields, at, _gamma) for at in range(len(STATES))]
    for at, f in enumerate(STATES.values()):
        drops = [d for d, _ in curves.reduced if d.friction == f and d.yields == yields]
        values = _percent([curves.reduced_vibration(drop) for drop in drops])
        series.append(Series("reduced model (modal)", [d.gamma for d in drops], values, "thin", at))
    if yields:
        series.append(_series("measured sets, own scenes", curves.sets, _gamma, "diamonds", "night"))
    return Panel(
        f"{KINDS[yields]}: over gamma", GAMMA, SHARE, tuple(s for s in series if np.size(s.x)), MARKS
    )


def _over_group(curves: Curves, yields: bool) -> Panel:
    series = [_state_series(curves, yields, at, _ratio) for at in range(len(STATES))]
    other = [p for p in curves.others if p.drop.yields == yields and p.drop.angle == 45.0]
    series.append(_series("other diameters and speeds", other, _ratio, "rings", "grey"))
    if yields:
        series.append(_series("measured sets, own scenes", curves.sets, _ratio, "diamonds", "night"))
    title = f"{KINDS[yields]}: over T1/tau"
    return Panel(title, "T1/tau", SHARE, tuple(s for s in series if np.size(s.x)))


def _partition(curves: Curves, yields: bool) -> Panel:
    points = [p for p in plain_line(curves, yields) if p.value("E_r_over_E_0") is not None]
    gamma, series = [p.drop.gamma for p in points], []
    for share in shares("figure"):
        values = [max(p.value(share.key.name) or 0.0, 0.0) for p in points]
        if max(values, default=0.0) > 1e-3:
            series.append(Series(share.label, gamma, _percent(values), "area", share.colour))
    title = f"{KINDS[yields]}, {_state(points)}: where the energy is"
    return Panel(title, GAMMA, "share of E_0, %", tuple(series), MARKS)


def _by(curves: Curves, yields: bool, name: str) -> Panel:
    changed = [p for p in curves.others if p.drop.yields == yields and p.drop.angle == 45.0]
    fixed = {key: value for key, value in USUAL.items() if key != name}
    points = [*among(changed, **fixed), *plain_line(curves, yields)]
    title, label = LABELS[name]
    series = [
        _series(label(value), among(points, **{name: value}), _gamma, "joined", at)
        for at, value in enumerate(sorted({getattr(p.drop, name) for p in points}))
    ]
    return Panel(f"{KINDS[yields]}: by {title}", GAMMA, SHARE, tuple(series), MARKS)


def _by_angle(curves: Curves, yields: bool) -> Panel:
    series = []
    for at, (rod, length) in enumerate(PAPER_RODS.items()):
        changed = among(curves.others, length=length, yields=yields, **USUAL)
        points = [*changed, *among(plain_line(curves, yields), length=length)]
        points.sort(key=lambda point: point.drop.angle)
        series.append(_series(f"{rod} rod", points, lambda point: point.drop.angle, "joined", at))
    return Panel(f"{KINDS[yields]}: by inclination", "inclination, degrees", SHARE, tuple(series))


def _state_series(curves: Curves, yields: bool, at: int, place: Place) -> Series:
    state, f = list(STATES.items())[at]
    points = among(curves.line, friction=f, yields=yields)
    return _series(f"{state}, f = {f:g}", points, place, "joined", at)


def _series(label: str, points: Sequence[Point], place: Place, look: Look, colour: int | str) -> Series:
    """Return vibration with its bands at the points that have a place; a point without a value is a gap."""
    placed = [(x, point) for point in points if (x := place(point)) is not None]
    values, bands = ([getattr(p, of)(VIBRATION) for _, p in placed] for of in ("value", "band"))
    return Series(label, [x for x, _ in placed], _percent(values), look, colour, _percent(bands))


def _gamma(point: Point) -> float:
    return point.drop.gamma


def _ratio(point: Point) -> float | None:
    return point.ratio


def _percent(values: Sequence[float | None]) -> Array:
    return 100.0 * np.array([np.nan if value is None else value for value in values])


def _state(points: Sequence[Point]) -> str:
    names = {f: name for name, f in STATES.items()}
    return names[points[0].drop.friction] if points else "none"
