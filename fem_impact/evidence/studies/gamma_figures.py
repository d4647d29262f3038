"""Figures of the study of slenderness: vibration, and the change of e by it."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from pandas import DataFrame

from fem_impact.evidence.studies import gamma_findings as findings
from fem_impact.evidence.studies import gamma_table as runs
from fem_impact.evidence.studies.gamma_table import VIBRATION, among
from fem_impact.evidence.studies.rod_theory import blind_ratio
from fem_impact.evidence.studies.rods import BODY, KINDS, PAPER_RODS, PLAIN, STATES, DroppedRod
from fem_impact.figures.panels import Look, Mark, Panel, Picture, Series
from fem_impact.outcome.shares import shares
from rigid import LIMIT, slenderness

GAMMA, SHARE, INCLINATION = "gamma, m^-0.3815", "vibration, % of E_0", "inclination, degrees"
LIMIT_MARK = (Mark(LIMIT, "limit of Eq 29"),)
MARKS = (*(Mark(float(slenderness(l, BODY)), name) for name, l in PAPER_RODS.items()), *LIMIT_MARK)
STATE_NAMES = {f: f"{state}, f = {f:g}" for state, f in STATES.items()}
ROD_NAMES = {length: f"{rod} rod" for rod, length in PAPER_RODS.items()}
LAWS = {"hardness": "from hardness", "tensile": "from ultimate stress"}
USUAL = {"diameter_m": BODY, "speed_m_per_s": 2.1, "law": "tensile"}  # of the curve
SHOWN = (1.0, 5.0, 20.0)  # degrees: angles in the picture of the static give
MOST = 6  # rods of a family in the picture over the angles


def pictures(table: DataFrame, angles: DataFrame, rods: DataFrame, upright: DataFrame) -> list[Picture]:
    """Return the figures of the study from its tables, as `findings` takes them."""
    last, first = 100 * table[f"{VIBRATION}_own_mesh"], 100 * table[f"{VIBRATION}_first_contact"]
    percent = {"share": 100 * table[VIBRATION], "share_band": 100 * table[f"{VIBRATION}_band"]}
    table = table.assign(**percent, last=last, first=first.where(first.notna(), last))
    kinds = {kind: table[table.contact == kind] for kind in KINDS.values()}
    return [
        vibration(kinds),
        later_contacts(kinds),
        other_inputs(kinds),
        onset(rods),
        over_angles(angles),
        static_give(upright),
        master(rods),
        blind_direction(table),
    ]


def lines(
    rows: DataFrame,
    x: str,
    y: str,
    by: str,
    names: Mapping[Any, str],
    look: Look = "joined",
    colours: Sequence[int | str | None] = (),
) -> list[Series]:
    """Return y over x, one line for each named value of a column that is among the rows.

    A line has the colour of its name's number unless ``colours`` are given, and the bands of ``y`` where
    there are any; rows without an x are left out, one without a y is a gap.
    """
    drawn = []
    for (value, name), colour in zip(names.items(), colours or range(len(names)), strict=True):
        line = rows[(rows[by] == value) & rows[x].notna()]
        bands = line[f"{y}_band"].to_numpy() if f"{y}_band" in line else np.array([np.nan])
        if len(line):
            known = bands if np.isfinite(bands).any() else None
            drawn.append(Series(name, line[x].tolist(), line[y].to_numpy(), look, colour, known))
    return drawn


def panel(title: str, x: str, series: Iterable[Series], marks: tuple[Mark, ...] = ()) -> Panel:
    """Return a panel of vibration."""
    return Panel(title, x, SHARE, tuple(series), marks)


def vibration(kinds: Mapping[str, DataFrame]) -> Picture:
    """Return vibration over gamma and over T1/tau, and the shares of E_0; elastic left, yielding right."""
    over_gamma, over_group, partition = [], [], []
    for kind, rows in kinds.items():
        curve, sets = among(rows, family=runs.CURVE), rows[rows.family == runs.MEASURED]
        changed = rows[(rows.family == runs.OTHERS) & (rows.angle_deg == 45.0)]
        reduced = dict.fromkeys(STATES.values(), "reduced model (modal)")
        modes = lines(among(rows, family=runs.MODES), "gamma", "share", "f", reduced, "thin")
        by_state = {x: lines(curve, x, "share", "f", STATE_NAMES) for x in ("gamma", "T1_over_tau")}
        other = {runs.OTHERS: "other diameters and speeds"}
        rings = lines(changed, "T1_over_tau", "share", "family", other, "rings", ("grey",))
        own = {runs.MEASURED: "measured sets, own scenes"}
        measured = {x: lines(sets, x, "share", "family", own, "diamonds", ("night",)) for x in by_state}
        over_gamma.append(
            panel(f"{kind}: over gamma", GAMMA, (*by_state["gamma"], *modes, *measured["gamma"]), MARKS)
        )
        by_group = (*by_state["T1_over_tau"], *rings, *measured["T1_over_tau"])
        over_group.append(panel(f"{kind}: over T1/tau", "T1/tau", by_group))
        partition.append(_partition(kind, rows))
    caption = (
        "Vibration after the impact by finite elements, with the bands of the levels: 19 mm rods at 45 "
        "degrees, 2.1 m/s. Diamonds: measured sets from their own scenes. Thin lines: the reduced model "
        "(modal). Last row: where the energy is after the impact."
    )
    return Picture("vibration", caption, (*over_gamma, *over_group, *partition))


def _partition(kind: str, rows: DataFrame) -> Panel:
    line = findings.plain_line(rows, kind)
    line = line[line.E_r_over_E_0.notna()]
    series = []
    for share in shares("figure"):
        values = np.nan_to_num(100 * line[share.key.name].to_numpy()).clip(min=0.0)
        if values.max(initial=0.0) > 0.1:
            series.append(Series(share.label, line.gamma.tolist(), values, "area", share.colour))
    title = f"{kind}, {PLAIN[kind]}: where the energy is"
    return Panel(title, GAMMA, "share of E_0, %", tuple(series), MARKS)


def later_contacts(kinds: Mapping[str, DataFrame]) -> Picture:
    """Return vibration after the first and after the last contact."""
    panels = []
    for kind, rows in kinds.items():
        line = findings.plain_line(rows, kind)
        first = lines(line, "gamma", "first", "contact", {kind: "after the first contact"}, "rings", (1,))
        last = lines(line, "gamma", "last", "contact", {kind: "after the last contact"}, "joined", (0,))
        panels.append(panel(f"{kind}, {PLAIN[kind]}", GAMMA, (*first, *last), MARKS))
    caption = "What later contacts give back to the rigid motion or take from it; each point on its own mesh."
    return Picture("later-contacts", caption, tuple(panels))


def other_inputs(kinds: Mapping[str, DataFrame]) -> Picture:
    """Return vibration by diameter, speed and flow curve over gamma, and of three rods over the angle."""
    panels = []
    for column, title, label in (
        ("diameter_m", "by diameter", lambda d: f"{d * 1e3:g} mm"),
        ("speed_m_per_s", "by speed", lambda v: f"{v:g} m/s"),
        ("angle_deg", "by inclination", None),
        ("law", "by flow curve", LAWS.__getitem__),
    ):
        usual = {name: value for name, value in USUAL.items() if name != column}
        for kind, rows in kinds.items() if column != "law" else [("yielding", kinds["yielding"])]:
            changed = among(rows, family=runs.OTHERS, **usual)
            if label is not None:
                changed = changed[changed.angle_deg == 45.0]
            if changed.empty:
                continue
            drawn = rows.loc[[*changed.index, *findings.plain_line(rows, kind).index]]
            if label is None:
                series = lines(drawn.sort_values("angle_deg"), "angle_deg", "share", "length_m", ROD_NAMES)
                panels.append(panel(f"{kind}: {title}", INCLINATION, series))
            else:
                names = {value: label(value) for value in sorted(set(drawn[column]))}
                series = lines(drawn.sort_values("gamma", kind="stable"), "gamma", "share", column, names)
                panels.append(panel(f"{kind}: {title}", GAMMA, series, MARKS))
    caption = (
        "Other diameters, speeds, inclinations, and the flow curve from hardness instead of the ultimate "
        "stress: elastic frictionless, yielding machined."
    )
    return Picture("other-inputs", caption, tuple(panels))


def onset(rods: DataFrame) -> Picture:
    """Return the largest error of e against gamma, 19 mm, one line per family."""
    body = rods[rods.diameter_m == BODY]
    series = lines(body, "gamma", "error_of_e", "family", {name: name for name in body.family.unique()})
    label, levels = "largest error of e by rigid theory", tuple(map(Mark, findings.LEVELS))
    caption = "Where vibration changes the rebound; horizontal lines: the stated levels."
    return Picture("onset", caption, (Panel("19 mm", GAMMA, label, tuple(series), LIMIT_MARK, levels),), 1)


def over_angles(angles: DataFrame) -> Picture:
    """Return e against inclination, degrees, one panel per family with up to `MOST` of its 19 mm rods."""
    panels = []
    colours: dict[str, int] = {}
    for name, rods in angles[angles.diameter_m == BODY].groupby("family", sort=False):
        gammas = sorted(set(rods.gamma))
        some = [gammas[at] for at in np.unique(np.linspace(0, len(gammas) - 1, MOST).astype(int))]
        names = {gamma: f"gamma {gamma:.0f}" for gamma in some}
        same = [colours.setdefault(label, len(colours)) for label in names.values()]  # in all panels
        banded = rods.assign(e_edge_band=rods.band_of_change)
        series = lines(banded, "angle_deg", "e_edge", "gamma", names, colours=same)
        panels.append(Panel(name, INCLINATION, "e", tuple(series)))
    caption = "Restitution against inclination, 19 mm rods; bands: of the change of e by vibration."
    return Picture("angles", caption, tuple(panels))


def static_give(upright: DataFrame) -> Picture:
    """Return e of the vibrating rod, by quasi-static bending alone, and of the rigid rod, at three angles."""
    looks: dict[str, tuple[str, Look]] = {
        "vibrating": ("e_edge", "points"),
        "quasi-static bending alone": ("e_static_give", "line"),
        "rigid": ("e_edge_rigid", "dashed"),
    }
    panels = []
    for near in (findings.nearest(upright, angle) for angle in SHOWN):
        series = [
            Series(label, near.gamma.tolist(), near[column].tolist(), look)
            for label, (column, look) in looks.items()
        ]
        panels.append(Panel(f"{near.angle_deg.iloc[0]:g} degrees", GAMMA, "e", tuple(series)))
    caption = "Yielding tip, frictionless, 19 mm: what the rod stores elastically never reaches the contact."
    return Picture("static-give", caption, tuple(panels), 3)


def master(rods: DataFrame) -> Picture:
    """Return 1 - largest error of e against T1/tau in both meanings of tau and against gamma."""
    left = rods.assign(left=1 - rods.error_of_e, left_band=rods.error_of_e_band)
    names = {name: name for name in rods.family.unique()}
    panels = []
    for title, axis, column, marks in (
        ("by T1/tau, tau of the inclined rod", "T1/tau", "T1_over_tau", ()),
        ("by T1/tau, tau of the whole mass", "T1/tau", "T1_over_tau_whole", ()),
        ("by gamma", GAMMA, "gamma", (Mark(LIMIT, "limit"),)),
    ):
        series = lines(left, column, "left", "family", names, "points")
        if column == "T1_over_tau_whole":
            series.append(Series("independent reference", *findings.INDEPENDENT, "rings", 6))
        panels.append(Panel(title, axis, "1 - largest error of e", tuple(series), marks))
    caption = "One group or the other: all diameters, contacts and slendernesses."
    return Picture("master", caption, tuple(panels), 3)


def blind_direction(table: DataFrame) -> Picture:
    """Return vibration against friction of the paper's rods, with mu* of each."""
    over_friction = table[(table.family == runs.BLIND) & table.share.notna()]
    names = {length: rod for rod, length in PAPER_RODS.items()}
    series = lines(over_friction, "f", "share", "length_m", names)
    marks = tuple(Mark(blind_ratio(DroppedRod(length)), f"mu* of {rod}") for length, rod in names.items())
    caption = "A contact force of ratio mu* does not excite the first bending mode."
    return Picture("blind-direction", caption, (panel("elastic, 45 degrees", "f", series, marks),), 1)
