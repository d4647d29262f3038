"""Model beside measurement: one row a quantity of a measured set, and what no camera could see."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rigid.experiments import Statistic, measured_set

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A compared quantity: its name in the tables, its key in the Outcome, its unit, its name in the set."""

    name: str
    key: str
    unit: str
    measured: str | None


MEASURED = (
    Quantity("e", "e_paper", "-", "e"),
    Quantity("mu", "mu", "-", "mu"),
    Quantity("Omega", "Omega_rad_per_s", "rad/s", "Omega"),
    Quantity("V_n", "V_n_m_per_s", "m/s", "V_n"),
    Quantity("V_t", "V_t_m_per_s", "m/s", "V_t"),
    Quantity("E_ln/E_0", "E_ln_paper_over_E_0", "-", "E_ln_over_E_0"),
    Quantity("E_lt/E_0", "E_lt_paper_over_E_0", "-", "E_lt_over_E_0"),
    Quantity("E_r/E_0", "E_r_over_E_0", "-", "E_r_over_E_0"),
)
UNSEEN = (
    Quantity("vibration/E_0", "E_vib_over_E_0", "-", None),
    Quantity("friction/E_0", "W_friction_over_E_0", "-", None),
    Quantity("plastic rod/E_0", "E_plastic_rod_over_E_0", "-", None),
    Quantity("plastic barrier/E_0", "E_plastic_barrier_over_E_0", "-", None),
    Quantity("locked-in rod/E_0", "E_locked_rod_over_E_0", "-", None),
    Quantity("locked-in barrier/E_0", "E_locked_barrier_over_E_0", "-", None),
    Quantity("radiated/E_0", "W_radiated_over_E_0", "-", None),
)
BANDED = tuple(q.key for q in (*MEASURED, *UNSEEN))


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


def compare(outcome: Mapping[str, Any]) -> list[Row]:
    """Return the comparison rows of the outcome of a measured set."""
    statistics = measured_set(outcome["scene_id"]).statistics()
    rows = []
    for quantity in (*MEASURED, *UNSEEN):
        found = statistics[quantity.measured] if quantity.measured else None
        rows.append(_row(outcome, quantity, found))
    return rows


def _row(outcome: Mapping[str, Any], quantity: Quantity, found: Statistic | None) -> Row:
    model, band = outcome[quantity.key], (outcome["bands"] or {}).get(quantity.key)
    row: Row = {
        "set": outcome["scene_id"],
        "quantity": quantity.name,
        "unit": quantity.unit,
        "model": model,
        "band": band,
        "measured_mean": None,
        "measured_sd": None,
        "measured_low": None,
        "measured_high": None,
        "n": None,
        "verdict": _unseen_verdict(outcome, quantity),
    }
    if found is not None:
        row |= {
            "measured_mean": found.mean,
            "measured_sd": found.sd,
            "measured_low": found.low,
            "measured_high": found.high,
            "n": found.n,
            "verdict": verdict(model, band, found) if model is not None else _unknown(outcome, quantity),
        }
    return row


def _unknown(outcome: Mapping[str, Any], quantity: Quantity) -> str:
    return f"not known: {outcome['reasons'][quantity.key]}"


def _unseen_verdict(outcome: Mapping[str, Any], quantity: Quantity) -> str:
    if outcome[quantity.key] is None:
        return _unknown(outcome, quantity)
    if quantity.key == "E_vib_over_E_0" and outcome["E_vib_below_floor"]:
        return "below floor"
    return "not measurable by camera"


def text_table(rows: list[Row]) -> str:
    """Return the rows as aligned text."""
    head = (
        f"{'set':<16}{'quantity':<22}{'model':>9} {'± mesh':>8}  {'measured':>9} {'SD':>7}  "
        f"{'95 % of mean':<18}verdict"
    )
    lines = [head, "-" * len(head)]
    for row in rows:
        if row["measured_mean"] is None:
            measured = f"{'-':>9} {'-':>7}  {'-':<18}"
        else:
            span = f"{row['measured_low']:.3f} .. {row['measured_high']:.3f}"
            measured = f"{row['measured_mean']:9.3f} {row['measured_sd']:7.3f}  {span:<18}"
        band = f"{row['band']:8.4f}" if row["band"] is not None else f"{'-':>8}"
        model = f"{row['model']:9.4f}" if row["model"] is not None else f"{'-':>9}"
        name = row["quantity"] + (f", {row['unit']}" if "/s" in row["unit"] else "")
        lines.append(f"{row['set']:<16}{name:<22}{model} {band}  {measured}{row['verdict']}")
    return "\n".join(lines)
