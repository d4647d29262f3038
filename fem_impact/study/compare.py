"""Model beside measurement: one row a quantity of a measured set, and what no camera could see."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fem_impact.outcome.keys import Key, Num, Unknown, known, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import shares
from rigid.experiments import Statistic, measured_set

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class ComparedQuantity:
    """A compared quantity: its name in the tables, its key in the outcome, its name in the measured set."""

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


def verdict(model: float, band: float | None, measured: Statistic) -> str:
    """Return how the model's interval stands to the measured mean and to the scatter of single tests.

    A model value that only its own mesh band brings to the measurement is undecided, not in agreement.

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
        return "undecided: mesh band"
    away = model - measured.mean
    beyond = max(0.0, abs(away) - half) / measured.sd
    if beyond <= 2:
        return "outside, within the scatter"
    return f"miss by {beyond if away > 0 else -beyond:+.1f} SD"


def compare(outcome: Outcome) -> list[Row]:
    """Return the comparison rows of the outcome of a measured set; model and band are those of two meshes.

    Without a second mesh the model is the run's own value and has no band.
    """
    statistics = measured_set(outcome.provenance.scene_id).statistics()
    return [
        _row(outcome, quantity, statistics[quantity.measured] if quantity.measured else None)
        for quantity in (*MEASURED, *UNSEEN)
    ]


def _row(outcome: Outcome, quantity: ComparedQuantity, found: Statistic | None) -> Row:
    model, band = outcome.estimate(quantity.key)
    return {
        "set": outcome.provenance.scene_id,
        "quantity": quantity.name,
        "unit": quantity.key.unit,
        "model": or_none(model),
        "band": band,
        "measured_mean": found and found.mean,
        "measured_sd": found and found.sd,
        "measured_low": found and found.low,
        "measured_high": found and found.high,
        "n": found and found.n,
        "verdict": _verdict(outcome, quantity, model, band, found),
    }


def _verdict(
    outcome: Outcome, quantity: ComparedQuantity, model: Num, band: float | None, found: Statistic | None
) -> str:
    if isinstance(model, Unknown):
        return f"not known: {model.reason}"
    if found is not None:
        return verdict(model, band, found)
    vibration = quantity.key.path == ("energy", "vibration")
    return "below floor" if vibration and known(outcome.energy.below_floor) else "not measurable by camera"
