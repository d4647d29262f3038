"""The layer of a freshly cut surface, which cutting has hardened.

Turning and milling strain the metal under the tool; a thin layer is left harder than the bulk. Its depth and
its factor belong to the state of the surface (``skin_depth``, ``skin_factor``). No source with numbers for
carbon steel could be read, so no shipped state has any, and the effect is off unless a scene states both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.effects.slots import Effect, ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.hardening import Skin

if TYPE_CHECKING:
    from fem_impact.case.bodies import Bodies
    from fem_impact.scene.surface import Surface


def layer(surface: Surface) -> Skin | None:
    """Return the hardened layer that a surface states, if any."""
    if surface.skin_depth is None or surface.skin_factor is None:
        return None
    return Skin(surface.skin_depth, surface.skin_factor)


def number(bodies: Bodies) -> float:
    """Return the mean gain of the flow stress within a contact radius of the surface; 0 without a layer."""
    skin = layer(bodies.scene.surface)
    if skin is None:
        return 0.0
    return (skin.factor - 1) * min(skin.depth / bodies.estimate.radius, 1.0)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the layer.

    Raises
    ------
    SceneError
        If the surface states none.
    """
    spec.skin = layer(bodies.scene.surface)
    if spec.skin is None:
        raise SceneError(
            'names "machined-skin", but the surface states no hardened layer.',
            key="effects",
            remedy="Give surface.skin_depth and surface.skin_factor, or leave the effect out.",
        )


EFFECT = Effect(
    "machined-skin",
    "Cells under the freshly cut surfaces are harder than the bulk.",
    "The surfaces are as hard as the bulk.",
    "gain of the flow stress, mean over a contact radius under the surface",
    0.03,
    "e grows like sigma_y^(5/8) (Thornton 1997, doi:10.1115/1.2787319): 2 % of e are 3 % of sigma_y",
    number,
    fill,
    needs=("rod-plasticity", "barrier-elastoplastic"),
    fidelities=("solid",),
)
