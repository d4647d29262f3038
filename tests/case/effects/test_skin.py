"""The hardened layer of a machined body: off unless stated, and where it is in the meshes."""

import numpy as np
import pytest

from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import EFFECTS
from fem_impact.case.record import expected_record
from fem_impact.case.recorded import recorded_zones, rows_within, unresolved_skins
from fem_impact.errors import SceneError
from fem_impact.fem.geometry import to_barrier_frame
from fem_impact.physics.hardening import Skin
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest, to_dict
from fem_impact.solid.build import Builder
from fem_impact.solid.skin import below_outline, strengths
from meshes import drawn_depths

T5B = load("t5b")
BODIES = ("projectile", "barrier")


def skinned(scene=T5B, bodies=BODIES, **skin):
    layer = {"factor": 1.5, "depth": "0.11 mm"} | skin
    return replace_all(scene, {f"{body}.material.skin": layer for body in bodies})


def test_it_is_off_unless_a_scene_states_a_layer():
    assert "machined-skin" not in Case(T5B).active
    assert Case.of(T5B).slots.barrier_skin is None
    stated = skinned(bodies=["barrier"], shape="exponential")
    slots = Case.of(stated).slots
    assert "machined-skin" in Case(stated).active
    assert slots.barrier_skin == Skin(pytest.approx(1.1e-4), 1.5, "exponential")
    assert slots.rod_skin is None
    assert (stated.surface.state, stated.measured) == ("machined", "t5b")
    assert read_dict(to_dict(stated)) == stated
    assert digest(stated) != digest(T5B)
    assert Case.of(replace_all(stated, OFF)).slots.barrier_skin is None


def test_one_value_of_it_is_changed_alone():
    deeper = replace_all(skinned(), {"barrier.material.skin.depth": "0.2 mm"})
    assert deeper.barrier.material.skin.depth == pytest.approx(2e-4)
    assert deeper.barrier.material.skin.factor == 1.5


def number(depth):
    elastic = Bodies(skinned(depth=depth), ("vibration", "barrier-elastic"))
    return EFFECTS["machined-skin"].number(elastic)


def test_its_number_is_the_mean_gain_within_a_contact_radius():
    assert 0 < number("0.05 mm") == pytest.approx(number("0.1 mm") / 2)
    assert number("1 mm") == 0.5


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"depth": None}, ["skin.depth", "is missing", "load of the hardness test"]),
        ({"load": 30}, ["skin.load", "stands beside depth"]),
        ({"factor": 0.5}, ["skin.factor", "at least 1"]),
        ({"depth": "2 mm"}, ["skin.depth", "at most 1 mm"]),
        ({"shape": "round"}, ["skin.shape", '"even" or "exponential"']),
        ({"hardness": 200}, ["skin.hardness", "is not a known key"]),
    ],
)
def test_half_a_layer_or_an_odd_one_is_refused(changes, words):
    layer = {"factor": 1.5, "depth": "0.1 mm"} | changes
    with pytest.raises(SceneError) as caught:
        replace_all(T5B, {"barrier.material.skin": {k: v for k, v in layer.items() if v is not None}})
    for word in words:
        assert word in str(caught.value)


def test_a_layer_that_follows_from_a_hardness_needs_one_and_a_softer_bulk():
    bare = {"barrier.material": {"name": "x", "E": "206 GPa", "nu": 0.3, "rho": "7850 kg/m3"}}
    strength = {"yield_stress": "320 MPa", "ultimate_stress": "446 MPa"}
    skin = {"skin": {"factor": 2.0, "load": 30}}
    with pytest.raises(SceneError, match=r"hardness: is missing beside skin\.load"):
        replace_all(T5B, {"barrier.material": bare["barrier.material"] | strength | skin})
    with pytest.raises(SceneError, match="gives the bulk the hardness"):
        replace_all(T5B, {"barrier.material.law": "hardness", "barrier.material.skin": skin["skin"]})
    with pytest.raises(SceneError, match=r"skin: means nothing without yield_stress"):
        replace_all(T5B, {"barrier.material": bare["barrier.material"] | {"hardness": 163} | skin})


def test_it_cannot_be_wanted_without_a_layer():
    with pytest.raises(SceneError, match="no material that touches states a skin"):
        Case.of(replace_all(T5B, {"effects": ["auto", "machined-skin"]}))


def test_a_layer_that_nothing_touches_is_refused():
    with pytest.raises(SceneError, match=r"barrier\.material\.skin: is that of a material which does not"):
        Case.of(skinned(load("layered"), ["barrier"]))


def test_other_models_refuse_it_or_say_that_it_does_not_enter():
    with pytest.raises(SceneError, match="holds machined-skin, which the reduced model does not compute"):
        Case.of(skinned(), "modal")
    assert Case.of(replace_all(skinned(), OFF), "modal").slots.barrier_skin is None
    told = [one.text for one in Case.of(skinned(), "rigid").limitations]
    assert sum("hardened layer does not enter" in text for text in told) == 1


def test_rows_of_the_plate_follow_the_layer():
    """Three rows lie in it, unless the first would be crushed; fewer are told."""
    for depth in (0.5, 0.3, 0.02):
        case = Case.of(replace_all(skinned(depth=f"{depth} mm"), {"accuracy.levels": 1, "effects": WANTED}))
        h, rows = case.zones.barrier_size, case.zones.skin_rows
        ends = drawn_depths(h * np.arange(1.0, 9.0), h, rows)
        within = int(np.searchsorted(ends, 1e-3 * depth * (1 + 1e-9), "right"))
        assert within == int(rows_within(1e-3 * depth, h, rows))
        told = [one.text for one in case.limitations if "hardened layer of the barrier" in one.text]
        assert bool(told) == (within < 3), depth
    assert told[0].startswith("The hardened layer of the barrier, 0.02 mm, lies in 1.")


def test_a_fine_zone_for_the_skin_has_three_rows_in_each_layer():
    """Cells of 0.148 mm: 4 rows that halve have three in 0.11 mm, and the rod is fine for twice as many."""
    for word, rows, told in (("graded", 3, 2), ("skin", 4, 0)):
        sizes = {"accuracy.tip_size": "0.15 mm", "accuracy.fine_zone": word, "effects": WANTED}
        case = Case(replace_all(skinned(), sizes))
        bodies, turn = case.bodies, to_barrier_frame(case.bodies.mesh_inclination)
        zones = recorded_zones(bodies, expected_record(bodies, 1.5e-4, 1.5e-4))
        deep = zones.in_rod(bodies.lowest_point, turn)[-1].points @ turn[2]
        assert (zones.rod_rows, zones.skin_rows) == (rows, rows)
        assert len(unresolved_skins(case.slots, zones)) == told
        assert np.ptp(deep) > 7 * zones.tip_size if word == "skin" else np.ptp(deep) < 4 * zones.tip_size


CUBE = np.array([[0, 1, 2, 3, 4, 5, 6, 7]])  # VTK order: the face z = 0 below that of z = 1
TOP = 2.0 * np.array([1, 1, 1, 1, 0, 0, 0, 0])  # m under the surface


@pytest.mark.parametrize(("depth", "upper", "lower"), [(0.5, 1.2, 1.0), (1.0, 1.4, 1.0), (1.5, 1.4, 1.2)])
def test_a_gauss_point_has_the_share_of_its_part_of_the_cell(depth, upper, lower):
    """A cell of 2 m: each half along z is one Gauss point's, the upper ones come last."""
    found = strengths(CUBE, TOP, Skin(depth, 1.4))
    assert found[0] == pytest.approx([lower] * 4 + [upper] * 4)


def test_an_exponential_layer_has_the_gain_of_an_even_one_in_all():
    found = strengths(CUBE, TOP, Skin(0.5, 1.4, "exponential"))
    assert found[0].mean() - 1 == pytest.approx(0.4 * 0.5 / 2 * (1 - np.exp(-4)))
    assert found[0, 4] - 1 == pytest.approx(0.4 * 0.5 * (1 - np.exp(-2)))


def test_distances_from_an_outline():
    outline = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 5.0]])
    points = np.array([[0.0, 0.0, 0.3], [0.0, 0.9, 2.0], [0.6, 0.0, 0.5], [3.0, 4.0, 5.0]])
    assert below_outline(points, outline) == pytest.approx([0.3, 0.1, 0.4, 4.0])


def test_the_model_is_harder_by_the_layer_and_no_more():
    """In the plate gain times volume, over the area that yields at its surface, is gain times depth."""
    coarse = {"accuracy.tip_size": "0.7 mm", "effects": WANTED}
    scenes = (replace_all(skinned(depth="0.2 mm", factor=factor), coarse) for factor in (1.0, 1.5))
    soft, hard = (Builder(Case.of(scene), 1e-10) for scene in scenes)
    for before, after in zip(soft.zones, hard.zones, strict=True):
        gain = after.blocks.flow / before.blocks.flow - 1
        assert np.unique(before.blocks.flow).size == 1
        assert gain.min() == 0.0 < gain.max() <= 0.5 + 1e-12
        assert np.array_equal(before.law, after.law)
    plate = hard.meshed.barrier
    corners = plate.points[plate.mesh.cells[plate.yields]]
    size = corners.max(axis=1) - corners.min(axis=1)
    area = size[corners[:, :, 2].max(axis=1) == 0.0, :2].prod(axis=1).sum()
    assert (gain * after.blocks.weight).sum() == pytest.approx(0.5 * 2e-4 * area, rel=0.03)


WANTED = ["auto", "machined-skin"]
OFF = {"effects": ["auto", "-machined-skin"]}
