"""Say where a scene leaves what was measured, so that nobody reads a prediction as a comparison."""

from __future__ import annotations

import math

from fem_impact.scene import library
from fem_impact.scene.types import Scene
from fem_impact.scene.units import format_quantity

__all__ = ["validity"]

# Smallest and largest of the 13 measured sets (Tables 2 to 6 of the paper), SI units.
LENGTHS = (0.08, 0.24)
DIAMETER = 0.019
SPEEDS = (1.30, 6.10)
ANGLES = (math.radians(17.0), math.radians(60.0))
TIPS = {("A", 0.007), ("B", 0.003)}


def validity(scene: Scene) -> tuple[str, ...]:
    """Return one sentence for each way in which the scene lies outside the measured range."""
    sentences = (_length(scene), _section(scene), _speed(scene), _angle(scene), _spin(scene))
    more = (_steels(scene), _surface(scene), _idealised(scene))
    return tuple(sentence for sentence in (*sentences, *more) if sentence)


def _outside(value: float, ends: tuple[float, float], words: str, dimension: str) -> str:
    low, high = (format_quantity(end, dimension) for end in ends)
    slack = 1e-9 * abs(ends[1])
    if ends[0] - slack <= value <= ends[1] + slack:
        return ""
    stated = format_quantity(value, dimension)
    return f"outside the measured range: {words} {stated}, measured {low} to {high}"


def _length(scene: Scene) -> str:
    return _outside(scene.projectile.length, LENGTHS, "length", "length")


def _section(scene: Scene) -> str:
    rod = scene.projectile
    if math.isclose(rod.diameter, DIAMETER) and any(
        rod.tip == tip and math.isclose(rod.tip_radius, radius) for tip, radius in TIPS
    ):
        return ""
    return "outside the measured range: measured were 19 mm rods with a 7 mm nose (A) or a 3 mm edge (B)"


def _speed(scene: Scene) -> str:
    speed = round(math.hypot(scene.impact.v_n, scene.impact.v_t), 3)
    return _outside(speed, SPEEDS, "speed", "speed")


def _angle(scene: Scene) -> str:
    return _outside(scene.impact.angle, ANGLES, "angle", "angle")


def _spin(scene: Scene) -> str:
    return (
        "outside the measured range: the measured rods did not turn before impact"
        if scene.impact.omega
        else ""
    )


def _steels(scene: Scene) -> str:
    known = library.materials()
    same = scene.projectile.material == known["rod-steel"] and scene.barrier.material == known["plate-steel"]
    return "" if same else "outside the measured range: other materials than the measured steels"


def _surface(scene: Scene) -> str:
    known = library.surfaces().values()
    if "friction" not in scene.active or scene.surface in known:
        return ""
    f, source = scene.surface.friction, scene.surface.source
    return f"friction f = {f:g} is not the committed value of a surface state ({source})"


def _idealised(scene: Scene) -> str:
    real = ("friction", "rod-plasticity", "barrier-elastoplastic")
    missing = [name for name in real if name not in scene.active]
    return f"idealised: without {', '.join(missing)}; no test corresponds to it" if missing else ""
