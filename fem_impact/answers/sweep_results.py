"""The results of a sweep: a row a case, and its tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from fem_impact.answers.vary import Variation, in_unit, measure
from fem_impact.errors import UsageError, did_you_mean
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import Unknown, known, nearest_key, or_none
from fem_impact.outcome.record import KEY_TABLE, KEYS, Outcome
from fem_impact.tables.table import Cell, Table

if TYPE_CHECKING:
    import pandas

    from fem_impact.arrays import Array

STATE = ("finished", "reason")
"""Columns of how a run ended: whether it came to its end, and why not."""
COLUMNS = tuple(
    key.name
    for key in KEYS
    if key.kind in ("number", "count", "flag", "text", "entries")
    and key.name not in ("schema_version", "effect_choices", "finished", "stopped_because")
)
"""Columns of an outcome: every number, count, flag and text of it by its key; of its contacts, how many."""
NUMBERS = frozenset(key.name for key in KEYS if key.kind == "number")
"""Columns of floats."""
SHORT = (
    *("e_edge", "mu", "Omega_rad_per_s", "E_vib_over_E_0", "W_skin_over_E_0"),
    *("flash_temperature_K", "contacts", "strikes_again"),
)
"""Columns that are shown unless others are chosen."""


LOW, HIGH = "_low", "_high"
"""Ends of the names of the columns with the ends of the band of the column before them."""


def known_bands(outcome: Outcome) -> dict[str, float]:
    """Return the half-widths of an outcome by key; none where it has none."""
    return dict(or_none(outcome.half_widths) or {})


def require_columns(names: Sequence[str]) -> None:
    """Refuse a name that is no column of an outcome.

    Raises
    ------
    UsageError
        With the nearest name.
    """
    for name in names:
        if name not in COLUMNS:
            meant = nearest_key(name, [KEY_TABLE[column] for column in COLUMNS], "")
            remedy = f"{meant} `fem-impact schema` lists and explains them.".lstrip()
            raise UsageError("is no column of an outcome.", key="columns=", value=name, remedy=remedy)


@dataclass(frozen=True, slots=True)
class SweepRow:
    """One case of a sweep: the values that it states, its outcome, or None and the reason."""

    case: Variation
    outcome: Outcome | None
    reason: str

    def told(self, name: str) -> Cell:
        """Return a column of the outcome for a reader: a number with its half-width; None: not known."""
        if self.outcome is None or name in self.outcome.reasons:
            return None
        value = KEY_TABLE[name].of(self.outcome)
        if isinstance(value, tuple):
            return len(value)
        return self.outcome.told(name) if isinstance(value, float) else value


@dataclass(frozen=True, slots=True, repr=False)
class Results(Sequence[SweepRow]):
    """The cases of a sweep in the order of their values, the last key changing fastest.

    Attributes
    ----------
    vary : the values by key, as stated
    rows : one a case, failed ones too

    Examples
    --------
    >>> import fem_impact
    >>> found = fem_impact.sweep(fem_impact.load("t5b"), {"surface.friction": [0.2, 0.4]}, fidelity="rigid")
    >>> [round(row.outcome.restitution.mu, 2) for row in found]
    [0.2, 0.4]
    >>> len(found.select({"surface.friction": 0.4}))
    1
    """

    vary: Mapping[str, Sequence[Any]]
    rows: tuple[SweepRow, ...]

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[SweepRow]:
        return iter(self.rows)

    def __getitem__(self, at: Any) -> Any:
        return self.rows[at]

    def __repr__(self) -> str:
        failed = sum(row.outcome is None for row in self.rows)
        return f"Results({len(self.rows)} cases of {', '.join(self.vary)}; {failed} failed)"

    def _repr_html_(self) -> str:
        table = self.brief()  # names stay as `numbers` and `to_dataframe` take them
        named = tuple(replace(column, label=f"`{column.name}`") for column in table.columns)
        return replace(table, columns=named).html(repr(self))

    def select(self, values: Mapping[str, Any]) -> Results:
        """Return the cases with given values, such as ``{"impact.angle": "30 deg"}``, in any unit.

        Raises
        ------
        UsageError
            A key does not vary, or no case has the value.
        """
        rows = self.rows
        for key, value in values.items():
            if key not in self.vary:
                remedy = did_you_mean(key, self.vary, f"Varied are: {', '.join(self.vary)}.")
                raise UsageError("is not varied in this sweep.", key=key, remedy=remedy)
            rows = tuple(row for row in rows if _same(row.case.values[key], value))
            if not rows:
                remedy = f"There are: {', '.join(map(str, self.vary[key]))}."
                raise UsageError("is no value of this sweep.", key=key, value=value, remedy=remedy)
        return Results(self.vary, rows)

    def numbers(self, name: str) -> Array:
        """Return a column of the table as floats (n,), NaN where it is not known.

        Raises
        ------
        UsageError
            There is no such column.
        """
        import numpy as np

        plain = name if name in COLUMNS else name.removesuffix(LOW).removesuffix(HIGH)
        table = self.table((plain,) if plain in COLUMNS else ())
        if name not in table.names:
            names = (*table.names, *COLUMNS)
            raise UsageError("is no column.", key=name, remedy=did_you_mean(name, names, f"{names}."))
        cells = table.cells(name)
        return np.array([float("nan") if cell is None else float(cell) for cell in cells])  # type: ignore[arg-type]

    def table(self, columns: Sequence[str] = COLUMNS) -> Table:
        """Return one row a case: values, unit in the header, how it ended, and columns of its outcome.

        A number with a band is the limit of its levels, and the ends of its band stand in two columns after
        it, named with `LOW` and `HIGH` at the end; None where it has none. Without any band there are no such
        columns.

        Raises
        ------
        UsageError
            A name is no column of an outcome.
        """
        require_columns(columns)
        bands = {name for row in self.rows if row.outcome for name in known_bands(row.outcome)}
        listed = [
            column
            for name in columns
            for column in (name, name + LOW, name + HIGH)[: 3 if name in bands else 1]
        ]
        units = {key: measure(values[0])[1] for key, values in self.vary.items()}
        heads = [f"{key} [{unit}]" if unit else key for key, unit in units.items()]
        rows = [
            [
                row.case.name,
                *(in_unit(row.case.values[key], unit) for key, unit in units.items()),
                *_ended(row, listed),
            ]
            for row in self.rows
        ]
        return Table.of(("case", *heads, *STATE, *listed), rows)

    def brief(self, columns: Sequence[str] = ()) -> Table:
        """Return the table for a reader: values, and chosen columns or those known of `SHORT`, with errors.

        Raises
        ------
        UsageError
            A name is no column of an outcome.
        """
        require_columns(columns)
        of_cases, whole = self.table(()), self.table(SHORT)
        names = columns or [name for name in SHORT if any(whole.texts(name))]
        shown = [
            at for at, name in enumerate(of_cases.names) if name != "reason" or any(of_cases.texts(name))
        ]
        rows = [
            [*(cells[at] for at in shown), *(row.told(name) for name in names)]
            for row, cells in zip(self, of_cases.rows, strict=True)
        ]
        return Table.of((*(of_cases.names[at] for at in shown), *names), rows)

    def to_dataframe(self, columns: Sequence[str] = COLUMNS) -> pandas.DataFrame:
        """Return the table as a data frame of pandas, of every column of an outcome or of chosen ones.

        A number that is not known is NaN.

        Raises
        ------
        UsageError
            A name is no column of an outcome.
        """
        import pandas

        table = self.table(columns)
        frame = pandas.DataFrame(list(table.rows), columns=[column.name for column in table.columns])
        numbers = [name for name in frame if name.removesuffix(LOW).removesuffix(HIGH) in NUMBERS]
        return frame.astype(dict.fromkeys(numbers, "float64"))


def _same(value: Any, wanted: Any) -> bool:
    """Return whether two values are one, to the precision of a change of units."""
    unit = measure(value)[1]
    a, b = in_unit(value, unit), in_unit(wanted, unit)
    if isinstance(a, str) or isinstance(b, str):
        return a == b
    return abs(a - b) <= 1e-9 * max(abs(a), abs(b))


def _ended(row: SweepRow, columns: Sequence[str]) -> list[Cell]:
    if row.outcome is None:
        return [False, row.reason, *([None] * len(columns))]
    validity, e = row.outcome.validity, KEY_TABLE["e_edge"].of(row.outcome)
    values = row.outcome.to_dict([KEY_TABLE[name] for name in columns if name in KEY_TABLE])
    for name in known_bands(row.outcome):
        values[name] = known(row.outcome.estimate(name)[0])
        ends = row.outcome.band_of(KEY_TABLE[name]) or (None, None)
        values |= dict(zip((name + LOW, name + HIGH), ends, strict=True))
    reason = (e.reason if isinstance(e, Unknown) else "") if validity.finished else validity.stopped_because
    target, achieved = validity.accuracy_target, or_none(validity.achieved_error)
    if not reason and isinstance(target, float) and achieved is not None and achieved > target:
        reason = f"known to {100 * achieved:.2g} %, not to the wanted {100 * target:.3g} %"
    cells = (values.get(name) for name in columns)
    return [validity.finished, reason, *(len(cell) if isinstance(cell, list) else cell for cell in cells)]


def row_of(case: Variation, result: Outcome | Failure | None) -> SweepRow:
    """Return the row of a case from what its job gave."""
    if isinstance(result, Outcome):
        return SweepRow(case, result, "")
    return SweepRow(case, None, result.reason if result else case.refused)
