"""A user's own camera data: a CSV file with one test a row and the units in the header."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text
from fem_impact.scene.units import DIMENSIONS, Unit
from rigid.arrays import Floats

KINDS = {"v_n": "speed", "v_t": "speed", "V_n": "speed", "V_t": "speed", "Omega": "angular speed"}
ARMS = {"d_c": "length", "d_d": "length"}
"""Columns that may state the arms of the contact with which the tests are to be worked out."""
HEADER = "v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"
LARGEST = 1e6
"""Bound of the size of a velocity, m/s or rad/s."""

_NAME = re.compile(r"(v_n|v_t|V_n|V_t|Omega|d_c|d_d)(?:_(\w+)|\s*[\[(](.+)[\])])?")
Line = tuple[int, list[str]]
"""Number and cells of a line of the file."""


@dataclass(frozen=True, slots=True)
class Camera:
    """Velocities of each test.

    Attributes
    ----------
    motion : mapping of str to (n,) float64
        v_n, v_t, V_n, V_t (m/s) and Omega (rad/s).
    tests : tuple of str
        Label of each test: its cell in a column ``test``, else its number.
    ignored : tuple of str
        Columns of the file that were not used.
    arms : (d_c, d_d) or None
        Arms of the contact point, m, where the file states them.
    """

    motion: Mapping[str, Floats]
    tests: tuple[str, ...]
    ignored: tuple[str, ...]
    arms: tuple[float, float] | None


def read_camera(path: str | Path) -> Camera:
    """Read the velocities before and after each impact.

    Parameters
    ----------
    path : path
        UTF-8 CSV with a header. Columns are named ``v_n_m_per_s`` or ``v_n [m/s]``, and so on, in
        any unit of speed (m/s, mm/s, km/s) and of angular speed (rad/s, deg/s, rpm); capitals are the
        motion after impact. A column ``test`` may label the rows, columns
        ``d_c_m`` and ``d_d_m`` may state the arms of the contact point.

    Raises
    ------
    ResultError
        Names the file, and the row and column where there is one.
    """
    lines = list(lines_of(read_text(path), path))
    if not lines:
        raise ResultError(f"{path}: is empty. Begin it with the header {HEADER}.")
    (_, header), *rows = lines
    names = [name.strip() for name in header]
    places = _places(names, path)
    for line, cells in rows:
        if len(cells) != len(names):
            raise ResultError(f"{path}: line {line} has {len(cells)} cells, the header {len(names)}.")
    if len(rows) < 2:
        raise ResultError(f"{path}: holds {len(rows)} tests; an uncertainty needs at least two.")
    columns = {}
    for name, (at, unit) in places.items():
        cells_of = [(f"{path}: line {line}, column {names[at]}", cells[at].strip()) for line, cells in rows]
        columns[name] = np.array([_number(place, text, unit) for place, text in cells_of])
    motion = {name: columns[name] for name in KINDS}
    arms = one_pair({name: columns[name] for name in ARMS if name in columns}, path)
    _check_motion(motion, rows, names, places, path)
    used = {names[at] for at, _ in places.values()}
    labels = [
        cells[names.index("test")].strip() if "test" in names else str(i)
        for i, (_, cells) in enumerate(rows, 1)
    ]
    ignored = tuple(name for name in names if name not in (*used, "test"))
    return Camera(motion, tuple(labels), ignored, arms)


def lines_of(text: str, path: str | Path) -> Iterator[Line]:
    """Yield the lines that are neither blank nor comments (#)."""
    reader = csv.reader(io.StringIO(text.removeprefix("\ufeff")), strict=True)
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells) and not cells[0].startswith("#"):
                yield reader.line_num, cells
    except csv.Error as error:
        raise ResultError(f"{path}: line {reader.line_num} is not CSV ({error}).") from None


def _places(names: Sequence[str], path: str | Path) -> dict[str, tuple[int, Unit]]:
    """Return index and unit of the five columns by quantity."""
    places: dict[str, tuple[int, Unit]] = {}
    for at, name in enumerate(names):
        match = _NAME.fullmatch(name)
        if match is None:
            continue
        if match[1] in places:
            raise ResultError(f"{path}: {match[1]} has two columns, the second is {name!r}. Keep one.")
        places[match[1]] = at, unit_of(name, {**KINDS, **ARMS}[match[1]], match[1], f"{path}: column")
    missing = [name for name in KINDS if name not in places]
    if missing:
        hint = " Separate columns by commas." if any(";" in name or "\t" in name for name in names) else ""
        lacks = f"{path}: the header lacks {', '.join(missing)}.{hint}"
        raise ResultError(f"{lacks} It needs {HEADER} (capitals: after impact).")
    return places


def unit_of(stated: str, dimension: str, name: str, place: str) -> Unit:
    """Return the unit of a quantity that is stated as ``name_unit`` or ``name [unit]``.

    Raises
    ------
    ResultError
        It states none, or none of its dimension; ``place`` is for the complaint.
    """
    kind, match = DIMENSIONS[dimension], _NAME.fullmatch(stated)
    text = (match[2] or match[3]) if match else None
    if not text:
        remedy = f"Name it {name}_{kind.suffix} or {name} [{kind.units[0].symbol}]"
        raise ResultError(f"{place} {stated!r} names no unit. {remedy} (units: {kind.symbols}).")
    unit = kind.unit(text.strip().replace("_per_", "/"))
    if unit is None:
        wrong = f"{place} {stated!r}: {text!r} is not a unit of {kind.name}"
        raise ResultError(f"{wrong} ({kind.symbols}).")
    return unit


def _number(place: str, text: str, unit: Unit) -> float:
    """Read one cell in SI; ``place`` is for complaints."""
    finite(place, text)
    value = unit.to_si(text)
    if abs(value) > LARGEST:
        raise ResultError(f"{place}: {text[:40]} is no speed of a dropped rod.")
    return value


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
    if not math.isfinite(number):
        raise ResultError(f"{place}: {text[:40]!r} is not a finite number.")
    return number


def one_pair(arms: Mapping[str, Iterable[float]], path: str | Path) -> tuple[float, float] | None:
    """Return the one pair of arms, m, that the rows of a file state, None where they state none.

    Raises
    ------
    ResultError
        They state one arm only, or several values.
    """
    stated = [set(map(float, values)) for values in arms.values()]
    if not stated:
        return None
    if len(stated) == 1 or any(len(values) > 1 for values in stated):
        rule = "Give both d_c and d_d, each the same in all rows, or neither."
        raise ResultError(f"{path}: the arms of the tests are not one pair. {rule}")
    return stated[0].pop(), stated[1].pop()


def _check_motion(
    motion: Mapping[str, Floats],
    rows: Sequence[Line],
    names: Sequence[str],
    places: Mapping[str, tuple[int, Unit]],
    path: str | Path,
) -> None:
    """Refuse a test that is no impact, usually because of a wrong sign."""
    wrong = (
        ("v_n", motion["v_n"] >= 0, "must be negative: n points out of the barrier, and the rod falls on it"),
        ("V_n", motion["V_n"] <= motion["v_n"], "must exceed v_n: the barrier can only push"),
    )
    for name, bad, rule in wrong:
        if bad.any():
            (line, cells), at = rows[int(np.argmax(bad))], places[name][0]
            raise ResultError(f"{path}: line {line}, column {names[at]}: {cells[at].strip()} {rule}.")
