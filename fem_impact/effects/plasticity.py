"""Yielding of the rod's tip (J2, isotropic power-law hardening through yield and ultimate stress)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, ModelSpec

if TYPE_CHECKING:
    from fem_impact.scene import Material, Scene
    from fem_impact.solid.hardening import Hardening


def first_yield_ratio(scene: Scene, material: Material) -> float:
    """Return the elastic peak pressure over that of first yield, 1.6 sigma_y (Johnson 1985, eq 6.9)."""
    from dataclasses import replace

    from fem_impact.estimates import contact_estimate

    names = ("rod-plasticity", "barrier-elastoplastic")
    elastic = tuple("barrier-elastic" if n == names[1] else n for n in scene.effects if n != names[0])
    mean = contact_estimate(replace(scene, effects=elastic)).pressure
    return 1.5 * mean / (1.6 * material.yield_stress)


def hardening_of(material: Material) -> Hardening:
    """Return the hardening law of a material."""
    from fem_impact.solid.hardening import power_hardening

    return power_hardening(material.E, material.yield_stress, material.ultimate_stress)


def number(scene: Scene) -> float:
    """Return the elastic peak pressure over that of first yield in the rod."""
    return first_yield_ratio(scene, scene.projectile.material)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Let the rod's tip yield."""
    spec.rod_law = hardening_of(scene.projectile.material)


EFFECT = Effect(
    "rod-plasticity",
    "The rod's tip yields (J2, hardening through yield and ultimate stress).",
    "The rod stays elastic.",
    "elastic peak pressure over first yield of the rod",
    number,
    fill,
)
