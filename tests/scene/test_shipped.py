"""Shipped scenes: all load, repeat the published sets and state where their values come from."""

import math

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.errors import SceneError, UsageError
from fem_impact.outcome.groups import texts
from fem_impact.scene.fields import DEFAULTS
from fem_impact.scene.impact import Following, Impact
from fem_impact.scene.inputs import DEFAULT, STATED, inputs, materials_of
from fem_impact.scene.library import materials, shipped, surfaces
from fem_impact.scene.read import read_dict, read_toml
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.types import MEASURED_SETS, Accuracy, Heating, Save, to_dict
from rigid.experiments import measured_set, set_ids

SECOND = {f"{name}-tip-a": name for name in ("t3-machined", "t3-contaminated", "t3-cleaned")}


OWN_BARRIERS = ("plate-10mm", "free-barrier-5kg", "moving-barrier", "spinning-rod")
OTHER_METALS = ("aluminium-rod", "tungsten-rod")
OWN_SHAPES = ("tube", "ogive", "heavy-tail", "sphere-cone")
LAYERS = ("layered",)


def test_the_thirteen_sets_and_others_are_shipped():
    others = (
        "elastic-frictionless",
        "quick",
        "wave",
        "wave-45",
        *SECOND,
        *OWN_BARRIERS,
        *OWN_SHAPES,
        *OTHER_METALS,
        *LAYERS,
    )
    assert shipped() == (*MEASURED_SETS, *others)
    assert tuple(set_ids()) == MEASURED_SETS
    assert len(MEASURED_SETS) == 13


@pytest.mark.parametrize("name", shipped())
def test_a_shipped_scene_carries_its_own_name(name):
    scene = load(name)
    assert scene.id == name
    assert scene.measured == {"quick": "t5b", **SECOND}.get(name, name if name in MEASURED_SETS else None)


@pytest.mark.parametrize("name", SECOND)
def test_table_3_with_tip_a_differs_by_its_tip_alone(name):
    first, second = to_dict(load(SECOND[name])), to_dict(load(name))
    tip = second["projectile"].pop("tip"), second["projectile"].pop("tip_radius")
    assert tip == ("A", "7 mm")
    for key in ("tip", "tip_radius"):
        del first["projectile"][key]
    for key in ("id", "title"):
        assert first.pop(key) != second.pop(key)
    assert first == second


def test_a_set_is_read_with_another_tip_only_where_that_is_shipped():
    data = to_dict(load("t5b"))
    data["projectile"] |= {"tip": "A", "tip_radius": "7 mm"}
    with pytest.raises(SceneError, match=r"measured with another projectile.tip_radius and projectile.tip"):
        read_dict(data)


@pytest.mark.parametrize("name", MEASURED_SETS)
def test_a_measured_scene_repeats_the_published_set(name):
    scene, published = load(name), measured_set(name)
    rod = scene.projectile
    assert (rod.length, rod.diameter, rod.tip, rod.tip_radius) == (
        published.length,
        published.diameter,
        published.tip,
        published.tip_radius,
    )
    assert scene.surface.state == published.surface
    assert math.isclose(scene.impact.angle, published.alpha, rel_tol=1e-12)
    means = [float(np.mean(published.motion[key])) for key in ("v_n", "v_t")]
    assert np.allclose((scene.impact.v_n, scene.impact.v_t), means, atol=6e-5)
    assert scene.impact.omega == 0.0


@pytest.mark.parametrize("name", MEASURED_SETS)
def test_a_measured_scene_lies_inside_the_measured_range(name):
    assert Case.of(load(name)).limitations == ()


def test_one_friction_interval_serves_every_rod_speed_and_angle():
    used = {}
    for name in MEASURED_SETS:
        surface = load(name).surface
        used.setdefault(surface.state, set()).add(surface)
    assert used == {state: {surface} for state, surface in surfaces().items()}


def test_every_surface_and_material_value_carries_a_source():
    stated = [surface.source for surface in surfaces().values()]
    for name in materials():
        rows = inputs(replace(load("quick"), "projectile.material", name)).rows
        stated += [
            source for key, _, source in rows if "material" in key and not key.endswith((".name", ".law"))
        ]
    assert len(stated) > 100
    assert all(len(source) > 15 and source not in ("stated in the scene", STATED) for source in stated)


def test_inputs_say_which_values_are_the_default():
    rows = {key: source for key, _, source in inputs(load("plate-10mm")).rows}
    assert rows["impact.omega"] == DEFAULT and rows["impact.height"] == STATED
    turning = inputs(replace(load("plate-10mm"), "impact.omega", "3 rad/s"))
    assert {key: source for key, _, source in turning.rows}["impact.omega"] == STATED


def test_inputs_name_each_segment_and_layer_once():
    tail = inputs(replace(load("heavy-tail"), "barrier.thickness", "50 mm"))
    rows = {key: (value, source) for key, value, source in tail.rows}
    assert len(rows) == len(tail)
    assert rows["projectile.segments[2].to"] == ("120 mm", STATED)
    assert rows["projectile.segments[2].material.name"][0] == "tungsten-heavy-alloy"
    assert "makeitfrom" in rows["projectile.segments[2].material.E"][1]
    assert rows["barrier.thickness"] == ("50 mm", STATED)
    assert "barrier.layers[1].material.E" in inputs(load("layered")).texts("input")
    assert [*materials_of(load("layered"))][1:] == ["barrier.layers[1].material", "barrier.material"]
    ogive = inputs(load("ogive")).texts("input")
    assert "projectile.calibre_radius" in ogive and "projectile.tip_radius" not in ogive


def test_the_steels_are_those_of_the_paper():
    rod, plate = materials()["rod-steel"], materials()["plate-steel"]
    assert (rod.E, rod.yield_stress, rod.ultimate_stress) == (219e9, 546e6, 592e6)
    assert (plate.E, plate.yield_stress, plate.ultimate_stress) == (206e9, 320e6, 446e6)


def test_a_volume_of_a_solid_holds_as_much_heat_as_its_atoms_can():
    """3 k for each of the 3e28 to 1.2e29 atoms of 1 m3, less where light atoms do not yet swing."""
    held = {name: one.rho * one.heat_capacity for name, one in materials().items() if one.heat_capacity}
    assert {name: per_volume for name, per_volume in held.items() if not 1.2e6 < per_volume < 4.5e6} == {}


DERIVED = {
    "save.gauge": "no gauge",
    "save.gauge_across": "1",
    "accuracy.tip_size": "5 elements over the estimated radius of a yielding contact, "
    "4 over that of an elastic one",
    "accuracy.barrier_size": "accuracy.tip_size",
    "accuracy.offsets": "1; 2 where an error is wanted",
    "accuracy.across": "8; 16 of a hollow body whose wall is on average an eighth of its diameter or thinner",
    **{
        f"heating.{body}_{key}": f"that of the {body}'s material"
        for body in ("rod", "barrier")
        for key in ("conductivity", "heat_capacity")
    },
    **{
        f"heating.{body}_melting": f"that of the {body}'s material, if it is a shipped one"
        for body in ("rod", "barrier")
    },
    "strikes.angle_error": "none: it is taken as exact",
    "strikes.speed_error": "none: it is taken as exact",
    "accuracy.max_time": "2.5 ms, or 2.8 times the bending period and the contact time where that is longer",
}


def test_the_table_of_defaults_is_what_an_unstated_value_becomes():
    made = {"impact": Impact(0.5, -1.0, -1.0), "accuracy": Accuracy(), "save": Save()}
    made |= {"heating": Heating(), "strikes": Following()}
    elastic = load("elastic-frictionless")
    for default in DEFAULTS:
        section, key = default.key.split(".")
        assert getattr(made[section], key) == getattr(getattr(elastic, section), key), default
        assert to_dict(elastic).get(section, {}).get(key, DERIVED.get(default.key)) == default.value
        assert len(default.source) > 20, default


def test_a_scene_that_leaves_the_measured_range_says_where():
    changed = replace(replace(load("t5b"), "impact.angle", "80 deg"), "impact.omega", "5 rad/s")
    sentences = " ".join(texts(Case.of(changed, "rigid").limitations, "range", "model"))
    assert "angle 80 deg, measured 17 deg to 60 deg" in sentences
    assert "turn" in sentences


def test_an_unknown_scene_is_answered_with_the_nearest_name():
    with pytest.raises(UsageError, match="Did you mean t5b"):
        load("t5bb")
    with pytest.raises(UsageError, match=r"no such file.*Did you mean quick"):
        read_toml("nowhere/qick.toml")


def test_a_scene_is_read_from_a_table_with_numbers_of_numpy(tmp_path):
    table = to_dict(load("quick"))
    table["impact"] = {
        "angle_rad": np.radians(45.0),
        "v_n_m_per_s": np.float64(-1.5),
        "v_t_m_per_s": np.array(0.25),
    }
    scene = load({key: value for key, value in table.items() if key not in ("measured", "title")})
    assert (scene.impact.v_n, scene.impact.v_t) == (-1.5, 0.25)
    with pytest.raises(SceneError, match="lenght"):
        load({**table, "projectile": {**table["projectile"], "lenght": "1 m"}})


@pytest.mark.parametrize(
    "change",
    [
        {"barrier.layers": [{"thickness": "1 mm", "material": "aluminium-6061-t6"}]},
        {"barrier": {"material": "aluminium-6061-t6"}},
        {"projectile": {"shape": "ball", "diameter": "20 mm", "material": "aluminium-6061-t6"}},
    ],
)
def test_the_surface_of_a_pair_follows_from_the_bodies_however_they_are_changed(change):
    data = {key: value for key, value in to_dict(load("quick")).items() if key not in ("surface", "measured")}
    scene = load(data)
    changed = replace_all(scene, change)
    assert changed.surface.state == "pair" and changed.surface.source.startswith("steel on aluminium")
    assert changed.surface.friction != scene.surface.friction
    assert replace_all(scene, change | {"surface.friction": 0.3}).surface.friction == 0.3
    with pytest.raises(SceneError, match=r"surface = .* must be a table"):
        replace_all(scene, change | {"surface": "machined"})


def test_who_asks_for_the_first_impact_alone_leaves_how_strikes_are_followed():
    followed = replace_all(load("quick"), {"impact.until": "rest", "strikes.angle_error": "1 deg"})
    assert replace(followed, "impact.until", "first").strikes == Following()
