"""The thirteen measured sets and their recomputed quantities; the audit of every printed number."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from itertools import product
from typing import Any

import numpy as np

from ..arms import Arms
from ..coefficients import coefficients
from ..inputs import ArrayLike, DataError, Floats, floats
from ..losses import losses
from ..massive import solve
from ..uncertainty import MOTION, Errors, sensitivities
from .statistics import Statistic, covariance_of_means, statistic
from .tables import decimals, printed_statistics, statistic_decimals, table

DIAMETER = 0.019


@dataclass(frozen=True, slots=True)
class MeasuredSet:
    """One series of repeated tests.

    Attributes
    ----------
    id : str
        "t2" ... "t6-60".
    table : int
        Of the paper.
    surface : str
        "machined", "contaminated" or "cleaned".
    alpha : float
        Inclination, rad.
    length, diameter, tip_radius : float
        m.
    tip : str
        "A" or "B".
    arms : Arms
        d_c, d_d (m) with which the table was worked out.
    mass, k2 : float
        kg and m2 with which the table was worked out.
    select : mapping
        Labels of its rows in the table.
    printed : mapping of str to (n,) float64
        The rows as printed, SI.
    motion : mapping of str to (n,) float64
        v_n, v_t, V_n, V_t (m/s) and Omega (rad/s) of each row.
    reconstructed : bool
        True if the table prints coefficients only, so that `motion` was worked back from them.
    """

    id: str
    table: int
    surface: str
    alpha: float
    length: float
    diameter: float
    tip: str
    tip_radius: float
    arms: Arms
    mass: float
    k2: float
    select: Mapping[str, str]
    printed: Mapping[str, Floats]
    motion: Mapping[str, Floats]
    reconstructed: bool

    @property
    def body(self) -> dict[str, Any]:
        """Arms d_c, d_d (m) and k2 (m2) with which the table was worked out, by name."""
        return {**self.arms._asdict(), "k2": self.k2}

    @property
    def speed(self) -> float:
        """Mean speed of the mass centre before impact, m/s."""
        return float(np.hypot(self.motion["v_n"], self.motion["v_t"]).mean())

    def recomputed(self) -> dict[str, Floats]:
        """Recompute every quantity of interest from the velocities, row by row.

        Returns
        -------
        dict of str to (n,) float64
            v_n, v_t, V_n, V_t (m/s), Omega (rad/s), e, mu, e_m, and E_ln_over_E_0, E_lt_over_E_0,
            E_r_over_E_0, with E_0 = m (v_n^2 + v_t^2)/2 of that row.
        """
        return {**self.motion, **derived_columns(self.motion, **self.body, mass=self.mass)}

    def statistics(self) -> dict[str, Statistic]:
        """Mean, sample SD and 95 % interval of the mean for each recomputed quantity."""
        return {name: statistic(values) for name, values in self.recomputed().items()}

    def covariance(self, names: Sequence[str]) -> Floats:
        """Covariance (k, k) of the means of named quantities, with what all tests share: tracking."""
        at = {name: np.asarray(np.mean(self.motion[name])) for name in MOTION}
        slopes = sensitivities(lambda **v: {**v, **derived_columns(v, **self.body, mass=self.mass)}, at)
        J = np.array([[float(slopes[name][by]) for by in MOTION] for name in names])
        sd = Errors().tracking_sd * np.array([float(at[by]) for by in MOTION])
        return self.scatter(names) + (J * sd) @ (J * sd).T

    def scatter(self, names: Sequence[str]) -> Floats:
        """Part (k, k) of it by which single tests differ."""
        return covariance_of_means(self.recomputed(), names)


def derived_columns(
    motion: Mapping[str, Floats], *, d_c: ArrayLike, d_d: ArrayLike, k2: float, mass: float
) -> dict[str, Floats]:
    """Return e, mu, e_m and E_ln_over_E_0, E_lt_over_E_0, E_r_over_E_0 of tests, (n,) each.

    Parameters
    ----------
    motion : v_n, v_t, V_n, V_t (m/s) and Omega (rad/s) of each test, (n,) each
    d_c, d_d : arms, m
    k2, mass : m2 and kg
    """
    body: dict[str, Any] = {"d_c": d_c, "d_d": d_d, "k2": k2}
    shares = losses(**motion, **body, mass=mass).fractions()._asdict()
    energies = {f"{name}_over_E_0": share for name, share in shares.items() if name != "E_0"}
    return {**coefficients(**motion, **body)._asdict(), **energies}


@cache
def _entries() -> dict[str, dict[str, Any]]:
    """Return the sets by id, as sets.toml states them."""
    return tomllib.loads((files(__package__) / "data" / "sets.toml").read_text(encoding="utf-8"))


def set_ids() -> tuple[str, ...]:
    """Ids of the thirteen sets, in the paper's order."""
    return tuple(_entries())


def measured_set(id: str) -> MeasuredSet:
    """Measured set by its id.

    Raises
    ------
    DataError
        If there is no set of this id; the message lists all ids.

    Examples
    --------
    >>> s = measured_set("t5b").statistics()["e"]
    >>> f"e = {s.mean:.3f}, SD {s.sd:.3f}, mean within {s.low:.3f} to {s.high:.3f}"
    'e = 0.327, SD 0.078, mean within 0.262 to 0.393'
    """
    if id not in _entries():
        raise DataError(f"no measured set {id!r}; there are {', '.join(set_ids())}")
    entry = _entries()[id]
    rows = table(entry["table"], entry["select"])
    reconstructed = "v_n" in entry
    if reconstructed:  # from the printed coefficients, by Eq 9, 10 and 12
        given = {name: entry[name] for name in ("v_n", "v_t", "d_c", "d_d", "k2")}
        after = solve(**given, e=rows["e"], mu=rows["mu"], e_m=rows["e_m"])
        before = {name: np.full(rows["e"].shape, entry[name]) for name in ("v_n", "v_t")}
        motion = {**before, **after._asdict()}
    else:
        motion = {name: rows[name] for name in MOTION}
    kept = ("table", "surface", "length", "tip", "tip_radius", "mass", "k2", "select")
    return MeasuredSet(
        id=id,
        alpha=float(np.radians(entry["alpha_deg"])),
        diameter=DIAMETER,
        arms=Arms(entry["d_c"], entry["d_d"]),
        printed=rows,
        motion=motion,
        reconstructed=reconstructed,
        **{name: entry[name] for name in kept},
    )


def measured_sets() -> tuple[MeasuredSet, ...]:
    """Thirteen sets, in the paper's order."""
    return tuple(measured_set(id) for id in set_ids())


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
    records = []
    for s in measured_sets():
        if s.reconstructed:
            continue
        tests = [f"{test:.0f}" for test in s.printed["test"]]
        for column, values, tolerance in _columns(s):
            rows = zip(tests, s.printed[column], values, tolerance, strict=True)
            records += [_record(s, row, column, *numbers) for row, *numbers in rows]
    return tuple(records)


def audit_statistics() -> tuple[AuditRecord, ...]:
    """Recompute the printed mean and SD lines of all tables from the printed rows."""
    records = []
    for s, which in product(measured_sets(), ("mean", "sd")):
        printed = printed_statistics(s.table, which, s.select)
        for column in (name for name in printed if name != "alpha_deg"):
            value = getattr(statistic(s.printed[column]), which)
            last = statistic_decimals(s.table, which, column, s.select)
            tolerance = 0.5001 * 10.0**-last + _half_units(s, column).max()
            records.append(_record(s, which, column, printed[column][0], value, tolerance))
    return tuple(records)


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


def _columns(s: MeasuredSet) -> Iterator[tuple[str, Floats, Floats]]:
    """Yield each column that follows from the printed numbers, worked out anew, and its tolerance, (n,)."""
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
        yield column, recompute(**at)[column], tolerance
    parts = ("E_lt", "E_ln", "E_r")  # of which the total is the sum
    rounded = sum(_half_units(s, name) for name in (*parts, "E_total"))
    yield "E_total", np.asarray(sum(s.printed[name] for name in parts)), np.asarray(rounded)


def _half_units(s: MeasuredSet, column: str) -> Floats:
    """Half a unit in the last printed digit of each row, (n,); 2e-4 of it more, for binary fractions."""
    return 0.5001 * 10.0 ** -np.array(decimals(s.table, column, s.select), dtype=np.float64)


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
