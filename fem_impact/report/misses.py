"""What could explain the quantities that the model misses."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from typing import Any

from fem_impact.report.embed import data_link
from fem_impact.report.html import Markup, bullets, details, number, paragraph, section, table
from fem_impact.report.study_data import Study
from fem_impact.study.sensitivity import WORDS

__all__ = ["miss_sentence", "misses_section"]

Row = Mapping[str, Any]
COLUMNS = ("set", "quantity", "input", "base", "changed")


def misses_section(study: Study) -> Markup:
    """Return, for each quantity outside its interval, which inputs could explain it and which not."""
    if not study.explanations:
        return Markup("")
    head = (
        "set",
        "quantity",
        "model",
        "measured",
        "could explain it",
        "share of the miss that each makes up",
    )
    shown = [_row(row) for row in study.explanations]
    told = [f"{name}: {meaning}" for name, meaning in WORDS.items()]
    link = Markup(f"<p>{data_link(_data(study.sensitivity), 'sensitivity.csv', 'what every input does')}</p>")
    return section(
        "What could explain the misses",
        paragraph(miss_sentence(study.explanations)),
        paragraph(
            "Each uncertain input was changed alone, on the coarser mesh, as far as its sources allow. A "
            "share of 100 % brings the model to the measured mean, one below 0 takes it further away."
        ),
        details("Quantity by quantity", table(head, shown, numbers=(2, 3))),
        details("What was changed", bullets(told)),
        link,
    )


def miss_sentence(rows: Sequence[Row]) -> str:
    """Say how many misses each input could explain, and how many none could."""
    counts = {name: sum(name in row["could"] for row in rows) for name in WORDS}
    ranked = sorted((name for name in counts if counts[name]), key=lambda name: -counts[name])
    listed = ", ".join(f"{name} {counts[name]}" for name in ranked) or "none"
    lost = sum(not row["could"] for row in rows)
    return (
        f"{len(rows)} computed quantities lie outside the 95 % interval of the measured mean. An uncertain "
        f"input, changed alone, could explain: {listed}. None of them explains {lost}."
    )


def _row(row: Row) -> list[str]:
    shares = ", ".join(f"{name} {share:+.0%}" for name, share in row["shares"].items())
    could = ", ".join(row["could"]) or "none of these"
    return [row["set"], row["quantity"], number(row["model"]), number(row["measured_mean"]), could, shares]


def _data(rows: Sequence[Row]) -> bytes:
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([row[name] for name in COLUMNS] for row in rows)
    return lines.getvalue().encode()
