"""Scenes on which the reduced model stands beside the finite elements: a Latin hypercube over what varies."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, radians, sin

import numpy as np
from scipy.stats import qmc

from fem_impact.evidence.studies.rods import BODY, length_of
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import Scene
from rigid.slenderness import EXPONENT

SEED = 20260301  # of the hypercube
COUNT = 24
COARSE = {"accuracy.tip_size": "0.6 mm", "accuracy.barrier_size": "0.3 mm", "save.frames": 0}


@dataclass(frozen=True, slots=True)
class Side:
    """One side of the hypercube: what varies evenly from ``low`` to ``high``."""

    name: str
    low: float
    high: float


SIDES = (
    Side("gamma", 10.0, 60.0),
    Side("angle_deg", 15.0, 65.0),
    Side("speed_m_per_s", 1.0, 5.0),
    Side("f", 0.0, 0.7),
    Side("tip_radius_mm", 2.0, 6.0),
    Side("barrier_yield_MPa", 200.0, 500.0),
    Side("barrier_ultimate_over_yield", 1.1, 1.8),
)
Row = dict[str, float]

_NAMES = [side.name for side in SIDES]
# gamma of rods of 100, 200, 60, 160, 100, 220 mm
CALIBRATION: tuple[Row, ...] = tuple(
    dict(zip(_NAMES, (0.001 * length / BODY**EXPONENT, *rest), strict=True))
    for length, *rest in (
        (100.0, 40.0, 1.5, 0.4, 5.0, 320.0, 446 / 320),
        (200.0, 50.0, 2.5, 0.5, 4.0, 320.0, 446 / 320),
        (60.0, 25.0, 3.0, 0.3, 2.0, 320.0, 446 / 320),
        (160.0, 60.0, 2.0, 0.7, 3.0, 320.0, 446 / 320),
        (100.0, 45.0, 2.5, 0.57, 3.0, 250.0, 480 / 250),
        (220.0, 35.0, 1.5, 0.2, 3.0, 400.0, 520 / 400),
    )
)
"""Impacts from which the two constants of `fem_impact.physics.flow_law` were read, with earlier inputs."""


def design(count: int) -> list[Row]:
    """Return the values of ``SIDES`` of each scene; the rod's steel and 19 mm stay as they are."""
    unit = qmc.LatinHypercube(len(SIDES), rng=np.random.default_rng(SEED)).random(count)
    values = qmc.scale(unit, [side.low for side in SIDES], [side.high for side in SIDES])
    return [dict(zip((side.name for side in SIDES), map(float, row), strict=True)) for row in values]


def scene_of(row: Row, name: str) -> Scene:
    """Return a drop without spin as a scene, on elements twice as large as its own."""
    angle, speed, f = radians(row["angle_deg"]), row["speed_m_per_s"], row["f"]
    changes: dict[str, str | int | float] = {
        "projectile.length": f"{length_of(row['gamma'], BODY):.6g} m",
        "projectile.tip_radius": f"{row['tip_radius_mm']:.6g} mm",
        "impact.angle": f"{row['angle_deg']:.6g} deg",
        "impact.v_n": f"{-speed * cos(angle):.6g} m/s",
        "impact.v_t": f"{-speed * sin(angle):.6g} m/s",
        "barrier.material.yield_stress": f"{row['barrier_yield_MPa']:.6g} MPa",
        "barrier.material.ultimate_stress": (
            f"{row['barrier_yield_MPa'] * row['barrier_ultimate_over_yield']:.6g} MPa"
        ),
        "surface.friction": f,
        "surface.friction_low": f,
        "surface.friction_high": f,
    }
    scene = replace_all(load("t5b"), changes | COARSE)
    return replace(scene, id=name, title="Reduced model beside finite elements", measured=None)
