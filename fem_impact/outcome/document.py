"""The table of keys as a document."""

from __future__ import annotations

from fem_impact.outcome.keys import KEYS, Key

__all__ = ["markdown_table"]


def markdown_table() -> str:
    """Return the table of keys in Markdown, one row a key.

    Returns
    -------
    str
        Columns: key, kind, unit, may be null, meaning.
    """
    head = "| key | kind | unit | null | meaning |\n|---|---|---|---|---|"
    return "\n".join([head, *map(_row, KEYS)]) + "\n"


def _row(key: Key) -> str:
    null = "with a reason" if key.nullable else "never"
    return f"| `{key.name}` | {key.kind} | {key.unit} | {null} | {key.meaning} |"
