"""What the paper concluded, what stands and what does not, each with the picture that shows it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from fem_impact.figures.lines import Panel, Series, lines_figure
from fem_impact.outcome import Outcome
from fem_impact.report.embed import download, picture
from fem_impact.report.html import Markup, join, number, paragraph, section, table
from rigid.experiments import measured_set

__all__ = ["marker_section", "verdict_section"]


def verdict_section(rows: Sequence[Outcome], figures: Path) -> Markup:
    """Return closure, trend of e_m, mu_c as a bound, and E_lt as heat, from the measured sets as computed."""
    rows = [row for row in rows if row["e_m_paper"] is not None]
    if not rows:
        return Markup("")
    parts = (_closure, _moment, _critical, _heat)
    title = "What the paper concluded, what stands and what does not"
    return section(title, *(part(rows, figures) for part in parts))


def _told(sentence: str, panel: Panel, name: str, figures: Path) -> Markup:
    drawn = picture(partial(_draw, panel), figures / name, panel.title, panel.title)
    return join([paragraph(sentence), drawn, download(figures / f"{name}.csv", "its data")])


def _draw(panel: Panel, path: Path, shape: str) -> Path:
    return lines_figure([panel], path, "wide" if shape == "wide" else "narrow", columns=1)


def _closure(rows: Sequence[Outcome], figures: Path) -> Markup:
    lost = [100 * row["E_vib_over_E_0"] for row in rows]
    gap = [100 * (_sum(row) - 1) for row in rows]
    identity = [100 * _spin(row) * (1 + 1 / row["e_m_paper"]) for row in rows]
    sentence = (
        "Does not stand: that losses and retained energy add up to E_0 was read as a sign that they hold all "
        "losses. The sum differs from E_0 by (I Omega^2/2)(1 + 1/e_m) whatever the rod lost: over the "
        f"{len(rows)} computed sets it misses E_0 by {min(map(abs, gap)):.1g} to {max(map(abs, gap)):.2g} % "
        f"and that expression by at most {_apart(gap, identity):.1g} %, "
        f"while vibration took {min(lost):.2g} to {max(lost):.2g} %."
    )
    series = (
        Series("E_ln + E_lt + E_r - E_0", range(len(rows)), gap, "points"),
        Series("(I Omega^2/2)(1 + 1/e_m)", range(len(rows)), identity, "rings"),
        Series("vibration", range(len(rows)), lost, "points"),
    )
    panel = Panel("Closure of the computed sets", _axis(rows), "% of E_0", series)
    return _told(sentence, panel, "closure", figures)


def _apart(a: Sequence[float], b: Sequence[float]) -> float:
    return float(np.abs(np.subtract(a, b)).max())


def _sum(row: Outcome) -> float:
    return float(row["E_ln_paper_over_E_0"] + row["E_lt_paper_over_E_0"] + row["E_r_over_E_0"])


def _spin(row: Outcome) -> float:
    turn = 0.5 * row["mass_kg"] * row["k_squared_m2"] * row["Omega_rad_per_s"] ** 2
    return float(turn / row["E_0_J"])


def _moment(rows: Sequence[Outcome], figures: Path) -> Markup:
    angle = np.degrees([row["alpha_rad"] for row in rows])
    names = {"paper": "the paper's arms", "edge": "arms of the edge", "impulse": "centre of the impulse"}
    series = tuple(
        Series(words, angle, [row[f"e_m_{arms}"] for row in rows], "points") for arms, words in names.items()
    )
    spread = [abs(row["e_m_paper"] - row["e_m_edge"]) for row in rows]
    sentence = (
        "Does not stand as physics: e_m moves with the contact point that is assumed. The same computed "
        f"motion gives values up to {max(spread):.2g} apart with the paper's arms and those of the edge, and "
        "-1 at the centre of the impulse."
    )
    return _told(sentence, Panel("e_m against angle", "angle, degrees", "e_m, -", series), "moment", figures)


def _critical(rows: Sequence[Outcome], figures: Path) -> Markup:
    measured = [measured_set(row["scene_id"]).statistics()["mu"].mean for row in rows]
    at = range(len(rows))
    series = (
        Series("measured mu", at, measured, "rings"),
        Series("computed mu", at, [row["mu"] for row in rows], "points"),
        Series("mu_c", at, [row["mu_c"] for row in rows], "points"),
    )
    most = [max(mu, row["mu"]) / row["mu_c"] for row, mu in zip(rows, measured, strict=True)]
    above = [row["scene_id"] for row, ratio in zip(rows, most, strict=True) if ratio > 1.02]
    sentence = (
        "Stands with a limit: mu_c is the ratio at which the tip stops without turning back, and no upper "
        f"bound. It is exceeded by more than 2 %, measured or computed, in {', '.join(above) or 'no set'}."
    )
    return _told(sentence, Panel("Impulse ratio and mu_c", _axis(rows), "mu, -", series), "critical", figures)


def _heat(rows: Sequence[Outcome], figures: Path) -> Markup:
    at = range(len(rows))
    tangential = [100 * row["E_lt_paper_over_E_0"] for row in rows]
    rubbed = [100 * row["W_friction_over_E_0"] for row in rows]
    series = (
        Series("E_lt, rigid theory", at, tangential, "rings"),
        Series("friction work", at, rubbed, "points"),
        Series("vibration", at, [100 * row["E_vib_over_E_0"] for row in rows], "points"),
    )
    ratio = [r / t for r, t in zip(rubbed, tangential, strict=True) if t > 0]
    sentence = (
        "Does not stand: E_lt is not the energy that can heat the contact. Friction takes "
        f"{min(ratio):.0%} to {max(ratio):.0%} of it; what is left of it is plastic flow and vibration."
    )
    return _told(sentence, Panel("E_lt and friction work", _axis(rows), "% of E_0", series), "heat", figures)


def _axis(rows: Sequence[Outcome]) -> str:
    return "set: " + ", ".join(f"{at} {row['scene_id']}" for at, row in enumerate(rows))


def marker_section(rows: Sequence[Outcome]) -> Markup:
    """Return the camera's two markers, replayed on the computed flight, beside the exact momentum sums."""
    names = ("V_n_m_per_s", "V_t_m_per_s", "Omega_rad_per_s")
    shown = [
        [row["scene_id"], *(number(row[key]) for name in names for key in (name, f"marker_{name}"))]
        for row in rows
        if row["marker_V_n_m_per_s"] is not None
    ]
    head = ("set", *(words for name in names for words in (name, "by markers")))
    listed = table(head, shown, numbers=range(1, 7), compact=True)
    return section("The camera's measurement, replayed", listed)
