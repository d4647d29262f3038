"""What the gamma study says: how much vibrates, where that peaks and why it falls, what the limit says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fem_impact.evidence.studies.gamma_points import CLOSE, LEAST, VIBRATION, Point, among
from fem_impact.evidence.studies.rods import PAPER_RODS, STATES, Drop
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.tables.text import rounded_up
from rigid import LIMIT

PLAIN = {False: "frictionless", True: "machined"}
"""Surface state, elastic and yielding, at which other inputs are changed and the partition is drawn."""

ONE_PERCENT = 0.01  # of E_0: beyond it vibration counts as large
ALIKE = 0.1  # m^-0.3815, difference of gammas that are called one


@dataclass(frozen=True, slots=True)
class Curves:
    """Points of the curve, of other inputs, of measured sets; drops of the modal fidelity, with results."""

    line: Sequence[Point]
    others: Sequence[Point]
    sets: Sequence[Point]
    reduced: Sequence[tuple[Drop, Outcome | Failure | None]]

    def reduced_vibration(self, drop: Drop) -> float | None:
        """Return E_vib/E_0 of a drop by modes, None where that is not known."""
        run = next((run for one, run in self.reduced if one == drop), None)
        return or_none(run.energy.vibration) if isinstance(run, Outcome) else None


def plain_line(curves: Curves, yields: bool) -> list[Point]:
    """Return the points of the curve in the state of `PLAIN`, by slenderness."""
    return among(curves.line, friction=STATES[PLAIN[yields]], yields=yields)


def findings(curves: Curves) -> list[str]:
    """Return the sentences of the study."""
    sentences = [
        *(how_much(curves, yields) for yields in (True, False)),
        *(where_it_peaks(curves, yields) for yields in (True, False)),
        what_the_limit_says(curves),
        *(other_inputs(curves, yields) for yields in (True, False)),
        measured_sets(curves),
        *(beside_modes(curves, yields) for yields in (True, False)),
        how_sure([*curves.line, *curves.others, *curves.sets]),
    ]
    return [sentence for sentence in sentences if sentence]


def how_much(curves: Curves, yields: bool) -> str:
    """Return vibration of the paper's rods, in the surface state of `PLAIN`."""
    kind, state = "A yielding" if yields else "An elastic", PLAIN[yields]
    known = {p.drop.length: share(p) for p in plain_line(curves, yields) if p.value(VIBRATION) is not None}
    rods = [f"{known[length]} ({rod} rod)" for rod, length in PAPER_RODS.items() if length in known]
    where = f"({state}, 45 degrees, 2.1 m/s)"
    return f"{kind} tip {where} leaves as vibration, of E_0: {', '.join(rods)}." if rods else ""


def where_it_peaks(curves: Curves, yields: bool) -> str:
    """Return the slenderness of most vibration, and what makes it fall beyond."""
    points = [p for p in plain_line(curves, yields) if p.value(VIBRATION) is not None and p.own is not None]
    if len(points) < 2:
        return ""
    top = max(points, key=_value)
    after = points[points.index(top) + 1 :]
    said = f"{'Yielding' if yields else 'Elastic'}, {PLAIN[yields]}: vibration is largest at gamma "
    said += f"{top.drop.gamma:.0f} with {share(top)} of E_0"
    if not after:
        return f"{said}, the longest rod."
    low, last = min(after, key=_value), after[-1]
    if _value(top) - _value(low) <= (top.band(VIBRATION) or 0.0) + (low.band(VIBRATION) or 0.0):
        return f"{said}; beyond it stays within the bands (least {share(low)} at gamma {low.drop.gamma:.0f})."
    again = f" At gamma {last.drop.gamma:.0f} it is {share(last)}." if last is not low else ""
    return f"{said}; it falls {_fall(top, low)}{again}"


def _fall(top: Point, low: Point) -> str:
    """Return how far vibration falls, and which part of that later contacts make."""
    first, fall = low.own if low.first is None else low.first, _value(top) - _value(low)
    back = (first or 0.0) - (low.own or 0.0)
    mostly = "later contacts give energy back" if back > fall / 2 else "the first contact itself leaves less"
    return (
        f"to {share(low)} at gamma {low.drop.gamma:.0f}, mostly because {mostly}: the first contact leaves "
        f"{100 * (first or 0.0):.2g} % there, {'later contacts change that by ' if back else 'no later one '}"
        + (f"{-100 * back:+.2g} % of E_0." if back else "follows.")
    )


def what_the_limit_says(curves: Curves) -> str:
    """Return vibration and e at the limit of Eq 29, and where vibration passes `ONE_PERCENT`."""
    told = []
    for yields in (True, False):
        points = plain_line(curves, yields)
        at = next(
            (p for p in points if abs(p.drop.gamma - LIMIT) < 1e-6 and p.value(VIBRATION) is not None), None
        )
        if at is not None:
            kind = f"{'yielding' if yields else 'elastic'}, {PLAIN[yields]}"
            told.append(f"{kind}: vibration there takes {share(at)} of E_0{_change(at)}; {_passes(points)}")
    rods = [name for name, length in PAPER_RODS.items() if Drop(length).gamma <= LIMIT]
    called = f"gamma <= {LIMIT} calls the {', '.join(rods)} rod rigid and the longer ones not"
    return f"The limit {called}. {'. '.join(one[0].upper() + one[1:] for one in told)}." if told else ""


def _change(point: Point) -> str:
    e = point.value("e_edge")
    if e is None or point.e_rigid is None:
        return ""
    return f" and e is {e:.3f} where a rod that cannot vibrate has {point.e_rigid:.3f}"


def _passes(points: Sequence[Point]) -> str:
    """Return from which slenderness on vibration takes more than `ONE_PERCENT`, by linear interpolation."""
    known = [(p.drop.gamma, v) for p in points if (v := p.value(VIBRATION)) is not None]
    if known[0][1] > ONE_PERCENT:
        return (
            f"it takes more than {ONE_PERCENT:.0%} of E_0 from gamma {known[0][0]:.0f} on, the shortest rod"
        )
    for (low, below), (high, above) in pairwise(known):
        if above > ONE_PERCENT:
            gamma = low + (high - low) * (ONE_PERCENT - below) / (above - below)
            return f"it passes {ONE_PERCENT:.0%} of E_0 at gamma {gamma:.1f}"
    return f"it never reaches {ONE_PERCENT:.0%} of E_0"


def other_inputs(curves: Curves, yields: bool) -> str:
    """Return vibration of rods as slender as the longest of the paper with one input changed."""
    usual = Drop(max(PAPER_RODS.values()), friction=STATES[PLAIN[yields]], yields=yields)
    alike = [
        f"{_changed(p.drop, usual)} {share(p)}"
        for p in curves.others
        if p.drop.yields == yields
        and abs(p.drop.gamma - usual.gamma) < ALIKE
        and p.value(VIBRATION) is not None
    ]
    curve = [
        share(p) for p in among(curves.line, length=usual.length, friction=usual.friction, yields=yields)
    ]
    if not alike or not curve:
        return ""
    kind = f"{'yielding' if yields else 'elastic'}, {PLAIN[yields]}"
    return (
        f"Other inputs at gamma {usual.gamma:.0f}, {kind}: vibration is {curve[0]} of E_0 on the curve "
        f"({usual.diameter * 1e3:g} mm, {usual.speed:g} m/s, {usual.angle:g} degrees), and with "
        f"{', '.join(alike)}."
    )


def _changed(drop: Drop, usual: Drop) -> str:
    """Return the input of a drop that is not the usual one."""
    if drop.law != usual.law:
        return f"strength from {drop.law}"
    if drop.angle != usual.angle:
        return f"{drop.angle:g} degrees"
    return f"{drop.speed:g} m/s" if drop.speed != usual.speed else f"{drop.diameter * 1e3:g} mm"


def measured_sets(curves: Curves) -> str:
    """Return vibration of the measured sets' own scenes."""
    told = [
        f"{p.name} (gamma {p.drop.gamma:.1f}, {p.drop.speed:.2f} m/s) {share(p)}"
        for p in curves.sets
        if p.value(VIBRATION) is not None
    ]
    return f"The measured sets' own scenes keep as vibration, of E_0: {', '.join(told)}." if told else ""


def beside_modes(curves: Curves, yields: bool) -> str:
    """Return how far the modal fidelity lies from the points of the curve."""
    pairs = [
        (curves.reduced_vibration(p.drop), p.value(VIBRATION)) for p in curves.line if p.drop.yields == yields
    ]
    away = [modal - solid for modal, solid in pairs if modal is not None and solid is not None]
    if not away:
        return ""
    return (
        f"{'Yielding' if yields else 'Elastic'} tips: vibration by modes less by finite elements, of E_0: "
        f"root mean square {100 * np.linalg.norm(away) / len(away) ** 0.5:.2g} %, largest "
        f"{100 * max(away, key=abs):+.2g} %, over {len(away)} points of the curve."
    )


def how_sure(points: Sequence[Point]) -> str:
    """Return how many points have a band as narrow as wanted, and how many are gaps."""
    close, gaps = sum(p.close for p in points), sum(bool(p.gap) for p in points)
    doubted = sum(p.close and p.doubted for p in points)
    residuals = [abs(p.run.energy.residual) for p in points if isinstance(p.run, Outcome)]
    return (
        f"Two meshes give vibration of {close} of {len(points)} points within {CLOSE:.0%} of itself or "
        f"{LEAST:g} of E_0; in {doubted} of them its two counts, by modes and without them, differ by more. "
        f"{gaps} points have no value or no band. The largest residual of their ledgers is "
        f"{max(residuals, default=0.0):.1g} of E_0."
    )


def share(point: Point) -> str:
    """Return vibration of a point with its band, rounded up to 0.01, in per cent."""
    value, band = 100 * _value(point), point.band(VIBRATION)
    if band is None:
        return f"{value:.2g} %"
    if value < 0.0:
        return f"less than {value + 100 * band:.2f} %"
    return f"{value:.2f} ± {rounded_up(100 * band, 2)} %"


def _value(point: Point) -> float:
    return point.value(VIBRATION) or 0.0
