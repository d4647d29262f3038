"""Bending waves in a plate that is free underneath: they take energy from the blow and do not come back."""

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.plate import plate_impedance, zener_number


def number(bodies: Bodies) -> float:
    """Return Zener's lambda, 0 for a barrier that does not bend."""
    return zener_number(bodies.contact)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the impedance of the plate; where finite elements mesh it through, the case takes it back.

    Raises
    ------
    SceneError
        If the barrier is no plate that bends.
    """
    if bodies.contact.plate is None:
        raise SceneError(
            'names "plate-bending", but the barrier does not bend.',
            key="effects",
            value=list(bodies.effects),
            remedy='Leave it out, or give barrier.support = "infinite" and barrier.thickness.',
        )
    spec.plate = plate_impedance(*bodies.contact.plate)
