"""In what a scene differs from the tests that it names, so that it is another impact."""

from dataclasses import fields
from math import hypot, isclose

from fem_impact.scene import library, types

FAR = 0.2
"""Difference from the scene's velocity, over its speed as seen from the barrier, above which a test is told
to be another impact."""
ROD = ("length", "diameter", "tip_radius")


def differing(scene: types.Scene, tested: types.Scene) -> list[str]:
    """Return the keys in which a scene is another impact than the tested one.

    Friction, metals and how the mesh of the barrier is held are the model's side.
    """
    rod, impact, struck = scene.projectile, scene.impact, scene.barrier
    pairs = {f"projectile.{key}": (getattr(rod, key), getattr(tested.projectile, key)) for key in ROD}
    pairs["impact.angle"] = impact.angle, tested.impact.angle
    other = [key for key, (a, b) in pairs.items() if not isclose(a, b, rel_tol=1e-3)]
    other += ["projectile.tip"] if rod.tip != tested.projectile.tip or not rod.is_rod else []
    far = FAR * hypot(tested.impact.v_n, tested.impact.v_t)
    other += [
        f"impact.{key}"
        for key, limit in (("v_n", far), ("v_t", far), ("omega", 0.0))
        if abs(getattr(impact, key) - getattr(tested.impact, key)) > limit
    ]
    other += [
        f"barrier.{part.name}"
        for part in fields(struck)
        if part.name not in ("material", "boundary")
        and getattr(struck, part.name) != getattr(tested.barrier, part.name)
    ]
    named = scene.surface.state in library.surfaces()
    return other + ["surface.state"] * (named and scene.surface.state != tested.surface.state)
