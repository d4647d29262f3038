"""Static elastic give of a rod with a yielding tip: restitution, findings, picture and table.

The rod's modes act as springs without inertia: they take up energy as the contact force rises and return it
as it falls, so that less is left for plastic flow. The furrow is pressed in along the normal here: that holds
for upright rods, whose tip slides little while it is pressed in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from fem_impact.answers.report import Sheet
from fem_impact.case.case import Case
from fem_impact.evidence.studies.criterion_measure import Rod, Rods, of_body
from fem_impact.evidence.studies.rods import PAPER_RODS, Drop
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.modal.furrow import indent
from fem_impact.modal.impact import reach
from fem_impact.modal.rod import modal_rod
from fem_impact.physics.contact_law import contact_law
from fem_impact.physics.flow_law import flow_law
from fem_impact.tables.table import Cell, Table

SHORT = 14.5  # gamma, m^-0.3815: below it vibration takes less than 0.5 % of E_0 at any angle
STEEPEST = 20.0  # degrees: beyond it the tip drags its furrow, which this reckoning leaves out
SHOWN = (1.0, 5.0, 20.0)  # degrees: angles in the picture
Gives = Sequence[tuple[Rod, NDArray[np.float64]]]
"""Rods, each with its e (n,) by quasi-static bending alone at the rod's n angles."""


def gives_of(rods: Rods) -> Gives:
    """Return the 19 mm rods by slenderness up to `STEEPEST`, and their e by quasi-static bending alone."""
    upright = [_upright(rod) for rod in of_body(rods)]
    return [
        (r, np.array([static_restitution(replace(r.drop, angle=float(a))) for a in r.angles]))
        for r in upright
    ]


def _upright(rod: Rod) -> Rod:
    held = rod.angles <= STEEPEST
    parts = {key: getattr(rod, key)[held] for key in ("angles", "e", "e_rigid", "groups", "bands")}
    return replace(rod, **parts)


def give_picture(gives: Gives) -> Picture:
    """Return e of the vibrating rod, by quasi-static bending alone, and of the rigid rod, at three angles."""
    gamma, panels = [rod.drop.gamma for rod, _ in gives], []
    for angle in SHOWN:
        at = [int(np.abs(rod.angles - angle).argmin()) for rod, _ in gives]
        curves = [(r.e[i], e[i], r.e_rigid[i]) for (r, e), i in zip(gives, at, strict=True)]
        vibrating, static, rigid = zip(*curves, strict=True)
        series = (
            Series("vibrating", gamma, vibrating, "points"),
            Series("quasi-static bending alone", gamma, static, "line"),
            Series("rigid", gamma, rigid, "dashed"),
        )
        panels.append(Panel(f"{gives[0][0].angles[at[0]]:g} degrees", "gamma, m^-0.3815", "e", series))
    caption = "Yielding tip, frictionless, 19 mm: what the rod stores elastically never reaches the contact."
    return Picture("static-give", caption, tuple(panels), 3)


def give_sentences(gives: Gives) -> list[str]:
    """Return the change of e of short rods, and e of the paper's rods; nothing without short rods."""
    short = [(r, e) for r, e in gives if r.drop.gamma < SHORT]
    if not short:
        return []
    error = max(r.error for r, _ in short)
    left = max(float(np.abs(r.e - e).max()) for r, e in short)
    values = []
    for name, length in PAPER_RODS.items():
        rod, give = next((r, e) for r, e in gives if r.drop.length == length)
        at = int(np.abs(rod.angles - 5.0).argmin())
        values.append(
            f"{name} rod: rigid {rod.e_rigid[at]:.2f}, bending {give[at]:.2f}, vibrating {rod.e[at]:.2f}"
        )
    return [
        f"Yielding, frictionless, up to {STEEPEST:g} degrees: below gamma {SHORT:g} e changes by up to "
        f"{error:.3f} without a loss to vibration. A rod that deforms elastically stores part of the energy "
        "and returns it, so that less is left for plastic flow and e is larger than that of a rigid rod. "
        f"This quasi-static bending alone gives e within {left:.3f}. Long rods vibrate instead; e at "
        f"{rod.angles[at]:g} degrees: {'; '.join(values)}.",
    ]


def give_sheet(gives: Gives) -> Sheet:
    """Return the table of e of every rod and angle: rigid, by quasi-static bending, vibrating."""
    rows: list[list[Cell]] = [
        [r.drop.gamma, float(a), float(stiff), float(slow), float(e)]
        for r, give in gives
        for a, stiff, slow, e in zip(r.angles, r.e_rigid, give, r.e, strict=True)
    ]
    head = ("gamma", "angle_deg", "e_rigid", "e_static_give", "e_vibrating")
    caption = "Yielding tip, frictionless, 19 mm: e of a rigid rod, with quasi-static bending, with vibration"
    return Sheet("static_give", caption, Table.of(head, rows), shown=False)


def static_restitution(drop: Drop) -> float:
    """Return e of a frictionless drop whose rod deforms elastically but is left without vibration.

    Impact energy = plastic and elastic work of the contact + F^2/2 times the flexibility of the rod's modes.
    """
    planned = Case.of(drop.scene(), "modal")
    scene, rod = planned.scene, modal_rod(planned.bodies)
    law = flow_law(planned.contact, planned.slots.rod_law, planned.slots.barrier_law)
    mass = rod.mass / (1 + rod.centre_t**2 / rod.k2)
    energy = 0.5 * mass * scene.impact.v_n**2
    flexibility = float((rod.along_n**2 / rod.omega**2).sum())
    widest = reach(contact_law(planned.contact), law, energy)
    return sqrt(1 - indent(law, widest, flexibility, energy)[2] / energy)
