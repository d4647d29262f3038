"""The conclusions of all studies on one page, each with the figure that shows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from fem_impact.outcome import Outcome, Unknown
from fem_impact.report.findings import figure_id
from fem_impact.report.html import Markup, bullets, section
from fem_impact.report.misses import miss_sentence
from fem_impact.report.study_data import Study
from fem_impact.report.verdicts import marker_sentence, verdicts

__all__ = ["Conclusion", "conclusion_section", "conclusion_text", "conclusions"]


class Conclusion(NamedTuple):
    """A sentence, and where its figure is: in the page, and as a file beside the report."""

    sentence: str
    figure: str = ""
    file: str = ""


def conclusions(told: Mapping[Path, Mapping[str, Any]], sets: Study | None) -> list[Conclusion]:
    """Return what the measured sets come to, then what each study concludes."""
    found = _of_sets(sets) if sets else []
    for folder, held in told.items():
        for entry in held["conclusions"]:
            file = f"../{folder.name}/figures/{entry['name']}.png"
            found.append(Conclusion(entry["sentence"], figure_id(held["study"], entry["name"]), file))
    return found


def _of_sets(sets: Study) -> list[Conclusion]:
    rows: Sequence[Outcome] = [row for row in sets.rows if not isinstance(row.contact.markers.V_n, Unknown)]
    judged = [Conclusion(v.sentence, v.name, f"figures/{v.name}.svg") for v in verdicts(sets.rows)]
    more = [marker_sentence(rows), miss_sentence(sets.explanations) if sets.explanations else ""]
    return judged + [Conclusion(sentence) for sentence in more if sentence]


def conclusion_section(found: Sequence[Conclusion]) -> Markup:
    """Return the page of conclusions, each linked to its figure."""
    return section("Conclusions", bullets(_linked(one) for one in found))


def _linked(one: Conclusion) -> Markup:
    link = f' <a href="#{escape(one.figure)}">figure</a>' if one.figure else ""
    return Markup(escape(one.sentence) + link)


def conclusion_text(found: Sequence[Conclusion]) -> str:
    """Return the same as Markdown, nothing when there is none."""
    lines = [f"- {one.sentence}" + (f" ([figure]({one.file}))" if one.file else "") for one in found]
    return "\n".join(["## Conclusions", "", *lines]) if lines else ""
