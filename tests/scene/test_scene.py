"""The scene as an object: one meaning for TOML and Python, exact round trips, stable digests."""

import dataclasses
import hashlib
import json
import math
import tomllib
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem_impact.case.effects.registry import BARRIERS
from fem_impact.errors import SceneError
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.fields import Boundary, Element, FineZone, YieldingElement
from fem_impact.scene.impact import Impact
from fem_impact.scene.library import materials, shipped, surfaces
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.read import read_dict, read_toml
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import Accuracy, Save, Scene, digest, to_dict, to_toml

LINEAR = Material("linear", 206e9, 0.29, 7850.0, 300e6, 400e6, hardening=2e9)
STEELS = st.sampled_from([*materials().values(), LINEAR])
OPTIONAL = ("vibration", "friction", "rod-plasticity", "gravity", "large-rotation")


@st.composite
def scenes(draw):
    diameter = draw(st.floats(5e-3, 0.05))
    tip = draw(st.sampled_from(["A", "B", "plain"]))
    radius = 0.0 if tip == "plain" else draw(st.floats(0.01, 1.0)) * diameter / 2
    rod = ProjectileSpec(diameter * draw(st.floats(1.0, 20.0)), diameter, tip, radius, draw(STEELS))
    angle = draw(st.floats(0.0, math.pi / 2, exclude_max=True))
    speed = st.floats(-300.0, -1e-6)
    spin = draw(st.floats(-100, 100))
    motions = [
        Impact(angle, draw(speed), draw(speed), spin),
        Impact.dropped(draw(st.floats(0.0, 1.5)), draw(st.floats(1e-9, 1e4)), spin),
        Impact.thrown(draw(st.floats(0.0, 1.5)), draw(st.floats(1e-3, 500.0)), spin),
    ]
    listed = (draw(st.sampled_from(BARRIERS)), *draw(st.sets(st.sampled_from(OPTIONAL))))
    effects = draw(st.sampled_from([listed, ("auto",), ("auto", "barrier-elastic", "-gravity")]))
    custom = st.floats(0.0, 3.0).map(lambda f: Surface("custom", f, f / 2, 2 * f, 'a \\ "guess" in é'))
    return Scene(
        id=draw(st.from_regex(r"[a-z0-9]([a-z0-9-]{0,20}[a-z0-9])?", fullmatch=True)),
        title=draw(st.text(st.characters(exclude_categories=["C", "Z"]), max_size=30)),
        projectile=rod,
        barrier=Barrier(draw(STEELS), draw(st.sampled_from(get_args(Boundary)))),
        surface=draw(st.one_of(custom, st.sampled_from(list(surfaces().values())))),
        impact=draw(st.sampled_from(motions)),
        effects=effects,
        accuracy=Accuracy(
            *(draw(st.one_of(st.none(), st.floats(1e-4, 1e-3))) for _ in range(2)),
            *(draw(st.floats(1.0, 25.0)), 2 * draw(st.integers(3, 32)), draw(st.sampled_from([0.0, 0.5]))),
            *(6e-3, draw(st.floats(1e-5, 1e-1)), draw(st.floats(0.01, 0.99))),
            *(draw(st.sampled_from(get_args(kinds))) for kinds in (Element, YieldingElement, FineZone)),
        ),
        save=Save(draw(st.integers(0, 1000)), draw(st.integers(1, 1000))),
        measured=None,
    )


@given(scenes())
@settings(max_examples=60, deadline=None)
def test_a_scene_survives_toml_exactly(scene):
    again = read_dict(tomllib.loads(to_toml(scene)))
    assert again == scene
    assert digest(again) == digest(scene)


def test_file_dict_and_object_are_one_scene(tmp_path):
    scene = load("t4")
    path = tmp_path / "scene.toml"
    path.write_text(to_toml(scene), encoding="utf-8")
    assert read_toml(path) == read_dict(to_dict(scene)) == load(path) == scene


def test_si_keys_say_the_same_as_units():
    data = to_dict(load("t4"))
    data["projectile"] = {**data["projectile"], "length_m": 0.12}
    del data["projectile"]["length"]
    data["impact"] = {"angle_rad": math.radians(45), "v_n_m_per_s": -2.9817, "v_t_m_per_s": -2.922}
    assert read_dict(data) == load("t4")


def test_digests_of_the_shipped_scenes_differ_and_do_not_drift():
    digests = {name: digest(load(name)) for name in shipped()}
    assert len(set(digests.values())) == len(digests)
    # Results are filed under the digest: a change here orphans every stored result, so it must be meant.
    assert (
        digests["elastic-frictionless"] == "d9bc4530c344bfca486da17586baf9625d9a6873c3f81a56bff9b97b6231d0a0"
    )


def test_any_change_changes_the_digest():
    scene = load("quick")
    others = [
        replace(scene, "accuracy.tip_size", "0.71 mm"),
        replace(scene, "impact.v_n", "-1.5025 m/s"),
        replace(scene, "save.frames", 121),
        replace(scene, "surface.state", "cleaned"),
    ]
    assert len({digest(scene), *(digest(other) for other in others)}) == 5


def test_a_scene_cannot_be_changed_in_place():
    with pytest.raises(dataclasses.FrozenInstanceError):
        load("quick").id = "other"


def test_effects_keep_one_order():
    data = to_dict(load("t4"))
    data["effects"] = list(reversed(data["effects"]))
    assert read_dict(data) == load("t4")


def test_a_changed_friction_is_custom_and_keeps_the_set_it_is_compared_with():
    scene = replace(load("t4"), "surface.friction", 0.3)
    assert (scene.surface.state, scene.surface.friction_low, scene.surface.friction_high) == (
        "custom",
        0.3,
        0.3,
    )
    assert scene.measured == "t4"


def test_the_content_of_own_tests_is_part_of_the_digest(tmp_path):
    """Numbers of an outcome follow from it; a scene without own tests has the digest of its tables."""
    tests = tmp_path / "mine.csv"
    tests.write_text("quantity,mean,sd,n,d_c_m,d_d_m\ne,0.4,0.01,5,0.03,0.05\n")
    scene = read_dict(to_dict(load("quick")) | {"measured": str(tests)})
    before = digest(scene)
    assert digest(scene) == before
    tests.write_text(tests.read_text().replace("0.05", "0.06"))
    assert digest(scene) != before
    tests.unlink()
    with pytest.raises(SceneError, match=r"measured = .*cannot be read"):
        digest(scene)
    plain = json.dumps(to_dict(load("quick")), sort_keys=True, separators=(",", ":"))
    assert digest(load("quick")) == hashlib.sha256(plain.encode()).hexdigest()


def test_a_changed_material_loses_its_name():
    scene = replace(replace(load("t4"), "projectile.material.E", "200 GPa"), "projectile.material.nu", 0.3)
    assert scene.projectile.material.name == "rod-steel (changed)"
    assert scene.projectile.material.E == 200e9


@pytest.mark.parametrize(
    ("key", "value"), [("impact.v_n", "-1 m/s"), ("projectile.length", "0.2 m"), ("surface.state", "cleaned")]
)
def test_another_rod_motion_or_surface_no_longer_repeats_a_set(key, value):
    assert replace(load("t4"), key, value).measured is None


BALL = {"shape": "ball", "diameter": "19 mm", "material": "rod-steel"}


@pytest.mark.parametrize(
    ("key", "table"),
    [
        ("projectile", BALL),
        ("impact", {"angle": "45 deg", "speed": "1 m/s"}),
        ("barrier", {"material": "plate-steel", "mass": "1 kg"}),
    ],
)
def test_a_whole_table_repeats_no_set_and_the_title_says_so(key, table):
    changed = replace(load("t5b"), key, table)
    assert changed.measured is None
    assert changed.title == f"t5b, changed: another {key}"


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("barrier.material", "copper", "barrier.material = copper"),
        ("barrier", {"material": "steel-4340"}, "another barrier"),
        ("projectile.material", {"name": "mine", "E": "200 GPa", "nu": 0.3, "rho": "7850 kg/m3"}, "= mine"),
    ],
)
def test_a_body_of_another_material_repeats_no_set(key, value, told):
    changed = replace_all(load("t5b"), {key: value, "effects": "auto"})
    assert changed.measured is None
    assert changed.title.startswith("t5b, changed: ") and changed.title.endswith(told)


def test_other_values_of_the_same_material_are_the_models_side():
    changed = replace(load("t5b"), "barrier.material.E", "200 GPa")
    assert changed.measured == "t5b"
    for key, value in {"barrier.material": "Plate-Steel", "barrier": {"material": "plate-steel"}}.items():
        assert replace(changed, key, value).measured == "t5b"


def test_a_title_says_that_its_set_was_changed():
    stated = load("t5b")
    assert replace(stated, "surface.friction", 0.3).title == stated.title
    changed = replace(replace(stated, "impact.angle", "20 deg"), "projectile.length", "100 mm")
    assert changed.title == "t5b, changed: impact.angle = 20 deg, projectile.length = 100 mm"
    both = replace_all(stated, {"surface.friction": 0.2, "impact.angle": "15 deg"})
    assert both.title == "t5b, changed: surface.friction = 0.2, impact.angle = 15 deg"
    whole = [{"surface.friction": f, "impact.angle": "15 deg"} for f in (0, 0.0)]
    assert len({replace_all(stated, changes).title for changes in whole}) == 1
    assert replace_all(stated, {"title": "mine", "impact.angle": "20 deg"}).title == "mine"


def test_changes_are_checked_together():
    changes = {"projectile.tip": "plain", "projectile.tip_radius": "0 mm"}
    assert replace_all(load("t4"), changes).projectile.tip == "plain"
    with pytest.raises(SceneError, match="tip_radius"):
        replace(load("t4"), "projectile.tip_radius", "0 mm")


def test_no_surface_is_needed_without_friction():
    assert load("elastic-frictionless").surface.friction == 0.0
    data = to_dict(load("t4"))
    del data["surface"]
    assert read_dict(data).surface.state == "pair"
    data["projectile"]["material"] = "titanium-6al-4v"
    with pytest.raises(SceneError, match=r"surface\.friction: is missing"):
        read_dict(data)
