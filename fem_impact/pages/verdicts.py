"""Verdicts on the paper's conclusions, each with its figure, and the replay of the camera's markers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.pages.html import Markup, join, paragraph, place, section, table
from fem_impact.pages.page import download, figure
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.tables.table import Cell, Table
from fem_impact.tables.text import plain
from rigid.experiments import measured_set

MOMENTS = (KEY_TABLE["e_m_paper"], KEY_TABLE["e_m_edge"], KEY_TABLE["e_m_impulse"])
MARKED = {"V_n": "m/s", "V_t": "m/s", "Omega": "rad/s"}
"""Quantities that the two markers measure, by attribute of `motion` and `contact.markers`, and units."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Verdict on a conclusion of the paper: name of the figure, sentence, and the figure's panel."""

    name: str
    sentence: str
    panel: Panel


def verdicts(rows: Sequence[Outcome]) -> list[Verdict]:
    """Return the verdicts on closure, e_m, mu_c as a bound and E_lt as heat, from outcomes of the sets.

    They are about the paper's own sets: scenes of other tests are left out.
    """
    rows = [row for row in rows if row.provenance.scene_id in MEASURED_SETS]
    rows = [row for row in rows if not isinstance(row.restitution.paper.e_m, Unknown)]
    return [part(rows) for part in (_closure, _moment, _critical, _heat)] if rows else []


def verdict_section(judged: Sequence[Verdict], figures: Path) -> Markup:
    """Return the verdicts with their figures, drawn into a folder."""
    title = "What the paper concluded, what stands and what does not"
    return section(title, *(_shown(verdict, figures) for verdict in judged))


def _shown(verdict: Verdict, figures: Path) -> Markup:
    name = verdict.name
    drawn = figure(Picture(name, verdict.panel.title, (verdict.panel,), 1), figures)
    data = download(figures / f"{name}.csv", "its data")
    return join([paragraph(verdict.sentence), place(name, drawn), data])


def _closure(rows: Sequence[Outcome]) -> Verdict:
    lost = [100 * known(row.energy.vibration) for row in rows]
    paper = [row.restitution.paper for row in rows]
    kept = [known(row.energy.rigid) for row in rows]
    gap = [100 * (known(p.E_ln) + known(p.E_lt) + k - 1) for p, k in zip(paper, kept, strict=True)]
    identity = [100 * _spin(row) * (1 + 1 / known(row.restitution.paper.e_m)) for row in rows]
    sentence = (
        "Does not stand: that losses and retained energy add up to E_0 was read as a sign that they hold all "
        "losses. The sum differs from E_0 by (I Omega^2/2)(1 + 1/e_m) whatever the rod lost: over the "
        f"{len(rows)} computed sets it misses E_0 by {min(map(abs, gap)):.1g} to "
        f"{plain(max(map(abs, gap)), 2)} % and that expression by at most {_apart(gap, identity):.1g} %, "
        f"while vibration took {min(lost):.2g} to {max(lost):.2g} %."
    )
    series = (
        Series("E_ln + E_lt + E_r - E_0", range(len(rows)), gap, "points"),
        Series("(I Omega^2/2)(1 + 1/e_m)", range(len(rows)), identity, "rings"),
        Series("vibration", range(len(rows)), lost, "points"),
    )
    panel = Panel("The paper's energy terms, less E_0", "set", "% of E_0", series, names=_names(rows))
    return Verdict("closure", sentence, panel)


def _apart(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the largest absolute difference."""
    return float(np.abs(np.subtract(a, b)).max())


def _spin(row: Outcome) -> float:
    """Return I Omega^2/2 after the impact, fraction of E_0."""
    m = row.motion
    return 0.5 * m.mass * m.k_squared * known(m.Omega) ** 2 / row.energy.E_0


def _moment(rows: Sequence[Outcome]) -> Verdict:
    angle = np.degrees([row.motion.alpha for row in rows])
    paper, edge, impulse = ([known(key.of(row)) for row in rows] for key in MOMENTS)
    named = {"the paper's arms": paper, "arms of the edge": edge, "centre of the impulse": impulse}
    series = tuple(Series(label, angle, e_m, "points") for label, e_m in named.items())
    spread = [abs(a - b) for a, b in zip(paper, edge, strict=True)]
    sentence = (
        "Does not stand as physics: e_m moves with the contact point that is assumed. The same computed "
        f"motion gives values up to {max(spread):.2g} apart with the paper's arms and those of the edge, and "
        "-1 at the centre of the impulse."
    )
    return Verdict("moment", sentence, Panel("e_m against angle", "angle, degrees", "e_m", series))


def _critical(rows: Sequence[Outcome]) -> Verdict:
    measured = [measured_set(row.provenance.scene_id).statistics()["mu"].mean for row in rows]
    at = range(len(rows))
    series = (
        Series("measured mu", at, measured, "rings"),
        Series("computed mu", at, [known(row.restitution.mu) for row in rows], "points"),
        Series("mu_c", at, [known(row.restitution.mu_c) for row in rows], "points"),
    )
    ratios = [row.restitution for row in rows]
    most = [max(mu, known(r.mu)) / known(r.mu_c) for r, mu in zip(ratios, measured, strict=True)]
    above = [name for name, ratio in zip(_names(rows), most, strict=True) if ratio > 1.02]
    sentence = (
        "Stands with a limit: mu_c is the ratio at which the tip stops without turning back, and no upper "
        f"bound. It is exceeded by more than 2 %, measured or computed, in {', '.join(above) or 'no set'}."
    )
    panel = Panel("Impulse ratio and mu_c", "set", "mu", series, names=_names(rows))
    return Verdict("critical", sentence, panel)


def _heat(rows: Sequence[Outcome]) -> Verdict:
    at = range(len(rows))
    tangential = [100 * known(row.restitution.paper.E_lt) for row in rows]
    rubbed = [100 * known(row.energy.friction) for row in rows]
    series = (
        Series("E_lt, rigid theory", at, tangential, "rings"),
        Series("friction work", at, rubbed, "points"),
        Series("vibration", at, [100 * known(row.energy.vibration) for row in rows], "points"),
    )
    ratio = [100 * r / t for r, t in zip(rubbed, tangential, strict=True) if t > 0]
    sentence = (
        "Does not stand: E_lt is not the energy that can heat the contact. Friction, which can, takes "
        f"{min(rubbed):.2g} to {max(rubbed):.2g} % of E_0 and {min(ratio):.0f} to {max(ratio):.0f} % of "
        "E_lt; what is left of E_lt is plastic flow and vibration."
    )
    panel = Panel("E_lt and friction work", "set", "% of E_0", series, names=_names(rows))
    return Verdict("heat", sentence, panel)


def _names(rows: Sequence[Outcome]) -> tuple[str, ...]:
    return tuple(row.provenance.scene_id for row in rows)


def marker_section(rows: Sequence[Outcome]) -> Markup:
    """Return the table of velocities by momentum sums and by two camera markers on the computed flight."""
    seen = [row for row in rows if not isinstance(row.contact.markers.V_n, Unknown)]
    shown: list[tuple[Cell, ...]] = [
        (row.provenance.scene_id, *(v for name in MARKED for v in _pair(row, name))) for row in seen
    ]
    titles = ((f"{name}, {unit}", "by markers") for name, unit in MARKED.items())
    head = ("set", *(title for pair in titles for title in pair))
    listed = table(Table.of(head, shown), compact=True)
    return section("The camera's measurement, replayed", paragraph(marker_sentence(seen)), listed)


def marker_sentence(seen: Sequence[Outcome]) -> str:
    """Return the largest differences of markers and momentum sums as a sentence, empty without markers."""
    if not seen:
        return ""
    away = {name: _apart(*zip(*(_pair(row, name) for row in seen), strict=True)) for name in MARKED}
    return (
        "Two markers over 40 frames at 10 kHz, replayed on the computed flight, give the exact momentum sums "
        f"within {away['V_n']:.2g} m/s along n, {away['V_t']:.2g} m/s along t and {away['Omega']:.2g} rad/s."
    )


def _pair(row: Outcome, name: str) -> tuple[float, float]:
    """Return a velocity by the momentum sums and by the markers."""
    return getattr(row.motion, name), known(getattr(row.contact.markers, name))
