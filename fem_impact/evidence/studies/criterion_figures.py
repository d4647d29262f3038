"""Figures of the criterion study."""

import numpy as np
from pandas import DataFrame

from fem_impact.arrays import Array
from fem_impact.evidence.studies import criterion_findings
from fem_impact.evidence.studies.rod_theory import blind_ratio
from fem_impact.evidence.studies.rods import BODY, PAPER_RODS, DroppedRod
from fem_impact.figures.panels import Mark, Panel, Picture, Series
from rigid import LIMIT

SHOWN = (1.0, 5.0, 20.0)  # degrees: angles in the picture of the static give
GAMMA, LIMIT_MARK = "gamma, m^-0.3815", (Mark(LIMIT, "limit of Eq 29"),)


def onset(body: DataFrame) -> Picture:
    """Return the largest error of e against gamma, 19 mm, one line per family."""
    series = tuple(
        Series(name, rods.gamma.tolist(), rods.error_of_e.tolist(), "joined", at, _bands(rods))
        for at, (name, rods) in enumerate(criterion_findings.by_contact(body).items())
    )
    label = "largest error of e by rigid theory"
    panel = Panel("19 mm", GAMMA, label, series, LIMIT_MARK, tuple(map(Mark, criterion_findings.LEVELS)))
    caption = "Where vibration changes the rebound; horizontal lines: the stated levels."
    return Picture("onset", caption, (panel,), 1)


def _bands(rods: DataFrame) -> Array | None:
    """Return the bands of the largest errors, None for rods of the reduced model, which have none."""
    bands: Array = (rods.error_high - rods.error_of_e).to_numpy()
    return bands if rods.band_of_change.any() else None


def angles(angles: DataFrame) -> Picture:
    """Return e against inclination, one panel per family with up to six of its 19 mm rods."""
    panels = []
    colours: dict[str, int] = {}
    for name, of_contact in angles[angles.diameter_m == BODY].groupby("contact", sort=False):
        rods = [rod for _, rod in of_contact.groupby("gamma")]
        series = []
        for at in np.unique(np.linspace(0, len(rods) - 1, 6).astype(int)):
            rod = rods[at]
            label = f"gamma {rod.gamma.iloc[0]:.0f}"
            colour = colours.setdefault(label, len(colours))  # one for each slenderness in all panels
            bands = rod.band_of_change.tolist() if rod.band_of_change.any() else None
            series.append(Series(label, rod.angle_deg.tolist(), rod.e.tolist(), "joined", colour, bands))
        panels.append(Panel(name, "inclination, degrees", "e", tuple(series)))
    caption = "Restitution against inclination, 19 mm rods; bands: of the change of e by vibration."
    return Picture("angles", caption, tuple(panels))


def static_give(upright: DataFrame) -> Picture:
    """Return e of the vibrating rod, by quasi-static bending alone, and of the rigid rod, at three angles."""
    panels = []
    for near in (criterion_findings.nearest(upright, angle) for angle in SHOWN):
        series = (
            Series("vibrating", near.gamma.tolist(), near.e.tolist(), "points"),
            Series("quasi-static bending alone", near.gamma.tolist(), near.e_static_give.tolist(), "line"),
            Series("rigid", near.gamma.tolist(), near.e_rigid.tolist(), "dashed"),
        )
        panels.append(Panel(f"{near.angle_deg.iloc[0]:g} degrees", GAMMA, "e", series))
    caption = "Yielding tip, frictionless, 19 mm: what the rod stores elastically never reaches the contact."
    return Picture("static-give", caption, tuple(panels), 3)


def master(rods: DataFrame) -> Picture:
    """Return 1 - largest error of e against T1/tau in both meanings of tau and against gamma."""
    panels = []
    for title, axis, column, marks in (
        ("by T1/tau, tau of the inclined rod", "T1/tau", "T1_over_tau", ()),
        ("by T1/tau, tau of the whole mass", "T1/tau", "T1_over_tau_whole", ()),
        ("by gamma", GAMMA, "gamma", (Mark(LIMIT, "limit"),)),
    ):
        series = [
            Series(name, same[column].tolist(), (1 - same.error_of_e).tolist(), "points", at, _bands(same))
            for at, (name, same) in enumerate(rods.groupby("contact", sort=False))
        ]
        if column == "T1_over_tau_whole":
            series.append(Series("independent reference", *criterion_findings.INDEPENDENT, "rings", 6))
        panels.append(Panel(title, axis, "1 - largest error of e", tuple(series), marks))
    caption = "One group or the other: all diameters, contacts and slendernesses."
    return Picture("master", caption, tuple(panels), 3)


def blind_direction(blind: DataFrame) -> Picture:
    """Return vibration against friction of the paper's rods, with mu* of each."""
    series, marks = [], []
    for at, (rod, length) in enumerate(PAPER_RODS.items()):
        f, share = criterion_findings.over_friction(blind, length)
        series.append(Series(rod, f, 100 * share, "joined", at))
        marks.append(Mark(blind_ratio(DroppedRod(length)), f"mu* of {rod}"))
    panel = Panel("elastic, 45 degrees", "f", "vibration, % of E_0", tuple(series), tuple(marks))
    caption = "A contact force of ratio mu* does not excite the first bending mode."
    return Picture("blind-direction", caption, (panel,), 1)
