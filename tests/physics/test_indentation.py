"""Vickers' number in closed form, and the layers that meet a measured one."""

from math import pi

import pytest

from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.errors import SceneError
from fem_impact.physics.hardening import KGF_PER_MM2, Hardening, Skin, linear_hardening
from fem_impact.physics.indentation import FACES, FRICTIONS, HardnessTest, share, skin_depth, vickers
from fem_impact.scene.library import material
from fem_impact.scene.shipped import load, replace_all

PLATE, ROD = (material(f"{name}-steel") for name in ("plate", "rod"))


@pytest.mark.parametrize(("of", "numbers"), [(PLATE, (126, 137, 142)), (ROD, (161, 178, 185))])
def test_the_bulk_has_the_numbers_of_the_elements(of, numbers):
    """Those that `verify hardness` presses, with friction 0, 0.1 and 0.2."""
    found = [vickers(of.E, hardening_of(of), f) for f in FRICTIONS]
    assert found == pytest.approx(numbers, rel=0.01)


def test_the_radius_is_that_of_the_load_over_the_pressure():
    test = HardnessTest(163, 30)
    assert test.pressure * pi * test.radius**2 == pytest.approx(30 * 9.80665)
    assert FACES * test.pressure / KGF_PER_MM2 == pytest.approx(163)


@pytest.mark.parametrize("shape", ["even", "exponential"])
@pytest.mark.parametrize(("of", "HV"), [(PLATE, 163), (ROD, 235)])
def test_a_layer_that_follows_from_a_hardness_has_it(of, HV, shape):
    law, test = hardening_of(of), HardnessTest(HV, 30)
    depth = skin_depth(of.E, law, test, 2.0, shape)
    gain = share(law, Skin(depth, 2.0, shape), test.radius)
    assert vickers(of.E, law) * (1 + gain) == pytest.approx(HV)
    assert skin_depth(of.E, law, HardnessTest(HV, 120), 2.0, shape) == pytest.approx(2 * depth)


@pytest.mark.parametrize(
    ("stiffness", "exponent", "skin", "harder"),
    [
        (643.75, 0.1033, Skin(0.496, 2.0), 1.445),
        (643.75, 0.1033, Skin(0.517, 3.0), 1.697),
        (643.75, 0.1033, Skin(0.724, 1.3), 1.226),
        (401.1, 0.0426, Skin(0.496, 2.0), 1.502),
        (1000.0, 0.3, Skin(0.54, 2.0), 1.325),
        (643.75, 0.1033, Skin(0.488, 2.0, "exponential"), 1.417),
        (401.1, 0.0426, Skin(0.273, 2.0, "exponential"), 1.329),
    ],
)
def test_a_layer_makes_the_number_higher_as_in_the_elements(stiffness, exponent, skin, harder):
    """Pressed by `references.axisymmetric`, friction 0.1, at cells of no size; depths over the radius."""
    law = Hardening(1e6, stiffness, exponent)
    assert 1 + (skin.factor - 1) * share(law, skin, 1.0) == pytest.approx(harder, rel=0.025)


def test_a_layer_counts_less_the_thinner_and_the_harder_it_is():
    law = hardening_of(PLATE)
    thin, thick, hard = (share(law, Skin(*of), 0.2e-3) for of in ((5e-5, 2.0), (1e-3, 2.0), (5e-5, 3.0)))
    assert 0 < hard < thin < 0.4 < 0.99 < thick < 1


@pytest.mark.parametrize(
    ("law", "test", "factor", "words"),
    [
        (hardening_of(PLATE), HardnessTest(120, 30), 2.0, "The bulk has HV 137 .* no less than 120"),
        (hardening_of(PLATE), HardnessTest(163, 30), 1.1, "a factor of 1.1 is too low at any depth"),
        (Hardening(50e6, 0.0, 0.0), HardnessTest(163, 30), 2.0, r"E / yield stress 4\.12e\+03"),
        (linear_hardening(320e6, 1e9), HardnessTest(163, 30), 2.0, "hardening exponent of 1 lies outside"),
    ],
)
def test_what_no_layer_or_no_indentation_meets_is_refused(law, test, factor, words):
    with pytest.raises(ValueError, match=words):
        skin_depth(PLATE.E, law, test, factor, "even")


def test_a_scene_takes_the_depth_from_its_hardness_or_is_refused():
    from fem_impact.case.case import Case

    skin = "barrier.material.skin"
    found = Case.of(replace_all(load("t5b"), {skin: {"factor": 2.0, "load": 30}})).slots.barrier_skin
    law = hardening_of(PLATE)
    assert found.depth == skin_depth(PLATE.E, law, HardnessTest(163, 30), 2.0, "even")
    with pytest.raises(SceneError, match=r"skin of plate-steel .*factor 1\.1, load 30 kgf.*hardness SCENE"):
        Case.of(replace_all(load("t5b"), {skin: {"factor": 1.1, "load": 30}}))
