"""A result without fields: `render` says why it has none, and what to do."""

import pytest
import result_maker

from fem_impact import load
from fem_impact.scene.types import to_toml


@pytest.mark.parametrize(
    ("fidelity", "words"),
    [
        ("modal", "fidelity modal has no mesh. Run its scene with --fidelity solid."),
        ("solid", "its scene says save.frames = 0. Run it with --set save.frames=120."),
    ],
)
def test_a_run_without_fields(cli, tmp_path, fidelity, words):
    result_maker.write_result(tmp_path / "one", fidelity=fidelity)
    (tmp_path / "one" / "fields.vtkhdf").unlink(missing_ok=True)
    code, _, err = cli("render", "one")
    assert code == 5
    assert f"one: holds no fields.vtkhdf, the fields that a film shows: {words}" in err


def test_a_run_whose_last_level_did_not_end(cli, tmp_path):
    result_maker.write_result(tmp_path / "one", fidelity="solid")
    (tmp_path / "one" / "level-3").mkdir()
    (tmp_path / "one" / "fields.vtkhdf").unlink(missing_ok=True)
    (tmp_path / "one" / "level-3" / "fields.vtkhdf").write_bytes(b"")
    code, _, err = cli("render", "one")
    assert code == 5 and "its last level, which alone keeps them, did not end. Run it with --resume" in err


def test_a_scene_that_asks_for_frames_lacks_them_where_its_last_level_did_not_end(cli, tmp_path):
    result_maker.write_result(tmp_path / "one", fidelity="solid")
    (tmp_path / "one" / "fields.vtkhdf").unlink(missing_ok=True)
    (tmp_path / "one" / "scene.toml").write_text(to_toml(load("t5b")))
    _, _, err = cli("render", "one")
    assert "its last level, which alone keeps them, did not end. Run it with --resume" in err


def test_a_path_needs_strikes_and_is_shown_whole(cli, tmp_path):
    result_maker.write_result(tmp_path / "one", fidelity="modal")
    _, _, err = cli("render", "one", "--field", "path")
    assert "one: holds no strikes to film. Run its scene with --until rest." in err
    assert "shows all strikes of one result" in cli("render", "one", "--field", "path", "--frames", "9")[2]


def test_a_study_names_a_run_that_has_them(cli, tmp_path):
    (tmp_path / "sets" / "t4").mkdir(parents=True)
    (tmp_path / "sets" / "study.json").write_text("{}")
    assert "no run has kept its fields" in cli("render", "sets")[2]
    (tmp_path / "sets" / "t4" / "fields.vtkhdf").write_bytes(b"")
    assert "sets: is a study. Name one of its runs, such as sets/t4." in cli("render", "sets")[2]


def test_a_file_is_answered_with_its_directory(cli, tmp_path):
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "fields.vtkhdf").write_bytes(b"")
    code, _, err = cli("render", "one/fields.vtkhdf")
    assert code == 5
    assert "is a file, not the directory of a result. Name the directory that it lies in: one\n" in err
