"""The audit of the paper's tables as one document: summary, constants used, disagreements, scatter."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from fem_impact.errors import UsageError, did_you_mean
from fem_impact.paper.numbers import estimate_entry, statistic_entry
from rigid import first_order
from rigid.experiments import (
    AuditRecord,
    MeasuredSet,
    audit,
    audit_statistics,
    column_arms,
    correlations,
    measured_set,
    set_ids,
)

__all__ = ["CSV_COLUMNS", "audit_document", "csv_rows"]

COEFFICIENTS = ("e", "mu", "e_m")
SCATTER = (*COEFFICIENTS, "E_ln_over_E_0", "E_lt_over_E_0", "E_r_over_E_0")
CSV_COLUMNS = ("set", "table", "row", "column", "printed", "recomputed", "tolerance", "agrees", "explanation")


def audit_document(set_id: str | None = None) -> dict[str, Any]:
    """Audit every printed number of Tables 2 to 6, or of one measured set.

    Parameters
    ----------
    set_id : str, optional
        Such as ``"t5b"``; all thirteen sets unless given.

    Returns
    -------
    dict
        Plain JSON: summary, columns (numbers checked and agreeing), constants of each set, disagreements
        with explanations, scatter of each set, and `records` with every number.

    Raises
    ------
    UsageError
        There is no such set.
    """
    ids = (_checked(set_id),) if set_id else set_ids()
    records = [r for r in (*audit(), *audit_statistics()) if r.set_id in ids]
    sets = [measured_set(name) for name in ids]
    return {
        "summary": _summary(records),
        "columns": list(_columns(records)),
        "constants": [_constants(s) for s in sets],
        "disagreements": list(_disagreements(records)),
        "scatter": [_scatter(s) for s in sets],
        "records": [_entry(r) for r in records],
    }


def csv_rows(document: dict[str, Any]) -> Iterator[list[Any]]:
    """Yield every audited number in the order of `CSV_COLUMNS`."""
    for record in document["records"]:
        cells = [record[name] for name in CSV_COLUMNS]
        yield [str(cell).lower() if isinstance(cell, bool) else cell for cell in cells]


def _checked(set_id: str) -> str:
    if set_id in set_ids():
        return set_id
    remedy = did_you_mean(set_id, set_ids(), f"Measured: {', '.join(set_ids())}.")
    raise UsageError("is not a measured set.", key="--set", value=set_id, remedy=remedy)


def _summary(records: Sequence[AuditRecord]) -> dict[str, int]:
    apart = [r for r in records if not r.agrees]
    markers = sum(_is_marker(r) for r in apart)
    return {
        "numbers": len(records),
        "agree": len(records) - len(apart),
        "marker_velocities_apart": markers,
        "others_apart": len(apart) - markers,
        "unexplained": sum(not r.explanation for r in apart),
    }


def _is_marker(r: AuditRecord) -> bool:
    """Tell whether this is a tip velocity of a single test (they belong to a marker, not to the contact)."""
    return r.column in ("V_cn", "V_ct") and r.row not in ("mean", "sd")


def _columns(records: Sequence[AuditRecord]) -> Iterator[dict[str, Any]]:
    for which, wanted in (("rows", False), ("mean and SD lines", True)):
        kept = [r for r in records if (r.row in ("mean", "sd")) is wanted]
        for name in dict.fromkeys(r.column for r in kept):
            group = [r for r in kept if r.column == name]
            agree = sum(r.agrees for r in group)
            yield {"lines": which, "column": name, "numbers": len(group), "agree": agree}


def _constants(s: MeasuredSet) -> dict[str, Any]:
    """Give what a set's columns were worked out with."""
    return {
        "set": s.id,
        "table": s.table,
        "d_c_m": float(s.arms.d_c),
        "d_d_m": float(s.arms.d_d),
        "mass_kg": s.mass,
        "k_squared_m2": s.k2,
        "other_d_c_m": dict(column_arms(s.id)),
        "reconstructed": s.reconstructed,
    }


def _disagreements(records: Iterable[AuditRecord]) -> Iterator[dict[str, Any]]:
    """Give what is apart: singly, but the marker's velocities as one entry a set and column."""
    apart = [r for r in records if not r.agrees]
    for r in apart:
        if not _is_marker(r):
            yield _entry(r)
    markers = [r for r in apart if _is_marker(r)]
    for key in dict.fromkeys((r.set_id, r.column) for r in markers):
        group = [r for r in markers if (r.set_id, r.column) == key]
        worst = max(group, key=lambda r: abs(r.printed - r.recomputed))
        yield {**_entry(worst), "row": f"{len(group)} rows, worst {worst.row}"}


def _entry(r: AuditRecord) -> dict[str, Any]:
    values = (
        r.set_id,
        r.table,
        r.row,
        r.column,
        r.printed,
        r.recomputed,
        r.tolerance,
        r.agrees,
        r.explanation,
    )
    return dict(zip(CSV_COLUMNS, values, strict=True))


def _scatter(s: MeasuredSet) -> dict[str, Any]:
    """Give scatter, error bar of e_m and correlations of one set."""
    found = s.statistics()
    arms: dict[str, Any] = {"d_c": float(s.arms.d_c), "d_d": float(s.arms.d_d), "k2": s.k2}
    rows = s.recomputed()
    pairs = correlations({name: rows[name] for name in COEFFICIENTS})
    return {
        "set": s.id,
        **{name: statistic_entry(found[name]) for name in SCATTER},
        "e_m_of_mean": estimate_entry(first_order(s.motion, **arms)["e_m"]),
        "correlations": [
            {"pair": f"{a}, {b}", "r": c.r, "low": c.low, "high": c.high, "p": c.p}
            for (a, b), c in pairs.items()
        ],
    }
