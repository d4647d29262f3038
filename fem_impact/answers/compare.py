"""Computed against measured quantities of a measured set, with computed energies that cannot be measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fem_impact.outcome.keys import Key, Num, Unknown, known, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome, ends_of
from fem_impact.outcome.shares import shares
from fem_impact.run.tests import OTHERS, MeasuredTests
from fem_impact.tables.text import plain, with_band
from rigid.experiments import Statistic, measured_set

ComparisonRow = dict[str, Any]


@dataclass(frozen=True, slots=True)
class ComparedQuantity:
    """A compared quantity.

    Attributes
    ----------
    name : str
        Name in the tables.
    key : Key
        Key of the computed value in the outcome.
    measured : str or None
        Name in the measured set; None where it cannot be measured.
    """

    name: str
    key: Key
    measured: str | None = None


MEASURED = (
    ComparedQuantity("e", KEY_TABLE["e_paper"], "e"),
    ComparedQuantity("mu", KEY_TABLE["mu"], "mu"),
    ComparedQuantity("Omega", KEY_TABLE["Omega_rad_per_s"], "Omega"),
    ComparedQuantity("V_n", KEY_TABLE["V_n_m_per_s"], "V_n"),
    ComparedQuantity("V_t", KEY_TABLE["V_t_m_per_s"], "V_t"),
    ComparedQuantity("E_ln/E_0", KEY_TABLE["E_ln_paper_over_E_0"], "E_ln_over_E_0"),
    ComparedQuantity("E_lt/E_0", KEY_TABLE["E_lt_paper_over_E_0"], "E_lt_over_E_0"),
    ComparedQuantity("E_r/E_0", KEY_TABLE["E_r_over_E_0"], "E_r_over_E_0"),
)
UNSEEN = tuple(ComparedQuantity(share.title, share.key) for share in shares("comparison"))
COMPARED = ("e", "mu", "Omega", "E_ln/E_0", "E_lt/E_0", "E_r/E_0")
"""Quantities of the tables that set model and measurement beside each other."""
STATISTICS = {f"measured_{name}": name for name in ("mean", "low", "high")} | {
    "measured_sd": "spread",
    "n": "n",
}
"""Columns of a measured quantity, and their attributes of `rigid.experiments.Statistic`."""


def verdict(model: float, band: float | None, measured: Statistic, called: str = "mesh band") -> str:
    """Return whether the computed value agrees with the measurement.

    "inside": in the 95 % interval of the mean; "undecided: mesh band": only the value's band reaches
    that interval; otherwise the distance from the mean, less the band, in standard deviations (SD) of single
    tests with what they share, "outside, within the scatter" up to two.

    Parameters
    ----------
    model : computed value
    band : half-width of its mesh band, same unit; None without a second mesh
    measured : mean, standard deviation and 95 % interval of the tests
    called : what the band is

    Examples
    --------
    >>> verdict(0.33, 0.01, Statistic(0.32, 0.04, 0.29, 0.35, 8))
    'inside'
    >>> verdict(0.45, 0.2, Statistic(0.32, 0.04, 0.29, 0.35, 8))
    'undecided: mesh band'
    >>> verdict(0.45, 0.01, Statistic(0.32, 0.04, 0.29, 0.35, 8))
    'miss by +3.0 SD'
    """
    half = band or 0.0
    if measured.low <= model <= measured.high:
        return "inside"
    if model - half <= measured.high and model + half >= measured.low:
        return f"undecided: {called}"
    away = model - measured.mean
    if measured.spread == 0:
        return "miss: tests without scatter"
    beyond = max(0.0, abs(away) - half) / measured.spread
    if beyond <= 2:
        return "outside, within the scatter"
    return f"miss by {beyond if away > 0 else -beyond:+.1f} SD"


def told(row: Mapping[str, Any]) -> str:
    """Return the model's number of a row with its half-width if it has one; a share of E_0 within 0 and 1."""
    value, band = row["model"], row["band"]
    if band is None:
        return plain(value)
    keys = {quantity.name: quantity.key for quantity in (*MEASURED, *UNSEEN)}
    key = keys.get(row["quantity"])
    return with_band(value, band, *(ends_of(key) if key else ()))


def measured_value(outcome: Outcome, name: str) -> tuple[Num, float | None]:
    """Return value and half band of a number of tests: a key of the outcome, or one of `OTHERS`."""
    return OTHERS[name][1](outcome) if name in OTHERS else outcome.estimate(name)


def compare(outcome: Outcome, tests: MeasuredTests | None = None) -> list[ComparisonRow]:
    """Return one row a quantity of an outcome beside tests; without them beside the set of its scene's id.

    With a second mesh, model and band are the limit for vanishing elements and its uncertainty; without one,
    model is the run's own value and band is None. The band of the reduced model is its half-width; a number
    of it that has none is not judged.
    """
    set_id, rows = outcome.provenance.scene_id, []
    statistics = (tests or measured_set(set_id)).statistics()
    reduced = outcome.provenance.fidelity == "modal"
    # those of a camera, others that the tests hold, those none can see
    usual = {quantity.measured for quantity in MEASURED}
    more = [ComparedQuantity(n, KEY_TABLE[n], n) for n in statistics if n in KEY_TABLE and n not in usual]
    other = [ComparedQuantity(n, Key(n, "number", OTHERS[n][0], ""), n) for n in statistics if n in OTHERS]
    for quantity in (*MEASURED, *more, *other, *UNSEEN):
        key, (model, band) = quantity.key, measured_value(outcome, quantity.key.name)
        computed = {"set": set_id, "quantity": quantity.name, "unit": key.unit, "model": or_none(model)}
        measured = statistics.get(quantity.measured or "")
        if isinstance(model, Unknown):
            judged = f"not known: {model.reason}"
        elif measured is not None and band is None and reduced:
            judged = "not judged: how far the reduced model is off is not known"
        elif measured is not None:
            judged = verdict(model, band, measured, "the model's error" if reduced else "mesh band")
        elif quantity.measured:
            judged = "not measured"
        else:
            below = key.path == ("energy", "vibration") and known(outcome.energy.below_floor)
            judged = "below floor" if below else "not measurable by camera"
        values = {column: measured and getattr(measured, name) for column, name in STATISTICS.items()}
        rows.append({**computed, "band": band, **values, "verdict": judged})
    return rows
