"""Coulomb friction between rod and barrier."""

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec


def number(bodies: Bodies) -> float:
    """Return the largest f. It matters in an upright impact too: it restrains the spread of the tip."""
    faces = bodies.scene.projectile.faces
    return max(bodies.scene.surface.friction, *(face.surface.friction for face in faces), 0.0)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the Coulomb coefficient."""
    spec.friction = bodies.scene.surface.friction
    spec.friction_over_speed = bodies.friction_over_speed
