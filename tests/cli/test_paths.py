"""Output and result places are checked before any work."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from outcome_maker import outcome as an_outcome

import fem_impact
from fem_impact.errors import OutputPathError
from fem_impact.films.movement import Span
from fem_impact.options import RunOptions
from fem_impact.scene.shipped import load
from fem_impact.scene.types import to_toml

pytestmark = pytest.mark.usefixtures("unrendered")


def refused(cli, stand, *words):
    code, out, err = cli(*words)
    assert not stand.calls
    assert out == ""
    assert "Traceback" not in err
    return code, err


def test_an_output_that_is_a_file(cli, stand):
    Path("taken").write_text("mine")
    code, err = refused(cli, stand, "run", "t5b", "--out", "taken")
    assert code == 4
    assert "taken: is a file" in err
    assert Path("taken").read_text() == "mine"


def test_an_output_under_a_file(cli, stand):
    Path("taken").write_text("mine")
    code, err = refused(cli, stand, "study", "sets", "--out", "taken/a/b")
    assert code == 4
    assert "lies below taken, which is a file" in err


def test_an_output_among_other_files(cli, stand):
    Path("home").mkdir()
    Path("home/letter.txt").write_text("mine")
    code, err = refused(cli, stand, "run", "t5b", "--out", "home")
    assert code == 4
    assert "other files" in err


MINE = {
    "a store below beside my file": ("important.txt", "any/store.sqlite"),
    "a result below beside my file": ("important.txt", "any/outcome.json"),
    "an empty store": ("store.sqlite",),
    "a result of another program": ("outcome.json",),
    "a scene": ("scene.toml",),
    "a scene and a table": ("history.csv", "scene.toml"),
    "a scene below": ("sub/scene.toml",),
}


@pytest.mark.parametrize("names", MINE.values(), ids=MINE)
def test_an_output_that_only_looks_like_results(cli, stand, names):
    for name in names:
        Path("home", name).parent.mkdir(parents=True, exist_ok=True)
        Path("home", name).write_text("" if name.endswith("sqlite") else "mine")
    code, err = refused(cli, stand, "run", "t5b", "--out", "home")
    assert code == 4
    assert f"other files, such as {names[0].split('/')[0]}" in err


def test_a_file_among_results_is_named_and_kept(cli):
    line = ("run", "t5b", "--fidelity", "rigid", "--quiet", "--out", "here")
    assert cli(*line)[0] == cli(*line)[0] == 0
    Path("here/notes.txt").write_text("mine")
    code, _, err = cli(*line)
    assert code == 4
    assert "other files, such as notes.txt" in err


def test_the_scene_that_a_run_reads_is_not_replaced(cli):
    mine = "# mine\n" + to_toml(load("t5b"))
    Path("scene.toml").write_text(mine)
    code, _, err = cli("run", "scene.toml", "--fidelity", "rigid", "--out", ".")
    assert code == 4
    assert "other files, such as scene.toml" in err
    with pytest.raises(OutputPathError, match="is not the scene as this command would write it"):
        fem_impact.simulate(load("t5c"), "rigid", RunOptions(out=Path()))
    assert Path("scene.toml").read_text() == mine


def test_a_run_that_ends_before_it_computes_leaves_no_scene(monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("fem_impact.run.rigid.rigid_outcome", stop)
    with pytest.raises(KeyboardInterrupt):
        fem_impact.simulate(load("t5b"), "rigid", RunOptions(out=Path("here")))
    assert list(Path("here").iterdir()) == []


ONE = ("--workers", "1", "--quiet")
SWEEP = ("--vary", "impact.angle=30,40deg", "--fidelity", "rigid", *ONE)


@pytest.mark.long
def test_a_sweep_and_a_verdict_go_on_in_their_directories(cli):
    for line in (("sweep", "t5b", *SWEEP), ("assess", "t5b", "--fidelity", "modal")):
        assert [cli(*line, "--out", line[0])[0] for _ in range(2)] == [0, 0]


def test_a_verdict_does_not_replace_the_scene_that_it_reads(cli, monkeypatch):
    """Beside its own files, where the directory is not refused as a stranger's."""
    assert cli("assess", "t5b", "--fidelity", "modal", "--out", "here")[0] == 0
    mine = "# mine\n" + Path("here/scene.toml").read_text()
    Path("here/scene.toml").write_text(mine)
    monkeypatch.setattr(
        "fem_impact.answers.verdict.assess.assess", lambda *_, **__: pytest.fail("work has begun")
    )
    code, _, err = cli("assess", "here/scene.toml", "--fidelity", "modal", "--out", "here")
    assert code == 4
    assert "would be replaced. Choose another --out" in err
    assert Path("here/scene.toml").read_text() == mine


def test_a_sweep_leaves_the_scene_that_it_reads(cli):
    assert cli("sweep", "t5b", *SWEEP, "--out", "here")[0] == 0
    mine = "# mine\n" + to_toml(load("t5b"))
    Path("here/scene.toml").write_text(mine)
    assert cli("sweep", "here/scene.toml", *SWEEP, "--out", "here")[0] == 0
    assert Path("here/scene.toml").read_text() == mine


@pytest.mark.parametrize(
    "line", [("sweep", "scene.toml", *SWEEP), ("cost", "scene.toml"), ("assess", "scene.toml")]
)
def test_a_command_does_not_write_beside_a_scene_alone(cli, line):
    mine = "# mine\n" + to_toml(load("t5b"))
    Path("scene.toml").write_text(mine)
    code, _, err = cli(*line, "--out", ".")
    assert code == 4
    assert "other files, such as scene.toml" in err
    assert Path("scene.toml").read_text() == mine


def test_an_output_that_cannot_be_made(cli, stand):
    code, err = refused(cli, stand, "run", "t5b", "--out", "/proc/nowhere/results")
    assert code == 4
    assert "cannot be written" in err


def test_an_output_with_a_name_too_long(cli, stand):
    code, err = refused(cli, stand, "run", "t5b", "--out", "x" * 5000)
    assert code == 4
    assert "cannot be written" in err


def test_a_run_that_was_not_finished_says_how_to_go_on(cli):
    Path("half").mkdir()
    Path("half/history.csv").write_text("time_s")
    code, _, err = cli("report", "half")
    assert code == 5
    assert "did not come to its end. Go on with `fem-impact run half/scene.toml --resume --out half`" in err


def test_a_second_run_may_take_the_place_of_results(cli, stand):
    an_outcome().write(Path("here/outcome.json"))
    assert cli("run", "t5b", "--out", "here", "--quiet")[0] == 0


def test_a_study_that_was_stopped_goes_on_in_its_directory(cli, stand):
    Path("sets/t4").mkdir(parents=True)
    Path("sets/t4/history.csv").write_text("")
    assert cli("study", "sets", "--out", "sets", "--quiet")[0] == 0


def test_a_bad_scene_makes_no_directory(cli, stand):
    code, err = refused(cli, stand, "run", "t5b", "--set", "impact.v_n=1 m/s", "--out", "here")
    assert code == 3
    assert "impact.v_n = 1 m/s" in err
    assert not Path("here").exists()


@pytest.mark.parametrize(
    ("change", "wanted"), [("accuracy.tip_size", 2), ("=3", 2), ("impact.angle=45", 3), ("impact=1", 3)]
)
def test_a_bad_change_is_refused(cli, stand, change, wanted):
    code, err = refused(cli, stand, "run", "t5b", "--set", change)
    assert code == wanted
    assert "--set" in err


@pytest.mark.parametrize("command", ["render", "report"])
def test_results_that_are_none(cli, stand, command):
    Path("empty").mkdir()
    Path("file").write_text("")
    for place, words in (("gone", "no such directory"), ("file", "is a file"), ("empty", "holds no")):
        code, err = refused(cli, stand, command, place)
        assert code == 5
        assert words in err


def test_a_file_where_a_result_is_wanted_is_told_what_to_name(cli):
    Path("ring.toml").write_text("")
    Path("notes.md").write_text("")
    Path("here").mkdir()
    Path("here/outcome.json").write_text("{}")
    for file, remedy in (
        (
            "ring.toml",
            "Compute the scene by `fem-impact run ring.toml`, which prints its directory at the end.",
        ),
        ("notes.md", "Name the one that `fem-impact run` printed at its end."),
        ("here/outcome.json", "Name the directory that it lies in: here"),
    ):
        assert cli("report", file)[2].endswith(
            f"{file}: is a file, not the directory of a result. {remedy}\n"
        )


def test_render_names_what_is_missing_and_loses_nothing(cli, stand):
    Path("here").mkdir()
    for name in ("outcome.json", "fields.vtkhdf"):
        Path("here", name).write_text("{}")
    code, _, err = cli("render", "here")
    assert code == 7
    assert err == "drawing the film ...\nnote: install libegl1\n"
    assert json.loads(cli("render", "here", "--json")[1]) == {"path": None, "notes": ["install libegl1"]}


def test_several_results_make_one_film(cli, stand):
    for name in ("here", "there"):
        Path(name).mkdir()
        for file in ("outcome.json", "fields.vtkhdf"):
            Path(name, file).write_text("{}")
    cli("render", "here", "there", "--out", "both.gif")
    cli("render", "here", "--out", "one.gif")
    assert stand.calls == [
        ("render_side_by_side", ([Path("here"), Path("there")], Path("both.gif"), Span(), (1280, 720))),
        ("render", (Path("here"), Path("one.gif"), Span(), "strain", (1280, 720))),
    ]


def test_report_prints_where_it_is(cli, stand):
    Path("here").mkdir()
    Path("here/study.json").write_text("{}")
    assert cli("report", "here")[:2] == (0, "report: report.html\n")


def test_a_film_is_not_written_over_a_directory(cli, stand):
    Path("here").mkdir()
    Path("here/outcome.json").write_text("{}")
    code, err = refused(cli, stand, "render", "here", "--out", "here")
    assert code == 4
    assert "is a directory" in err


def test_a_reader_that_leaves_makes_no_noise():
    line = f"{sys.executable} -m fem_impact scenes | true"
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=True)
    assert done.stderr == ""


def test_a_report_makes_the_film_that_is_missing(cli, stand):
    Path("here").mkdir()
    for file in ("outcome.json", "fields.vtkhdf"):
        Path("here", file).write_text("{}")
    told = json.loads(cli("report", "here", "--json", "--quiet")[1])
    assert told["notes"] == ["install libegl1"]
    assert [name for name, _ in stand.calls] == ["render", "write_report"]
    Path("here", "film.webp").write_text("a film")
    cli("report", "here")
    assert [name for name, _ in stand.calls] == ["render", "write_report", "write_report"]
