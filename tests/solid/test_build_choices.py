"""What a scene chooses of the model: step, elements, faces of the block, hardening."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
import solid_scenes as scenes

from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.fem.eigen import rod_modes
from fem_impact.scene.shipped import load
from fem_impact.solid.build import build
from meshes import OUTER

BASE = scenes.scene("vibration", "barrier-elastic", length=0.08)


def model(**accuracy):
    scene = replace(BASE, accuracy=replace(BASE.accuracy, **accuracy))
    return build(Case.of(scene))


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


def test_cells_that_yield_may_be_fully_integrated():
    scene = scenes.scene("vibration", "rod-plasticity", "barrier-rigid", length=0.08)
    accuracy = replace(scene.accuracy, yielding_element="full")
    plain, full = build(Case.of(scene)), build(Case.of(replace(scene, accuracy=accuracy)))
    assert [zone.full for zone in (*plain.zones, *full.zones)] == [False, True]
    assert full.steps["rod"] <= plain.steps["rod"]


def faces_inverse(model):
    """Return the inverse masses of the nodes on the block's outer faces."""
    return model.inverse_mass[model.layout.barrier[np.unique(model.geometry.barrier.faces_with(OUTER))]]


def test_faces_of_a_block_are_held_where_the_scene_says_so():
    fixed = replace(BASE, barrier=replace(BASE.barrier, boundary="fixed"))
    around, held = build(Case.of(BASE)), build(Case.of(fixed))
    assert (faces_inverse(around) > 0.0).mean() > 0.5
    assert faces_inverse(held).max() == 0.0
    free = np.count_nonzero(around.inverse_mass) - np.count_nonzero(faces_inverse(around))
    assert np.count_nonzero(held.inverse_mass) == free


def test_faces_that_are_held_let_no_waves_out():
    effects = ("vibration", "barrier-elastic", "radiation")
    fast = replace(BASE, impact=replace(BASE.impact, v_n=-6.0), effects=effects)
    fixed = replace(fast, barrier=replace(fast.barrier, boundary="fixed"))
    with pytest.raises(SceneError, match="lets no waves out"):
        Case.of(fixed)
    assert "radiation" in Case.of(replace(fast, effects=("auto",))).active
    assert "radiation" not in Case.of(replace(fixed, effects=("auto",))).active


def test_hardening_is_linear_where_its_modulus_is_stated():
    rod = replace(BASE.projectile.material, name="linear", hardening=2e9)
    scene = replace(
        BASE, projectile=replace(BASE.projectile, material=rod), effects=("rod-plasticity", "barrier-rigid")
    )
    law = Case.of(scene).slots.rod_law
    assert law.flow_stress(0.1) == pytest.approx(rod.yield_stress + 2e8)


@pytest.mark.long
def test_building_takes_little_memory():
    """Element matrices alone, if all were kept at once, would take 4.6 kB an element."""
    scene = load("t5b")
    build(Case.of(scene))  # the first one also loads the compiled kernels
    tracemalloc.start()
    try:
        built = build(Case.of(scene))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    elements = len(built.geometry.rod.mesh.cells) + len(built.geometry.barrier.cells)
    assert peak < 25e6 + 4.5e3 * elements
