"""A table that a user wrote: CSV text with units in its header; complaints name file, line and column.

Columns stand between commas; where the header has semicolons or tabs, between these, and then a number may
have a decimal comma, as spreadsheets of many countries write it.
"""

import csv
import io
import math
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_bytes
from fem_impact.scene.units import DIMENSIONS, Unit

DECIMAL = re.compile(r"^([+-]?\d*),(\d+(?:[eE][+-]?\d+)?)$")  # a number with a decimal comma
POINT = re.compile(r"[+-]?\d*\.\d+(?:[eE][+-]?\d+)?")
MISSPELT = 0.85
"""Likeness of a column's name to a known one from which it is taken for that, misspelt."""
Line = tuple[int, list[str]]
"""Number and cells of a line of the file."""


@dataclass(frozen=True, slots=True)
class UserTable:
    """Header and lines of a file.

    Attributes
    ----------
    path : the file
    names : names of its columns, as the header states them
    lines : number and cells of each line below the header
    """

    path: str | Path
    names: tuple[str, ...]
    lines: tuple[Line, ...]

    def records(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Yield number and cells by column of each line.

        Raises
        ------
        ResultError
            A line has another number of cells than the header.
        """
        for line, stated in self.lines:
            cells = stated if any(stated[len(self.names) :]) else stated[: len(self.names)]
            if len(cells) != len(self.names):
                counts = f"line {line} has {len(cells)} cells, the header {len(self.names)}"
                remedy = "Give each line one cell a column."
                if len(cells) > len(self.names):
                    remedy += " Numbers with decimal commas need semicolons between all cells."
                raise ResultError(f"{self.path}: {counts}. {remedy}")
            yield line, dict(zip(self.names, cells, strict=True))

    def column(self, name: str) -> list[tuple[str, str]]:
        """Return place, for complaints, and text of each cell. Raises ResultError as `records`."""
        return [(f"{self.path}: line {line}, column {name}", cells[name]) for line, cells in self.records()]

    def stating(self, key: str) -> list[str]:
        """Return the names of the columns that state a quantity, in whatever unit."""
        return [name for name in self.names if _stated(name, key)]

    def quantities(self, dimensions: Mapping[str, str]) -> dict[str, tuple[str, Unit]]:
        """Return name and unit of the column of each quantity that has one; see `quantity`."""
        found = {key: self.quantity(key, dimension) for key, dimension in dimensions.items()}
        return {key: column for key, column in found.items() if column}

    def unused(self, used: Collection[str], optional: Collection[str]) -> tuple[str, ...]:
        """Return the columns that are not used.

        Parameters
        ----------
        used : names of columns as the header states them
        optional : names, without units, of columns that there may be

        Raises
        ------
        ResultError
            One is nearly an optional column that the file does not have: ``Systematic``, ``d_c mm``.
        """
        held = [name for name in self.names if name in used]
        lacking = [one for one in optional if not any(_stated(name, one) for name in held)]
        left = tuple(name for name in self.names if name and name not in used)
        for name in left:
            near = [one for one in lacking if re.match(rf"{one}(?![a-z])", name.lower())]
            near += get_close_matches(name.lower(), lacking, 1, MISSPELT)
            if near:
                remedy = f"Did you mean {near[0]}? Give a column of your own another name."
                raise ResultError(f"{self.path}: column {name!r} is not one that is read. {remedy}")
        return left

    def quantity(self, key: str, dimension: str, bare: Unit | None = None) -> tuple[str, Unit] | None:
        """Return name and unit of the column that states a quantity, None where none does.

        Parameters
        ----------
        key : name of the quantity, such as ``v_n``
        dimension : a name in `DIMENSIONS`
        bare : unit where the header states none; None: it must state one

        Raises
        ------
        ResultError
            Two columns state it, or the unit is missing or of another dimension.
        """
        stated = self.stating(key)
        if len(stated) > 1:
            raise ResultError(f"{self.path}: {key} has two columns, the second is {stated[1]!r}. Keep one.")
        if not stated:
            return None
        if bare and stated[0] == key:
            return key, bare
        return stated[0], unit_of(stated[0], dimension, key, f"{self.path}: column")


def read_user_table(path: str | Path, header: str) -> UserTable:
    """Read CSV text; blank lines and comments (#) are left out.

    Text is UTF-8, UTF-16 with its mark, or of one byte a letter, as spreadsheets write it.

    Parameters
    ----------
    path : path
    header : an example of its first line, for complaints

    Raises
    ------
    ResultError
        The file cannot be read, is empty, is not CSV, has two columns of one name, or has decimal
        commas and decimal points.
    """
    text = _text(path)
    header_line = next((line for line in text.split("\n") if line.strip() and not line.startswith("#")), "")
    mark = max(",;\t", key=header_line.count)
    reader = csv.reader(io.StringIO(text), strict=True, delimiter=mark)
    try:
        stated = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader]
    except csv.Error as error:
        raise ResultError(f"{path}: line {reader.line_num} is not CSV ({error}).") from None
    lines = [(line, cells) for line, cells in stated if any(cells) and not cells[0].startswith("#")]
    if mark != ",":
        lines = _with_points(lines, path)
    if not lines:
        raise ResultError(f"{path}: is empty. Begin it with the header {header}.")
    names = lines[0][1]
    while names and not names[-1]:  # spreadsheets end lines by empty cells
        names.pop()
    if twice := next((name for name in names if name and names.count(name) > 1), ""):
        raise ResultError(f"{path}: has two columns {twice!r}. Keep one.")
    return UserTable(path, tuple(names), tuple(lines[1:]))


def _text(path: str | Path) -> str:
    data = read_bytes(path)
    for encoding in ("utf-16",) if data.startswith((b"\xff\xfe", b"\xfe\xff")) else ("utf-8-sig", "cp1252"):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            continue
    raise ResultError(f"{path}: is no text. Save it as CSV.")


def _with_points(lines: list[Line], path: str | Path) -> list[Line]:
    """Return lines whose numbers with a decimal comma have a point; labels of tests may have one as well.

    Raises
    ------
    ResultError
        Others have a point: one of the two marks stands between thousands.
    """
    labels = lines[0][1].index("test") if lines and "test" in lines[0][1] else -1
    numbers = [(line, cell) for line, cells in lines for at, cell in enumerate(cells) if at != labels]
    comma, point = (
        next((f"{cell} (line {line})" for line, cell in numbers if kind.fullmatch(cell)), "")
        for kind in (DECIMAL, POINT)
    )
    if comma and point:
        both = f"has numbers with a comma, such as {comma}, and with a point, such as {point}"
        remedy = "Write all with a decimal point, or all with a decimal comma, and no mark between thousands."
        raise ResultError(f"{path}: {both}. {remedy}")
    return [(line, [DECIMAL.sub(r"\1.\2", cell) for cell in cells]) for line, cells in lines]


def unit_of(stated: str, dimension: str, name: str, place: str) -> Unit:
    """Return the unit of a quantity that is stated as ``name_unit`` or ``name [unit]``.

    Raises
    ------
    ResultError
        It states none, or none of its dimension; ``place`` is for the complaint.
    """
    kind, match = DIMENSIONS[dimension], _stated(stated, name)
    text = (match["suffix"] or match["symbol"]) if match else None
    if not text:
        remedy = f"Name it {name}_{kind.suffix} or {name} [{kind.units[0].symbol}]"
        raise ResultError(f"{place} {stated!r} names no unit. {remedy} (units: {kind.symbols}).")
    unit = kind.unit(text.strip().replace("_per_", "/"))
    if unit is None:
        wrong = f"{place} {stated!r}: {text!r} is not a unit of {kind.name}"
        hint = kind.hint(text.strip().replace("_per_", "/"))
        raise ResultError(f"{wrong} ({kind.symbols}). {hint}".rstrip())
    return unit


def finite(place: str, text: str) -> float:
    """Read one cell; ``place`` is for complaints.

    Raises
    ------
    ResultError
        It is not a finite number.
    """
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not text:
        raise ResultError(f"{place}: is empty. Give a number, or leave the line out.")
    if not math.isfinite(number):
        raise ResultError(f"{place}: {text[:40]!r} is not a finite number. Write one such as -1.5 or 2e-3.")
    return number


def in_si(place: str, text: str, unit: Unit) -> float:
    """Read one cell of a quantity in SI, 0 without a sign. Raises ResultError as `finite`."""
    finite(place, text)
    return unit.to_si(text) + 0.0


def _stated(stated: str, name: str) -> re.Match[str] | None:
    """Match ``name``, ``name_unit`` or ``name [unit]``."""
    return re.fullmatch(rf"{re.escape(name)}(?:_(?P<suffix>\w+)|\s*[\[(](?P<symbol>.+)[\])])?", stated)
