"""The library of materials: names and aliases, sources, families, intervals; friction of pairs."""

import pytest

from fem_impact.case.case import Case
from fem_impact.case.metals import unknowns
from fem_impact.errors import SceneError
from fem_impact.scene import fields, library
from fem_impact.scene.library import (
    aliases_of,
    family_of,
    friction_pairs,
    intervals_of,
    material,
    materials,
    melting_of,
    read_material,
    sourced_values,
    sources_of,
)
from fem_impact.scene.material import FAMILIES, Material, family_by_words, kind_of
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.scene.surface_table import known_pair, pair_surface
from fem_impact.scene.types import to_dict
from fem_impact.scene.units import data_tables

T5B = load("t5b")
BESIDE = {"about", "aliases", "family", "intervals", "sources", "melting"}


def stated(name):
    """The table of a shipped material as its file states it."""
    return data_tables("materials.toml")[name]


@pytest.mark.parametrize(
    ("name", "own"),
    [
        ("1.4404", "stainless-316l"),
        ("316L", "stainless-316l"),
        ("AISI 316L", "stainless-316l"),
        ("aisi-316l", "stainless-316l"),
        ("S355J2", "s355"),
        ("C45", "c45"),
        ("EN-GJS-400-18", "ductile-cast-iron"),
        ("Ti-6Al-4V", "titanium-6al-4v"),
        ("CuSn8", "bronze-cusn8"),
        ("nylon", "pa66"),
        ("Stainless 316L", "stainless-316l"),
    ],
)
def test_a_material_is_found_by_its_standard_number_and_by_other_names(name, own):
    assert material(name) == materials()[own]
    assert replace(T5B, "projectile.material", name).projectile.material.name == own


def test_no_name_stands_for_two_materials():
    names = [library._plain(one) for name in materials() for one in (name, *aliases_of(name))]
    assert len(names) == len(set(names))
    refused = {library._plain(one) for of in data_tables("not_modelled.toml").values() for one in of["names"]}
    assert not refused & set(names)


@pytest.mark.parametrize("name", materials())
def test_every_value_of_a_shipped_material_has_its_source(name):
    values = set(stated(name)) - BESIDE
    assert values | ({"melting"} & set(stated(name))) == set(sources_of(name))
    assert library.about(name)
    assert family_of(materials()[name]) in FAMILIES
    assert {row[0] for row in sourced_values(name)} == set(sources_of(name))


@pytest.mark.parametrize("name", materials())
def test_a_value_lies_in_its_interval_and_metals_melt_above_room_temperature(name):
    metal = materials()[name]
    for key, (low, high) in intervals_of(name).items():
        value = getattr(metal, key, None)
        assert low < high
        assert value is None or low <= value <= high, key
    assert (melting_of(name) or 600.0) > 550.0
    if kind_of(family_of(metal)) == "metal":
        assert metal.yields, "a shipped metal states how it flows"


def test_what_is_known_by_name_and_not_modelled_is_refused_with_the_reason():
    for name, words in (
        ("concrete", "crushed and cracks.*upper bound"),
        ("sand", "crushed"),
        ("oak", "another material along the grain"),
        ("Magnox", "no source with its values"),
        ("peek", "is a polymer"),
    ):
        with pytest.raises(SceneError, match=words):
            material(name)


@pytest.mark.parametrize(
    ("name", "family"),
    [
        ("rubber", "rubber"),
        ("my rubber ball", "rubber"),
        ("NR-60", ""),
        ("316L", "stainless steel"),
        ("my-steel", "steel"),
        ("plate-steel (changed)", "steel"),
        ("C30/37 concrete", "concrete"),
        ("granite 2", "rock"),
        ("leaded thing", ""),
        ("crash pad", ""),
        ("cu", "copper"),
        ("aluminium-bronze", "bronze"),
        ("steel, stainless", "stainless steel"),
        ("lead-free brass", "brass"),
        ("tungsten-carbide", ""),
        ("aluminium oxide", ""),
    ],
)
def test_a_family_is_read_from_a_word_of_the_name_and_from_no_part_of_one(name, family):
    assert family_by_words(name) == family


@pytest.mark.parametrize(
    ("name", "families"),
    [
        ("steel-reinforced concrete", "steel and of concrete"),
        ("aluminum oxide ceramic", "aluminium and of ceramic"),
        ("glass-fibre-nylon", "glass and of polyamide"),
        ("tungsten-carbide", "tungsten and of ceramic"),
        ("lead-glass", "lead and of glass"),
    ],
)
def test_a_name_of_families_of_different_kinds_needs_a_stated_one(name, families):
    table = {"name": name, "E": "70 GPa", "nu": 0.25, "rho": "2500 kg/m3"}
    with pytest.raises(SceneError, match=f"family: is missing: the words of the name '{name}' .* {families}"):
        read_material(table)
    assert family_of(read_material(table | {"family": "glass"})) == "glass"


def test_a_stated_family_comes_before_the_name():
    assert family_of(Material("rubber", 2e11, 0.3, 7850.0, family="steel")) == "steel"
    with pytest.raises(SceneError, match="family"):
        Material("x", 2e11, 0.3, 7850.0, family="unobtainium")
    scene = replace_all(T5B, {"barrier.material.family": "cast iron", "barrier.material.hardness": 150})
    assert scene.barrier.material.family == "cast iron"
    assert read_dict(to_dict(scene)) == scene


def test_the_pairs_are_intervals_of_known_families_with_sources():
    seen = set()
    for pair in friction_pairs():
        assert 0 < pair["low"] < pair["high"] < 2
        assert set(pair["families"]) <= set(FAMILIES)
        assert len(pair["source"]) > 20
        key = frozenset(pair["families"])
        assert key not in seen
        seen.add(key)


def without_surface(**materials_of):
    data = to_dict(T5B)
    del data["surface"], data["measured"]
    for body, name in materials_of.items():
        data[body]["material"] = name
    return data


def test_a_scene_without_friction_takes_the_middle_of_its_pair_and_says_so():
    scene = read_dict(without_surface(projectile="aluminium-6061-t6"))
    surface = scene.surface
    assert (surface.state, surface.friction) == ("pair", 0.36)
    assert (surface.friction_low, surface.friction_high) == (0.25, 0.47)
    told = [one for one in unknowns(Case(scene).bodies) if "No friction is stated" in one]
    assert len(told) == 1
    assert "f = 0.36 is the middle of 0.25 to 0.47 (steel on aluminium" in told[0]
    assert read_dict(to_dict(scene)) == scene


def test_the_narrowest_pair_is_taken_whichever_body_is_which():
    known = materials()
    steel, copper, stainless = known["s235"], known["copper"], known["stainless-304"]
    assert known_pair(steel, copper).friction_high == 0.80
    assert known_pair(stainless, copper) == known_pair(copper, stainless)
    assert known_pair(stainless, copper).friction_high == 0.23
    assert known_pair(stainless, known["brass"]).source.startswith("steel on brass")
    assert known_pair(known["lead"], known["soda-lime-glass"]).source.startswith("metal on glass")
    assert known_pair(known["titanium-grade-2"], steel) is None


def test_a_pair_that_no_table_has_is_refused_with_what_to_write():
    with pytest.raises(
        SceneError, match=r'surface\.friction: is missing.*titanium-6al-4v on plate-steel.*"custom"'
    ):
        read_dict(without_surface(projectile="titanium-6al-4v"))
    unknown = Material("mystery", 1e11, 0.3, 5e3)
    with pytest.raises(SceneError, match="no friction of mystery on mystery"):
        pair_surface(unknown, unknown)
    frictionless = without_surface(projectile="titanium-6al-4v") | {"effects": ["auto", "-friction"]}
    assert read_dict(frictionless).surface.friction == 0.0


def test_another_material_takes_the_friction_of_its_own_pair():
    scene = read_dict(without_surface(projectile="aluminium-6061-t6"))
    assert replace(scene, "projectile.material", "brass").surface.friction == 0.43
    with pytest.raises(SceneError, match="titanium"):
        replace(scene, "projectile.material", "titanium-6al-4v")
    own = replace(scene, "surface.friction", 0.5)
    assert (own.surface.state, own.surface.friction_low) == ("custom", 0.5)
    assert replace(T5B, "surface.state", "pair").surface.friction == 0.465
    both = {"surface.state": "pair", "projectile.material": "plate-steel"}
    assert replace_all(T5B, both).surface.friction == 0.465


def test_values_beside_the_state_of_a_pair_may_only_repeat_it():
    data = without_surface(projectile="brass") | {"surface": {"state": "pair", "friction": 0.3}}
    with pytest.raises(SceneError, match=r"surface\.friction = 0\.3.*is not the value of a pair surface"):
        read_dict(data)


def test_a_surface_of_steel_beside_another_metal_names_the_interval_of_the_pair():
    brass, titanium = (replace(T5B, "projectile.material", one) for one in ("brass", "titanium-6al-4v"))
    of_brass = next(one for one in unknowns(Case(brass).bodies) if one.startswith("Friction f"))
    assert "not of brass" in of_brass
    assert 'surface.state = "pair" takes 0.35 to 0.51' in of_brass
    of_titanium = next(one for one in unknowns(Case(titanium).bodies) if one.startswith("Friction f"))
    assert "takes" not in of_titanium
    assert not [one for one in unknowns(Case(T5B).bodies) if "riction" in one]


def test_each_bound_of_a_material_is_that_of_its_table():
    assert {f.key for f in fields.MATERIAL} >= {"tangent_modulus", "loss_factor"}
