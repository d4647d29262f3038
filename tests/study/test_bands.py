"""Bands of two meshes, verdicts, and the rows of the comparison."""

import numpy as np
import pytest
from fem_impact.study.bands import EXTRA, bands, limits
from study_fakes import outcome

from fem_impact.outcome.record import KEYS
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.study.compare import BANDED, MEASURED, UNSEEN, compare, text_table, verdict
from rigid.experiments import Statistic, measured_set


@pytest.mark.parametrize("ratio", [2.0, 1.5, 3.0])
def test_bands_are_exact_for_first_order(ratio):
    h = 0.3e-3
    fine = outcome(tip_size_m=h, mu=0.5 + 200 * h, e_edge=0.3 - 50 * h, e_paper=None)
    coarse = outcome(tip_size_m=ratio * h, mu=0.5 + 200 * ratio * h, e_edge=0.3 - 50 * ratio * h)
    found = bands(fine, coarse)
    assert found["mu"] == pytest.approx(200 * h)
    assert found["e_edge"] == pytest.approx(50 * h)
    assert "e_paper" not in found


@pytest.mark.parametrize("ratio", [2.0, 1.5])
def test_limits_are_exact_for_first_order(ratio):
    fine, coarse = (
        outcome(tip_size_m=h, mu=0.5 + 200 * h, e_edge=0.3 - 50 * h) for h in (3e-4, ratio * 3e-4)
    )
    found = limits(fine, coarse)
    assert (found["mu"], found["e_edge"]) == pytest.approx((0.5, 0.3))


def test_bands_are_no_narrower_than_the_error_of_second_order():
    h = 0.3e-3
    found = bands(outcome(tip_size_m=h, mu=1e6 * h**2), outcome(tip_size_m=2 * h, mu=1e6 * 4 * h**2))
    assert found["mu"] >= 1e6 * h**2


def test_every_banded_quantity_exists_in_the_record():
    assert set(BANDED) | set(EXTRA) <= {key.name for key in KEYS}


# ---------------------------------------------------------------- comparison

SAMPLE = Statistic(0.32, 0.04, 0.29, 0.35, 8)


@pytest.mark.parametrize(
    ("model", "band", "says"),
    [
        (0.33, None, "inside"),
        (0.29, 0.0, "inside"),
        (0.36, 0.02, "undecided: mesh band"),
        (0.28, 0.02, "undecided: mesh band"),
        (0.36, 0.001, "outside, within the scatter"),
        (0.25, 0.01, "outside, within the scatter"),
        (0.45, 0.01, "miss by +3.0 SD"),
        (0.19, 0.01, "miss by -3.0 SD"),
        (0.45, None, "miss by +3.2 SD"),
    ],
)
def test_verdicts(model, band, says):
    assert verdict(model, band, SAMPLE) == says


def test_a_wide_band_never_makes_agreement():
    for model in np.linspace(-1, 2, 50):
        if not SAMPLE.low <= model <= SAMPLE.high:
            assert verdict(model, 10.0, SAMPLE) == "undecided: mesh band"


@pytest.mark.parametrize("name", MEASURED_SETS)
def test_rows_of_every_measured_set(name):
    record = outcome(scene_id=name, e_paper=0.3, E_ln_paper_over_E_0=0.4, E_lt_paper_over_E_0=0.3)
    rows = compare(record)
    assert [r["quantity"] for r in rows] == [q.name for q in (*MEASURED, *UNSEEN)]
    by_name = {r["quantity"]: r for r in rows}
    exact = measured_set(name).recomputed()
    assert by_name["e"]["measured_mean"] == pytest.approx(exact["e"].mean())
    assert by_name["Omega"]["measured_mean"] == pytest.approx(exact["Omega"].mean())
    assert by_name["mu"]["n"] == len(exact["mu"])
    assert by_name["friction/E_0"]["verdict"] == "not measurable by camera"
    table = text_table(rows)
    assert len(table.splitlines()) == len(rows) + 2
    assert " Omega, rad/s  " in table and " V_n, m/s  " in table and " mu  " in table


def test_vibration_below_its_floor_says_so():
    record = outcome(e_paper=0.3, E_ln_paper_over_E_0=0.4, E_lt_paper_over_E_0=0.3, E_vib_below_floor=True)
    found = {r["quantity"]: r["verdict"] for r in compare(record)}
    assert found["vibration/E_0"] == "below floor"
    assert found["radiated/E_0"] == "not measurable by camera"


def test_bands_reach_the_rows():
    record = outcome(e_paper=0.3, E_ln_paper_over_E_0=0.4, E_lt_paper_over_E_0=0.3, bands={"e_paper": 0.07})
    found = {r["quantity"]: r["band"] for r in compare(record)}
    assert found["e"] == 0.07
    assert found["mu"] is None
