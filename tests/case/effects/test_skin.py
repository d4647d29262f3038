"""The hardened layer of a cut surface: off unless stated, and where it is in the meshes."""

import numpy as np
import pytest

from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import EFFECTS
from fem_impact.errors import SceneError
from fem_impact.physics.hardening import Skin
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.write import digest, to_dict
from fem_impact.solid.build import Builder
from fem_impact.solid.skin import below_outline, strengths

T5B = load("t5b")
LAYER = {"surface.skin_depth": "0.11 mm", "surface.skin_factor": 1.5}


def skinned(**more):
    return replace_all(T5B, LAYER | more)


def test_it_is_off_unless_a_scene_states_a_layer():
    assert "machined-skin" not in Case(T5B).active
    assert Case.of(T5B).slots.skin is None
    stated = skinned()
    assert "machined-skin" in Case(stated).active
    assert Case.of(stated).slots.skin == Skin(pytest.approx(1.1e-4), 1.5)
    assert (stated.surface.state, stated.measured) == ("machined", "t5b")
    assert Case.of(stated).limitations == Case.of(T5B).limitations
    assert read_dict(to_dict(stated)) == stated
    assert digest(stated) != digest(T5B)
    without = replace_all(stated, {"effects": ["auto", "-machined-skin"]})
    assert Case.of(without).slots.skin is None


def number(depth):
    elastic = Bodies(skinned(**{"surface.skin_depth": depth}), ("vibration", "barrier-elastic"))
    return EFFECTS["machined-skin"].number(elastic)


def test_its_number_is_the_mean_gain_within_a_contact_radius():
    assert 0 < number("0.05 mm") == pytest.approx(number("0.1 mm") / 2)
    assert number("1 mm") == 0.5


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"surface.skin_depth": "0.1 mm"}, ["surface.skin_factor", "is missing"]),
        ({"surface.skin_factor": 1.5}, ["surface.skin_depth", "is missing"]),
        (LAYER | {"surface.skin_factor": 0.5}, ["skin_factor", "at least 1"]),
        (LAYER | {"surface.skin_depth": "2 mm"}, ["skin_depth", "at most 1 mm"]),
    ],
)
def test_half_a_layer_or_an_odd_one_is_refused(changes, words):
    with pytest.raises(SceneError) as caught:
        replace_all(T5B, changes)
    for word in words:
        assert word in str(caught.value)


def test_only_freshly_cut_surfaces_have_one():
    with pytest.raises(SceneError, match="contaminated surfaces"):
        replace_all(load("t2"), LAYER)


def test_it_cannot_be_wanted_without_a_layer():
    with pytest.raises(SceneError, match="states no hardened layer"):
        Case.of(replace_all(T5B, {"effects": ["auto", "machined-skin"]}))


def test_a_layer_that_no_gauss_point_can_hold_is_refused_before_any_mesh():
    thin = {"surface.skin_depth": "0.002 mm", "effects": ["auto", "machined-skin"]}
    with pytest.raises(SceneError, match=r"skin_depth = .*0.002 mm.*: is thinner.*accuracy.barrier_size"):
        Case.of(skinned(**thin))


def test_rows_of_the_plate_follow_the_layer():
    """The first row is no higher than the layer, unless it would be crushed."""
    for depth in (0.2, 0.1, 0.05):
        zones = Case.of(skinned(**{"surface.skin_depth": f"{depth} mm"})).zones
        assert zones.barrier_size * 0.5**zones.skin_rows <= 1e-3 * depth * 1.001


CUBE = np.array([[0, 1, 2, 3, 4, 5, 6, 7]])  # VTK order: the face z = 0 below that of z = 1
TOP = 2.0 * np.array([1, 1, 1, 1, 0, 0, 0, 0])  # m under the surface


@pytest.mark.parametrize(("depth", "upper", "lower"), [(0.5, 1.2, 1.0), (1.0, 1.4, 1.0), (1.5, 1.4, 1.2)])
def test_a_gauss_point_has_the_share_of_its_part_of_the_cell(depth, upper, lower):
    """A cell of 2 m: each half along z is one Gauss point's, the upper ones come last."""
    found = strengths(CUBE, TOP, Skin(depth, 1.4))
    assert found[0] == pytest.approx([lower] * 4 + [upper] * 4)


def test_distances_from_an_outline():
    outline = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 5.0]])
    points = np.array([[0.0, 0.0, 0.3], [0.0, 0.9, 2.0], [0.6, 0.0, 0.5], [3.0, 4.0, 5.0]])
    assert below_outline(points, outline) == pytest.approx([0.3, 0.1, 0.4, 4.0])


def test_the_model_is_harder_by_the_layer_and_no_more():
    """In the plate gain times volume, over the area that yields at its surface, is gain times depth."""
    coarse = skinned(**{"accuracy.tip_size": "0.7 mm", "surface.skin_depth": "0.2 mm"})
    soft, hard = (Builder(Case.of(scene), 1e-10) for scene in (replace_all(coarse, OFF), coarse))
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


OFF = {"effects": ["auto", "-machined-skin"]}
