"""Bad input: every mistake is one message with file, key, value and remedy, before any work."""

import dataclasses
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem_impact.case.case import Case
from fem_impact.errors import SceneError, UsageError
from fem_impact.run.tests import doubtful_tests
from fem_impact.scene.impact import Impact
from fem_impact.scene.library import material, materials
from fem_impact.scene.material import Material
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.read import read_dict, read_toml
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import to_dict, to_toml

ROD = {"length": "80 mm", "diameter": "19 mm", "tip": "B", "tip_radius": "3 mm", "material": "rod-steel"}
NAN, INF = float("nan"), float("inf")
MISTAKES = [
    ("impact.v_n", "2.1 m/s", ["impact.v_n = 2.1 m/s", "at most -0.000001 m/s", "out of the barrier"]),
    ("impact.v_n", "0 m/s", ["has v_n below 0"]),
    ("impact.v_t", "501 m/s", ["impact.v_t", "at most 500 m/s"]),
    ("impact.angle", "95 deg", ["impact.angle = 95 deg", "at most 90 deg"]),
    ("impact.angle", "30 rad", ["impact.angle = 30 rad", "at most 90 deg"]),
    ("impact.angle", "-91 deg", ["at least -90 deg"]),
    ("impact.angle", "20 +- 10 deg", ["states an interval", "--uncertain impact.angle=30,50deg"]),
    ("impact.angle", 45, ["impact.angle = 45", "bare number", '"45 deg"', "angle_rad"]),
    ("impact.v_n_m_per_s", NAN, ["impact.v_n", "finite"]),
    ("impact.v_n", "-inf m/s", ["impact.v_n", "finite"]),
    ("projectile.tip_radius", "10 mm", ["projectile.tip_radius", "10 mm", "9.5 mm"]),
    ("projectile.tip_radius", "0 mm", ['tip = "plain"']),
    ("projectile.length", 0.24, ["projectile.length = 0.24", "bare number", "length_m"]),
    ("projectile.length", "240", ["no unit"]),
    ("projectile.length", "240 kg", ["not a unit of length"]),
    ("projectile.length", "240 m", ["at most", "10000 mm"]),
    ("projectile.length", "2 mm", ["the nose is 3 mm long, the body only 2 mm"]),
    ("projectile.length", ["240 mm"], ["projectile.length", "list"]),
    ("projectile.lenght", "240 mm", ["projectile.lenght", "Did you mean length"]),
    ("projectile.tip", "C", ["projectile.tip", '"A", "B" or "plain"']),
    ("projectile.material", "rod-stel", ["Did you mean rod-steel?"]),
    ("projectile.material", "nope", ['"nope": is not a shipped material. All: `fem-impact scenes']),
    ("projectile.radius", "9.5 mm", ["radius: is not a known key. Give diameter, twice the radius."]),
    ("accuracy", "e5%", ['accuracy = "e5%": must be a share in per cent']),
    ("barrier.material", "mild-steel", ["Some that are: rod-steel, plate-steel", "s235, s275"]),
    ("projectile.material", 7850, ["projectile.material", "table"]),
    ("projectile.material.nu", 0.5, ["projectile.material.nu", "below 0.5"]),
    ("projectile.material.nu", "0.29", ["projectile.material.nu", "text"]),
    ("projectile.material.ultimate_stress", "100 MPa", ["below the yield stress"]),
    ("projectile.material.colour", "red", ["is not a known key"]),
    ("barrier.material.rho", "7.85 kg/m3", ["at least 10 kg/m3"]),
    ("barier", {}, ["barier", "Did you mean barrier"]),
    ("surface.state", "wet", ["surface.state", '"machined"']),
    ("surface.friction", -0.1, ["surface.friction", "at least 0"]),
    ("surface.friction_low", 0.9, ["outside its own interval"]),
    ("surface", {"state": "custom", "friction": 0.3, "source": " "}, ["surface.source: says nothing"]),
    ("surface.friction_source", "a handbook", ["Did you mean source?"]),
    ("accuracy", {"levels": 1, "target": "5 %"}, ["accuracy.levels = 1", "one mesh, which tells no error"]),
    ("accuracy.across", 8.5, ["accuracy.across = 8.5", "whole number"]),
    ("accuracy.across", 4, ["accuracy.across = 4", "at least 6"]),
    ("accuracy.across", 7, ["accuracy.across = 7", "an even number"]),
    ("accuracy.across", True, ["accuracy.across", "true/false"]),
    ("accuracy.tip_size", "6 mm", ["accuracy.tip_size", "too coarse"]),
    ("accuracy.tip_size", "-0.3 mm", ["at least 0.0001 mm"]),
    ("accuracy.max_time", "2.5 mm", ["not a unit of time"]),
    ("accuracy.step", 1.0, ["accuracy.step", "at most 0.99"]),
    ("accuracy.element", "reduced", ["accuracy.element", '"full" or "bbar"']),
    ("accuracy.yielding_element", "incompatible", ["accuracy.yielding_element", '"bbar" or "full"']),
    ("accuracy.fine_zone", "coarse", ["accuracy.fine_zone", '"even" or "skin"']),
    ("barrier.boundary", "free", ["barrier.boundary", '"half-space" or "fixed"']),
    ("barrier.material.hardening", "-1 GPa", ["barrier.material.hardening", "at least 0"]),
    ("accuracy.element", ["full"], ["accuracy.element", "is not a choice"]),
    ("save.frames", 10**30, ["save.frames", "at most 100000"]),
    ("effects", "vibration", ["list of names"]),
    ("effects", [["vibration"]], ["list of names"]),
    ("measured", "t7", ["measured", '"t2"']),
    ("id", "../../etc", ["id", "directory"]),
    ("id", "", ["id"]),
    ("title", 5, ["title", "text"]),
    ("title", "two\nlines", ["one line"]),
    ("nowhere.at.all", 1, ["is not a key"]),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES)
def test_a_mistake_is_named_with_key_value_and_remedy(key, value, words):
    with pytest.raises(SceneError) as caught:
        replace(load("t5b"), key, value)
    message = str(caught.value)
    assert message.startswith(key.partition(".")[0])
    for word in words:
        assert word in message
    assert caught.value.exit_code == 3


EFFECTS = [
    (["auto", "auto"], ["twice"]),
    (["auto", "gravity", "-gravity"], ["twice"]),
    (["auto", "-gravty"], ["-gravty", "Did you mean -gravity?"]),
    (["auto", "gravitiy"], ["gravitiy", "Did you mean gravity?"]),
    (["auto", "-barrier-rigid"], ["always a barrier"]),
    (["auto", "barrier-rigid", "barrier-elastic"], ["2 barriers"]),
    (["auto", "radiation", "barrier-rigid"], ["means nothing without", "barrier-elastic"]),
    (["vibration", "barrier-rigid", "rate-hardening"], ["means nothing", "rod-plasticity"]),
    (["vibration", "barrier-rigid", "-gravity"], ["-gravity", "is not an effect"]),
    (["-friction"], ["-friction", 'write ["auto", "-friction"]']),
    (["gravity"], ["names 0 barriers", "gravity"]),
    (["vibration", "frictoin", "barrier-rigid"], ["frictoin", "Did you mean friction?"]),
    (["vibration", "vibration", "barrier-rigid"], ["twice"]),
    (["vibration"], ["0 barriers", "barrier-elastic"]),
    (["vibration", "barrier-rigid", "barrier-elastic"], ["2 barriers"]),
]


@pytest.mark.parametrize(("names", "words"), EFFECTS)
def test_effects_that_cannot_be_are_named_by_the_plan(names, words):
    with pytest.raises(SceneError) as caught:
        Case.of(replace(load("t5b"), "effects", names), "rigid")
    assert all(word in str(caught.value) for word in words) and caught.value.key == "effects"


def write(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "mine.toml"
    path.write_bytes(text.encode(encoding))
    return path


def refusal(path):
    with pytest.raises(SceneError) as caught:
        read_toml(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    return message


def test_a_file_with_a_mistake_is_named(tmp_path):
    text = to_toml(load("t5b")).replace('length = "80 mm"', "length = 80")
    assert "projectile.length = 80" in refusal(write(tmp_path, text))


def test_a_missing_file_says_so(tmp_path):
    with pytest.raises(UsageError, match=r"none.toml: there is no such file"):
        read_toml(tmp_path / "none.toml")


def test_a_directory_is_no_scene(tmp_path):
    assert "is a directory, not a scene file. Name a scene file." in refusal(tmp_path)
    (tmp_path / "scene.toml").write_text("")
    assert f"such as {tmp_path / 'scene.toml'}." in refusal(tmp_path)


@pytest.mark.parametrize(
    ("left_out", "remedy"),
    [
        ('source = "own"', 'Write source = "our own tests"'),
        ("friction = 0.3", "Write friction = 0.3, Coulomb's"),
    ],
)
def test_what_a_surface_of_ones_own_lacks_is_said_with_an_example(tmp_path, left_out, remedy):
    own = '[surface]\nstate = "custom"\nfriction = 0.3\nsource = "own"\n'
    stated = to_toml(load("t5b"))
    start = stated.index("[surface]")
    end = stated.index("[", start + 1)
    path = tmp_path / "own.toml"
    path.write_text(stated[:start] + own.replace(left_out, "") + stated[end:])
    assert remedy in refusal(path)


def test_a_key_by_another_word_for_it_is_proposed(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text(to_toml(load("t5b")).replace("rho =", "density =", 1))
    assert "density: is not a known key. Did you mean rho?" in refusal(path)


def test_a_key_that_is_no_text_is_refused():
    with pytest.raises(SceneError, match="5: is not a known key"):
        read_dict(to_dict(load("t5b")) | {5: 1})


@pytest.mark.parametrize("text", ["length = = 3", 'id = "a"\nid = "b"', "[" * 3000, "x = " + "1" * 9999])
def test_unreadable_toml_says_where(tmp_path, text):
    assert "TOML" in refusal(write(tmp_path, text))


def test_a_byte_order_mark_is_no_mistake(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbf" + to_toml(load("t5b")).encode())
    assert load(path) == load("t5b")


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"length": "160 mm"}, "projectile.length"),
        ({"tip": "A", "tip_radius": "7 mm"}, "projectile.tip_radius and projectile.tip"),
        ({}, "impact.angle"),
    ],
)
def test_a_set_that_was_measured_with_another_rod_or_angle_is_not_named(changes, named):
    data = to_dict(load("t5b"))
    data["projectile"] |= changes
    data["impact"] |= {} if changes else {"angle": "20 deg"}
    with pytest.raises(SceneError, match=f'measured = "t5b": .*another {named}.*Leave out'):
        read_dict(data)
    del data["measured"]
    assert read_dict(data).measured is None


@pytest.mark.parametrize(
    ("part", "changes", "named"),
    [
        ("impact", {"v_n": "-5 m/s"}, "impact.v_n"),
        ("impact", {"v_t": "-0.9 m/s", "omega": "20 rad/s"}, "impact.v_t and impact.omega"),
        ("barrier", {"mass": "0.3 kg"}, "barrier.mass"),
        ("barrier", {"v_t": "0.3 m/s"}, "barrier.v_t"),
        ("barrier", {"layers": [{"thickness": "1 mm", "material": "copper"}]}, "barrier.layers"),
        ("barrier", {"thickness": "5 mm", "support": "infinite"}, "barrier.thickness and barrier.support"),
        ("surface", {"state": "contaminated"}, "surface.state"),
    ],
)
def test_a_set_that_was_measured_in_another_impact_is_not_named(part, changes, named):
    data = to_dict(load("t5b"))
    data[part] = changes if part == "surface" else data[part] | changes
    with pytest.raises(SceneError, match=f'measured = "t5b": .*with another {named}\\. Leave out'):
        read_dict(data)


def test_a_measured_set_takes_another_friction_and_a_velocity_within_its_scatter():
    data = to_dict(load("t5b"))
    data["impact"] |= {"v_n": "-1.7 m/s"}
    data["surface"] = {"state": "custom", "friction": 0.3, "source": "a test"}
    assert read_dict(data).measured == "t5b"
    assert doubtful_tests(read_dict(data)) == []


def test_metals_of_other_names_than_the_tested_ones_are_told():
    assert doubtful_tests(replace(load("t5b"), "barrier.material.E", "200 GPa")) == []
    data = to_dict(load("t5b"))
    data["barrier"]["material"] = "copper"
    told = "barrier.material is copper, but t5b was measured with plate-steel."
    assert doubtful_tests(read_dict(data)) == [told]


def test_a_target_and_a_mesh_together_are_refused_by_name():
    with pytest.raises(SceneError, match=r"accuracy.tip_size: stands beside accuracy = '5 %'.*not both"):
        replace_all(load("t5b"), {"accuracy": "5 %", "accuracy.tip_size": "0.5 mm"})


def test_bytes_that_are_no_text(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xff\xfe\x00id")
    assert "UTF-8" in refusal(path)


def test_a_huge_file_is_not_read(tmp_path):
    assert "megabyte" in refusal(write(tmp_path, "# " + "x" * 1_000_001))


def test_a_name_with_a_zero_byte():
    with pytest.raises(SceneError, match="cannot be read"):
        read_toml("a\0b.toml")


@pytest.mark.parametrize("key", ["id", "projectile", "barrier", "impact"])
def test_a_missing_table_or_key_is_named(key):
    data = to_dict(load("t5b"))
    del data[key]
    with pytest.raises(SceneError, match=f"here: {key}: is missing"):
        read_dict(data, "here")


def test_one_number_is_never_taken_twice():
    data = to_dict(load("t5b"))
    data["projectile"]["length_m"] = 0.08
    with pytest.raises(SceneError, match=r"projectile\.length: is given twice"):
        read_dict(data)


def test_friction_belongs_to_its_state():
    data = to_dict(load("t5b"))
    data["surface"] = {"state": "machined", "friction": 0.6}
    with pytest.raises(SceneError, match=r'surface\.friction = 0\.6.*state = "custom"'):
        read_dict(data)


def test_own_friction_needs_its_source():
    data = to_dict(load("t5b"))
    data["surface"] = {"state": "custom", "friction": 0.6}
    with pytest.raises(SceneError, match=r"surface\.source: is missing"):
        read_dict(data)


def test_a_shipped_name_never_stands_for_other_values():
    data = to_dict(load("t5b"))
    data["projectile"]["material"]["E"] = "200 GPa"
    with pytest.raises(SceneError, match=r"projectile\.material\.name"):
        read_dict(data)


def test_python_objects_pass_the_same_checks():
    steel = materials()["rod-steel"]
    with pytest.raises(SceneError, match=r"tip_radius = \"10 mm\""):
        ProjectileSpec(0.24, 0.019, "B", 0.010, steel)
    with pytest.raises(SceneError, match=r"impact\.v_n"):
        dataclasses.replace(load("quick"), impact=Impact(math.pi / 4, 1.5, -1.5))
    with pytest.raises(SceneError, match="finite"):
        Material("mine", INF, 0.3, 7850.0, 1e8, 2e8)


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=12),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3),
    max_leaves=5,
)
FULL = to_dict(load("t5b"))
KEYS = [(s, k) for s, table in FULL.items() if isinstance(table, dict) for k in table] + [
    (key, None) for key in FULL
]


@given(st.sampled_from(KEYS), values)
@settings(max_examples=300, deadline=None)
def test_any_wrong_value_is_refused_or_gives_a_sound_scene(place, value):
    section, key = place
    data = to_dict(load("t5b"))
    if key is None:
        data[section] = value
    else:
        data[section][key] = value
    try:
        scene = read_dict(data)
    except SceneError as error:
        assert section in str(error)
        return
    assert read_dict(to_dict(scene)) == scene


@pytest.mark.parametrize("shape", ["hemisphere", "ogive", "ball"])
def test_a_shape_that_is_given_as_a_tip_is_told_where_it_belongs(shape):
    data = to_dict(load("tube")) | {"projectile": {**ROD, "tip": shape}}
    with pytest.raises(
        SceneError, match=rf'projectile\.tip = "{shape}".*Write shape = "{shape}" with .*diameter'
    ):
        read_dict(data)


@pytest.mark.parametrize(
    ("key", "words"), [("nu", "Poisson's ratio"), ("E", "Young's modulus"), ("rho", "density")]
)
def test_a_material_of_ones_own_without_a_constant_is_told_which(key, words):
    metal = {"name": "mine", "E": "70 GPa", "nu": 0.3, "rho": "2700 kg/m3"} | {
        "yield_stress": "200 MPa",
        "ultimate_stress": "300 MPa",
    }
    del metal[key]
    data = to_dict(load("quick")) | {"projectile": {**ROD, "material": metal}}
    data.pop("measured", None)
    with pytest.raises(SceneError, match=rf"projectile\.material\.{key}: is missing: the {words}\..*Give it"):
        read_dict(data)
    data["projectile"]["material"] = {"name": "mine"}
    with pytest.raises(SceneError, match=r"\.E: .*, and so are nu \(Poisson's ratio\), rho \(density\)\."):
        read_dict(data)


@pytest.mark.parametrize(
    ("name", "told", "not_told"),
    [
        ("aluminum", "aluminium-6061-t6, aluminium-2024-t3", "alumina"),
        ("steel-304", "stainless-304", "4340"),
        ("Aluminium", "aluminium-6061-t6", "alumina"),
        ("6061-T66", "aluminium-6061-t6", "steel"),
        ("steel", "rod-steel, plate-steel", "alumina"),
        ("aluminium-6061-T66", "aluminium-6061-t6", "alumina"),
    ],
)
def test_a_material_that_is_not_shipped_is_answered_with_its_family(name, told, not_told):
    with pytest.raises(SceneError) as refused:
        material(name)
    assert told in str(refused.value) and not_told not in str(refused.value)


def test_a_misspelt_key_is_named_before_what_is_missing_for_it():
    data = to_dict(load("t5b"))
    data["projectile"]["lenght"] = data["projectile"].pop("length")
    data["surface"] = {"stat": "machined"}
    del data["id"]
    with pytest.raises(SceneError, match=r"projectile\.lenght: is not a known key\. Did you mean length\?"):
        read_dict(data)
    data["projectile"]["length"] = data["projectile"].pop("lenght")
    with pytest.raises(SceneError, match=r"surface\.stat: is not a known key\. Did you mean state\?"):
        read_dict(data)
    data["surface"] = {"state": "machined"}
    with pytest.raises(SceneError, match=r"id: is missing"):
        read_dict(data)


@pytest.mark.parametrize(
    ("key", "place"),
    [("friction", r"\[surface\]"), ("speed", r"\[impact\]"), ("E", "a material: .* or barrier.material")],
)
def test_a_key_in_a_wrong_place_is_told_its_own(key, place):
    with pytest.raises(SceneError, match=rf"{key}: is not a known key\. It is a key of {place}\."):
        read_dict(to_dict(load("t5b")) | {key: 1})


def test_a_bore_that_is_a_table_is_refused():
    tube = {"profile": [["0 mm", "8 mm"], ["80 mm", "8 mm"]], "bore": {}, "material": "rod-steel"}
    with pytest.raises(SceneError, match=r"projectile\.bore: must be a list"):
        read_dict(to_dict(load("t5b")) | {"projectile": tube, "measured": None})


def test_a_velocity_beside_a_barrier_that_runs_away_names_what_strikes():
    table = to_dict(load("quick")) | {"measured": None}
    table = {key: value for key, value in table.items() if value is not None}
    table["barrier"]["v_n"] = "-3 m/s"
    with pytest.raises(SceneError, match=r"Give a velocity above -503 m/s and below -3 m/s"):
        read_dict(table)
