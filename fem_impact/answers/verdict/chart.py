"""The design chart: change of e and energy of vibration over T1/tau and mu, with the point of a verdict.

The points were computed once by the reduced model (``tests/benchmarks/design_chart.py``). They do not fall on
one curve: `collapse` says by how much points of like T1/tau and mu differ.
"""

import csv
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from itertools import pairwise

import numpy as np

from fem_impact.answers.verdict.assess import Verdict
from fem_impact.arrays import Array
from fem_impact.figures.panels import Mark, Panel, Picture, Series
from fem_impact.outcome.keys import or_none

TABLE = "design-chart.csv"
COLUMNS = (
    *("contact", "material", "diameter_m", "gamma_per_m0_3815", "angle_deg", "f"),
    *("T1_over_tau", "mu", "change_of_e", "E_vib_over_E_0"),
)
STEPS = (0.1, 0.3, 0.5)
"""Impulse ratios mu between the colours of the chart."""
NEAR_RATIO, NEAR_MU = 1.15, 0.05
"""ChartPoints are alike whose T1/tau lie within a factor and whose mu within a distance."""
LEAST_NEAR = 5


@dataclass(frozen=True, slots=True)
class ChartPoints:
    """Points of the chart, each array (n,): T1/tau, mu, change of e, E_vib over E_0; whether both yield."""

    made: str
    ratio: Array
    mu: Array
    change: Array
    E_vib: Array
    yielding: Array

    def where(self, chosen: Array) -> "ChartPoints":
        """Return some of the points."""
        columns = (self.ratio, self.mu, self.change, self.E_vib, self.yielding)
        return ChartPoints(self.made, *(column[chosen] for column in columns))


@dataclass(frozen=True, slots=True)
class Collapse:
    """How well T1/tau and mu alone tell a quantity.

    Attributes
    ----------
    compared : points that have others of like T1/tau and mu
    within, among : nine tenths of these lie within so much of the median of their like, and of all points
    """

    compared: int
    within: float
    among: float


@cache
def points() -> ChartPoints:
    """Return the stored points."""
    table = files("fem_impact.answers.verdict").joinpath("data", TABLE)
    header, _, text = table.read_text(encoding="utf-8").partition("\n")
    rows = list(csv.DictReader(text.splitlines()))
    ratio, mu, change, E_vib = (np.array([float(row[name]) for row in rows]) for name in COLUMNS[-4:])
    yielding = np.array([row["contact"] == "yielding" for row in rows])
    return ChartPoints(header.removeprefix("# "), ratio, mu, change, E_vib, yielding)


def collapse(some: ChartPoints, values: Array) -> Collapse:
    """Return by how much points of like T1/tau and mu differ in ``values`` (n,)."""
    away = []
    for i in range(len(values)):
        like = np.abs(np.log(some.ratio / some.ratio[i])) <= np.log(NEAR_RATIO)
        like &= np.abs(some.mu - some.mu[i]) <= NEAR_MU
        if like.sum() > LEAST_NEAR:
            away.append(abs(values[i] - np.median(values[like])))
    among = np.quantile(np.abs(values - np.median(values)), 0.9)
    return Collapse(len(away), float(np.quantile(away, 0.9)), float(among))


def chart(verdict: Verdict) -> Picture | None:
    """Return the chart of contacts like the verdict's, yielding or elastic, with its point; None of none."""
    if verdict.here is None:
        return None
    effect, free = verdict.here, verdict.here.free
    yields = bool({"rod-plasticity", "barrier-elastoplastic"} & set(free.provenance.effects))
    some = points().where(points().yielding == yields)
    mu = or_none(free.restitution.mu)
    label = f"this scene, mu {'not known' if mu is None else f'{mu:.2f}'}"
    ratio = np.array([verdict.screening.ratio])
    e, tolerance = (np.abs(some.change), abs(effect.value), effect.band), verdict.tolerance
    vibration = some.E_vib, effect.E_vib, effect.E_vib_band
    marks = (Mark(tolerance, f"allowed: {tolerance:g}"),)
    panels = [_panel("energy of vibration over E_0", some, vibration, label, ratio)]
    if effect.of == "e":  # the other rods' changes of other numbers are not stored
        panels.insert(0, _panel("size of the change of e", some, e, label, ratio, marks))
    return Picture("design-chart", caption(some, "yielding" if yields else "elastic"), tuple(panels))


def _panel(
    label: str,
    some: ChartPoints,
    values: tuple[Array, float, float],
    named: str,
    ratio: Array,
    levels: tuple[Mark, ...] = (),
) -> Panel:
    """Return a quantity over T1/tau, points coloured by mu.

    ``values`` are those of the points (n,), of the verdict, and its band.
    """
    of_points, value, band = values
    series = []
    for at, (low, high) in enumerate(pairwise((0.0, *STEPS, np.inf))):
        chosen = (np.abs(some.mu) >= low) & (np.abs(some.mu) < high)
        words = f"mu {low:g} to {high:g}" if high < np.inf else f"mu from {low:g}"
        series.append(Series(words, some.ratio[chosen], of_points[chosen], "points", at))
    half = np.array([band if band < np.inf else np.nan])  # none is drawn of an error that is not known
    point = Series(named, ratio, np.array([value]), "diamonds", "ink", half)
    marks = (Mark(float(ratio[0]), "this scene"),)  # its point lies among many
    return Panel("", "T1/tau, bending period over contact time", label, (*series, point), marks, levels)


def caption(some: ChartPoints, kind: str) -> str:
    """Return what the chart shows, where it comes from and how far it can be read off."""
    e, vibration = collapse(some, np.abs(some.change)), collapse(some, some.E_vib)
    return (
        f"{len(some.ratio)} rods on {kind} contacts by the reduced model ({some.made}), and this scene with "
        f"its band. The points do not fall on one curve of T1/tau and mu: of {e.compared} rods that have "
        f"others of like T1/tau (factor {NEAR_RATIO:g}) and mu (within {NEAR_MU:g}), nine tenths lie within "
        f"{e.within:.2g} of the median change of e of their like (of all rods: {e.among:.2g}) and within "
        f"{vibration.within:.2g} of that of the energy of vibration (of all rods: {vibration.among:.2g})."
    )
