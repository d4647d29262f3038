import csv
import json

import numpy as np
import pytest

from rigid import coefficients
from rigid.experiments import measured_set
from rigid.experiments.sets import recompute


def test_the_summary_counts_what_follows(cli):
    code, out, _ = cli("audit", "--json")
    document = json.loads(out)
    s = document["summary"]
    assert (code, s["numbers"], s["unexplained"]) == (0, 1216, 0)
    assert s["numbers"] - s["agree"] == s["marker_velocities_apart"] + s["others_apart"]
    apart = {(d["set"], d["row"], d["column"]) for d in document["disagreements"]}
    assert {("t2", "16", "mu"), ("t2", "25", "mu"), ("t3-cleaned", "sd", "e")} <= apart
    assert len(document["records"]) == 1216
    assert sum(not r["agrees"] for r in document["records"]) == s["numbers"] - s["agree"]


def test_text_comes_summary_first_and_names_every_set(cli):
    _, out, _ = cli("audit")
    assert out.splitlines()[0].endswith("within rounding.")
    for words in ("d_c = 0.0225 m", "leaves out test 1", "t6-60", "E_ln 3.0, e_m 3.0", "Chance alone"):
        assert words in out
    assert "leaves out -1" not in out  # e_m = -1 lies in the interval of every set


def test_one_set_and_its_file(cli, tmp_path):
    code, out, _ = cli("audit", "--set", "t5c", "--out", "t5c.csv", "--json")
    assert code == 0
    with (tmp_path / "t5c.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["set"] for row in rows} == {"t5c"}
    assert len(rows) == len(json.loads(out)["records"]) == 8 * 9 + 2 * 14
    first = next(row for row in rows if row["column"] == "e" and row["row"] == "1")
    assert (first["printed"], first["agrees"]) == ("0.218", "false")
    assert float(first["recomputed"]) == pytest.approx(0.21898, abs=1e-5)


def test_a_set_that_does_not_exist(cli):
    code, out, err = cli("audit", "--set", "t5e")
    assert (code, out) == (2, "")
    assert "Did you mean t5" in err


def test_constants_reported_are_those_used(cli):
    found = {c["set"]: c for c in json.loads(cli("audit", "--json")[1])["constants"]}
    assert found["t6-17"]["other_d_c_m"] == {"E_ln": 0.003, "e_m": 0.003}
    assert (found["t4"]["mass_kg"], found["t4"]["k_squared_m2"]) == (0.2623, 1.2226e-3)
    assert found["t3-cleaned"]["reconstructed"] is True


def test_scatter_has_the_error_bar_of_e_m(cli):
    scatter = {s["set"]: s for s in json.loads(cli("audit", "--json")[1])["scatter"]}
    bar = scatter["t6-37"]["e_m_of_mean"]
    assert bar["high"] - bar["low"] > 2 > scatter["t2"]["e_m_of_mean"]["high"] + 2
    assert scatter["t5b"]["e"]["tests"] == 8


def test_a_mean_that_leaves_out_a_test_is_not_blamed_on_the_marker(cli):
    records = json.loads(cli("audit", "--set", "t6-17", "--json")[1])["records"]
    (mean,) = [r for r in records if (r["column"], r["row"]) == ("V_ct", "mean")]
    assert mean["explanation"] == "the printed mean leaves out test 1"


# the explanations themselves


def row_of(s, test, **changed):
    i = list(s.printed["test"]).index(test)
    motion = {name: values[i] for name, values in s.motion.items()} | changed
    return i, lambda d_c: recompute(**motion, d_c=d_c, d_d=s.arms.d_d, k2=s.k2, mass=s.mass)


def test_table_2_test_25_was_worked_out_with_another_v_n():
    s = measured_set("t2")
    i, other = row_of(s, 25, v_n=-2.873)
    _, own = row_of(s, 25)
    for column in ("e", "mu"):
        assert other(0.084)[column] == pytest.approx(s.printed[column][i], abs=6e-4)
        assert abs(own(0.084)[column] - s.printed[column][i]) > 0.01
    assert own(0.083)["E_ln"] == pytest.approx(s.printed["E_ln"][i], abs=2e-3)


def test_table_2_test_16_follows_from_no_other_single_velocity():
    s = measured_set("t2")
    i, _ = row_of(s, 16)
    for name in s.motion:
        values = s.motion[name][i] * np.linspace(0.7, 1.3, 6001)
        motion = {k: v[i] for k, v in s.motion.items()} | {name: values}
        found = coefficients(**motion, d_c=0.0838, d_d=s.arms.d_d, k2=s.k2)
        both = (np.abs(found.mu - 0.430) < 8e-4) & (np.abs(found.e_m + 1.10) < 6e-3)
        assert not both.any()


def test_table_5_c_tests_1_and_2_were_worked_out_with_22_5_mm():
    s = measured_set("t5c")
    for test in (1, 2):
        i, found = row_of(s, test)
        assert found(0.0225)["e"] == pytest.approx(s.printed["e"][i], abs=1.1e-3)
        assert found(0.0225)["e_m"] == pytest.approx(s.printed["e_m"][i], abs=0.01)
        assert found(0.0225)["E_ln"] == pytest.approx(s.printed["E_ln"][i], abs=1.1e-3)
        assert abs(found(0.0226)["e_m"] - s.printed["e_m"][i]) > 0.03


def test_table_3_contaminated_test_12_is_a_misprint():
    rows = measured_set("t3-contaminated").printed["e_m"].copy()
    rows[11] = -0.959
    assert (rows.mean(), rows.std(ddof=1)) == (
        pytest.approx(-1.0145, abs=5e-5),
        pytest.approx(0.038, abs=5e-4),
    )
