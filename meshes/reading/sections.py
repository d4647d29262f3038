"""Decks of keywords at the beginning of a line, with lines of fields of fixed widths."""

from collections.abc import Iterator
from itertools import accumulate, pairwise

__all__ = ["fixed_fields", "sections"]


def sections(text: str, mark: str, comment: str) -> Iterator[tuple[str, list[str]]]:
    """Yield each keyword in capitals, without its ``mark``, and its lines but comments and blank ones."""
    name, lines = "", list[str]()
    for line in text.splitlines():
        if line.startswith(comment) or not line.strip():
            continue
        if not line.startswith(mark):
            lines.append(line.rstrip())
            continue
        if name:
            yield name, lines
        name, lines = line[len(mark) :].strip().upper(), []
    if name:
        yield name, lines


def fixed_fields(line: str, widths: list[int]) -> list[str]:
    """Return the fields of a line by their widths in letters."""
    return [line[low:high].strip() for low, high in pairwise(accumulate(widths, initial=0))]
