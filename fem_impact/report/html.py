"""Small pieces of HTML; every text from outside is escaped here and nowhere else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

__all__ = [
    "Markup",
    "bullets",
    "cell",
    "details",
    "join",
    "number",
    "paragraph",
    "place",
    "section",
    "table",
    "with_band",
]


@dataclass(frozen=True, slots=True)
class Markup:
    """HTML that is already escaped; anything else is escaped when it is put in."""

    text: str


def join(parts: Iterable[Markup]) -> Markup:
    """Return the pieces one after the other."""
    return Markup("\n".join(part.text for part in parts if part.text))


def paragraph(content: str | Markup, kind: str = "") -> Markup:
    """Return a paragraph, nothing for an empty text."""
    shown = f' class="{escape(kind)}"' if kind else ""
    text = _safe(content)
    return Markup(f"<p{shown}>{text}</p>" if text else "")


def place(name: str, content: Markup) -> Markup:
    """Return a piece that a link ``#name`` leads to."""
    return Markup(f'<div id="{escape(name)}">\n{content.text}\n</div>')


def section(title: str, *content: Markup) -> Markup:
    """Return a titled section, nothing when it would be empty."""
    inner = join(content).text
    return Markup(f"<section>\n<h2>{escape(title)}</h2>\n{inner}\n</section>" if inner else "")


def details(title: str, *content: Markup, opened: bool = False) -> Markup:
    """Return a piece that can be unfolded."""
    state = " open" if opened else ""
    return Markup(f"<details{state}><summary>{escape(title)}</summary>\n{join(content).text}\n</details>")


def bullets(items: Iterable[str | Markup]) -> Markup:
    """Return a list, nothing when it is empty."""
    lines = "\n".join(f"<li>{_safe(item)}</li>" for item in items)
    return Markup(f"<ul>\n{lines}\n</ul>" if lines else "")


def cell(content: str | Markup, kind: str = "") -> Markup:
    """Return a table cell of a kind: number, inside, outside."""
    shown = f' class="{escape(kind)}"' if kind else ""
    return Markup(f"<td{shown}>{_safe(content)}</td>")


def table(
    head: Sequence[str],
    rows: Iterable[Sequence[str | Markup]],
    caption: str = "",
    numbers: Iterable[int] = (),
    compact: bool = False,
) -> Markup:
    """Return a table that scrolls sideways where the screen is narrow, nothing when it has no rows.

    Parameters
    ----------
    head : sequence of str
        Column titles.
    rows : iterable of sequences
        Cells as text, or made by ``cell``.
    caption : str
        What the table shows.
    numbers : iterable of int
        Columns set flush right.
    compact : bool
        Whether each row is one line.
    """
    right = set(numbers)
    titles = "".join(f"<th{_kind(at in right)}>{escape(text)}</th>" for at, text in enumerate(head))
    body = "\n".join(_row(row, right) for row in rows)
    above = f"<caption>{escape(caption)}</caption>" if caption else ""
    inner = f"{above}<thead><tr>{titles}</tr></thead>\n<tbody>\n{body}\n</tbody>"
    look = ' class="compact"' if compact else ""
    return Markup(f'<div class="scroll"><table{look}>{inner}</table></div>' if body else "")


def number(value: Any) -> str:
    """Return a value for the eye: four digits, a true minus sign, a dash for null."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f").replace("-", "−")
    return f"{value:.4g}".replace("-", "−")


def with_band(value: Any, width: Any) -> str:
    """Return a value with its half-width, where it has one."""
    return number(value) if width is None or value is None else f"{number(value)} ± {width:.2g}"


def _row(row: Sequence[str | Markup], right: set[int]) -> str:
    return "<tr>" + "".join(_cell(item, at in right) for at, item in enumerate(row)) + "</tr>"


def _cell(item: str | Markup, right: bool) -> str:
    made = isinstance(item, Markup) and item.text.startswith("<td")
    return item.text if isinstance(item, Markup) and made else f"<td{_kind(right)}>{_safe(item)}</td>"


def _kind(right: bool) -> str:
    return ' class="number"' if right else ""


def _safe(content: str | Markup) -> str:
    return content.text if isinstance(content, Markup) else escape(str(content))
