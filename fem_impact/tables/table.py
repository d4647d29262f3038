"""One table, written for a terminal, as Markdown, HTML and CSV, and read back from CSV."""

from __future__ import annotations

import csv
import io
import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Self, TypeVar

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_text
from fem_impact.tables.text import CODE, STRONG, markup, plain

if TYPE_CHECKING:
    import numpy as np


Plain = float | int | str | None
"""A cell of a CSV file."""
C = TypeVar("C")


def row_of(row: Sequence[C] | Mapping[str, C], names: Sequence[str]) -> list[C]:
    """Return the cells of a row, given in order or by name. Raises ValueError when it does not fit."""
    if isinstance(row, Mapping):
        if set(row) != set(names):
            raise ValueError(f"a row's keys {sorted(row)} are not the columns {sorted(names)}.")
        return [row[name] for name in names]
    if len(row) != len(names):
        raise ValueError(f"a row holds {len(row)} cells, the table {len(names)} columns.")
    return list(row)


def csv_line(cells: Sequence[Plain]) -> str:
    """Return one line; floats are written so that they read back exactly."""
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow([_written(cell) for cell in cells])
    return line.getvalue()


def _written(cell: Plain) -> Plain:
    # a number of numpy gives a plain one; numpy itself is not imported for a list of scenes
    cell = getattr(cell, "item", lambda: cell)()
    if isinstance(cell, bool):
        return str(cell).lower()
    if isinstance(cell, str):
        # one row, one line: a table cut off by a kill must stay readable up to its last line end
        return cell.replace("\r", " ").replace("\n", " ")
    return repr(cell) if isinstance(cell, float) else cell


COMPARISON = (
    "set",
    "quantity",
    "unit",
    "model",
    "band",
    "measured_mean",
    "measured_sd",
    "measured_low",
    "measured_high",
    "n",
    "verdict",
)
"""One row a quantity of a measured set; low and high bound the 95 % interval of the mean."""


DASH = "–"
GAP = "  "
NARROWEST = 12
"""Letters that a column of texts keeps at least when a table is fitted to a terminal."""


@dataclass(frozen=True, slots=True)
class Missing:
    """A cell without a value, and why: shown as a dash, on a page with the reason behind it."""

    reason: str


@dataclass(frozen=True, slots=True)
class Marked:
    """A text, and the class that it has in the style sheet of a page, such as ``inside``."""

    text: str
    style: str


Cell = Plain | Missing | Marked


@dataclass(frozen=True, slots=True)
class Column:
    """A column.

    Parameters
    ----------
    name : str
        In the header of a CSV file; ends in the unit.
    label, unit : str
        What a reader sees above it; the name where there is no label.
    digits : int
        Significant digits of the floats that a reader sees; CSV holds all of them.
    left : bool
        Whether cells stand flush left, as texts do.
    """

    name: str
    label: str = ""
    unit: str = ""
    digits: int = 4
    left: bool = False

    @property
    def title(self) -> str:
        """Label and unit."""
        return (self.label or self.name) + (f", {self.unit}" if self.unit else "")


@dataclass(frozen=True, slots=True)
class Table:
    """Columns, and rows of cells.

    Texts may hold ``**strong**`` and `` `code` `` as in Markdown: tags on a page, plain in a terminal.

    Parameters
    ----------
    columns : tuple of Column
    rows : tuple of tuple of Cell
        None and `Missing` are unknown. A table from a file holds texts; an empty one is unknown.
    source : str
        The file, for complaints.

    Raises
    ------
    ValueError
        A row does not fit the columns.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    source: str = ""

    def __repr__(self) -> str:
        return f"Table({len(self)} rows: {', '.join(self.names)})"

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(f"a row holds {len(row)} cells, the table {len(self.columns)} columns.")

    @classmethod
    def of(
        cls,
        names: Sequence[str],
        rows: Iterable[Sequence[Cell] | Mapping[str, Cell]],
        left: Iterable[int] = (0,),
    ) -> Self:
        """Return a table from names and rows, given in order or by name; ``left`` columns hold texts."""
        texts = {*left}
        columns = tuple(Column(name, left=at in texts) for at, name in enumerate(names))
        return cls(columns, tuple(tuple(row_of(row, names)) for row in rows))

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(column.name for column in self.columns)

    def cells(self, name: str) -> list[Cell]:
        """Return a column. Raises ResultError when there is none of that name."""
        if name not in self.names:
            raise ResultError(f'{self.source}: column "{name}" is missing.')
        at = self.names.index(name)
        return [row[at] for row in self.rows]

    def texts(self, name: str) -> list[str]:
        """Return a column as texts, empty where nothing is known. Raises ResultError."""
        return ["" if cell is None or isinstance(cell, Missing) else str(cell) for cell in self.cells(name)]

    def numbers(self, name: str) -> np.ndarray:
        """Return a column as ``(n_rows,) float64``, nan where nothing is known. Raises ResultError."""
        import numpy as np

        values = np.full(len(self), math.nan)
        for at, text in enumerate(self.texts(name)):
            if not text:
                continue
            with suppress(ValueError):
                values[at] = float(text)
            if not math.isfinite(values[at]):
                place = f"{self.source}: row {at + 1}, column {name}"
                raise ResultError(f'{place} = "{text[:40]}" is not a finite number.')
        return values

    def csv(self) -> str:
        """Return header and rows as CSV; floats read back exactly, an empty cell is unknown."""
        lines = [csv_line(self.names), *(csv_line([_plain(cell) for cell in row]) for row in self.rows)]
        return "".join(lines)

    def markdown(self) -> str:
        """Return a Markdown table."""
        rules = ["---" if column.left else "---:" for column in self.columns]
        body = [[text.replace("|", "\\|").replace("\n", " ") for text in row] for row in self._shown()]
        lines = [[column.title for column in self.columns], rules, *body]
        return "\n".join(f"| {' | '.join(line)} |" for line in lines)

    def html(self, caption: str = "", compact: bool = False) -> str:
        """Return a table that scrolls sideways on a narrow screen, nothing when it has no rows.

        ``compact`` keeps each row on one line.
        """
        if not self.rows:
            return ""
        titles = "".join(f"<th{_style(column)}>{markup(column.title)}</th>" for column in self.columns)
        lines = [
            "".join(_html(cell, column) for cell, column in zip(row, self.columns, strict=True))
            for row in self.rows
        ]
        body = "\n".join(f"<tr>{line}</tr>" for line in lines)
        above = f"<caption>{markup(caption)}</caption>" if caption else ""
        look = ' class="compact"' if compact else ""
        inner = f"{above}<thead><tr>{titles}</tr></thead>\n<tbody>\n{body}\n</tbody>"
        return f'<div class="scroll"><table{look}>{inner}</table></div>'

    def terminal(self, width: int = 120, indent: str = "") -> str:
        """Return aligned lines; the widest column of texts is broken where ``width`` letters are too few."""
        rows = [[column.title for column in self.columns], *self.plain_rows()]
        # letters of each column, the widest one of texts cut down to what fits
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        over = sum(widths) + len(GAP) * (len(widths) - 1) - (width - len(indent))
        texts = [at for at, column in enumerate(self.columns) if column.left]
        if over > 0 and texts:
            widest = max(texts, key=lambda at: widths[at])
            widths[widest] = max(widths[widest] - over, min(NARROWEST, widths[widest]))
        lines = list[str]()
        for row in rows:
            parts = [textwrap.wrap(text, width) or [""] for text, width in zip(row, widths, strict=True)]
            for at in range(max(map(len, parts))):  # as many lines as the longest cell needs
                cells = (
                    f"{part[at] if at < len(part) else '':{'<' if column.left else '>'}{width}}"
                    for part, column, width in zip(parts, self.columns, widths, strict=True)
                )
                lines.append((indent + GAP.join(cells)).rstrip())
        return "\n".join(lines)

    def plain_rows(self) -> list[list[str]]:
        """Return the cells as texts without marks."""
        return [[STRONG.sub(r"\1", CODE.sub(r"\1", text)) for text in row] for row in self._shown()]

    def _shown(self) -> list[list[str]]:
        return [
            [_text(cell, column.digits) for cell, column in zip(row, self.columns, strict=True)]
            for row in self.rows
        ]


def number(value: float | int | bool | None, digits: int = 4) -> str:
    """Return a number for a page: a true minus sign, thousands apart, a dash for None."""
    if isinstance(value, int) and not isinstance(value, bool):
        return f"{value:,}".replace(",", "\u202f").replace("-", "−")
    return _text(value, digits).replace("-", "−")


def read_csv(path: str | Path) -> Table:
    """Read a table of texts; a last line that a killed run left unfinished is not counted.

    Raises
    ------
    ResultError
        The file is missing or empty, or a row has too few or too many cells.
    """
    text = read_text(path)
    try:
        lines = list(csv.reader(io.StringIO(text[: text.rfind("\n") + 1]), strict=True))
    except csv.Error as error:
        raise ResultError(f"{path}: not a readable CSV table ({error}).") from error
    if not lines:
        raise ResultError(f"{path}: holds no header line.")
    head, *rows = lines
    for at, row in enumerate(rows, start=1):
        if len(row) != len(head):
            raise ResultError(f"{path}: row {at} has {len(row)} cells, the header {len(head)}.")
    return Table(tuple(map(Column, head)), tuple(map(tuple, rows)), str(path))


def _plain(cell: Cell) -> Plain:
    if isinstance(cell, Missing):
        return None
    return cell.text if isinstance(cell, Marked) else cell


def _text(cell: Cell, digits: int) -> str:
    known = _plain(cell)
    if known is None:
        return DASH
    if isinstance(known, bool):
        return "yes" if known else "no"
    return plain(known, digits) if isinstance(known, float) else str(known)


def _html(cell: Cell, column: Column) -> str:
    plain = _plain(cell)
    shown = markup(plain) if isinstance(plain, str) else number(plain, column.digits)
    why = f' title="{escape(cell.reason)}"' if isinstance(cell, Missing) else ""
    return f"<td{_style(column, cell.style if isinstance(cell, Marked) else '')}{why}>{shown}</td>"


def _style(column: Column, more: str = "") -> str:
    classes = " ".join(name for name in ("" if column.left else "number", more) if name)
    return f' class="{escape(classes)}"' if classes else ""
