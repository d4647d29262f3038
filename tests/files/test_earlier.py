"""A run sets aside what an older one left in its directory: nothing that was computed is lost."""

import os

import pytest

from fem_impact.files.run_directory import earlier_runs, set_aside
from fem_impact.options import RunOptions
from fem_impact.outcome.record import Outcome
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_toml
from fem_impact.scene.shipped import load


def test_an_older_run_goes_whole_into_a_directory_of_its_time(tmp_path):
    names = ("outcome.json", "scene.toml", "film.webp", "report.html", "figures/ledger.svg", "notes.txt")
    (tmp_path / "figures").mkdir()
    for name in names:
        (tmp_path / name).write_text(name)
    os.utime(tmp_path / "outcome.json", (1e9, 1e9))
    place = set_aside(tmp_path)
    assert place.name == "earlier-2001-09-09T01-46-40Z"
    assert all((place / name).read_text() == name for name in names[:-1])
    assert sorted(path.name for path in tmp_path.iterdir()) == [place.name, "notes.txt"]
    assert set_aside(tmp_path) is None
    (tmp_path / "outcome.json").write_text("another")
    os.utime(tmp_path / "outcome.json", (1e9, 1e9))
    assert set_aside(tmp_path).name == f"{place.name}-2"
    assert earlier_runs(tmp_path) == [place, tmp_path / f"{place.name}-2"]


def test_a_scene_alone_is_no_run(tmp_path):
    (tmp_path / "scene.toml").write_text("mine")
    assert set_aside(tmp_path) is None
    assert (tmp_path / "scene.toml").read_text() == "mine"


def test_another_run_into_the_same_directory_loses_nothing(tmp_path, monkeypatch):
    first = simulate(load("t5b"), "rigid", RunOptions(out=tmp_path))
    second = simulate(load("t5c"), "rigid", RunOptions(out=tmp_path))
    (place,) = earlier_runs(tmp_path)
    assert Outcome.read(place / "outcome.json") == first
    assert read_toml(place / "scene.toml") == load("t5b")
    assert Outcome.read(tmp_path / "outcome.json") == second

    def killed(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("fem_impact.run.simulate._compute", killed)
    with pytest.raises(KeyboardInterrupt):
        simulate(load("t5d"), "rigid", RunOptions(out=tmp_path))
    assert not (tmp_path / "outcome.json").exists()
    assert Outcome.read(earlier_runs(tmp_path)[-1] / "outcome.json") in (first, second)


def test_a_reduced_run_does_not_go_on_from_a_checkpoint(tmp_path):
    (tmp_path / "run.checkpoint").write_bytes(b"of a finite-element run")
    (tmp_path / "fields.vtkhdf").write_bytes(b"its fields")
    simulate(load("t5b"), "rigid", RunOptions(out=tmp_path, resume=True))
    (place,) = earlier_runs(tmp_path)
    assert {path.name for path in place.iterdir()} == {"run.checkpoint", "fields.vtkhdf"}
    assert not (tmp_path / "fields.vtkhdf").exists()


def test_the_command_says_where_the_older_run_is(cli):
    cli("run", "t5b", "--fidelity", "rigid", "--out", "here")
    code, _, err = cli("run", "t5c", "--fidelity", "rigid", "--out", "here")
    assert code == 0
    assert "Older results that were in here are kept in here/earlier-" in err
