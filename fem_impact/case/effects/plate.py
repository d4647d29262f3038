"""Bending waves in a plate that is free underneath: they take energy from the blow and do not come back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.effects.slots import Effect, Harm, ModelSpec, bodies_of, quick_impact
from fem_impact.errors import SceneError
from fem_impact.physics.plate import LOSS, impedance_of, zener_number

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def number(scene: Scene) -> float:
    """Return Zener's lambda, 0 for a barrier that does not bend."""
    return zener_number(bodies_of(scene))


def harm(scene: Scene) -> Harm:
    """Return the loss of e by bending waves; E_vib changes like the square of the impulse."""
    lost = min(LOSS * number(scene), 1.0)
    return Harm(lost, lost * quick_impact(scene).E_vib)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Set the impedance of the plate; where finite elements mesh it through, the plan takes it back.

    Raises
    ------
    SceneError
        If the barrier is no plate that bends.
    """
    if not scene.barrier.bends:
        raise SceneError(
            'names "plate-bending", but the barrier does not bend.',
            key="effects",
            value=list(scene.effects),
            remedy='Leave it out, or give barrier.support = "infinite" and barrier.thickness.',
        )
    spec.plate = impedance_of(scene)


EFFECT = Effect(
    "plate-bending",
    "The plate gives way as a whole, by F / (8 sqrt(D rho h)) or, where finite elements mesh it through, by "
    "itself; bending waves run away in it.",
    "The barrier does not bend.",
    "Zener's lambda, m / (8 sqrt(D rho h) T)",
    0.006,
    "1 - e = 1.73 lambda for a small lambda (Zener 1941, doi:10.1103/PhysRev.59.669): 1 % of e, half of the "
    "2 % that it may be off",
    number,
    fill,
    harm,
)
