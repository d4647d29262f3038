"""Sentences broken to the width of a terminal, and numbers in plain digits."""

from __future__ import annotations

import textwrap
from decimal import Decimal
from math import ceil

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


def plain(value: float, digits: int = 3) -> str:
    """Return a number with so many significant digits, without an exponent from 1e-5 up to a million.

    Examples
    --------
    >>> plain(123.4, 2), plain(0.00012, 2), plain(3e-7, 2), plain(12, 2)
    ('120', '0.00012', '3e-07', '12')
    """
    rounded = f"{value:.{digits}g}"
    return f"{Decimal(rounded):f}" if 1e-5 <= abs(value) < 1e6 else rounded


def rounded_up(value: float, places: int) -> str:
    """Return a number with ``places`` after the point, never less than it is: the half-width of a band.

    Examples
    --------
    >>> rounded_up(0.0034, 2), rounded_up(0.03, 2)
    ('0.01', '0.03')
    """
    return f"{ceil(round(value * 10**places, 6)) / 10**places:.{places}f}"
