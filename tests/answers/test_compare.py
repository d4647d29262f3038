"""Verdicts of the comparison with measured tests, and its rows."""

import numpy as np
import pytest
from study_fakes import outcome

from fem_impact.answers.compare import MEASURED, UNSEEN, compare, told, verdict
from fem_impact.scene.types import MEASURED_SETS
from rigid.experiments import Statistic, measured_set

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


def test_the_reduced_model_is_judged_by_its_own_error_and_where_it_has_none_not_at_all():
    """Numbers without a half-width were called a miss, and others open by the band of a mesh."""
    numbers = {"e_paper": 0.3, "E_ln_paper_over_E_0": 0.4, "E_lt_paper_over_E_0": 0.3}
    record = outcome(scene_id="t4", mesh_limit={"e_paper": 0.3}, mesh_band={"e_paper": 0.2}, **numbers)
    reduced = outcome(
        scene_id="t4", fidelity="modal", model_band={"e_paper": 0.2}, mesh_limit=None, **numbers
    )
    found = {row["quantity"]: row["verdict"] for row in compare(reduced)}
    assert found["e"] == "undecided: the model's error"
    assert found["E_ln/E_0"] == "not judged: how far the reduced model is off is not known"
    assert compare(record)[0]["verdict"] == "undecided: mesh band"


def test_a_share_of_the_energy_is_told_within_0_and_1():
    row = {"model": 0.05, "band": 0.2}
    assert told(row | {"quantity": "E_r/E_0"}) == "0.05 (0.00 to 0.25)"
    assert told(row | {"quantity": "E_ln/E_0"}) == "0.05 +- 0.20"
