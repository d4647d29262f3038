"""What a scene chooses of the numerics: the step and the operator of the cells that cannot yield."""

import tracemalloc
from dataclasses import replace

import pytest
import solid_scenes as scenes

from fem_impact.fem.eigen import rod_modes
from fem_impact.plan.plan import plan
from fem_impact.scene.shipped import load
from fem_impact.solid.build import build

BASE = scenes.scene("vibration", "barrier-elastic", length=0.08)


def model(**accuracy):
    scene = replace(BASE, accuracy=replace(BASE.accuracy, **accuracy))
    return build(plan(scene))


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


def test_building_takes_little_memory():
    """Element matrices alone, if all were kept at once, would take 4.6 kB an element."""
    scene = load("t5b")
    build(plan(scene))  # the first one also loads the compiled kernels
    tracemalloc.start()
    try:
        built = build(plan(scene))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    elements = len(built.geometry.rod.mesh.cells) + len(built.geometry.barrier.cells)
    assert peak < 25e6 + 4.5e3 * elements
