"""Bands of two meshes, verdicts, and the rows of the comparison."""

import numpy as np
import pytest
from study_fakes import outcome

from fem_impact.answers.compare import MEASURED, UNSEEN, compare, verdict
from fem_impact.answers.refine.extrapolate import LOWEST, ONE_RUN, mesh_limits, mesh_means, pair_limit
from fem_impact.outcome.record import KEYS
from fem_impact.scene.types import MEASURED_SETS
from rigid.experiments import Statistic, measured_set


@pytest.mark.parametrize("ratio", [2.0, 1.5, 3.0])
@pytest.mark.parametrize("order", [LOWEST, 1.0, 1.5, 2.0, 4.0])
def test_the_band_holds_the_limit_of_every_order_from_the_lowest(ratio, order):
    h = 0.3e-3
    fine, coarse = (
        outcome(tip_size_m=size, mu=0.5 + 0.1 * (size / h) ** order, e_edge=0.3 - 0.02 * (size / h) ** order)
        for size in (h, ratio * h)
    )
    limits, bands = mesh_limits(([fine] * 2, [coarse] * 2))
    for key, limit in (("mu", 0.5), ("e_edge", 0.3)):
        assert abs(limits[key] - limit) <= bands[key] * (1 + 1e-9)


def test_the_band_reaches_from_the_finer_mesh_to_the_lowest_order():
    fine, coarse = outcome(tip_size_m=3e-4, e_edge=0.30), outcome(tip_size_m=6e-4, e_edge=0.36)
    limits, bands = mesh_limits(([fine] * 2, [coarse] * 2))
    assert limits["e_edge"] + bands["e_edge"] == pytest.approx(0.30)
    assert limits["e_edge"] - bands["e_edge"] == pytest.approx(0.30 - 0.06 / (2**LOWEST - 1))
    assert limits["e_edge"] == pytest.approx(0.256, abs=5e-4)
    assert bands["e_edge"] == pytest.approx(0.044, abs=5e-4)


def test_one_run_on_each_mesh_has_a_wider_band_about_the_same_limit():
    fine, coarse = outcome(tip_size_m=3e-4, e_edge=0.30), outcome(tip_size_m=6e-4, e_edge=0.36)
    (limits, bands), (means, narrow) = (mesh_limits(([fine] * n, [coarse] * n)) for n in (1, 2))
    assert limits["e_edge"] == means["e_edge"]
    assert bands["e_edge"] == pytest.approx(ONE_RUN * narrow["e_edge"])
    assert mesh_limits(([fine] * 2, [coarse]))[1]["e_edge"] == bands["e_edge"]


def test_what_one_mesh_does_not_know_has_no_limit():
    limits, bands = mesh_limits(([outcome(e_paper=None)], [outcome(tip_size_m=8e-4)]))
    assert "e_paper" not in limits
    assert set(limits) == set(bands) == {key.name for key in KEYS if key.banded} - {"e_paper"}


def test_shares_keep_their_sum_in_the_limit():
    """The rule is linear, so what adds up on both meshes adds up in the limit."""
    fine = outcome(E_r_over_E_0=0.7, W_friction_over_E_0=0.3)
    coarse = outcome(tip_size_m=8e-4, E_r_over_E_0=0.6, W_friction_over_E_0=0.4)
    limits, _ = mesh_limits(([fine], [coarse]))
    assert limits["E_r_over_E_0"] + limits["W_friction_over_E_0"] == pytest.approx(1.0)


def test_places_of_the_grid_widen_the_band_by_their_scatter():
    fine = [outcome(mu=mu) for mu in (0.50, 0.52)]
    coarse = [outcome(mu=0.56, tip_size_m=8e-4)] * 2
    limits, bands = mesh_limits((fine, coarse))
    limit, half = pair_limit(0.51, 0.56, 2.0, places=2)
    assert limits["mu"] == pytest.approx(limit)
    assert bands["mu"] > half
    assert mesh_means(fine)["mu"] == pytest.approx(0.51)


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


def test_vibration_below_its_floor_says_so():
    record = outcome(e_paper=0.3, E_ln_paper_over_E_0=0.4, E_lt_paper_over_E_0=0.3, E_vib_below_floor=True)
    found = {r["quantity"]: r["verdict"] for r in compare(record)}
    assert found["vibration/E_0"] == "below floor"
    assert found["radiated/E_0"] == "not measurable by camera"


def test_limits_and_bands_reach_the_rows():
    record = outcome(e_paper=0.3, mesh_limit={"e_paper": 0.32}, mesh_band={"e_paper": 0.07})
    found = {r["quantity"]: (r["model"], r["band"]) for r in compare(record)}
    assert found["e"] == (0.32, 0.07)
    assert found["mu"] == (0.5, None)
