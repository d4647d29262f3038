"""Scenes changed by ``--set``: their title tells what was changed, paths are told from where one works."""

from functools import reduce
from pathlib import Path

import pytest

from fem_impact.cli.paths import shown_path
from fem_impact.cli.scene_options import changed_scene
from fem_impact.cli.values import read_values
from fem_impact.errors import SceneError
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import to_dict, to_toml


def test_the_title_follows_every_change_of_the_impact():
    changed = changed_scene("elastic-frictionless", ["projectile.length=0.1 m", "accuracy.across=12"])
    assert changed.title.endswith("frictionless plane, changed: projectile.length = 0.1 m")
    assert changed_scene("t5b", ["surface.friction=0.2"]).title.endswith(", changed: surface.friction = 0.2")
    plain = changed_scene("t5b", [])
    assert changed_scene("t5b", ["save.frames=10"]).title == plain.title
    assert changed_scene("t5b", ["title=mine", "impact.angle=20 deg"]).title == "mine"


def test_the_title_of_a_scene_with_own_tests_names_no_file(tmp_path):
    (tmp_path / "mine.csv").write_text("quantity,mean,sd,n\ne,0.3,0.1,5\n")
    scene = changed_scene("t5b", ["title=my rod", "id=my-rod", f"measured={tmp_path / 'mine.csv'}"])
    (tmp_path / "mine.toml").write_text(to_toml(scene))
    changed = changed_scene(str(tmp_path / "mine.toml"), ["impact.angle=30 deg"])
    assert (changed.title, changed.measured) == ("my rod, changed: impact.angle = 30 deg", None)


BAD = """
id = "mine"
projectile = {{ length = "{length}", diameter = "19 mm", tip = "plain", material = "rod-steel" }}
barrier = {{ material = "plate-steel" }}
surface = {{ state = "machined" }}
impact = {{ angle = "{angle}", v_n = "{v_n}", v_t = "-1 m/s" }}
"""
GOOD = {"length": "80 mm", "angle": "45 deg", "v_n": "-1 m/s"}


def test_a_change_replaces_a_number_in_si_of_a_file_that_another_change_mends(tmp_path):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(BAD.format(**GOOD | {"angle": "95 deg"}).replace('length = "80 mm"', "length_m = 0.08"))
    changed = changed_scene(str(wrong), ["impact.angle=30 deg", "projectile.length=0.1 m"])
    assert changed.projectile.length == 0.1


@pytest.mark.parametrize(
    ("bad", "changes"),
    [
        ({"length": "80"}, ["projectile.length=0.1 m"]),
        ({"length": "80"}, ["projectile.length_m=0.1", "accuracy.across=12"]),
        ({"angle": "95 deg"}, ["impact.angle=30 deg"]),
        ({"v_n": "1 m/s"}, ["impact.v_n=-2 m/s"]),
        ({"v_n": "1 m/s"}, ["impact.speed=2 m/s"]),
    ],
)
def test_a_change_mends_what_is_refused_in_the_file(tmp_path, bad, changes):
    good, wrong = tmp_path / "good.toml", tmp_path / "wrong.toml"
    good.write_text(BAD.format(**GOOD))
    wrong.write_text(BAD.format(**GOOD | bad))
    with pytest.raises(SceneError, match=str(wrong)):
        changed_scene(str(wrong), [])
    with pytest.raises(SceneError, match=f"{wrong} with --set: .*{next(iter(bad))}"):
        changed_scene(str(wrong), ["accuracy.across=10"])
    mended, changed = (changed_scene(str(path), changes) for path in (wrong, good))
    assert (mended.projectile, mended.accuracy, mended.title) == (
        changed.projectile,
        changed.accuracy,
        changed.title,
    )


@pytest.mark.parametrize(
    ("changes", "lost"),
    [
        (["accuracy.tip_size=0.5 mm", "accuracy.target=5 %"], "accuracy.tip_size"),
        (["projectile.tip_radius=2 mm", "projectile.shape=hemisphere"], "projectile.tip_radius"),
        (["surface.friction=0.3", "surface.state=cleaned"], "surface.state"),
        (["surface.state=cleaned", "surface.friction_low=0.1"], "surface.state"),
    ],
)
def test_a_change_that_another_one_takes_out_is_refused(changes, lost):
    with pytest.raises(SceneError, match=f"^--set: {lost}: is taken out again by another change"):
        changed_scene("t5b", changes)


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize(
    "changes",
    [
        ["surface.friction=0.3", "surface.friction_low=0.1", "surface.friction_high=0.9"],
        ["surface.friction=0.3", "surface.source=our own tests"],
        ["surface.state=custom", "surface.friction=0.3", "surface.source=our own tests"],
        ["barrier.material.E=200 GPa", "barrier.material.name=our plate"],
        ["barrier.material.rate.law=johnson-cook", "barrier.material.rate.C=0.03"],
        ["accuracy={levels = 2}", "accuracy.across=12"],
    ],
)
def test_the_order_of_changes_does_not_matter(changes, way):
    """A value that stands for others is set before them: none of those that are stated is lost."""
    scene = changed_scene("t5b", changes[::way])
    table = to_dict(scene)
    for change in changes[-2:]:
        key, _, value = change.partition("=")
        *path, last = key.split(".")
        at = reduce(dict.__getitem__, path, table)[last]
        assert str(at) == value or isinstance(at, dict)


def test_whole_tables_and_parts_of_them_are_refused_in_either_order():
    for changes in (
        ["accuracy.tip_size=0.5 mm", "accuracy=5 %"],
        ["accuracy=5 %", "accuracy.tip_size=0.5 mm"],
    ):
        with pytest.raises(SceneError, match="stands beside accuracy = '5 %'"):
            changed_scene("t5b", changes)


def test_a_shape_takes_the_place_of_a_tip():
    assert changed_scene("t5b", ["projectile.shape=hemisphere"]).projectile.tip_radius == 0.0095


def test_paths_are_shown_from_the_working_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert shown_path(str(tmp_path / "a" / "tests.csv")) == str(Path("a") / "tests.csv")
    assert shown_path("/elsewhere/tests.csv") == "/elsewhere/tests.csv"
    assert shown_path("t5b") == "t5b"


def test_a_bore_that_stays_short_is_told(cli, tmp_path):
    _, _, err = cli("check", "tube", "--set", "projectile.length=0.4 m")
    assert "the bore ends at the new tail" in err and "warning" not in err
    closed = replace(load("tube"), "projectile.bore", [["0 mm", "6 mm"], ["150 mm", "6 mm"]])
    (tmp_path / "closed.toml").write_text(to_toml(closed))
    _, _, err = cli("check", str(tmp_path / "closed.toml"), "--set", "projectile.length=0.4 m")
    assert "warning: the bore is that of the old length, 0 to 150 mm from the tip." in err
    bore = 'projectile.bore=[["0 mm", "6 mm"], ["400 mm", "6 mm"]]'
    assert "bore" not in cli("check", "tube", "--set", "projectile.length=0.4 m", "--set", bore)[2]
    assert "bore" not in cli("check", "t5b", "--set", "projectile.length=0.1 m")[2]


def test_a_ball_has_no_axis_to_fall_along(cli):
    Path("ball.toml").write_text(BALL)
    for scene, falls in (
        ("ball.toml", "the ball still moves at 3 m/s"),
        ("t5b", "the rod still moves along its axis at"),
    ):
        assert falls in " ".join(cli("check", scene, "--set", "impact.angle=20 deg")[2].split())


@pytest.mark.parametrize(("velocity", "advised"), [("0 m/s", True), ("1 m/s", False)])
def test_no_fall_is_advised_where_the_barrier_moves(cli, velocity, advised):
    thrown = BALL.replace('speed = "3 m/s"', 'v_n = "-3 m/s", v_t = "-1 m/s"')
    barrier = f'barrier = {{ material = "plate-steel", v_n = "{velocity}" }}'
    Path("thrown.toml").write_text(thrown.replace('barrier = { material = "plate-steel" }', barrier))
    _, _, err = cli("check", "thrown.toml", "--set", "impact.angle=20 deg")
    assert "those of the old angle" in err and ("A fall as fast" in err) == advised


BALL = """
id = "ball"
projectile = { shape = "ball", diameter = "25 mm", material = "rod-steel" }
barrier = { material = "plate-steel" }
surface = { state = "machined" }
impact = { angle = "30 deg", speed = "3 m/s" }
"""


def test_velocities_along_the_axis_at_the_new_angle_need_no_warning(cli, tmp_path):
    velocities = {"impact.angle": "25 deg", "impact.v_n": "-2 m/s", "impact.v_t": "0 m/s"}
    (tmp_path / "down.toml").write_text(to_toml(replace_all(load("t5b"), velocities)))
    path = str(tmp_path / "down.toml")
    assert "those of the old angle" in cli("check", path, "--set", "impact.angle=1 deg")[2]
    assert not cli("check", path, "--set", "impact.angle=0 deg")[2]


def test_a_number_may_begin_with_its_point():
    assert changed_scene("t5b", ["surface.friction=.36"]).surface.friction == 0.36
    assert changed_scene("t5b", ["accuracy.grid_shift=+.5"]).accuracy.grid_shift == 0.5


@pytest.mark.parametrize(("number", "name"), [("4340", "steel-4340"), ("1.4404", "stainless-316l")])
def test_a_number_in_the_place_of_a_material_is_a_name(number, name):
    """TOML reads it as a number, which is no material."""
    assert changed_scene("t5b", [f"projectile.material={number}"]).projectile.material.name == name
    vary = read_values(f"projectile.material={number},304,316L")
    assert vary == ("projectile.material", [name, "stainless-304", "316L"])
    with pytest.raises(SceneError, match=r'barrier\.material = "9999": is not a shipped material'):
        read_values("barrier.material=9999,304")


def test_values_of_a_material_that_is_named_in_the_same_call_may_be_changed():
    stated = ["projectile.material=copper", "projectile.material.E=100 GPa", "barrier.material=lead"]
    changed = changed_scene("t5b", stated)
    metal = changed.projectile.material
    assert (metal.name, metal.E, metal.rho) == ("copper (changed)", 100e9, 8930.0)
    with pytest.raises(SceneError, match=r'projectile\.material = "coppr".*Did you mean copper'):
        changed_scene("t5b", ["projectile.material=coppr", "projectile.material.E=100 GPa"])


def test_a_shape_a_plain_tip_and_a_state_replace_what_they_have_themselves():
    """No option can leave out what stands in the file."""
    ball = changed_scene("t5b", ["projectile.shape=ball"]).projectile
    assert ball.is_ball and ball.length == ball.diameter == 0.019
    cone = ["projectile.shape=cone", "projectile.cone_angle=30 deg", "projectile.face_diameter=2 mm"]
    other = [*cone[::-1], "projectile.length_m=0.1"]
    assert changed_scene("t5b", other).projectile.length == 0.1
    ogive = replace_all(changed_scene("t5b", cone), {"projectile.shape": "hemisphere"}).projectile
    assert (ogive.tip, ogive.tip_radius) == ("B", 0.0095)
    assert changed_scene("t5b", ["projectile.tip=plain"]).projectile.tip_radius == 0.0
    for stated in (["surface.friction=0.3", "surface.state=custom"], ["surface.friction=0.3"]):
        surface = changed_scene("t5b", stated).surface
        assert (surface.state, surface.friction, surface.friction_high) == ("custom", 0.3, 0.3)
    with pytest.raises(SceneError, match=r"surface\.state: is taken out again by another change"):
        changed_scene("t5b", ["surface.friction=0.3", "surface.state=cleaned"])
