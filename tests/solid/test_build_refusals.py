"""What the model builder refuses before any work."""

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.case.layers import block_of
from fem_impact.case.zones import zones_of
from fem_impact.errors import SceneError
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.solid.build import build


@pytest.mark.parametrize("name", ["t5b", "t3-machined"])
def test_a_tip_too_coarse_to_yield_is_refused(name):
    scene = replace(load(name), "accuracy.tip_size", "2.4 mm")
    with pytest.raises(SceneError, match=r"accuracy\.tip_size.*Give at most 1\.7 mm"):
        build(Case.of(scene))


def test_a_side_that_comes_down_before_the_tip_is_refused():
    coarse = {"accuracy.across": 12, "accuracy.tip_size": "2 mm", "effects": ["vibration", "barrier-rigid"]}
    scene = replace_all(load("t5b"), {"impact.angle": "88.9 deg"} | coarse)
    with pytest.raises(SceneError, match=r"impact\.angle: .*before its tip.*smaller accuracy\.tip_size"):
        build(Case.of(scene))
    assert build(Case.of(replace(scene, "accuracy.tip_size", "0.7 mm")))


def test_steel_that_no_power_law_fits_is_refused():
    scene = replace(load("t5b"), "projectile.material.ultimate_stress", "20 GPa")
    with pytest.raises(SceneError, match=r"ultimate_stress of rod-steel.*must lie between the yield stress"):
        Case.of(scene)


def test_a_block_of_too_many_cells_is_refused(monkeypatch):
    monkeypatch.setattr("fem_impact.fem.geometry.MOST_CELLS", 10)  # a million take twenty seconds to reach
    monkeypatch.setattr("fem_impact.case.layers.MOST_CELLS", 10)
    scene = replace_all(load("t5b"), {"accuracy.tip_size": "0.8 mm", "accuracy.across": 16})
    with pytest.raises(SceneError, match=r'accuracy\.across = "16": makes a block of .* cells'):
        build(Case.of(scene))


def test_the_margin_of_a_block_leaves_no_more_cells_than_it_may_have(monkeypatch):
    """A cone of 6 mm with cells of 142 um was refused for the margin that it had not stated."""
    case = Case.of(replace_all(load("t5b"), {"accuracy.tip_size": "0.1 mm", "accuracy.across": 32}))
    zones = zones_of(case.bodies)

    def cells():
        low, high = block_of(case.bodies, zones)
        return np.prod((high - low) / zones.base)

    assert cells() > 5000
    monkeypatch.setattr("fem_impact.case.layers.MOST_CELLS", 2000)
    assert 1000 < cells() <= 2000


def test_a_rod_without_room_for_its_cells_is_refused():
    stub = {"projectile.tip": "A", "projectile.tip_radius": "0.5 mm", "projectile.length": "19 mm"}
    scene = replace_all(load("t5b"), stub)
    with pytest.raises(SceneError, match=r"projectile: cannot be meshed: .*Give a longer rod"):
        build(Case.of(scene))


def test_the_proposed_tip_is_taken():
    scene = replace(load("t5b"), "accuracy.tip_size", "1.6 mm")
    assert [zone.count > 0 for zone in build(Case.of(scene)).zones] == [True, True]
