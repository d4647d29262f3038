"""Texts: sentences broken to a terminal's width, numbers in plain digits, symbols and units typeset."""

import re
import textwrap
from decimal import Decimal
from html import escape
from math import ceil, floor, inf, log10

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
    >>> plain(123.4, 2), plain(0.00012, 2), plain(3e-7, 2), plain(-0.0, 2)
    ('120', '0.00012', '3e-07', '0')
    """
    rounded = f"{value + 0.0:.{digits}g}"  # no minus zero
    return f"{Decimal(rounded):f}" if 1e-5 <= abs(value) < 1e6 else rounded


def plain_bound(value: float, digits: int, rounding: str) -> str:
    """Return a number with so many significant digits, rounded to one side as `decimal` names it.

    Examples
    --------
    >>> plain_bound(0.02806, 2, "ROUND_CEILING"), plain_bound(0.28, 2, "ROUND_CEILING")
    ('0.029', '0.28')
    >>> plain_bound(998.6, 3, "ROUND_FLOOR")
    '998'
    """
    exact = Decimal(repr(float(value)))
    step = Decimal(1).scaleb(exact.adjusted() + 1 - digits)
    return plain(float(exact.quantize(step, rounding)), digits)


def digits_apart(one: float, other: float, least: int = 2) -> int:
    """Return with how many significant digits, at least so many, two numbers differ as text.

    Examples
    --------
    >>> digits_apart(0.0112, 0.0375), digits_apart(0.02254, 0.02323), digits_apart(5e3, 5001.0, 3)
    (2, 3, 4)
    """
    differ = (digits for digits in range(least, 17) if plain(one, digits) != plain(other, digits))
    return next(differ, least)


def rounded_up(value: float, places: int) -> str:
    """Return a number with ``places`` after the point, never less than it is: the half-width of a band.

    Examples
    --------
    >>> rounded_up(0.0034, 2), rounded_up(0.03, 2), rounded_up(21240.0, -3)
    ('0.01', '0.03', '22000')
    """
    return f"{ceil(round(value * 10.0**places, 6)) / 10.0**places:.{max(0, places)}f}"


LEAST = 1e-4  # of a number, its least half-width: no model holds more digits


def with_band(value: float, band: float, low: float = -inf, high: float = inf) -> str:
    """Return a number with its half-width, of `LEAST` at least, both to the second digit of that.

    Where the band of a number between ``low`` and ``high`` runs beyond them, its ends stand in its place. A
    number that lies beyond them itself, as one extrapolated from meshes may, is the end that its band holds.

    Examples
    --------
    >>> with_band(0.36787, 0.01801), with_band(16.54, 14.38), with_band(0.25, 0.0)
    ('0.368 +- 0.019', '17 +- 15', '0.25 +- 0')
    >>> with_band(53737.0, 21240.0), with_band(5.43e9, 1.2e8)
    ('54000 +- 22000', '(5.43 +- 0.12)e9')
    >>> with_band(11.0, 0.0074), with_band(11.0, 1e-9)
    ('11.0000 +- 0.0074', '11.0000 +- 0.0011')
    >>> with_band(2.4, 39.0, 0.0, 100.0), with_band(-0.001, 0.5), with_band(1.2e-6, 3e-6, 0.0)
    ('2 (0 to 42)', '0.00 +- 0.50', '(1.2 (0.0 to 4.2))e-6')
    >>> with_band(25.05, 99.0, 0.0, 100.0), with_band(-4.2, 37.0, 0.0, 100.0), with_band(-4.2, 3.0, 0.0)
    ('25 (0 to 100)', '0 (0 to 33)', '-4.2 +- 3.0')
    """
    if band <= 0.0:
        return f"{value:.4g} +- 0"
    band = max(band, LEAST * abs(value))
    power = floor(log10(max(abs(value), band)))
    if not -5 < power < 6:
        return f"({with_band(*(one / 10.0**power for one in (value, band, low, high)))})e{power}"
    places, shown = 1 - floor(log10(band)), min(max(value, low), high)
    if abs(shown - value) > band:
        shown, low, high = value, -inf, inf
    told = f"{round(shown, places) + 0.0:.{max(0, places)}f}"  # no minus zero
    if low <= value - band and value + band <= high:
        return f"{told} +- {rounded_up(band, places)}"
    if places < 0:  # ends need no more digits, but the number would not add up with others
        told = plain(shown, 2)
    first = f"{round(max(low, value - band), places) + 0.0:.{max(0, places)}f}"
    return f"{told} ({first} to {rounded_up(min(high, value + band), places)})"


GREEK = {"gamma": "γ", "mu": "µ", "Omega": "Ω", "alpha": "α", "tau": "τ"}
"""Letters whose English name stands for them in plain texts."""

SYMBOL = re.compile(
    r"(?<![\w`.^/\\-])(?P<base>E|W|V|v|T|T1|d|e|u|k|f|t|n|mu|gamma|Omega|alpha|tau)"
    r"(?:_(?P<index>0|[A-Za-z]{1,4}))?(?![\w`^\\])"
    r"|(?<=/)(?P<under>E_0|tau)(?!\w)"
    r"|(?<=\bm)\^(?P<power>-?[\d.]*\d)"
)
"""A letter with an index, the name of a Greek letter, and a power of a metre."""

STRONG, CODE = re.compile(r"\*\*(.+?)\*\*"), re.compile(r"`([^`]+)`")
UNITS = {"_deg": "degrees", "_m": "m", "_mm": "mm", "_s": "s", "_J": "J", "_N": "N", "_Pa": "Pa"}
"""Endings of the names of columns, and the units that they stand for."""

PLAIN = ((re.compile(r"(?<=\d )us\b"), "µs"), (re.compile(r"<=|&lt;="), "≤"), (re.compile(r"\+-"), "±"))
"""Signs in plain letters, and what stands for them."""


def markup(text: str) -> str:
    """Return a text as HTML, escaped: indices, powers, Greek letters, ``**strong**`` and `` `code` ``.

    Examples
    --------
    >>> markup("E_vib < 1 at gamma = 26 m^-0.3815 after 3 us: `E_vib`")
    '<i>E</i><sub>vib</sub> &lt; 1 at γ = 26 m<sup>−0.3815</sup> after 3 µs: <code>E_vib</code>'
    """
    parts = CODE.split(escape(text))  # code at the odd places
    for at in range(0, len(parts), 2):
        signs = _replaced(parts[at], "<sup>{}</sup>", "<i>{}</i><sub>{}</sub>")
        parts[at] = STRONG.sub(r"<strong>\1</strong>", signs)
    for at in range(1, len(parts), 2):
        parts[at] = f"<code>{parts[at]}</code>"
    return "".join(parts)


def readable(name: str) -> str:
    """Return the name of a column of a file as words, its unit after a comma; other names as they are.

    Examples
    --------
    >>> readable("T1_over_tau"), readable("angle_deg"), readable("E_vib_modal"), readable("E_vib/E_0, %")
    ('T1/tau', 'angle, degrees', 'E_vib modal', 'E_vib/E_0, %')
    """
    if not re.fullmatch(r"\w+", name):
        return name
    words, unit = name.replace("_over_", "/"), ""
    for ending, shown in UNITS.items():
        if words.endswith(ending):
            words, unit = words.removesuffix(ending), f", {shown}"
    return re.sub(r"(?<!\bE)(?<!\bu)(?<!\bV)_", " ", words) + unit


def formula(text: str) -> str:
    """Return a text for matplotlib: indices and powers between dollar signs, its own dollar signs escaped."""
    return _replaced(text.replace("$", r"\$"), "$^{{{}}}$", r"${}_{{\mathrm{{{}}}}}$")


def _replaced(text: str, raised: str, indexed: str) -> str:
    """Return a text with its signs, and its powers and letters with an index in the forms of these two."""

    def one(match: re.Match[str]) -> str:
        base, _, index = (match["under"] or match["base"] or "").partition("_")
        index = index or match["index"] or ""
        if base == "T1":
            base, index = "T", "1"
        if match["power"]:
            return raised.format(match["power"].replace("-", "−"))
        if index:
            return indexed.format(GREEK.get(base, base), index)
        return GREEK.get(base, match[0])

    for plain, sign in PLAIN:
        text = plain.sub(sign, text)
    return SYMBOL.sub(one, text)
