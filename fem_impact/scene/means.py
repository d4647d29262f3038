"""A user's own tests as mean values with their scatter: a CSV file with one quantity a row."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from fem_impact.errors import ResultError, did_you_mean
from fem_impact.scene.camera import ARMS, LARGEST, one_pair
from fem_impact.scene.camera import HEADER as TESTS
from fem_impact.scene.camera import MEANS as HEADER
from fem_impact.scene.user_table import finite, read_user_table, unit_of

KINDS = {"e": "", "mu": "", "Omega": "angular speed", "V_n": "speed", "V_t": "speed"}
"""Quantities that a row may state, and their dimensions; empty: a pure number."""
LIKELY = {
    "e": (-1.0, 2.0, "the contact point's normal velocity after the impact over that before, a number"),
    "mu": (-10.0, 10.0, "the tangential impulse over the normal one, a number"),
}
"""Bounds of the means of pure numbers, and what these are; beyond them it is per cent or another quantity."""
SCATTER = ("sd", "standard_error")
CORRELATION = "r_"
"""Begins the columns of correlation coefficients: ``r_mu`` is that with the mean of mu."""


@dataclass(frozen=True, slots=True)
class Mean:
    """Mean and standard deviation of single tests, SI, and the number of tests.

    ``systematic`` is the standard uncertainty that all tests share, such as that of the instrument. A single
    test has it alone. ``correlation`` is that with other means by their names, where it is stated.
    """

    mean: float
    sd: float
    n: int
    systematic: float = 0.0
    correlation: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Means:
    """Means by quantity, and the arms of the contact point (d_c, d_d), m, where the file states them."""

    means: Mapping[str, Mean]
    arms: tuple[float, float] | None


def holds_means(path: str | Path) -> bool:
    """Return whether a file is one of means: its header has a column ``quantity``."""
    return "quantity" in read_user_table(path, f"{TESTS} (single tests) or {HEADER} (means)").names


def read_means(path: str | Path, others: Collection[str] = ()) -> Means:
    """Read means with their scatter.

    Parameters
    ----------
    path : path
        UTF-8 CSV with the columns ``quantity``, ``mean``, ``sd`` (standard deviation of single tests) or
        ``standard_error`` (of the mean), and ``n`` (number of tests). A quantity is ``e``, ``mu``,
        ``Omega_rad_per_s``, ``V_n_m_per_s`` or ``V_t_m_per_s``, the last three in any unit of theirs. Columns
        ``d_c_m`` and ``d_d_m`` may state the arms of the contact point with which ``e`` was worked out, a
        column ``systematic`` the standard uncertainty that all tests share; where n is 1 it is the only one.
        Columns such as ``r_mu`` may state the correlation of a mean with that of another quantity.
    others : names of further quantities, each with the SI unit that its name ends with

    Raises
    ------
    ResultError
        Names the file, and the line and column where there is one.
    """
    table = read_user_table(path, HEADER)
    scatter = _scatter(table.names, path)
    means: dict[str, Mean] = {}
    arms: dict[str, list[float]] = {name: [] for name in ARMS if f"{name}_m" in table.names}
    for line, row in table.records():
        place = f"{path}: line {line}"
        name, mean = _read_row(row, scatter, place, others)
        if name in means:
            raise ResultError(f"{place}: {name} has a line already. Keep one.")
        means[name] = mean
        for arm in arms:
            arms[arm].append(finite(f"{place}, column {arm}_m", row[f"{arm}_m"]))
    if not means:
        raise ResultError(f"{path}: holds no line below its header.")
    for name, mean in means.items():
        for other, r in mean.correlation.items():
            if other not in means or not abs(r) <= 1 or (other == name and r != 1):
                known = f"-1 to 1, with one of {', '.join(means)}"
                raise ResultError(f"{path}: {name}, column {CORRELATION}{other}: {r:g} is none from {known}.")
    return Means(means, one_pair(arms, path))


def _scatter(names: Sequence[str], path: str | Path) -> str:
    """Return the one column of the scatter; refuse a header that lacks a column or has both."""
    missing = [name for name in ("mean", "n") if name not in names]
    given = [name for name in SCATTER if name in names]
    if missing or len(given) != 1:
        raise ResultError(
            f"{path}: the header must be {HEADER}, or have standard_error in the place of sd; it is "
            f"{','.join(names)}."
        )
    return given[0]


def _read_row(row: Mapping[str, str], scatter: str, place: str, others: Collection[str]) -> tuple[str, Mean]:
    """Return the quantity of a row, and its mean and scatter in SI."""
    column = row["quantity"]
    name = next((name for name in KINDS if column == name or column.startswith((f"{name}_", f"{name} "))), "")
    if column in others and column != name and not KINDS.get(name):
        name = column  # e_edge is a number of its own, Omega_rad_per_s is Omega
    if not name:
        known = did_you_mean(column, (*KINDS, *others), f"Known: {', '.join(KINDS)} and keys of an outcome.")
        raise ResultError(f"{place}: {column!r} is not a quantity of tests. {known}")
    factor = 1.0
    if KINDS.get(name):
        factor = unit_of(column, KINDS[name], name, f"{place}, quantity").to_si("1")
    elif column != name:
        raise ResultError(f"{place}: {name} is a pure number. Write {name}, not {column!r}.")
    mean = factor * finite(f"{place}, column mean", row["mean"])
    tests = finite(f"{place}, column n", row["n"])
    if tests < 1 or tests != int(tests):
        raise ResultError(f"{place}, column n: {row['n']} is not a number of tests.")
    spread = 0.0 if tests == 1 else factor * finite(f"{place}, column {scatter}", row[scatter])
    if spread <= 0 and tests > 1:
        raise ResultError(f"{place}, column {scatter}: {row[scatter]} must be above 0: tests scatter.")
    if abs(mean) > LARGEST or spread > LARGEST:
        raise ResultError(f"{place}: {row['mean']} with {row[scatter]} is too large to be one of a test.")
    _check_likely(name, mean, place)
    shared = factor * finite(f"{place}, column systematic", row.get("systematic") or "0")
    if shared < 0 or (shared == 0 and tests == 1):
        bound = "be above 0: one test has no other uncertainty" if tests == 1 else "not be below 0"
        raise ResultError(f"{place}, column systematic: {row.get('systematic') or '0'} must {bound}.")
    sd = spread * tests**0.5 if scatter == "standard_error" else spread
    columns = (column for column, cell in row.items() if column.startswith(CORRELATION) and cell)
    together = {c.removeprefix(CORRELATION): finite(f"{place}, column {c}", row[c]) for c in columns}
    return name, Mean(mean, sd, int(tests), shared, together)


def _check_likely(name: str, mean: float, place: str) -> None:
    if name not in LIKELY:
        return
    low, high, meaning = LIKELY[name]
    if not low <= mean <= high:
        raise ResultError(
            f"{place}: {name} = {mean:g} is none of an impact: {name} is {meaning} from {low:g} to {high:g}, "
            "not in per cent. Correct it."
        )
