"""Random physical scenes: rods, barriers, surfaces and blows over all that the program is meant for."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, exp, log, radians, sin

import numpy as np

from fem_impact.scene.barrier import Barrier
from fem_impact.scene.impact import Impact
from fem_impact.scene.material import Material, Surface
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.types import Accuracy, Save, Scene

METALS = (
    Material("aluminium", 70e9, 0.33, 2700.0, 270e6, 310e6),
    Material("titanium", 114e9, 0.34, 4430.0, 880e6, 950e6),
    Material("copper", 120e9, 0.34, 8960.0, 120e6, 220e6),
    Material("mild steel", 210e9, 0.29, 7850.0, 350e6, 520e6),
    Material("hard steel", 210e9, 0.29, 7850.0, 1500e6, 1800e6),
    Material("tungsten", 400e9, 0.28, 19250.0, 750e6, 980e6),
)
LENGTH, DIAMETER = (20e-3, 2.0), (5e-3, 60e-3)  # m
SPEED, ANGLE, FRICTION = (0.01, 50.0), (0.0, 88.0), (0.0, 2.0)  # m/s, deg, -
FASTEST = 1e4  # rad/s, the largest spin that a scene may state
TIPS = ("A", "B", "plain")
EFFECTS = (
    ("auto",),
    ("auto", "gravity"),
    ("vibration", "friction", "barrier-rigid"),
    ("vibration", "friction", "barrier-elastic"),
    ("vibration", "friction", "barrier-elastic", "gravity"),
    ("vibration", "friction", "barrier-elastoplastic"),
    ("vibration", "friction", "rod-plasticity", "barrier-rigid"),
    ("vibration", "friction", "rod-plasticity", "barrier-elastoplastic"),
    ("friction", "barrier-rigid"),
)


def random_rod(random: np.random.Generator) -> ProjectileSpec:
    """Return a rod of any length, diameter, tip and metal, at least 1.05 diameters long."""
    diameter = spread(random, DIAMETER)
    length = max(spread(random, LENGTH), 1.05 * diameter)
    tip = str(random.choice(TIPS))
    radius = 0.0 if tip == "plain" else float(random.uniform(0.05, 1.0)) * diameter / 2
    return ProjectileSpec(length, diameter, tip, radius, _metal(random))


def random_scene(
    seed: int, number: int, rod_of: Callable[[np.random.Generator], ProjectileSpec] = random_rod
) -> Scene:
    """Return the scene of a number: the same one wherever it is made.

    A third of the scenes has no friction, half no spin, three of ten fall beside their axis.
    """
    random = np.random.default_rng([seed, number])
    rod = rod_of(random)
    f = float(random.choice([0.0, random.uniform(*FRICTION), random.uniform(0.0, 1.0)]))
    speed = spread(random, SPEED)
    angle = radians(random.choice([0.0, random.uniform(0.0, 10.0), *random.uniform(*ANGLE, 3)]))
    fall = angle if random.random() < 0.7 else float(random.uniform(0.0, 1.2))
    spin = 0.0 if random.random() < 0.5 else float(random.normal()) * 3 * speed / rod.length
    omega = min(max(spin, -FASTEST), FASTEST)
    return Scene(
        id=f"s{seed}-{number}",
        title="random",
        projectile=rod,
        barrier=Barrier(_metal(random)),
        surface=Surface("custom", f, f, f, "random"),
        impact=Impact(float(angle), -speed * cos(fall), -speed * sin(fall), omega),
        effects=EFFECTS[random.integers(len(EFFECTS))],
        accuracy=Accuracy(tip_size=min(0.35e-3, rod.diameter / 4)),
        save=Save(frames=0),
    )


def one_of(rods: list[ProjectileSpec]) -> Callable[[np.random.Generator], ProjectileSpec]:
    """Return a choice among a few rods, whose modes then are computed once."""
    return lambda random: rods[random.integers(len(rods))]


def spread(random: np.random.Generator, ends: tuple[float, float]) -> float:
    """Return a number between two ends, as often in each decade."""
    return exp(random.uniform(log(ends[0]), log(ends[1])))


def _metal(random: np.random.Generator) -> Material:
    return METALS[random.integers(len(METALS))]
