"""What a scene chooses of the numerics: the step and the operator of the cells that cannot yield."""

from dataclasses import replace

import pytest
import solid_scenes as scenes

from fem_impact.effects import specify
from fem_impact.modes import rod_modes
from fem_impact.solid.build import build

BASE = scenes.scene("vibration", "barrier-elastic", length=0.08)


def model(**accuracy):
    scene = replace(BASE, accuracy=replace(BASE.accuracy, **accuracy))
    return build(scene, specify(scene))


def lowest(model):
    n = model.layout.rod_size
    return rod_modes(model.rod_stiffness, model.mass[:n], model.inverse_mass[:n] == 0).omega.min()


def test_the_step_is_the_stated_share_of_the_stable_one():
    half, usual = model(step=0.45), model()
    for body in ("rod", "barrier"):
        assert half.steps[body] == pytest.approx(usual.steps[body] / 2, rel=1e-12)


def test_fully_integrated_cells_are_stiffer_in_bending_than_incompatible_ones():
    soft, full = lowest(model()), lowest(model(element="full"))
    assert 1.005 * soft < full < 1.2 * soft
