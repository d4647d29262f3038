"""The thirteen measured sets: rod, barrier, arms, rows, and the quantities recomputed from the rows."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arms import Arms
from ..arrays import Floats
from ..coefficients import coefficients
from ..errors import DataError
from ..losses import losses
from ..massive import solve
from ..uncertainty import MOTION
from .statistics import Statistic, covariance_of_means, statistic
from .tables import table

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
        """Covariance (k, k) of the means of named quantities."""
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


def _motion(entry: Mapping[str, Any], rows: Mapping[str, Floats]) -> dict[str, Floats]:
    """Measured velocities, or those that the printed coefficients give (Eq 9, 10 and 12)."""
    if "v_n" not in entry:
        return {name: rows[name] for name in MOTION}
    given = {name: entry[name] for name in ("d_c", "d_d", "k2")}
    after = solve(entry["v_n"], entry["v_t"], e=rows["e"], mu=rows["mu"], e_m=rows["e_m"], **given)
    before = {name: np.full(rows["e"].shape, entry[name]) for name in ("v_n", "v_t")}
    return {**before, **after._asdict()}


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
    kept = ("table", "surface", "length", "tip", "tip_radius", "mass", "k2", "select")
    return MeasuredSet(
        id=id,
        alpha=float(np.radians(entry["alpha_deg"])),
        diameter=DIAMETER,
        arms=Arms(entry["d_c"], entry["d_d"]),
        printed=rows,
        motion=_motion(entry, rows),
        reconstructed="v_n" in entry,
        **{name: entry[name] for name in kept},
    )


def measured_sets() -> tuple[MeasuredSet, ...]:
    """Thirteen sets, in the paper's order."""
    return tuple(measured_set(id) for id in set_ids())
