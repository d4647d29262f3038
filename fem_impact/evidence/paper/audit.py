"""Audit of the paper's tables: every printed number recomputed, as a plain document and as text."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from fem_impact.errors import UsageError, did_you_mean
from fem_impact.tables.table import Cell, Column, Table
from fem_impact.tables.text import wrapped
from rigid import Coefficients, Estimate, experiments, first_order

SCATTER = (*Coefficients._fields, "E_ln_over_E_0", "E_lt_over_E_0", "E_r_over_E_0")
CSV_COLUMNS = ("set", "table", "row", "column", "printed", "recomputed", "tolerance", "agrees", "explanation")

CONSTANT_COLUMNS = (
    Column("set", left=True),
    *(Column(name) for name in ("table", "d_c", "d_d", "mass", "k2")),
    Column("other_d_c", "columns with another d_c", left=True),
)

APART_COLUMNS = (
    *(Column(name, left=True) for name in ("set", "column", "row")),
    Column("printed"),
    Column("recomputed"),
    Column("tolerance", "rounding", digits=2),
)


def finite(value: Any) -> float | None:
    """Return a float, or None where it is infinite or undefined."""
    number = float(value)
    return number if math.isfinite(number) else None


def statistic_entry(estimate: experiments.Statistic) -> dict[str, Any]:
    """Return mean, SD and 95 % interval of the mean by name."""
    numbers = {name: finite(getattr(estimate, name)) for name in ("mean", "sd", "low", "high")}
    return {**numbers, "tests": estimate.n}


def estimate_entry(estimate: Estimate) -> dict[str, Any]:
    """Return value, standard uncertainty, 95 % interval and parts of the uncertainty by source."""
    numbers = {name: finite(getattr(estimate, name)) for name in ("value", "sd", "low", "high")}
    return {**numbers, "parts": {name: finite(part) for name, part in estimate.parts.items()}}


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
    if set_id and set_id not in experiments.set_ids():
        remedy = did_you_mean(set_id, experiments.set_ids(), f"Measured: {', '.join(experiments.set_ids())}.")
        raise UsageError("is not a measured set.", key="--set", value=set_id, remedy=remedy)
    ids = (set_id,) if set_id else experiments.set_ids()
    records = [r for r in (*experiments.audit(), *experiments.audit_statistics()) if r.set_id in ids]
    sets = [experiments.measured_set(name) for name in ids]
    return {
        "summary": _summary(records),
        "columns": list(_columns(records)),
        "constants": [_constants(s) for s in sets],
        "disagreements": list(_disagreements(records)),
        "scatter": [_scatter(s) for s in sets],
        "records": [_entry(r) for r in records],
    }


def records_table(document: Mapping[str, Any]) -> Table:
    """Return every audited number in the order of `CSV_COLUMNS`."""
    return Table.of(CSV_COLUMNS, document["records"])


def _summary(records: Sequence[experiments.AuditRecord]) -> dict[str, int]:
    apart = [r for r in records if not r.agrees]
    markers = sum(_is_marker(r) for r in apart)
    return {
        "numbers": len(records),
        "agree": len(records) - len(apart),
        "marker_velocities_apart": markers,
        "others_apart": len(apart) - markers,
        "unexplained": sum(not r.explanation for r in apart),
    }


def _is_marker(r: experiments.AuditRecord) -> bool:
    """Return whether this is a tip velocity of a single test, measured at a marker, not at the contact."""
    return r.column in ("V_cn", "V_ct") and r.row not in ("mean", "sd")


def _columns(records: Sequence[experiments.AuditRecord]) -> Iterator[dict[str, Any]]:
    for which, summarises in (("rows", False), ("mean and SD lines", True)):
        lines = [r for r in records if (r.row in ("mean", "sd")) is summarises]
        for name in dict.fromkeys(r.column for r in lines):
            group = [r for r in lines if r.column == name]
            agree = sum(r.agrees for r in group)
            yield {"lines": which, "column": name, "numbers": len(group), "agree": agree}


def _constants(s: experiments.MeasuredSet) -> dict[str, Any]:
    """Return the arms, mass and k2 with which a set's columns were computed."""
    return {
        "set": s.id,
        "table": s.table,
        "d_c_m": float(s.arms.d_c),
        "d_d_m": float(s.arms.d_d),
        "mass_kg": s.mass,
        "k_squared_m2": s.k2,
        "other_d_c_m": dict(experiments.column_arms(s.id)),
        "reconstructed": s.reconstructed,
    }


def _disagreements(records: Iterable[experiments.AuditRecord]) -> Iterator[dict[str, Any]]:
    """Yield the disagreements; the markers' velocities as one entry a set and column."""
    markers: dict[tuple[str, str], list[experiments.AuditRecord]] = {}
    for r in records:
        if not r.agrees and _is_marker(r):
            markers.setdefault((r.set_id, r.column), []).append(r)
        elif not r.agrees:
            yield _entry(r)
    for group in markers.values():
        worst = max(group, key=lambda r: abs(r.printed - r.recomputed))
        yield {**_entry(worst), "row": f"{len(group)} rows, worst {worst.row}"}


def _entry(r: experiments.AuditRecord) -> dict[str, Any]:
    return {"set": r.set_id, **{name: getattr(r, name) for name in CSV_COLUMNS[1:]}}


def _scatter(s: experiments.MeasuredSet) -> dict[str, Any]:
    """Return scatter, uncertainty of e_m and correlations of one set."""
    statistics, rows = s.statistics(), s.recomputed()
    pairs = experiments.correlations({name: rows[name] for name in Coefficients._fields})
    return {
        "set": s.id,
        **{name: statistic_entry(statistics[name]) for name in SCATTER},
        "e_m_of_mean": estimate_entry(first_order(s.motion, **s.body)["e_m"]),
        "correlations": [
            {"pair": f"{a}, {b}", "r": c.r, "low": c.low, "high": c.high, "p": c.p}
            for (a, b), c in pairs.items()
        ],
    }


def audit_text(document: Mapping[str, Any]) -> str:
    """Return the document of `audit_document` as text."""
    parts = (_summary_text, _constants_text, _disagreements_text, _scatter_text, _correlations_text)
    return "\n".join(line for part in parts for line in part(document)) + "\n"


def _summary_text(document: Mapping[str, Any]) -> Iterator[str]:
    s = document["summary"]
    yield from wrapped(
        f"{s['agree']} of {s['numbers']} printed numbers follow from the printed velocities within rounding."
    )
    yield from wrapped(
        f"{s['marker_velocities_apart']} tip velocities do not (they are a marker's, not the contact "
        f"point's), {s['others_apart']} other numbers do not; {s['unexplained']} of all these are "
        "unexplained."
    )

    for which in ("rows", "mean and SD lines"):
        columns = [c for c in document["columns"] if c["lines"] == which]
        if columns:
            counts = ", ".join(f"{c['column']} {c['agree']}/{c['numbers']}" for c in columns)
            yield from wrapped(f"{which}: {counts}", "  ")


def _constants_text(document: Mapping[str, Any]) -> Iterator[str]:
    yield ""
    yield "What the columns were worked out with (mm, kg, mm2)"
    rows: list[tuple[Cell, ...]] = []
    for c in document["constants"]:
        other = ", ".join(f"{name} {1e3 * d:.1f}" for name, d in c["other_d_c_m"].items())
        other = other or ("velocities worked back from the coefficients" if c["reconstructed"] else "")
        numbers = (f"{1e3 * c['d_c_m']:.1f}", f"{1e3 * c['d_d_m']:.1f}", f"{c['mass_kg']:.4f}")
        rows.append((c["set"], c["table"], *numbers, f"{1e6 * c['k_squared_m2']:.1f}", other))
    yield Table(CONSTANT_COLUMNS, tuple(rows)).terminal(indent="  ")


def _disagreements_text(document: Mapping[str, Any]) -> Iterator[str]:
    yield ""
    yield "Disagreements, by reason"
    apart = document["disagreements"]
    for why in dict.fromkeys(d["explanation"] for d in apart):
        yield from wrapped(f"- {why or 'no explanation is known'}")
        group = [d for d in apart if d["explanation"] == why]
        named = [{**d, "row": f"test {d['row']}" if d["row"].isdecimal() else d["row"]} for d in group]
        rows = tuple(tuple(d[column.name] for column in APART_COLUMNS) for d in named)
        yield Table(APART_COLUMNS, rows).terminal(indent="    ")
    if not apart:
        yield "  none"


def _scatter_text(document: Mapping[str, Any]) -> Iterator[str]:
    yield ""
    caption = "Scatter, mean (SD); e_m of the mean motion with its 95 % interval"
    yield from wrapped(f"{caption} for a contact point known to 0.5 mm")
    head = ("set", "tests", "e", "mu", "loss/E_0", "e_m of the mean motion")
    rows: list[tuple[Cell, ...]] = []
    for s in document["scatter"]:
        e, mu, remaining, e_m = (s[name] for name in ("e", "mu", "E_r_over_E_0", "e_m_of_mean"))
        means = ((e["mean"], e["sd"]), (mu["mean"], mu["sd"]), (1 - remaining["mean"], remaining["sd"]))
        moment = f"{e_m['value']:+.2f} ({e_m['low']:+.2f} to {e_m['high']:+.2f})"
        mark = "" if e_m["low"] <= -1 <= e_m["high"] else "  leaves out -1"
        spreads = (f"{mean:.3f} ({sd:.3f})" for mean, sd in means)
        rows.append((s["set"], e["tests"], *spreads, moment + mark))
    yield Table.of(head, rows, left=(0, 2, 3, 4, 5)).terminal(indent="  ")


def _correlations_text(document: Mapping[str, Any]) -> Iterator[str]:
    """Yield the pairs of coefficients whose 95 % interval of correlation excludes zero."""
    pairs = [(s["set"], c) for s in document["scatter"] for c in s["correlations"]]
    real = [f"{name}: {c['pair']} r = {c['r']:+.2f}" for name, c in pairs if c["low"] > 0 or c["high"] < 0]
    yield ""
    sentence = (
        f"Correlations of e, mu, e_m beyond their 95 % interval: {'; '.join(real) or 'none'}. Chance alone "
        f"would give about {0.05 * len(pairs):.0f} of {len(pairs)}, and numbers worked out from the same "
        "velocities share errors."
    )
    yield from wrapped(sentence, hang="")
