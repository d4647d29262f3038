"""Cases of a study: computed once, never read stale, a failure is a row; bands and verdicts."""

import json
from concurrent.futures import Executor, Future
from dataclasses import replace

import numpy as np
import pytest
from study_fakes import outcome

import fem_impact.simulate
import fem_impact.sources as sources_module
from fem_impact.compare import BANDED, MEASURED, UNSEEN, compare, text_table, verdict
from fem_impact.errors import RunError
from fem_impact.outcome import KEYS, Outcome
from fem_impact.scene import MEASURED_SETS, load
from fem_impact.sources import source_digest, stamp
from fem_impact.study import run_sets
from fem_impact.study.bands import EXTRA, bands
from fem_impact.study.cases import STAMP, Case, Failure, compute, stored
from fem_impact.study.sensitivity import INPUTS
from fem_impact.study.sets import COARSER, cases_of, run_cases
from rigid.experiments import Statistic, measured_set


class Here(Executor):
    """Runs every case at once, in this process."""

    def __init__(self):
        self.cases = []

    def submit(self, work, case):
        self.cases.append(case.out.name)
        future = Future()
        future.set_result(work(case))
        return future


class Meter:
    def __init__(self):
        self.seen = []

    def __call__(self, progress):
        self.seen.append(progress)

    def close(self):
        pass


@pytest.fixture
def solver(monkeypatch):
    """A solver that answers at once; cases whose name is in ``broken`` fail."""
    broken = set()

    def simulate(scene, out=None, **_):
        if out.name in broken:
            raise RunError("An element folded at 12.00 us.")
        size = scene.accuracy.tip_size
        found = outcome(scene_id=scene.id, tip_size_m=size, e_paper=0.3 + 100 * size, E_vib_over_E_0=0.01)
        found.write(out / "outcome.json")
        return found

    monkeypatch.setattr(fem_impact.simulate, "simulate", simulate)
    monkeypatch.setattr("fem_impact.study.sets.present", lambda *_: [])  # pages are tested elsewhere
    return broken


def _run(tmp_path, ids=("t5b",), quick=True):
    engine, meter = Here(), Meter()
    return run_sets(ids, quick, tmp_path, meter, 1, engine, films=False), engine, meter


def test_a_set_is_two_meshes_and_a_table(solver, tmp_path):
    study, engine, meter = _run(tmp_path)
    assert engine.cases == ["t5b", "t5b-coarse"]
    assert [p.done for p in meter.seen[:2]] == [1, 2]
    assert study.rows[0]["bands"]["e_paper"] == pytest.approx(100 * 0.6e-3)
    written = json.loads((tmp_path / "study.json").read_text())
    assert written["rows"][0]["scene_id"] == "t5b"
    assert (tmp_path / "comparison.csv").is_file()
    assert "t5b" in study.table
    assert Outcome.read(tmp_path / "t5b" / "outcome.json")["bands"]["e_paper"] == pytest.approx(0.06)


def test_finished_cases_are_not_computed_again(solver, tmp_path):
    first, _, _ = _run(tmp_path)
    second, engine, _ = _run(tmp_path)
    assert engine.cases == []
    assert second.rows == first.rows


@pytest.mark.parametrize("harm", ["truncate", "remove", "unstamp", "other scene"])
def test_harmed_results_are_computed_again(solver, tmp_path, harm):
    _run(tmp_path)
    result, mark = tmp_path / "t5b" / "outcome.json", tmp_path / "t5b" / STAMP
    if harm == "truncate":
        result.write_text(result.read_text()[:200])
    elif harm == "remove":
        result.unlink()
    elif harm == "unstamp":
        mark.unlink()
    else:
        mark.write_text(mark.read_text().replace("scene ", "scene 0"))
    _, engine, _ = _run(tmp_path)
    assert engine.cases == ["t5b"]


def test_a_changed_scene_or_program_never_reads_a_stale_result(solver, tmp_path, monkeypatch):
    case = Case(load("t5b"), tmp_path / "t5b")
    assert compute(case) is None
    assert stored(case)["scene_id"] == "t5b"
    other = replace(case.scene, impact=replace(case.scene.impact, v_n=-1.0))
    assert stored(Case(other, case.out)) is None
    monkeypatch.setattr(sources_module, "source_digest", lambda: "another program")
    assert stored(case) is None


def test_a_run_killed_half_way_leaves_no_stamp(solver, tmp_path, monkeypatch):
    case = Case(load("t5b"), tmp_path / "t5b")
    compute(case)

    def killed(scene, out, **_):
        outcome().write(out / "outcome.json")
        raise KeyboardInterrupt

    monkeypatch.setattr(fem_impact.simulate, "simulate", killed)
    with pytest.raises(KeyboardInterrupt):
        compute(case)
    assert not (case.out / STAMP).exists()
    assert stored(case) is None


def test_sources_changed_during_a_run_do_not_sign_its_result(solver, tmp_path, monkeypatch):
    """The stamp must name the program that ran, not the one that lies there when it is done."""
    source = tmp_path / "kernel.py"
    source.write_text("old")
    monkeypatch.setattr(sources_module, "_sources", lambda: [source])
    quick = fem_impact.simulate.simulate

    def slow(scene, out, **rest):
        source.write_text("new")
        return quick(scene, out, **rest)

    monkeypatch.setattr(fem_impact.simulate, "simulate", slow)
    case = Case(load("t5b"), tmp_path / "t5b")
    source_digest.cache_clear()
    try:
        compute(case)
        source_digest.cache_clear()
        assert stored(case) is None
    finally:
        source_digest.cache_clear()


def test_the_digest_covers_what_makes_numbers():
    names = {path.name for path in sources_module._sources()}
    assert {"yielding_kernel.py", "impulses.py", "rod.py", "reduce.py", "markers.py", "eigen.py"} <= names
    assert not {"film.py", "run_page.py"} & names
    assert stamp(load("t5b")) != stamp(load("t5c"))


def test_the_digest_covers_the_arms_that_e_is_worked_out_with():
    """e_paper of an outcome uses the arms in the packaged table of sets: other arms, another result."""
    assert "sets.toml" in {path.name for path in sources_module._sources()}


def test_a_failing_case_is_a_row(solver, tmp_path):
    solver.add("t5c")
    study, engine, _ = _run(tmp_path, ("t5b", "t5c"))
    assert len(engine.cases) == 4
    assert [r["scene_id"] for r in study.rows] == ["t5b"]
    assert [f["scene_id"] for f in study.failures] == ["t5c"]
    assert "folded at 12.00 us" in study.failures[0]["error"]
    assert "failed: t5c" in study.table


def test_a_failing_coarse_mesh_leaves_the_fine_result_without_bands(solver, tmp_path):
    solver.add("t5b-coarse")
    study, _, _ = _run(tmp_path)
    assert study.rows[0]["bands"] is None
    assert "coarser mesh failed" in study.rows[0]["reasons"]["bands"]


def test_changed_inputs_are_run_unless_quick(solver, tmp_path):
    study, engine, _ = _run(tmp_path, quick=False)
    changed = {f"t5b-coarse-{i.name}" for i in INPUTS}
    assert set(engine.cases) == {"t5b", "t5b-coarse"} | changed
    written = json.loads((tmp_path / "study.json").read_text())
    assert {row["quantity"] for row in written["sensitivity"]} >= {"e", "mu"}
    assert study.failures == []


def test_the_coarser_twin(tmp_path):
    group = cases_of("t5b", False, tmp_path)
    fine, coarse = group["fine"].scene, group["coarse"].scene
    assert coarse.accuracy.tip_size == pytest.approx(COARSER * fine.accuracy.tip_size)
    assert coarse.save.frames == 0
    assert replace(coarse, accuracy=fine.accuracy, save=fine.save) == fine


def test_an_unreadable_result_is_a_failure(solver, tmp_path, monkeypatch):
    monkeypatch.setattr(fem_impact.simulate, "simulate", lambda scene, out, **_: None)
    found = run_cases([Case(load("t5b"), tmp_path / "t5b")], Meter(), 1, Here())
    assert isinstance(found["t5b"], Failure)
    assert "read back" in found["t5b"].reason


# ---------------------------------------------------------------- bands


@pytest.mark.parametrize("ratio", [2.0, 1.5, 3.0])
def test_bands_are_exact_for_first_order(ratio):
    h = 0.3e-3
    fine = outcome(tip_size_m=h, mu=0.5 + 200 * h, e_edge=0.3 - 50 * h, e_paper=None)
    coarse = outcome(tip_size_m=ratio * h, mu=0.5 + 200 * ratio * h, e_edge=0.3 - 50 * ratio * h)
    found = bands(fine, coarse)
    assert found["mu"] == pytest.approx(200 * h)
    assert found["e_edge"] == pytest.approx(50 * h)
    assert "e_paper" not in found


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
