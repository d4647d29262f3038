"""A user's own camera data: a CSV file with one test a row and the units in the header."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.scene.units import Unit
from fem_impact.scene.user_table import UserTable, in_si, read_user_table
from rigid.inputs import Floats

KINDS = {"v_n": "speed", "v_t": "speed", "V_n": "speed", "V_t": "speed", "Omega": "angular speed"}
ARMS = {"d_c": "length", "d_d": "length"}
"""Columns that may state the arms of the contact with which the tests are to be worked out."""
HEADER = "v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"
MEANS = "quantity,mean,sd,n"
"""Header of a file of means (`fem_impact.scene.means`)."""
LARGEST = 1e6
"""Bound of the size of a velocity, m/s or rad/s."""


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
    table = read_user_table(path, HEADER)
    columns = _columns(table)
    records = list(table.records())
    if len(records) < 2:
        raise ResultError(f"{path}: holds {len(records)} tests; an uncertainty needs at least two.")
    values = {
        name: np.array([_number(place, text, unit) for place, text in table.column(stated)])
        for name, (stated, unit) in columns.items()
    }
    motion = {name: values[name] for name in KINDS}
    arms = one_pair({name: values[name] for name in ARMS if name in values}, path)
    _check_motion(motion, table, {name: stated for name, (stated, _) in columns.items()})
    labels = tuple(record.get("test", str(i)) for i, (_, record) in enumerate(records, 1))
    used = {stated for stated, _ in columns.values()}
    return Camera(motion, labels, tuple(name for name in table.names if name not in (*used, "test")), arms)


def _columns(table: UserTable) -> dict[str, tuple[str, Unit]]:
    """Return name and unit of the column of each quantity; refuse a header that lacks one."""
    missing = [name for name in KINDS if not table.stating(name)]
    if missing and not any(len(table.stating(name)) > 1 for name in KINDS):
        hint = " Separate columns by commas." if any(";" in n or "\t" in n for n in table.names) else ""
        known = [name for name in ("e", "mu", "V_n", "V_t", "Omega") if table.stating(name)]
        means = f" {', '.join(known)} alone can be given as means: a file {MEANS}." if known else ""
        lacks = f"{table.path}: the header lacks {', '.join(missing)}.{hint}"
        raise ResultError(f"{lacks} It needs {HEADER} (capitals: after impact).{means}")
    stated = {name: table.quantity(name, dimension) for name, dimension in {**KINDS, **ARMS}.items()}
    return {name: column for name, column in stated.items() if column}


def _number(place: str, text: str, unit: Unit) -> float:
    """Read one cell in SI; ``place`` is for complaints."""
    value = in_si(place, text, unit)
    if abs(value) > LARGEST:
        raise ResultError(f"{place}: {text[:40]} is no speed of a dropped rod.")
    return value


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


def _check_motion(motion: Mapping[str, Floats], table: UserTable, stated: Mapping[str, str]) -> None:
    """Refuse a test that is no impact, usually because of a wrong sign."""
    wrong = (
        ("v_n", motion["v_n"] >= 0, "must be negative: n points out of the barrier, and the rod falls on it"),
        ("V_n", motion["V_n"] <= motion["v_n"], "must exceed v_n: the barrier can only push"),
    )
    for name, bad, rule in wrong:
        if bad.any():
            place, text = table.column(stated[name])[int(np.argmax(bad))]
            raise ResultError(f"{place}: {text} {rule}.")
