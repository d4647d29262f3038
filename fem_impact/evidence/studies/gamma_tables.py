"""Tables of the gamma study."""

from __future__ import annotations

from collections.abc import Sequence

from fem_impact.evidence.studies.gamma_findings import Curves
from fem_impact.evidence.studies.gamma_points import FORCE, RESTITUTION, VIBRATION, Point, among
from fem_impact.evidence.studies.rods import PAPER_RODS, STATES, Drop
from fem_impact.outcome.keys import known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import shares
from fem_impact.tables.table import Cell, Table
from fem_impact.tables.text import rounded_up

KINDS = {False: "elastic", True: "yielding"}
BANDED = (VIBRATION, RESTITUTION, "mu", "Omega_rad_per_s", FORCE)
SHARES = tuple(share.key.name for share in shares("figure") if share.key.name != VIBRATION)
INPUTS = ("point", "gamma", "diameter_m", "length_m", "speed_m_per_s", "angle_deg", "f", "contact", "law")


def rod_table(curves: Curves) -> Table:
    """Return one row per paper's rod, kind of contact and surface state."""
    rows: list[list[Cell]] = []
    for rod, length in PAPER_RODS.items():
        for yields, kind in KINDS.items():
            for state, f in STATES.items():
                for point in among(curves.line, length=length, friction=f, yields=yields):
                    rows.append([rod, kind, state, *_rod_cells(point, curves.reduced_vibration(point.drop))])
    head = (
        "rod",
        "contact",
        "surface",
        "E_vib/E_0, %",
        "e",
        "e if rigid",
        "contacts",
        "peak force, kN",
        "T1/tau",
    )
    return Table.of((*head, "E_vib/E_0 by modes, %"), rows)


def _rod_cells(point: Point, reduced: float | None) -> list[Cell]:
    return [
        _with_band(point, VIBRATION, 100.0, 2),
        _with_band(point, RESTITUTION, 1.0, 3),
        point.e_rigid,
        len(point.contacts) or None,
        _with_band(point, FORCE, 1e-3, 1),
        point.ratio,
        None if reduced is None else 100 * reduced,
    ]


def _with_band(point: Point, key: str, scale: float, places: int) -> str | None:
    value, band = point.value(key), point.band(key)
    if value is None:
        return None
    return f"{scale * value:.{places}f}" + ("" if band is None else f" ± {rounded_up(scale * band, places)}")


def gap_table(points: Sequence[Point]) -> Table:
    """Return one row per point without a value or a band of vibration, with the reason."""
    return Table.of((*INPUTS, "reason"), [[*_inputs(p.name, p.drop), p.gap] for p in points])


def point_table(points: Sequence[Point]) -> Table:
    """Return one row per point: inputs, limits with bands, shares, contacts, T1/tau, reason of a gap."""
    head = [column for key in BANDED for column in (key, f"{key}_band")]
    more = (
        "E_vib_over_E_0_own_mesh",
        "E_vib_over_E_0_first_contact",
        "tip_size_m",
        "contacts",
        "T1_s",
        "tau_s",
    )
    last = ("T1_over_tau", "e_edge_rigid", "residual_over_E_0", "band_as_wanted", "reason")
    return Table.of((*INPUTS, *head, *SHARES, *more, *last), [_point_cells(point) for point in points])


def _point_cells(point: Point) -> list[Cell]:
    run = point.run if isinstance(point.run, Outcome) else None
    banded = [cell for key in BANDED for cell in (point.value(key), point.band(key))]
    return [
        *_inputs(point.name, point.drop),
        *banded,
        *(point.value(key) for key in SHARES),
        *(point.own, point.first, known(run.cost.tip_size) if run else None, len(point.contacts) or None),
        *(point.drop.first_period, point.tau, point.ratio, point.e_rigid),
        *(run.energy.residual if run else None, "yes" if point.close else "no", point.gap),
    ]


def contact_table(points: Sequence[Point]) -> Table:
    """Return one row per contact of every point, of its finest mesh."""
    rows: list[list[Cell]] = [
        [p.name, p.drop.gamma, at, one.start, one.end, one.impulse_n, one.impulse_t]
        for p in points
        for at, one in enumerate(p.contacts, 1)
    ]
    head = ("point", "gamma", "contact", "start_s", "end_s", "impulse_n_Ns", "impulse_t_Ns")
    return Table.of(head, rows)


def reduced_table(curves: Curves) -> Table:
    """Return one row per drop of the modal fidelity."""
    rows: list[list[Cell]] = []
    for drop, run in curves.reduced:
        values: list[Cell] = [None, None]
        if isinstance(run, Outcome):
            values = [or_none(run.energy.vibration), or_none(run.restitution.edge.e)]
        rows.append([*_inputs(drop.name, drop), *values])
    return Table.of((*INPUTS, VIBRATION, RESTITUTION), rows)


def _inputs(name: str, drop: Drop) -> list[Cell]:
    numbers = (drop.gamma, drop.diameter, drop.length, drop.speed, drop.angle, drop.friction)
    return [name, *numbers, KINDS[drop.yields], drop.law]
