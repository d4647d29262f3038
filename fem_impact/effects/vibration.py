"""Elastic vibration of the rod: waves and bending."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, ModelSpec
from fem_impact.estimates import contact_estimate

if TYPE_CHECKING:
    from fem_impact.scene import Scene


def bending_period(scene: Scene) -> float:
    """Return the first free-free bending period, s (Euler-Bernoulli: (beta l)^2 = 22.373)."""
    rod = scene.projectile
    c0 = (rod.material.E / rod.material.rho) ** 0.5
    return float(2 * pi * rod.length**2 / (22.373 * c0 * rod.diameter / 4))


def number(scene: Scene) -> float:
    """Return the first bending period over the contact time."""
    return bending_period(scene) / contact_estimate(scene).duration


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Need no slot: the elastic rod is the model's base."""


EFFECT = Effect(
    "vibration",
    "The rod is elastic: longitudinal and bending waves take energy that rigid theory cannot see.",
    "The rod is rigid but for its contact.",
    "T1/tau, first bending period over contact time",
    number,
    fill,
)
