"""Hard cases: a few of them, what judges them, and the command; all of them are slow."""

import json
import math
from dataclasses import replace

import pytest
from study_fakes import published

from fem_impact.answers.report import Request
from fem_impact.case.case import Case
from fem_impact.case.zones import face_reach
from fem_impact.errors import ResultError, RunError, SceneError
from fem_impact.evidence.hard_cases.study import (
    CASES,
    Balance,
    HardCaseJob,
    HardCaseResult,
    balance,
    conclude,
    model_of,
)
from fem_impact.jobs.job import Failure
from fem_impact.options import FIDELITIES, RunOptions
from fem_impact.outcome.groups import texts
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.run import solve

QUICK = (
    *("flat-on-plane", "flat-on-block", "few-elements", "overlap", "between-nodes", "painleve"),
    *("upright-round", "resting"),
)


def run_case(name, out, **changed):
    job = HardCaseJob(replace(CASES[name], **changed), out / name)
    return job.read(job.run())


def test_the_list_is_long_and_holds_refused_and_detected_ones():
    assert len(CASES) >= 40
    assert {case.expected for case in CASES.values()} == {"closed", "refused", "detected"}
    assert len({case.difficulty for case in CASES.values()}) == len(CASES)


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.long) if name == "flat-on-block" else name for name in QUICK],
)
def test_a_hard_case_closes(name, tmp_path):
    result = run_case(name, tmp_path)
    assert (result.verdict, result.reason) == ("closed", "")
    assert result.residual < 1e-5 and result.steps > 100
    assert not list((tmp_path / name).glob("*checkpoint*"))


def test_more_than_the_stable_step_is_detected(tmp_path):
    result = run_case("step-1.1", tmp_path)
    assert result.verdict == "detected"
    assert "The energy has grown by" in result.reason and "near" not in result.reason
    assert result.steps < 400


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case.expected == "refused"])
def test_what_cannot_be_run_is_refused_before_any_work(name, tmp_path):
    result = run_case(name, tmp_path)
    assert result.verdict == "refused" and result.steps == 0
    assert any(key in result.reason for key in ("accuracy.across", "impact.omega", "impact.v_n"))


def test_a_case_that_ends_otherwise_than_expected_has_failed(tmp_path):
    with pytest.raises(RunError, match=r"refused, not closed: .*accuracy\.across"):
        run_case("six-elements", tmp_path, expected="closed")


def test_a_damaged_result_is_told(tmp_path):
    for text in ("{", '{"word": 1}', "[]"):
        with pytest.raises(ResultError, match="six-elements: its stored result is damaged"):
            HardCaseJob(CASES["six-elements"], tmp_path).read(text)


def test_the_start_and_the_step_of_a_case_are_its_own():
    case = replace(CASES["between-nodes"], step=0.45)
    scene = case.scene()
    own, plain = model_of(case, Case.of(scene)), build(Case.of(scene), case.gap)
    moved = own.start[0] - plain.start[0]
    assert moved[own.layout.rod[:, 0]] == pytest.approx(4e-4)
    assert own.step == pytest.approx(0.5 * plain.step)


@pytest.mark.long
def test_a_face_that_lies_flat_is_meshed_as_a_whole(tmp_path):
    run_case("upright-edge", tmp_path)
    outcome = Outcome.read(tmp_path / "upright-edge" / "outcome.json")
    assert not [words for words in texts(outcome.validity.limitations) if "outside its fine zone" in words]
    upright, tilted = (replace(CASES[name].scene(), id="x") for name in ("upright-edge", "angle-17"))
    assert face_reach(Case.of(upright).bodies) == (pytest.approx((13e-3, 0.0)), pytest.approx(6.5e-3))
    assert face_reach(Case.of(tilted).bodies) == ((0.0, 0.0), 0.0)


@pytest.mark.long
def test_a_rod_that_comes_down_nearly_flat_ends_before_its_tail_strikes(tmp_path):
    assert run_case("angle-89-block", tmp_path).verdict == "closed"
    assert Outcome.read(tmp_path / "angle-89-block" / "outcome.json").contact.strikes_again is True
    assert run_case("angle-89-coarse", tmp_path).verdict == "closed"


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.5, 1.57, -0.9, 3.0])
def test_the_rim_holds_the_lowest_point_however_the_rod_turns(run, angle):
    """So the free flight need not follow other nodes: neither tip nor tail is missed."""
    result, _ = run
    x = result.model.start[0]
    skin = result.model.layout.rod[result.model.geometry.rod.mesh.free_skin]
    height = x * 0.0
    height[skin[:, 2]] = math.cos(angle) * x[skin[:, 2]] + math.sin(angle) * x[skin[:, 0]]
    assert height[result.view.rim[:, 2]].min() == pytest.approx(height[skin[:, 2]].min(), abs=1e-9)


def test_a_spin_is_refused_where_the_contact_point_lifts_off():
    scene = load("t5b")
    for omega, fine in (("-1000 rad/s", True), ("67 rad/s", True), ("72 rad/s", False)):
        turned = replace_all(scene, {"impact.omega": omega})
        for fidelity in ("rigid", "solid"):
            if fine:
                Case.of(turned, fidelity)
            else:
                with pytest.raises(SceneError, match="lifts the contact point off"):
                    Case.of(turned, fidelity)


def test_an_indentation_deeper_than_the_radius_is_refused():
    scene = load("t5b")
    fast = replace_all(scene, {"impact.v_n": "-200 m/s"})
    assert Case(fast).bodies.estimate.depth > 0.0095
    assert Case.of(scene).bodies.estimate.depth < 0.0095
    for fidelity in FIDELITIES:
        with pytest.raises(SceneError, match="press the tip"):
            Case.of(fast, fidelity)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A case that closes, with its history."""
    out = tmp_path_factory.mktemp("run")
    scene = CASES["overlap"].scene()
    return solve(Case.of(scene), RunOptions(out)), out / "history.csv"


def test_the_judge_sees_what_is_wrong(run):
    result, history = run
    assert balance(result, history).faults() == []
    motion = result.motion
    wrong = {
        "momentum": replace(motion, V_n=motion.V_n * 1.01 + 0.01),
        "angular": replace(motion, Omega=motion.Omega + 5.0),
    }
    for word, changed in wrong.items():
        assert any(word in fault for fault in balance(replace(result, motion=changed), history).faults())
    assert "ledger" in balance(replace(result, worst=0.002 * result.E_0), history).faults()[0]


def test_every_balance_has_its_limit_and_nan_is_none():
    fine = dict.fromkeys(("residual", "growth", "fed", "momentum", "spin"), 0.0)
    assert Balance(**fine).faults() == []
    for name in fine:
        for value in (0.01, float("nan")):
            assert len(Balance(**fine | {name: value}).faults()) == 1


@pytest.mark.parametrize(
    ("column", "words"), [("W_friction_J", "friction fed"), ("residual_J", "the energy grew")]
)
def test_energy_out_of_nothing_is_seen(column, words, run, tmp_path):
    result, history = run
    lines = history.read_text().splitlines()
    at = lines[0].split(",").index(column)
    cells = lines[-1].split(",")
    cells[at] = repr(float(cells[at]) - 0.002 * result.E_0)
    made = tmp_path / "history.csv"
    made.write_text("\n".join([*lines[:-1], ",".join(cells)]) + "\n")
    (fault,) = balance(result, made).faults()
    assert fault.startswith(words)


@pytest.mark.long
def test_the_command_prints_a_table_and_keeps_what_it_computed(cli):
    words = ("stress", "--only", "six-elements", "--out", "here", "--workers", "1")
    code, out, err = cli(*words)
    assert code == 0
    assert "| six-elements |" in out and "1 of 1 scenes that are hard" in out
    assert "1 of 1 runs done" in err
    code, out, err = cli(*words, "--json")
    assert code == 0 and err == (kept := "1 of 1 runs are kept from before.\n")  # so nothing is run
    (sheet,) = json.loads(out)["sheets"]
    assert dict(zip(sheet["columns"], sheet["rows"][0], strict=True))["verdict"] == "refused"
    assert cli("stress", "--only", "spinning-away", "--out", "here")[0] == 0
    assert cli(*words)[2] == kept  # another case in the same place leaves the first one there


def test_an_unknown_case_and_a_page_of_something_else_are_refused(cli, tmp_path):
    code, _, err = cli("stress", "--only", "paineve")
    assert code == 2 and "Did you mean painleve?" in err
    (tmp_path / "page.md").write_text("nothing")
    code, _, err = cli("stress", "--page", "page.md")
    assert code == 2 and "holds something else" in err
    code, _, err = cli("stress", "--only", "six-elements", "--page", "new.md")
    assert code == 2 and "runs all cases" in err


def test_the_report_tells_what_failed_and_why_a_case_did_not_close(tmp_path):
    refused = HardCaseResult("refused", "too few elements")
    results = {"six-elements": refused, "painleve": Failure("painleve", "FAILED, not closed: why")}
    found = published(conclude, Request(tmp_path), results)
    assert "1 of 2 scenes that are hard" in found.text and "`six-elements`: too few elements" in found.text
    assert "| **FAILED** |" in found.text and "failed: painleve: FAILED, not closed: why" in found.text
    assert [failure["scene_id"] for failure in found.document["failures"]] == ["painleve"]


@pytest.mark.slow
def test_all_hard_cases_are_as_they_must_be(cli):
    code, out, _ = cli("stress", "--out", "here", "--json", "--quiet")
    document = json.loads(out)
    assert document["failures"] == []
    assert code == 0 and document["runs"] == len(CASES)
