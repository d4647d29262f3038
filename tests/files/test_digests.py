"""Files beside an outcome: one that is not what the run wrote is refused, with its name and a remedy."""

import shutil
import subprocess

import pytest

from fem_impact.errors import ResultError
from fem_impact.files.atomic import DIGESTS, check_digest, write_digests
from fem_impact.files.fields import read_fields
from fem_impact.files.waves import read_waves
from fem_impact.options import RunOptions
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load
from fem_impact.tables.history import read_history

REFUSED = "is not the file that the run wrote.* Restore a copy, or run the scene again"


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Two finished runs of the reduced model."""
    place = tmp_path_factory.mktemp("runs")
    for name in ("t5b", "t5a"):
        simulate(load(name), "modal", RunOptions(place / name))
    return place


@pytest.fixture
def run(runs, tmp_path):
    shutil.copytree(runs / "t5b", tmp_path / "run")
    return tmp_path / "run"


def test_a_finished_run_states_its_files_as_sha256sum_reads_them(run):
    names = [line.split()[1] for line in (run / DIGESTS).read_text().splitlines()]
    assert names == ["contacts.csv", "history.csv"]
    assert len(read_history(run / "history.csv")) > 10
    command = ["sha256sum", "--check", "--strict", DIGESTS]
    assert subprocess.run(command, cwd=run, capture_output=True, check=False).returncode == 0


def test_a_history_of_another_run_is_refused(runs, run):
    shutil.copy(runs / "t5a" / "history.csv", run)
    with pytest.raises(ResultError, match=REFUSED):
        read_history(run / "history.csv")


def test_a_history_cut_at_the_end_of_a_row_is_refused(run):
    """Its rows are whole and their energies add up: nothing else tells that some are missing."""
    file = run / "history.csv"
    file.write_text("".join(file.read_text().splitlines(keepends=True)[:-3]))
    with pytest.raises(ResultError, match=REFUSED):
        read_history(file)
    (run / DIGESTS).unlink()  # of a run that goes on
    assert len(read_history(file)) > 10


@pytest.mark.parametrize(("name", "read"), [("fields.vtkhdf", read_fields), ("waves.h5", read_waves)])
def test_field_files_are_held_to_their_digest_first(tmp_path, name, read):
    (tmp_path / name).write_bytes(b"what the run wrote")
    write_digests(tmp_path, [name, "never written"])
    check_digest(tmp_path / name)
    (tmp_path / name).write_bytes(b"what the run wrot")
    with pytest.raises(ResultError, match=REFUSED):
        read(tmp_path / name)


def test_a_new_run_takes_the_place_of_the_stated_files(run):
    simulate(load("t5a"), "modal", RunOptions(run))
    assert len(read_history(run / "history.csv")) > 10
    (older,) = run.glob("earlier-*")
    assert len(read_history(older / "history.csv")) > 10


def test_the_report_says_that_a_history_is_of_another_run(runs, run, monkeypatch, capsys):
    from fem_impact.cli.main import main

    shutil.copy(runs / "t5a" / "history.csv", run)
    monkeypatch.chdir(run.parent)
    assert main(["report", "run"]) == 0
    page = (run / "report.html").read_text(encoding="utf-8")
    assert "history.csv: is not the file that the run wrote" in page
