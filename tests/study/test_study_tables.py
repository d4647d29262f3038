"""The study's Markdown, its friction ends, and pictures that may be missing."""

import pytest

import fem_impact.render
import fem_impact.report
from fem_impact.errors import MissingLibraryError
from fem_impact.progress import NullMeter
from fem_impact.study import friction as friction_module
from fem_impact.study.friction import friction_cases, friction_notes, friction_rows
from fem_impact.study.markdown import summary
from fem_impact.study.present import present
from fem_impact.study.sets import cases_of


def row(quantity, verdict, model=0.3, band=0.01):
    return {
        "set": "t5b",
        "quantity": quantity,
        "model": model,
        "band": band,
        "measured_mean": 0.327,
        "measured_sd": 0.078,
        "verdict": verdict,
    }


COMPARISON = [
    row("e", "inside"),
    row("mu", "undecided: mesh band"),
    row("Omega", "miss by +3.0 SD", 12.34, 1.26),
    row("E_ln/E_0", "outside, within the scatter"),
    row("E_lt/E_0", "inside", band=None),
    row("E_r/E_0", "inside"),
    row("V_n", "inside"),
]
SHARES = ("E_r", "E_vib", "W_friction", "E_plastic_rod", "E_plastic_barrier", "E_locked_rod", "W_radiated")
OUTCOME = {f"{name}_over_E_0": 0.1234 for name in SHARES} | {
    "scene_id": "t5b",
    "E_vib_over_E_0": 0.00354,
    "bands": {"E_vib_over_E_0": 0.0012},
    "residual_over_E_0": -2.1e-5,
    "steps": 9100,
    "cpu_s": 7.26,
}


def test_marks_tell_inside_undecided_and_outside_apart():
    beside = summary([OUTCOME], COMPARISON, []).splitlines()[2]
    cells = [cell.strip() for cell in beside.strip("|").split("|")]
    assert cells == [
        "t5b",
        "**0.300 ± 0.010** / 0.327 ± 0.078",
        "0.300 ± 0.010 / 0.327 ± 0.078 ?",
        "12.3 ± 1.3 / 0.3 ± 0.1",
        "0.300 ± 0.010 / 0.327 ± 0.078",
        "**0.300** / 0.327 ± 0.078",
        "**0.300 ± 0.010** / 0.327 ± 0.078",
    ]


def test_shares_are_percent_with_their_bands():
    cells = summary([OUTCOME], COMPARISON, []).splitlines()[6].strip("|").split("|")
    assert [cell.strip() for cell in cells] == [
        "t5b",
        "12.3",
        "0.35 ± 0.12",
        *["12.3"] * 5,
        "-2e-05",
        "9100",
        "7",
    ]


def test_a_study_has_both_ends_of_friction_and_a_quick_one_has_none(tmp_path):
    cases = cases_of("t3-contaminated", False, tmp_path)
    assert list(cases) == ["fine", "coarse", "low", "high"]
    surface = cases["coarse"].scene.surface
    ends = [cases[end].scene.surface.friction for end in ("low", "high")]
    assert ends == [surface.friction_low, surface.friction_high]
    assert cases["low"].scene.accuracy == cases["coarse"].scene.accuracy
    assert len({case.out for case in cases.values()}) == 4
    assert list(cases_of("t3-contaminated", True, tmp_path)) == ["fine", "coarse"]
    assert friction_cases(cases["coarse"]).keys() == {"low", "high"}


def test_friction_rows_and_their_sentence(monkeypatch):
    monkeypatch.setattr(friction_module, "Outcome", dict)
    outcomes = [
        {"scene_id": "t4", "friction_f": f, "e_paper": e, "mu": mu, "Omega_rad_per_s": 1.0}
        | {"E_vib_over_E_0": 0.01, "W_friction_over_E_0": 0.2}
        for f, e, mu in ((0.45, 0.40, 0.45), (0.57, 0.36, 0.52), (0.7, 0.31, 0.57))
    ]
    rows = friction_rows(*outcomes)
    assert rows[1] == {"set": "t4", "quantity": "mu", "f": [0.45, 0.57, 0.7], "model": [0.45, 0.52, 0.57]}
    (note,) = friction_notes(rows)
    assert "from 0.45 to 0.7 moves e from 0.400 to 0.310 and mu from 0.450 to 0.570" in note
    assert "0.360 and 0.520 at the stated f = 0.57" in note
    table = summary([OUTCOME], COMPARISON, rows).split("\n\n")[2]
    assert "| t4 | 0.45 / 0.57 / 0.7 | 0.4 / 0.36 / 0.31 |" in table


def test_a_failed_end_gives_no_row(tmp_path):
    assert friction_rows(None, None, None) == []


@pytest.mark.parametrize("films", [True, False])
def test_a_missing_library_costs_a_film_only(tmp_path, monkeypatch, films):
    run = tmp_path / "t4"
    run.mkdir()
    (run / "fields.vtkhdf").write_bytes(b"")
    pages = []

    def no_film(place, **_):
        raise MissingLibraryError("install libegl1")

    monkeypatch.setattr(fem_impact.render, "render", no_film)
    monkeypatch.setattr(fem_impact.report, "write_report", pages.append)
    notes = present([run], tmp_path, NullMeter(), films)
    assert pages == [run, tmp_path]
    assert notes == (["t4: install libegl1"] if films else [])
