"""Sentences broken to the width of a terminal."""

from __future__ import annotations

import textwrap

WIDTH = 79


def wrapped(text: str, indent: str = "", hang: str = "  ") -> list[str]:
    """Return a sentence in lines of 79 letters at most, the later ones set in by ``hang`` more.

    Names such as ``barrier-rigid`` are not broken.
    """
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=indent,
        subsequent_indent=indent + hang,
        break_on_hyphens=False,
        break_long_words=False,
    )
