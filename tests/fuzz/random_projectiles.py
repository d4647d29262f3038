"""Random projectiles of every shape, with bores and segments, on barriers of every kind, as stated."""

from __future__ import annotations

from typing import Any

import numpy as np
from random_scenes import spread

from fem_impact.scene.library import materials
from fem_impact.scene.read import read_dict
from fem_impact.scene.shapes import NEEDS
from fem_impact.scene.types import Scene

LENGTH, DIAMETER = (0.03, 1.0), (5e-3, 50e-3)  # m
SPEED, ANGLE = (0.2, 20.0), (0.0, 80.0)  # m/s, deg
METALS = tuple(name for name, metal in materials().items() if metal.yield_stress < 1e10)

Tables = dict[str, Any]


def random_own(seed: int, number: int) -> Scene:
    """Return the scene of a number: the same one wherever it is made.

    Raises
    ------
    SceneError
        Where the random sizes make no body.
    """
    random = np.random.default_rng([seed, number, 25])
    f = float(random.uniform(0.0, 1.0))
    return read_dict(
        {
            "id": f"own{seed}-{number}",
            "title": "random projectile",
            "projectile": _projectile(random),
            "barrier": _barrier(random),
            "surface": {
                "state": "custom",
                "friction": f,
                "friction_low": 0.5 * f,
                "friction_high": 1.5 * f,
                "source": "random",
            },
            "impact": _impact(random),
            "save": {"frames": 0},
        }
    )


def _projectile(random: np.random.Generator) -> Tables:
    """Return a shape, in one of two cases with a bore, in one of three with two segments."""
    diameter = spread(random, DIAMETER)
    length = max(spread(random, LENGTH), 2.0 * diameter)
    shape = str(random.choice([*NEEDS, "profile", "profile"]))
    table = (
        _profile(random, length, diameter) if shape == "profile" else _named(random, shape, length, diameter)
    )
    if shape == "ball":
        return table | {"material": str(random.choice(METALS))}
    if random.random() < 0.5:
        ends = sorted(random.uniform(0.3, 1.0, 2)) if random.random() < 0.5 else (0.4, 1.0)
        table["bore"] = [[_mm(length * end), _mm(random.uniform(0.2, 0.7) * diameter / 2)] for end in ends]
    if random.random() < 1 / 3:
        ends = (float(random.uniform(0.2, 0.8)) * length, length)
        return table | {
            "segments": [{"to": _mm(end), "material": str(random.choice(METALS))} for end in ends]
        }
    return table | {"material": str(random.choice(METALS))}


def _named(random: np.random.Generator, shape: str, length: float, diameter: float) -> Tables:
    sizes = {
        "length": _mm(length),
        "diameter": _mm(diameter),
        "edge_radius": _mm(random.uniform(0.05, 0.9) * diameter / 2),
        "nose_radius": _mm(random.uniform(0.1, 0.6) * diameter / 2),
        "face_diameter": _mm(random.uniform(0.1, 0.9) * diameter),
        "cone_angle": f"{random.uniform(15.0, 75.0)} deg",
        "calibre_radius": float(random.uniform(0.6, 4.0)),
    }
    return {"shape": shape} | {key: sizes[key] for key in NEEDS[shape]}


def _profile(random: np.random.Generator, length: float, diameter: float) -> Tables:
    """Return a profile of some points, smooth or piecewise, with a flat or a pointed tip."""
    z = length * np.sort(np.r_[0.0, random.uniform(0.02, 0.98, random.integers(1, 5)), 1.0])
    r = diameter / 2 * random.uniform(0.3, 1.0, len(z))
    r[0] *= random.random() < 0.5
    points = [[_mm(a), _mm(b)] for a, b in zip(z, r, strict=True)]
    return {"profile": points, "profile_smooth": bool(random.random() < 0.5)}


def _barrier(random: np.random.Generator) -> Tables:
    """Return a massive barrier, a backed or a wide plate, a free body or one that moves."""
    kind = str(random.choice(["massive", "massive", "backed", "infinite", "free", "moving"]))
    table: Tables = {"material": str(random.choice(METALS))}
    if kind in ("backed", "infinite"):
        table |= {"thickness": _mm(spread(random, (5e-3, 0.1))), "support": kind}
    if kind == "free":
        table["mass"] = f"{spread(random, (0.2, 100.0))} kg"
    if kind == "moving":
        table["v_n"] = f"{random.uniform(0.1, 3.0)} m/s"
    return table


def _impact(random: np.random.Generator) -> Tables:
    angle = float(random.choice([0.0, *random.uniform(*ANGLE, 4)]))
    return {"angle": f"{angle} deg", "speed": f"{spread(random, SPEED)} m/s"}


def _mm(metres: float) -> str:
    return f"{metres * 1e3} mm"
