"""HTML elements; texts that are not `Markup` are escaped, their symbols typeset."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape

from fem_impact.tables.symbols import markup
from fem_impact.tables.table import Table, number


@dataclass(frozen=True, slots=True)
class Markup:
    """HTML that is already escaped."""

    text: str


def join(parts: Iterable[Markup]) -> Markup:
    """Return the non-empty parts, one a line."""
    return Markup("\n".join(part.text for part in parts if part.text))


def paragraph(content: str | Markup, kind: str = "") -> Markup:
    """Return a paragraph, nothing for an empty text."""
    shown = f' class="{escape(kind)}"' if kind else ""
    text = _safe(content)
    return Markup(f"<p{shown}>{text}</p>" if text else "")


def place(name: str, content: Markup) -> Markup:
    """Return a block with the id ``name``."""
    return Markup(f'<div id="{escape(name)}">\n{content.text}\n</div>')


def section(title: str, *content: Markup) -> Markup:
    """Return a section, titled where there is a title, nothing when it would be empty."""
    inner = join(content).text
    head = f"<h2>{markup(title)}</h2>\n" if title else ""
    return Markup(f"<section>\n{head}{inner}\n</section>" if inner else "")


def details(title: str, *content: Markup) -> Markup:
    """Return a block that can be unfolded."""
    return Markup(f"<details><summary>{markup(title)}</summary>\n{join(content).text}\n</details>")


def bullets(items: Iterable[str | Markup]) -> Markup:
    """Return a list, nothing when it is empty."""
    lines = "\n".join(f"<li>{_safe(item)}</li>" for item in items)
    return Markup(f"<ul>\n{lines}\n</ul>" if lines else "")


def table(rows: Table, caption: str = "", compact: bool = False) -> Markup:
    """Return a table, nothing when it has no rows."""
    return Markup(rows.html(caption, compact))


def with_band(value: float | None, width: float | None) -> str:
    """Return a value with its half-width, where it has one."""
    return number(value) if width is None or value is None else f"{number(value)} ± {width:.2g}"


def _safe(content: str | Markup) -> str:
    return content.text if isinstance(content, Markup) else markup(str(content))
