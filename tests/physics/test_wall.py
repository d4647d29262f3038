"""Ovalling of hollow projectiles, beside the ring of theory and the modes of a mesh."""

import math

import pytest

from fem_impact.answers.verdict.screening import screening
from fem_impact.case.case import Case
from fem_impact.case.effects.vibration import number
from fem_impact.fem.eigen import rod_modes
from fem_impact.physics.beam import bending_period, ovalling_period
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build

RING = {"length": "60 mm", "diameter": "60 mm", "tip_radius": "3 mm"}


def ring(bore="24 mm", **changes):
    """Return a short wide tube, which ovals more slowly than it bends."""
    size = {**RING, "bore": [["0 mm", bore], ["60 mm", bore]], **changes}
    return replace_all(load("tube"), {f"projectile.{key}": value for key, value in size.items()})


def test_a_ring_of_constant_wall_ovals_as_in_theory():
    rod = ring("27 mm", tip="plain", tip_radius="0 mm").projectile
    h, R, steel = 3e-3, 28.5e-3, rod.material
    D = steel.E * h**3 / (12 * (1 - steel.nu**2))
    omega = math.sqrt(36 / 5 * D / (steel.rho * h * R**4))
    assert ovalling_period(rod) == pytest.approx(2 * math.pi / omega, rel=1e-9)


def test_solid_bodies_do_not_oval():
    assert ovalling_period(load("t5b").projectile) == ovalling_period(load("ogive").projectile) == 0.0


def slowest(scene):
    """Return the two longest periods of the projectile's mesh, s."""
    model = build(Case.of(scene))
    n = model.layout.rod_size
    modes = rod_modes(model.rod_stiffness, model.mass[:n], model.inverse_mass[:n] == 0, count=2)
    return 1 / modes.frequency[:2]


def test_the_modes_of_a_mesh_begin_with_it():
    lowest, longest = slowest(ring())
    assert longest < ovalling_period(ring().projectile) < 1.1 * lowest
    assert bending_period(ring().projectile) < 0.3 * lowest


@pytest.mark.long
@pytest.mark.parametrize("bore", ["22.5 mm", pytest.param("24 mm", marks=pytest.mark.slow)])
def test_a_thin_wall_has_the_cells_that_its_ovalling_needs(bore):
    finer, few = (slowest(replace_all(ring(bore), {"accuracy.across": n}))[0] for n in (24, 8))
    assert slowest(ring(bore))[0] == pytest.approx(finer, rel=0.01)
    assert few < 0.96 * finer


def test_only_a_thin_wall_has_more_cells_unless_they_are_stated():
    assert [ring(bore).across for bore in ("22.4 mm", "22.6 mm")] == [8, 16]
    assert load("tube").across == load("t5b").across == 8
    assert replace_all(ring("25 mm"), {"accuracy.across": 10}).across == 10
    assert (
        replace_all(ring("25 mm"), {"projectile.bore": [["0 mm", "12 mm"], ["60 mm", "12 mm"]]}).across == 8
    )


def test_it_counts_for_the_effect_of_vibration_and_is_told():
    scene, slender = ring(), load("tube")
    share = ovalling_period(scene.projectile) / screening(Case(scene).bodies).duration
    assert number(Case(scene).bodies) == pytest.approx(share)
    assert "ovals more slowly than the body bends" in screening(Case(scene).bodies).sentence
    assert "ovals" not in screening(Case(slender).bodies).sentence


@pytest.mark.parametrize(("bore", "share"), [("24 mm", 0.065), ("20 mm", 0.011)])
def test_the_reduced_model_has_the_ovalling_in_its_modes(bore, share):
    """Finite elements gave these shares, and .074 and .012 with 8 cells over the diameter; this has .091."""
    energy = simulate(replace_all(ring(bore), {"accuracy.across": 16}), "modal").energy
    assert energy.vibration == pytest.approx(share, rel=0.45)
