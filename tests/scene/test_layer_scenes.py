"""Layers as a scene states them: read, written, refused where no mesh and no model holds them."""

from dataclasses import replace
from math import inf

import pytest

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.outcome.groups import texts
from fem_impact.run.simulate import simulate
from fem_impact.scene.barrier import Layer
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load
from fem_impact.scene.types import digest, to_dict, to_toml

PLATE = {"thickness": "2 mm", "material": "steel-4340"}


def layered(layers, fidelity="solid", **barrier):
    data = to_dict(load("layered"))
    data["barrier"] = {"material": "aluminium-6061-t6", "layers": layers, **barrier}
    scene = read_dict(data)
    Case.of(scene, fidelity)
    return scene


def test_materials_are_those_from_the_top_down():
    barrier = layered([PLATE, {"thickness": "4 mm", "material": "copper"}]).barrier
    assert [(round(end, 9), metal.name) for end, metal in barrier.strata] == [
        (2e-3, "steel-4340"),
        (6e-3, "copper"),
        (inf, "aluminium-6061-t6"),
    ]
    assert barrier.struck.name == "steel-4340"


def test_a_written_scene_reads_back_equal_and_layers_are_part_of_it():
    import tomllib

    one = layered([PLATE])
    assert read_dict(tomllib.loads(to_toml(one))) == one
    assert digest(one) != digest(layered([{**PLATE, "thickness": "2.5 mm"}]))


@pytest.mark.parametrize(
    ("layers", "more", "reason"),
    [
        ("steel", {}, r"barrier.layers: must be a list of layers\. Write layers = \[\{thickness"),
        ([], {}, "must be a list of layers"),
        ([{"material": "steel-4340"}], {}, r"barrier.layers\[1\].thickness"),
        ([PLATE, {**PLATE, "thickness": "-1 mm"}], {}, r"barrier.layers\[2\].thickness = .*at least"),
        (
            [{**PLATE, "thickness": "2000 cm"}],
            {},
            r"barrier.layers\[1\].thickness = 2000 cm: .*at most 1000 mm",
        ),
        ([{**PLATE, "thickness": 2}], {}, r"barrier.layers\[1\].thickness"),
        ([{**PLATE, "hardness": 3}], {}, r"barrier.layers\[1\].hardness: is not a known key"),
        ([{**PLATE, "material": "unobtainium"}], {}, r"barrier.layers\[1\].material"),
        ([PLATE], {"thickness": "10 mm", "support": "infinite"}, "lie on a plate that bends"),
        ([PLATE], {"mass": "5 kg"}, "free to move: only a massive one"),
        (
            [{**PLATE, "thickness": "0.3 mm"}],
            {},
            r"layers\[1\].thickness = .0.3 mm.: fits no row of .* cells, 2.38 mm wide: .*across = \d+",
        ),
        (
            [PLATE, {**PLATE, "thickness": "120 mm"}, PLATE],
            {},
            r"layers\[2\].thickness = .120 mm.: makes a block .* Give .steel-4340. as barrier.material",
        ),
    ],
)
def test_what_cannot_be_layered_is_refused_with_what_to_do(layers, more, reason):
    with pytest.raises(SceneError, match=reason):
        layered(layers, **more)


def test_the_advised_cells_take_the_thin_layer():
    data = to_dict(load("layered"))
    data["barrier"]["layers"][0]["thickness"] = "0.2 mm"
    with pytest.raises(SceneError) as told:
        Case.of(read_dict(data))
    data["accuracy"]["across"] = int(told.value.remedy.split("across = ")[1].split(",")[0])
    assert Case.of(read_dict(data)).scene.accuracy.across > 8


def test_the_estimates_are_told():
    planned = Case.of(load("layered"))
    assert any("first layer alone" in sentence for sentence in texts(planned.limitations, "model"))
    assert any("is thin for a contact" in sentence for sentence in texts(planned.limitations, "model"))
    assert Case.of(load("layered"), "rigid").fidelity == "rigid"


def test_a_rod_that_presses_through_a_soft_thin_layer_may_yield_on_what_lies_under_it():
    """On 0.5 mm of weak metal a rod met the base, told to stay elastic by the strength of the layer alone."""
    soft = {"name": "soft", "E": "96 GPa", "nu": 0.25, "rho": "7140 kg/m3", "source": "assumed"}
    soft |= {"yield_stress": "60 MPa", "hardening": "100 MPa"}
    data = to_dict(load("quick")) | {"effects": "auto", "measured": None}
    on = {}
    for thickness in ("0.5 mm", "40 mm"):
        data["barrier"] = {"material": "s355", "layers": [{"thickness": thickness, "material": soft}]}
        on[thickness] = "rod-plasticity" in Case.of(read_dict(data)).active
    assert on == {"0.5 mm": True, "40 mm": False}


def test_a_soft_base_is_seen_to_yield_under_a_hard_layer_that_cannot():
    data = to_dict(load("layered"))
    on = {}
    for base in ("lead", "titanium-6al-4v"):
        data["barrier"] = {"material": base, "layers": [{"thickness": "1.5 mm", "material": "alumina"}]}
        data["effects"] = "auto"
        on[base] = "barrier-elastoplastic" in Case.of(read_dict(data)).active
    assert on == {"lead": True, "titanium-6al-4v": False}


def test_the_reduced_model_refuses_a_base_that_yields_under_layers_that_do_not():
    alumina = {"thickness": "1.5 mm", "material": "alumina"}
    with pytest.raises(SceneError, match=r"a base that yields .* no law of that\. Use fidelity solid"):
        layered([alumina], "modal", material="lead")
    layered([alumina], "modal", material="titanium-6al-4v")


def test_layers_of_one_material_leave_the_reduced_model_as_it_is():
    plain = load("t5b")
    metal = plain.barrier.material
    same = (Layer(1e-3, metal), Layer(2e-3, metal))
    moved = [
        simulate(replace(plain, barrier=replace(plain.barrier, layers=layers)), "modal").restitution.edge.e
        for layers in ((), same, (Layer(0.5e-3, load("layered").barrier.struck),))
    ]
    assert moved[1] == pytest.approx(moved[0], rel=1e-6)
    assert abs(moved[2] - moved[0]) > 0.002


def test_a_thin_soft_layer_bears_more_than_its_ultimate_stress_on_a_hard_base():
    """The scene was refused, as if its author had stated the strength of both together."""
    scene = layered([{"thickness": "0.05 mm", "material": "aluminium-1350-h14"}], "modal", material="100cr6")
    assert Case.of(scene, "modal").contact.barrier.yield_stress > scene.barrier.struck.ultimate_stress


def test_the_reduced_model_refuses_metal_on_rubber_for_what_it_is():
    """It asked for the unit of a modulus that no one had stated, and finite elements take the scene."""
    sandwich = [
        {"thickness": "1 mm", "material": "s355"},
        {"thickness": "6 mm", "material": "natural-rubber"},
    ]
    assert layered(sandwich, material="s355")
    with pytest.raises(SceneError) as refused:
        layered(sandwich, "modal", material="s355")
    assert refused.value.key == "barrier.layers" and "unit" not in str(refused.value)
