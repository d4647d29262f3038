"""Rate hardening: the flow stress of a metal grows with the strain rate, by the law of its own data.

The law is Johnson and Cook's or Cowper and Symonds' (`fem_impact.scene.material`). A metal without data has
none, and the plan says so; no law of another metal takes its place.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fem_impact.effects.slots import Effect, ModelSpec, bodies_of
from fem_impact.physics.hardening import rate_gain, rate_law, strain_rate

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return the largest relative gain of flow stress, of the bodies that yield, or of both if none does."""
    bodies = bodies_of(scene)
    metals = bodies.yielding or [scene.projectile.material, scene.barrier.material]
    rate = strain_rate(bodies)
    return max(rate_gain(metal, rate) for metal in metals)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Give every material that yields its own rate law."""
    rod, barrier = rate_law(scene.projectile.material), rate_law(scene.barrier.material)
    spec.rod_law = replace(spec.rod_law, rate=rod) if spec.rod_law else None
    spec.barrier_law = replace(spec.barrier_law, rate=barrier) if spec.barrier_law else None


EFFECT = Effect(
    "rate-hardening",
    "Flow stresses grow with the strain rate, by each metal's own law.",
    "Flow stresses do not depend on the strain rate.",
    "gain of the flow stress at the rate 0.4 a/(R tau) of the indentation",
    0.03,
    "e grows like sigma_y^(5/8) (Thornton 1997, doi:10.1115/1.2787319): 2 % of e are 3 % of sigma_y",
    number,
    fill,
    needs=("rod-plasticity", "barrier-elastoplastic"),
)
