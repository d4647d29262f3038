"""Every printed column against its recomputation from the velocities, row by row."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Floats, floats
from ..coefficients import coefficients
from ..losses import losses
from ..uncertainty import MOTION, sensitivities
from .sets import MeasuredSet, measured_sets
from .statistics import statistic
from .tables import decimals, printed_statistics, statistic_decimals

COLUMNS = ("V_cn", "V_ct", "e", "mu", "e_m", "E_lt", "E_ln", "E_r")
CONSTANTS = {"d_c": 5e-5, "d_d": 5e-5, "mass": 5e-4, "k2": 1e-3}
"""Rounding of the constants: 0.05 mm, 0.5 g, and a thousandth of k2 itself."""


@dataclass(frozen=True, slots=True)
class AuditRecord:
    """One printed number and its recomputation.

    Attributes
    ----------
    set_id, column, row : str
        Place of the number; `row` is the test's number, "mean" or "sd".
    table : int
        Of the paper.
    printed, recomputed : float
        In the column's unit.
    tolerance : float
        Largest difference that the rounding of all numbers involved can make.
    explanation : str
        Reason why a number does not agree; empty if it does, or if the reason is not known.
    """

    set_id: str
    table: int
    row: str
    column: str
    printed: float
    recomputed: float
    tolerance: float
    explanation: str

    @property
    def agrees(self) -> bool:
        """Whether rounding accounts for the difference."""
        return abs(self.printed - self.recomputed) <= self.tolerance


def audit() -> tuple[AuditRecord, ...]:
    """Recompute Tables 2 and 4-6 with the arms, masses and k2 that they really used.

    Returns
    -------
    tuple of AuditRecord
        One for every number in the columns V_cn, V_ct (as the velocity of the contact point, Eq 14-15), e,
        mu, e_m, E_lt, E_ln, E_r and E_total (the sum of the three before). Table 3 prints nothing that
        could be recomputed.

    Examples
    --------
    >>> records = audit()
    >>> len(records), [r.row for r in records if r.column == "mu" and not r.agrees]
    (918, ['16', '25'])
    """
    sets = [s for s in measured_sets() if not s.reconstructed]
    return tuple(record for s in sets for part in (_columns(s), _totals(s)) for record in part)


def audit_statistics() -> tuple[AuditRecord, ...]:
    """Recompute the printed mean and SD lines of all tables from the printed rows."""
    return tuple(record for s in measured_sets() for record in _statistics(s))


def column_arms(set_id: str) -> Mapping[str, float]:
    """Arm d_c (m) of the columns that were not worked out with their set's own.

    Examples
    --------
    >>> dict(column_arms("t2"))
    {'e': 0.084, 'e_m': 0.0838}
    """
    arms: Mapping[str, float] = _knowledge()["arms"].get(set_id, {})
    return arms


def recompute(*, mass: ArrayLike, **given: ArrayLike) -> dict[str, Floats]:
    """Return the derived columns of the tables: Eq 14-18, 20, 21 and 26 (SI units).

    ``given`` are the velocities of `MOTION`, the arms d_c and d_d, and k2.
    """
    V_n, V_t, Omega, d_c, d_d = floats(*(given[name] for name in ("V_n", "V_t", "Omega", "d_c", "d_d")))
    markers = {"V_cn": V_n + d_c * Omega, "V_ct": V_t - d_d * Omega}
    return {**markers, **coefficients(**given)._asdict(), **losses(**given, mass=mass)._asdict()}


def _columns(s: MeasuredSet) -> Iterator[AuditRecord]:
    """Audit the columns that follow from the velocities."""
    for column in COLUMNS:
        # the inputs of every row, (n,) each, and half a unit of their last digit
        d_c = column_arms(s.id).get(column, s.arms.d_c)
        constants = {"d_c": d_c, "d_d": s.arms.d_d, "k2": s.k2, "mass": s.mass}
        shape = s.motion["v_n"].shape
        at = {name: s.motion[name] for name in MOTION}
        half = {name: _half_units(s, name) for name in MOTION}
        scale = {**dict.fromkeys(constants, 1.0), "k2": s.k2}
        at |= {name: np.full(shape, value) for name, value in constants.items()}
        half |= {name: np.full(shape, CONSTANTS[name] * scale[name]) for name in constants}
        slopes = sensitivities(recompute, at)[column]
        tolerance = _half_units(s, column) + sum(np.abs(slopes[k]) * half[k] for k in at)
        yield from _records(s, column, recompute(**at)[column], tolerance)


def _totals(s: MeasuredSet) -> Iterator[AuditRecord]:
    """Audit E_total as the sum of the three energies printed before it."""
    parts = ("E_lt", "E_ln", "E_r")
    total = sum(s.printed[name] for name in parts)
    tolerance = sum(_half_units(s, name) for name in (*parts, "E_total"))
    yield from _records(s, "E_total", np.asarray(total), np.asarray(tolerance))


def _half_units(s: MeasuredSet, column: str) -> Floats:
    """Half a unit in the last printed digit of each row, (n,); 2e-4 of it more, for binary fractions."""
    return 0.5001 * 10.0 ** -np.array(decimals(s.table, column, s.select), dtype=np.float64)


def _records(s: MeasuredSet, column: str, recomputed: Floats, tolerance: Floats) -> Iterator[AuditRecord]:
    """Pair the printed rows with the recomputed values."""
    tests = (f"{test:.0f}" for test in s.printed["test"])
    for row, printed, value, half in zip(tests, s.printed[column], recomputed, tolerance, strict=True):
        yield _record(s, row, column, printed, value, half)


def _statistics(s: MeasuredSet) -> Iterator[AuditRecord]:
    """Audit the mean and SD lines below a set's rows."""
    for which in ("mean", "sd"):
        printed = printed_statistics(s.table, which, s.select)
        for column in (name for name in printed if name != "alpha_deg"):
            value = getattr(statistic(s.printed[column]), which)
            last = statistic_decimals(s.table, which, column, s.select)
            tolerance = 0.5001 * 10.0**-last + _half_units(s, column).max()
            yield _record(s, which, column, printed[column][0], value, tolerance)


def _record(
    s: MeasuredSet, row: str, column: str, printed: float, value: float, tolerance: float
) -> AuditRecord:
    """Record of one number, with an explanation where it disagrees and the reason is known."""
    record = AuditRecord(s.id, s.table, row, column, float(printed), float(value), float(tolerance), "")
    if record.agrees:
        return record
    rows = {row} if row in ("mean", "sd") else {row, "*"}  # "*" stands for all tests, for no statistic
    reasons = (
        known["why"]
        for known in _knowledge()["known"]
        if known["set"] in ("*", s.id) and known["column"] in ("*", column) and rows & set(known["rows"])
    )
    return replace(record, explanation=next(reasons, ""))


@cache
def _knowledge() -> dict[str, Any]:
    """Tables of audit.toml: constants that columns were worked out with, and known misprints."""
    return tomllib.loads((files(__package__) / "data" / "audit.toml").read_text(encoding="utf-8"))
