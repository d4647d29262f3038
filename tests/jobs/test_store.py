"""Results by content address: read back whole or not at all, never for another scene or program."""

import json
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from outcome_maker import altered
from scale_tasks import Here, job, record, simulate

import fem_impact.run.program as sources_module
import fem_impact.run.simulate
from fem_impact.answers.refine.forecast import OverBudgetError
from fem_impact.errors import OutputPathError, ResultError, RunError, SceneError
from fem_impact.jobs import job as job_module
from fem_impact.jobs.job import Failure, Store
from fem_impact.jobs.run import run_jobs
from fem_impact.progress import Notice, NullMeter
from fem_impact.run.program import source_digest, stamp
from fem_impact.scene.shipped import load, replace

ROOT = Path(fem_impact.run.simulate.__file__).parents[2]


@pytest.fixture(autouse=True)
def solver(monkeypatch):
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", simulate)


def run(store, *jobs):
    engine = Here()
    return run_jobs(jobs, store, NullMeter(), engine), engine.names


def test_what_is_stored_is_not_computed_again(tmp_path):
    store = tmp_path / "study" / "store.sqlite"
    first, names = run(store, job("a"), job("b"))
    assert (list(first), names) == (["a", "b"], ["a", "b"])
    again, names = run(store, job("b"), job("a"), job("c"))
    assert (list(again), names) == (["b", "a", "c"], ["c"])
    assert again["a"] == first["a"]


def test_a_result_belongs_to_one_scene_fidelity_and_program(tmp_path, monkeypatch):
    store = tmp_path / "store.sqlite"
    run(store, job("a"))
    other = job_module.Job("a", replace(job("a").scene, "impact.v_n", "-1 m/s"), "rigid")
    assert run(store, other)[1] == ["a"]
    assert run(store, job_module.Job("a", job("a").scene, "solid"))[1] == ["a"]
    monkeypatch.setattr(job_module, "source_digest", lambda: "another program")
    monkeypatch.setattr("fem_impact.jobs.run.source_digest", lambda: "another program")
    assert run(store, job("a"))[1] == ["a"]


def test_a_run_with_files_is_computed_again_when_they_are_not_its_own(tmp_path):
    store, wanted = tmp_path / "store.sqlite", job("a", out=tmp_path / "a")
    first, _ = run(store, wanted)
    result = tmp_path / "a" / "outcome.json"
    assert run(store, wanted)[1] == []
    result.write_text(result.read_text()[:200])
    assert run(store, wanted)[1] == ["a"]
    altered(first["a"], created_utc="2001-01-01T00:00:00+00:00").write(result)
    assert run(store, wanted)[1] == ["a"]
    result.unlink()
    assert run(store, wanted)[1] == ["a"]


def test_failures_of_the_run_last_and_faults_are_tried_again(tmp_path):
    store = tmp_path / "store.sqlite"
    found, _ = run(store, job("a", "fail"), job("b"), job("c", "break"))
    assert found["a"] == Failure("a", "An element folded at 12.00 us.")
    assert "a fault of the program" in found["c"].reason
    assert found["b"].provenance.scene_id == "b"
    again, names = run(store, job("a", "fail"), job("b"), job("c", "break"))
    assert names == ["c"]
    assert again["a"] == found["a"]


def test_a_damaged_record_is_computed_again(tmp_path):
    store = tmp_path / "store.sqlite"
    run(store, job("a"))
    with Store.open(store) as base, base._base:
        base._base.execute("UPDATE answers SET outcome = replace(outcome, '0.25', '0.26')")
    assert run(store, job("a"))[1] == ["a"]


def test_what_is_kept_from_before_is_counted(tmp_path):
    store, told = tmp_path / "store.sqlite", []
    run(store, job("a"), job("b"))
    run_jobs([job("a"), job("b"), job("c")], store, told.append, Here())
    assert [one.text for one in told if isinstance(one, Notice)] == ["2 of 3 runs are kept from before."]
    assert isinstance(told[0], Notice)  # before the others begin


COLUMNS = ("outcome, reason", "outcome, reason, checksum")


@pytest.mark.parametrize("columns", COLUMNS)
def test_answers_of_other_jobs_are_computed_again_and_told(tmp_path, columns):
    """Rows whose answers were exchanged, each whole in itself, as another program may leave them."""
    store, jobs, told = tmp_path / "store.sqlite", [job("a"), job("b"), job("c", "fail")], []
    first, _ = run(store, *jobs)
    with Store.open(store) as base, base._base:
        rows = base._base.execute(f"SELECT {columns} FROM answers ORDER BY key").fetchall()
        keys = [key for (key,) in base._base.execute("SELECT key FROM answers ORDER BY key")]
        marks = ", ".join("?" for _ in rows[0])
        for key, row in zip(keys, [*rows[1:], rows[0]], strict=True):
            base._base.execute(f"UPDATE answers SET ({columns}) = ({marks}) WHERE key = ?", (*row, key))
    engine = Here()
    again = run_jobs(jobs, store, told.append, engine)
    assert (again, sorted(engine.names)) == (first, ["a", "b", "c"])
    texts = [notice.text for notice in told if isinstance(notice, Notice)]
    assert len(texts) == 3
    assert all("not taken from the store" in text and "checksum" in text for text in texts)
    assert run(store, *jobs)[1] == []


@pytest.mark.parametrize("other", ["scene", "fidelity"])
def test_an_outcome_of_another_scene_or_fidelity_is_computed_again_and_told(tmp_path, other):
    """Though its row was signed anew: the outcome itself says what it was computed from."""
    store, wanted, told = tmp_path / "store.sqlite", job("a"), []
    strange = record(job("b").scene) if other == "scene" else record(wanted.scene, "modal")
    with Store.open(store) as base:
        base.put(wanted, job_module.Answer("", strange.to_json(), "", False, 1.0))
    engine = Here()
    found = run_jobs([wanted], store, told.append, engine)
    assert (engine.names, found["a"].provenance.scene_id) == (["a"], "a")
    assert "another scene or fidelity" in told[0].text


@pytest.mark.parametrize("damage", ["drop column", "text in a number", "no table"])
def test_a_damaged_store_is_told_as_damaged(tmp_path, damage):
    store = tmp_path / "store.sqlite"
    run(store, job("a"))
    base = sqlite3.connect(store)
    if damage == "drop column":
        base.execute("ALTER TABLE answers DROP COLUMN reason")
    elif damage == "text in a number":
        base.execute("UPDATE answers SET wall_s = 'long', tip_size_m = x'00'")
    else:
        base.execute("DROP TABLE answers")
        base.execute("CREATE VIEW answers AS SELECT 1")
    base.commit()
    base.close()
    if damage == "text in a number":
        assert run(store, job("a"), job("b"))[1] == ["b"]
        return
    with pytest.raises(ResultError, match="is damaged") as caught:
        run(store, job("a"))
    assert "space" not in str(caught.value)


def test_a_full_disk_and_a_busy_store_are_told_apart(tmp_path, monkeypatch):
    monkeypatch.setattr("fem_impact.jobs.job.PATIENCE", 0.05)
    store = tmp_path / "store.sqlite"
    run(store, job("a"))
    other = sqlite3.connect(store)
    other.execute("BEGIN EXCLUSIVE")
    with pytest.raises(OutputPathError, match="Close the program that uses it"):
        run(store, job("b"))
    other.close()
    with Store.open(store) as base, pytest.raises(OutputPathError, match="Free some space"):
        pages = base._base.execute("PRAGMA page_count").fetchone()[0]
        base._base.execute(f"PRAGMA max_page_count = {pages}")
        base.put(job("large"), job_module.Answer("", "x" * 100_000, "", False, 1.0))


def test_a_file_that_is_no_store_is_named(tmp_path):
    store = tmp_path / "store.sqlite"
    store.write_bytes(b"no data base at all" * 100)
    with pytest.raises(ResultError, match=r"store\.sqlite: is damaged .* Move it away"):
        run(store, job("a"))
    with pytest.raises(OutputPathError, match="cannot be opened"), Store.open(tmp_path):
        pass


def test_sources_changed_during_a_run_do_not_sign_its_result(tmp_path, monkeypatch):
    """The answer must name the program that ran, not the one that lies there when it is done."""
    source = tmp_path / "kernel.py"
    source.write_text("old")
    monkeypatch.setattr(sources_module, "_sources", lambda: {"kernel.py": source})

    def slow(scene, *others):
        source.write_text("new")
        return simulate(scene, *others)

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", slow)
    source_digest.cache_clear()
    try:
        before = source_digest()
        source_digest.cache_clear()
        assert job_module.compute(job("a")).program == before
    finally:
        source_digest.cache_clear()


def test_the_digest_covers_what_makes_numbers():
    names = set(sources_module._sources())
    wanted = (
        "solid/yielding_kernel.py",
        "run/solid.py",
        "run/markers.py",
        "fem/eigen.py",
        "scene/data/surfaces.toml",
        "case/data/summary.json",
    )
    assert {f"fem_impact/{name}" for name in wanted} <= names
    assert {"meshes/rod.py", "rigid/experiments/data/sets.toml"} <= names
    others = (
        "render/film.py",
        "commands/run.py",
        "jobs/run.py",
        "tables/text.py",
        "case/data/effect-cost.csv",
    )
    assert not {f"fem_impact/{name}" for name in others} & names
    assert stamp(load("t5b")) != stamp(load("t5c"))


@pytest.mark.parametrize(
    ("file", "moves"),
    [
        ("fem_impact/case/data/summary.json", True),
        ("fem_impact/scene/data/materials.toml", True),
        ("rigid/massive.py", True),
        ("fem_impact/tables/text.py", False),
        ("fem_impact/case/data/effect-cost.csv", False),
    ],
)
def test_the_digest_follows_the_files_that_make_numbers(tmp_path, monkeypatch, file, moves):
    for package in ("fem_impact", "meshes", "rigid"):
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(sources_module, "files", lambda package: tmp_path / package)
    before = source_digest.__wrapped__()
    (tmp_path / file).write_text("changed")
    assert (source_digest.__wrapped__() != before) == moves


@pytest.mark.long
def test_the_digest_covers_all_modules_that_a_run_imports():
    """All but those that refuse, write files or show progress."""
    probe = (
        "import sys\n"
        "from fem_impact.run.simulate import simulate\nfrom fem_impact.scene.shipped import load\n"
        "import fem_impact.run.solid, fem_impact.solid.run\n"
        "simulate(load('t5b'), 'rigid'), simulate(load('t5b'), 'modal')\n"
        "print(*(name for name in sys.modules if name.startswith('fem_impact.')))"
    )
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    known = {name.removesuffix(".py").replace("/", ".") for name in sources_module._sources()}
    known |= {name.removesuffix(".__init__") for name in known}
    others = {name.split(".")[1] for name in set(done.stdout.split()) - known}
    assert others == {"arrays", "errors", "files", "options", "plugins", "progress", "tables", "version"}


def test_the_digest_covers_the_libraries(monkeypatch):
    before = source_digest.__wrapped__()
    monkeypatch.setattr(sources_module.metadata, "version", lambda name: "0")
    assert source_digest.__wrapped__() != before


def test_answers_of_a_failure_are_plain_text(tmp_path):
    answer = job_module.compute(job("a"))
    assert json.loads(answer.outcome)["scene_id"] == "a"
    assert (answer.reason, answer.lasting) == ("", False)


@pytest.mark.parametrize(
    ("error", "lasts"),
    [
        (SceneError("is too short.", key="projectile.length"), True),
        (RunError("An element folded at 12.00 us."), True),
        (OverBudgetError("The level takes too long.", 90), False),
        (OutputPathError("The disk is full."), False),
    ],
)
def test_a_failure_that_depends_on_the_machine_is_tried_again(tmp_path, monkeypatch, error, lasts):
    def fails(*_):
        raise error

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", fails)
    store = tmp_path / "store.sqlite"
    first, _ = run(store, job("a"))
    again, names = run(store, job("a"))
    assert first["a"] == again["a"] == Failure("a", str(error))
    assert names == ([] if lasts else ["a"])
