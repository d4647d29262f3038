"""Figures of the gamma study: vibration over slenderness, over T1/tau and over other inputs."""

from collections.abc import Callable
from typing import Any

import numpy as np
from pandas import DataFrame

from fem_impact.arrays import Array
from fem_impact.evidence.studies.rods import BODY, KINDS, PAPER_RODS, PLAIN, STATES, VIBRATION, among
from fem_impact.figures.panels import Look, Mark, Panel, Picture, Series
from fem_impact.outcome.shares import shares
from rigid import LIMIT, slenderness

GAMMA, SHARE = "gamma, m^-0.3815", "vibration, % of E_0"
MARKS = (
    *(Mark(float(slenderness(length, BODY)), name) for name, length in PAPER_RODS.items()),
    Mark(LIMIT, "limit of Eq 29"),
)
USUAL = {"diameter_m": BODY, "speed_m_per_s": 2.1, "law": "tensile"}  # of the curve
CURVE = (
    "Vibration after the impact by finite elements, with the bands of the levels: 19 mm rods at 45 degrees, "
    "2.1 m/s. Diamonds: measured sets from their own scenes. Thin lines: the reduced model (modal). Last "
    "row: where the energy is after the impact."
)
OTHERS = (
    "Other diameters, speeds, inclinations, and the flow curve from hardness instead of the ultimate "
    "stress: elastic frictionless, yielding machined."
)
LATER = "What later contacts give back to the rigid motion or take from it; each point on its own mesh."


def plain_line(points: DataFrame, kind: str) -> DataFrame:
    """Return the points of the curve in the state of `PLAIN`, by slenderness."""
    return among(points, family="curve", contact=kind, f=STATES[PLAIN[kind]])


def curve(points: DataFrame, modes: DataFrame) -> Picture:
    """Return vibration over gamma and over T1/tau, and the shares of E_0; elastic left, yielding right."""
    panels = [_over_gamma(points, modes, kind) for kind in KINDS.values()]
    panels += [_over_group(points, kind) for kind in KINDS.values()]
    panels += [_partition(points, kind) for kind in KINDS.values()]
    return Picture("vibration", CURVE, tuple(panels))


def later_contacts(points: DataFrame) -> Picture:
    """Return vibration after the first and after the last contact."""
    panels = []
    for kind in KINDS.values():
        line = plain_line(points, kind)
        last, first = line[f"{VIBRATION}_own_mesh"], line[f"{VIBRATION}_first_contact"]
        line = line.assign(last=last, first=first.where(first.notna(), last))
        series = [
            _series("after the first contact", line, "gamma", "rings", 1, "first"),
            _series("after the last contact", line, "gamma", "joined", 0, "last"),
        ]
        panels.append(_panel(f"{kind}, {PLAIN[kind]}", GAMMA, series, MARKS))
    return Picture("later-contacts", LATER, tuple(panels))


def other_inputs(points: DataFrame) -> Picture:
    """Return vibration by diameter, speed and flow curve over gamma, and of three rods over the angle."""
    laws = {"tensile": "from ultimate stress", "hardness": "from hardness"}
    kinds = tuple(KINDS.values())
    panels = [
        *(_by(points, kind, "diameter_m", "diameter", lambda d: f"{d * 1e3:g} mm") for kind in kinds),
        *(_by(points, kind, "speed_m_per_s", "speed", lambda v: f"{v:g} m/s") for kind in kinds),
        *(_by_angle(points, kind) for kind in kinds),
        _by(points, "yielding", "law", "flow curve", laws.__getitem__),
    ]
    return Picture("other-inputs", OTHERS, tuple(panels))


def _over_gamma(points: DataFrame, modes: DataFrame, kind: str) -> Panel:
    series = [
        *_by_state(points, kind, "gamma"),
        *(
            _series("reduced model (modal)", among(modes, contact=kind, f=f), "gamma", "thin", at)
            for at, f in enumerate(STATES.values())
        ),
        *_sets(points, kind, "gamma"),
    ]
    return _panel(f"{kind}: over gamma", GAMMA, series, MARKS)


def _over_group(points: DataFrame, kind: str) -> Panel:
    changed = points[
        (points.family == "other inputs") & (points.contact == kind) & (points.angle_deg == 45.0)
    ]
    series = [
        *_by_state(points, kind, "T1_over_tau"),
        _series("other diameters and speeds", changed, "T1_over_tau", "rings", "grey"),
        *_sets(points, kind, "T1_over_tau"),
    ]
    return _panel(f"{kind}: over T1/tau", "T1/tau", series)


def _partition(points: DataFrame, kind: str) -> Panel:
    line = plain_line(points, kind)
    line = line[line.E_r_over_E_0.notna()]
    series = []
    for share in shares("figure"):
        values = np.nan_to_num(_percent(line[share.key.name])).clip(min=0.0)
        if values.max(initial=0.0) > 0.1:
            series.append(Series(share.label, line.gamma.tolist(), values, "area", share.colour))
    title = f"{kind}, {PLAIN[kind]}: where the energy is"
    return Panel(title, GAMMA, "share of E_0, %", tuple(series), MARKS)


def _by(points: DataFrame, kind: str, column: str, name: str, label: Callable[[Any], str]) -> Panel:
    usual = {key: value for key, value in USUAL.items() if key != column}
    changed = among(points, family="other inputs", contact=kind, angle_deg=45.0, **usual)
    drawn = points.loc[[*changed.index, *plain_line(points, kind).index]]
    series = [
        _series(label(value), among(drawn, **{column: value}), "gamma", "joined", at)
        for at, value in enumerate(sorted(set(drawn[column])))
    ]
    return _panel(f"{kind}: by {name}", GAMMA, series, MARKS)


def _by_angle(points: DataFrame, kind: str) -> Panel:
    changed = among(points, family="other inputs", contact=kind, **USUAL)
    drawn = points.loc[[*changed.index, *plain_line(points, kind).index]].sort_values("angle_deg")
    series = [
        _series(f"{rod} rod", drawn[drawn.length_m == length], "angle_deg", "joined", at)
        for at, (rod, length) in enumerate(PAPER_RODS.items())
    ]
    return _panel(f"{kind}: by inclination", "inclination, degrees", series)


def _by_state(points: DataFrame, kind: str, x: str) -> list[Series]:
    return [
        _series(f"{state}, f = {f:g}", among(points, family="curve", contact=kind, f=f), x, "joined", at)
        for at, (state, f) in enumerate(STATES.items())
    ]


def _sets(points: DataFrame, kind: str, x: str) -> list[Series]:
    sets = points[(points.family == "measured sets") & (points.contact == kind)]
    return [_series("measured sets, own scenes", sets, x, "diamonds", "night")]


def _series(
    label: str, points: DataFrame, x: str, look: Look, colour: int | str, y: str = VIBRATION
) -> Series:
    """Return vibration with its bands at the points that have a place; a point without a value is a gap."""
    points = points[points[x].notna()]
    bands = _percent(points[f"{y}_band"]) if f"{y}_band" in points else None
    return Series(label, points[x].tolist(), _percent(points[y]), look, colour, bands)


def _panel(title: str, x: str, series: list[Series], marks: tuple[Mark, ...] = ()) -> Panel:
    return Panel(title, x, SHARE, tuple(s for s in series if np.size(s.x)), marks)


def _percent(values: Any) -> Array:
    return 100.0 * np.asarray(values, float)
