"""A user's own tests: a CSV file with one test a row, or with mean and scatter of one quantity a row."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from fem_impact.errors import ResultError, did_you_mean
from fem_impact.scene.fields import V_N
from fem_impact.scene.units import Unit
from fem_impact.scene.user_table import UserTable, finite, in_si, read_user_table, unit_of
from rigid.inputs import Floats

OF_TESTS = {"v_n": "speed", "v_t": "speed", "V_n": "speed", "V_t": "speed", "Omega": "angular speed"}
SPIN_BEFORE = {"omega": "angular speed"}
"""Column that may state the spin before the impact, where it is not that of the scene."""
ARMS = {"d_c": "length", "d_d": "length"}
"""Columns that may state the arms of the contact with which the tests are to be worked out."""
HEADER = "v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"
MEANS = "quantity,mean,sd,n"
"""Headers of a file of single tests, and of one of means."""
LARGEST = 1e6
"""Bound of the size of a velocity, m/s or rad/s, and of e and mu."""
LARGEST_OTHER = 1e100
"""Bound of the size of any other number of an outcome, SI, of which variances must stay finite."""
FASTEST = -V_N.low
"""The most that a scene may state as a speed, m/s."""
TOO_FAST = f"is more than {FASTEST:g} m/s, the most that a scene may state: is its unit right?"


NO_TESTS = ("mean", "average", "median", "sd", "std", "min", "max", "sum", "total")
"""Labels, in small letters, of rows that spreadsheets add below the tests."""


@dataclass(frozen=True, slots=True)
class Camera:
    """Velocities of each test.

    Attributes
    ----------
    motion : mapping of str to (n,) float64
        v_n, v_t, V_n, V_t (m/s) and Omega (rad/s), and omega (rad/s) where the file states it.
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
        CSV with a header. Columns are named ``v_n_m_per_s`` or ``v_n [m/s]``, and so on, in
        any unit of speed (m/s, mm/s, km/s) and of angular speed (rad/s, deg/s, rpm); capitals are the
        motion after impact. A column ``test`` may label the rows, a column
        ``omega_rad_per_s`` may state the spin before, columns ``d_c_m`` and ``d_d_m`` the arms of the contact
        point.

    Raises
    ------
    ResultError
        Names the file, and the row and column where there is one.
    """
    table = read_user_table(path, HEADER)
    missing = [name for name in OF_TESTS if not table.stating(name)]
    if missing and not any(len(table.stating(name)) > 1 for name in OF_TESTS):
        known = [name for name in ("e", "mu", "V_n", "V_t", "Omega") if table.stating(name)]
        means = f" {', '.join(known)} alone can be given as means: a file {MEANS}." if known else ""
        lacks = f"{path}: the header lacks {', '.join(missing)}."
        raise ResultError(f"{lacks} It needs {HEADER} (capitals: after impact).{means}")
    columns = table.quantities({**OF_TESTS, **SPIN_BEFORE, **ARMS})
    records = list(table.records())
    if len(records) < 2:
        raise ResultError(f"{path}: holds {len(records)} tests; an uncertainty needs at least two.")
    values = {
        name: np.array([_number(place, text, unit) for place, text in table.column(stated)])
        for name, (stated, unit) in columns.items()
    }
    motion = {name: values[name] for name in (*OF_TESTS, *SPIN_BEFORE) if name in values}
    arms = one_pair({name: values[name] for name in ARMS if name in values}, path)
    _check_motion(motion, table, columns)
    _check_labels(table)
    labels = tuple(record.get("test", str(i)) for i, (_, record) in enumerate(records, 1))
    used = {stated for stated, _ in columns.values()} | {"test"}
    return Camera(motion, labels, table.unused(used, ("test", *ARMS)), arms)


def _number(place: str, text: str, unit: Unit) -> float:
    """Read one cell in SI; ``place`` is for complaints."""
    value = in_si(place, text, unit)
    if abs(value) > LARGEST:
        raise ResultError(f"{place}: {text[:40]} is no speed of a dropped rod.")
    return value


def _check_labels(table: UserTable) -> None:
    """Refuse a test that stands twice, and a row of what was worked out from tests."""
    seen = set[str]()
    for place, label in table.column("test") if "test" in table.names else ():
        if label.lower() in NO_TESTS:
            raise ResultError(f"{place}: {label!r} is no single test. Leave the line out.")
        if label and label in seen:
            remedy = "Leave one out, or give each test its own label."
            raise ResultError(f"{place}: test {label!r} stands in two lines. {remedy}")
        seen.add(label)


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
    motion: Mapping[str, Floats], table: UserTable, columns: Mapping[str, tuple[str, Unit]]
) -> None:
    """Refuse a test that is no impact, usually because of a wrong sign."""
    wrong = (
        ("v_n", motion["v_n"] >= 0, "must be negative: n points out of the barrier, and the rod falls on it"),
        ("V_n", motion["V_n"] <= motion["v_n"], "must exceed v_n: the barrier can only push"),
    )
    for name, bad, rule in wrong:
        if bad.any():
            place, text = table.column(columns[name][0])[int(np.argmax(bad))]
            raise ResultError(f"{place}: {text} {rule}.")
    for name in (name for name, dimension in OF_TESTS.items() if dimension == "speed"):
        if (fast := abs(motion[name]) > FASTEST).any():
            place, text = table.column(columns[name][0])[int(np.argmax(fast))]
            raise ResultError(f"{place}: {text} {TOO_FAST}")


OF_MEANS = {"e": "", "mu": "", "Omega": "angular speed", "V_n": "speed", "V_t": "speed"}
"""Quantities that a row may state, and their dimensions; empty: a pure number."""
LIKELY = {
    "e": (-1.0, 2.0, "the contact point's normal velocity after the impact over that before, a number"),
    "mu": (-10.0, 10.0, "the tangential impulse over the normal one, a number"),
}
SHARE = (-1.0, 2.0, "a share of the kinetic energy before the impact, a number")
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
    """Means of a file.

    Attributes
    ----------
    means : mapping of str to Mean
        By quantity.
    ignored : tuple of str
        Columns of the file that were not used.
    arms : (d_c, d_d) or None
        Arms of the contact point, m, where the file states them.
    """

    means: Mapping[str, Mean]
    ignored: tuple[str, ...]
    arms: tuple[float, float] | None


def holds_means(path: str | Path) -> bool:
    """Return whether a file is one of means: its header has a column ``quantity``."""
    return "quantity" in read_user_table(path, f"{HEADER} (single tests) or {MEANS} (means)").names


def read_means(path: str | Path, others: Collection[str] = ()) -> Means:
    """Read means with their scatter.

    Parameters
    ----------
    path : path
        CSV with the columns ``quantity``, ``mean``, ``sd`` (standard deviation of single tests) or
        ``standard_error`` (of the mean), and ``n`` (number of tests). A quantity is ``e``, ``mu``,
        ``Omega_rad_per_s``, ``V_n_m_per_s`` or ``V_t_m_per_s``, the last three in any unit of theirs. Columns
        ``d_c_m`` and ``d_d_m``, or in another unit of length, may state the arms of the contact point with
        which ``e`` was worked out, a column ``systematic`` the standard uncertainty that all tests share;
        where n is 1 it is the only one. Columns such as ``r_mu`` may state the correlation of a mean with
        that of another quantity.
    others : names of further quantities, each with the SI unit that its name ends with

    Raises
    ------
    ResultError
        Names the file, and the line and column where there is one.
    """
    table = read_user_table(path, MEANS)
    missing = [name for name in ("mean", "n") if name not in table.names]
    given = [name for name in SCATTER if name in table.names]
    if missing or len(given) != 1:
        raise ResultError(
            f"{path}: the header must be {MEANS}, or have standard_error in the place of sd; it is "
            f"{','.join(table.names)}."
        )
    scatter = given[0]
    means: dict[str, Mean] = {}
    columns = table.quantities(ARMS)
    used = {"quantity", "mean", scatter, "n", "systematic", *(column for column, _ in columns.values())}
    used |= {name for name in table.names if name.startswith(CORRELATION)}
    ignored = table.unused(used, ("systematic", *ARMS, *(f"{CORRELATION}{name}" for name in OF_MEANS)))
    arms: dict[str, list[float]] = {name: [] for name in columns}
    for line, row in table.records():
        place = f"{path}: line {line}"
        name, mean = _read_row(row, scatter, place, others)
        if name in means:
            raise ResultError(f"{place}: {name} has a line already. Keep one.")
        means[name] = mean
        for arm, (column, unit) in columns.items():
            arms[arm].append(in_si(f"{place}, column {column}", row[column], unit))
    if not means:
        raise ResultError(f"{path}: holds no line below its header.")
    _check_correlations(means, path)
    return Means(means, ignored, one_pair(arms, path))


def _check_correlations(means: Mapping[str, Mean], path: str | Path) -> None:
    """Refuse coefficients that no quantities have; what is not stated counts as 0."""
    together = np.eye(len(means))
    for row, (name, mean) in enumerate(means.items()):
        for other, r in mean.correlation.items():
            if other not in means or not abs(r) <= 1 or (other == name and r != 1):
                known = f"-1 to 1, with one of {', '.join(means)}"
                raise ResultError(f"{path}: {name}, column {CORRELATION}{other}: {r:g} is none from {known}.")
            if (back := means[other].correlation.get(name, r)) != r:
                both = f"{r:g} in the line of {name}, {back:g} in that of {other}"
                raise ResultError(
                    f"{path}: the correlation of {name} and {other} is {both}. It is one number."
                )
            column = list(means).index(other)
            together[row, column] = together[column, row] = r
    if np.linalg.eigvalsh(together).min() < -1e-6:  # of coefficients that are rounded
        raise ResultError(
            f"{path}: no quantities have these correlations together (their matrix has a negative "
            "eigenvalue, those that are not stated counted as 0). Check their signs and sizes."
        )


def _read_row(row: Mapping[str, str], scatter: str, place: str, others: Collection[str]) -> tuple[str, Mean]:
    """Return the quantity of a row, and its mean and scatter in SI."""
    column = row["quantity"]
    name = next(
        (name for name in OF_MEANS if column == name or column.startswith((f"{name}_", f"{name} "))), ""
    )
    if column in others and column != name and not OF_MEANS.get(name):
        name = column  # e_edge is a number of its own, Omega_rad_per_s is Omega
    if not name:
        known = did_you_mean(
            column, (*OF_MEANS, *others), f"Known: {', '.join(OF_MEANS)} and keys of an outcome."
        )
        raise ResultError(f"{place}: {column!r} is not a quantity of tests. {known}")
    factor = 1.0
    if OF_MEANS.get(name):
        factor = unit_of(column, OF_MEANS[name], name, f"{place}, quantity").to_si("1")
    elif column != name:
        raise ResultError(f"{place}: {name} is a pure number. Write {name}, not {column!r}.")
    mean = factor * finite(f"{place}, column mean", row["mean"])
    tests = finite(f"{place}, column n", row["n"])
    if tests < 1 or tests != int(tests):
        raise ResultError(f"{place}, column n: {row['n']} is not a number of tests.")
    spread = 0.0 if tests == 1 else factor * finite(f"{place}, column {scatter}", row[scatter])
    if spread <= 0 and tests > 1:
        raise ResultError(f"{place}, column {scatter}: {row[scatter]} must be above 0: tests scatter.")
    if max(abs(mean), spread) > (LARGEST if name in OF_MEANS else LARGEST_OTHER):
        raise ResultError(f"{place}: {row['mean']} with {row[scatter]} is too large to be one of a test.")
    _check_likely(name, mean, place)
    shared = factor * finite(f"{place}, column systematic", row.get("systematic") or "0")
    if shared < 0 or (shared == 0 and tests == 1):
        bound = "be above 0: one test has no other uncertainty" if tests == 1 else "not be below 0"
        stated = row.get("systematic") or "its standard uncertainty, which is not stated,"
        raise ResultError(f"{place}, column systematic: {stated} must {bound}.")
    sd = spread * tests**0.5 if scatter == "standard_error" else spread
    columns = (column for column, cell in row.items() if column.startswith(CORRELATION) and cell)
    together = {c.removeprefix(CORRELATION): finite(f"{place}, column {c}", row[c]) for c in columns}
    return name, Mean(mean, sd, int(tests), shared, together)


def _check_likely(name: str, mean: float, place: str) -> None:
    if OF_MEANS.get(name) == "speed" or name.endswith("_m_per_s"):
        if abs(mean) > FASTEST:
            raise ResultError(f"{place}: {name} = {mean:g} m/s {TOO_FAST}")
        return
    bounds = SHARE if name.endswith("_over_E_0") else LIKELY.get(name)
    if bounds is None:
        return
    low, high, meaning = bounds
    if not low <= mean <= high:
        raise ResultError(
            f"{place}: {name} = {mean:g} is none of an impact: {name} is {meaning} from {low:g} to {high:g}, "
            "not in per cent. Correct it."
        )
