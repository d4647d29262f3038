"""The paper's Tables 2-6 as columns, read from the CSV files beside this module."""

import csv
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

import numpy as np

from ..inputs import DataError, Floats

LABELS = ("series", "surface", "statistic")
TABLES = (2, 3, 4, 5, 6)


@cache
def _lines(name: str) -> tuple[dict[str, str], ...]:
    """Rows of one CSV file of the package."""
    text = (files(__package__) / "data" / name).read_text(encoding="utf-8")
    return tuple(csv.DictReader(text.splitlines()))


def _select(name: str, select: Mapping[str, str]) -> list[dict[str, str]]:
    """Rows whose labels match `select`."""
    lines = [line for line in _lines(name) if all(line.get(k) == v for k, v in select.items())]
    if not lines:
        raise DataError(f"{name} has no row with {dict(select)}")
    return lines


def _columns(name: str, select: Mapping[str, str]) -> dict[str, Floats]:
    """Numeric columns of the selected rows, (n,) each."""
    lines = _select(name, select)
    return {key: np.array([float(line[key]) for line in lines]) for key in lines[0] if key not in LABELS}


def _decimals(text: str) -> int:
    """Return the number of digits after the point."""
    return len(text.partition(".")[2])


def table(number: int, select: Mapping[str, str] | None = None) -> dict[str, Floats]:
    """Rows of Table `number` (2 to 6) as columns, SI units, in the printed order.

    Parameters
    ----------
    number : int
        Of the table in the paper.
    select : mapping, optional
        Labels that a row must carry, as text: ``{"series": "a"}``, ``{"alpha_deg": "17.0"}``.

    Returns
    -------
    dict of str to (n,) float64
        Column by name; names and units are in ``data/README.md``.

    Examples
    --------
    >>> table(5, {"series": "a"})["e"]
    array([0.368, 0.414, 0.401, 0.507, 0.42 , 0.422, 0.349, 0.375])
    """
    if number not in TABLES:
        raise DataError(f"the paper's measured tables are {TABLES}, got {number}")
    return _columns(f"table{number}.csv", select or {})


def decimals(number: int, column: str, select: Mapping[str, str] | None = None) -> tuple[int, ...]:
    """Return the decimals with which each row of a column was printed."""
    return tuple(_decimals(line[column]) for line in _select(f"table{number}.csv", select or {}))


def printed_statistics(number: int, which: str, select: Mapping[str, str] | None = None) -> dict[str, Floats]:
    """Return the printed "mean" or "sd" line of a table, misprints included, as one-element columns."""
    return _columns(f"table{number}_printed_statistics.csv", {**(select or {}), "statistic": which})


def statistic_decimals(number: int, which: str, column: str, select: Mapping[str, str] | None = None) -> int:
    """Return the decimals of one number of the printed "mean" or "sd" line."""
    wanted = {**(select or {}), "statistic": which}
    return _decimals(_select(f"table{number}_printed_statistics.csv", wanted)[0][column])
