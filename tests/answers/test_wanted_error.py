"""A scene that states the error it allows: reading, writing, refusing."""

import pytest

import fem_impact.run.simulate
from fem_impact.case.measured import summary
from fem_impact.errors import SceneError
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace
from fem_impact.scene.types import MEASURED_SETS, Accuracy, digest, to_dict


def asking(target):
    return replace(load("t5b"), "accuracy", f"{100 * target:g} %")


def test_a_target_is_written_and_read_back():
    scene = asking(0.02)
    assert scene.accuracy.target == 0.02
    assert read_dict(to_dict(scene)) == scene
    assert to_dict(scene)["accuracy"]["target"] == "2 %"
    assert digest(scene) != digest(load("t5b"))


def test_a_mesh_replaces_a_target_and_the_other_way_round():
    scene = replace(asking(0.02), "accuracy.tip_size", "0.5 mm")
    assert (scene.accuracy.target, scene.accuracy.tip_size) == (None, 0.5e-3)
    scene = replace(scene, "accuracy.target", "3 %")
    assert scene.accuracy.target == 0.03
    assert replace(asking(0.02), "accuracy.max_time", "1 ms").accuracy.target == 0.02


@pytest.mark.parametrize(
    "text", ["2", "0 %", "-1 %", "101 %", "2 mm", "", "%", 0.02, 2, "1e9999 %", "2 %" + 70 * " "]
)
def test_what_is_no_share_is_refused(text):
    data = to_dict(load("t5b"))
    with pytest.raises(SceneError, match="accuracy"):
        read_dict(data | {"accuracy": text})


@pytest.mark.parametrize("target", [-3.0, 50.0, 0.0, "2 %"])
def test_a_target_made_in_python_is_checked_too(target):
    with pytest.raises(SceneError, match="share above 0 and at most 1"):
        Accuracy(target=target)


def test_a_mesh_beside_a_target_is_refused():
    data = to_dict(load("t5b"))
    for key, size in (("tip_size", "0.4 mm"), ("tip_size_m", 0.0004)):
        with pytest.raises(SceneError, match=rf"accuracy\.{key}: stands beside a target"):
            read_dict(data | {"accuracy": {"target": "2 %", key: size}})


def test_a_run_on_one_mesh_refuses_a_target():
    with pytest.raises(SceneError, match="is an error, not a mesh"):
        fem_impact.run.simulate.simulate(asking(0.2))


def test_the_shipped_summary_is_dated_and_about_shipped_scenes():
    held = summary()
    assert held["created_utc"] and held["versions"]["numpy"]
    assert held["scenes"]
    for name, cost in held["scenes"].items():
        scene = read_dict(cost["scene"])
        assert name in MEASURED_SETS
        assert scene.impact == load(name).impact
        kinds = {setting["kind"] for setting in cost["settings"]}
        assert {"rigid", "modal", "levels", "variant"} <= kinds and not cost["failures"]


def test_a_target_chooses_the_place_of_the_grid_too():
    scene = replace(load("t5b"), "accuracy.grid_shift", 0.5)
    asked = replace(scene, "accuracy", "5 %")
    assert "grid_shift" not in to_dict(asked)["accuracy"]
    assert replace(asked, "accuracy.grid_shift", 0.25).accuracy.target is None
