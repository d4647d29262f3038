"""Viscous loss of the contact: bodies of rubber, plastic or wood give back less than they take up.

A rod that vibrates loses by the same factor in its modes (see `damping`); here it is what the contact itself
takes, which the closed forms of the rigid and the reduced model know. Finite elements have no viscous cells.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.effects.slots import Effect, ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.viscous import viscous_restitution

if TYPE_CHECKING:
    from fem_impact.case.bodies import Bodies


def number(bodies: Bodies) -> float:
    """Return what viscosity takes of e in the elastic contact; 0 where no material states a loss factor."""
    return 1 - viscous_restitution(bodies.contact.loss_factor)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the loss factor of the contact.

    Raises
    ------
    SceneError
        If no material states one.
    """
    spec.contact_loss = bodies.contact.loss_factor
    if not spec.contact_loss:
        raise SceneError(
            'names "contact-loss", but no material that gives way states a loss factor.',
            key="effects",
            remedy="Give the loss_factor of a material, or leave the effect out.",
        )


def require_closed_form(bodies: Bodies, spec: ModelSpec, fidelity: str) -> None:
    """Refuse a viscous contact of finite elements, or one that flows in the reduced model (SceneError)."""
    flows = fidelity == "modal" and bool(spec.rod_law or spec.barrier_law)
    if spec.contact_loss is None or not (fidelity == "solid" or flows):
        return
    where = "a contact that yields in the reduced model" if flows else "finite elements"
    raise SceneError(
        f"calls for contact-loss, which {where} do{'es' * flows} not have: an answer without it has e too "
        f"high by about {number(bodies):.2g}.",
        key="loss_factor",
        value=f"{bodies.contact.loss_factor:.3g}",
        remedy="Use --fidelity rigid" + (" or modal" * (not flows)) + ', or add "-contact-loss" to effects.',
    )


EFFECT = Effect(
    "contact-loss",
    "The contact is viscous: it loses what the loss factors of its materials say.",
    "The contact loses nothing by viscosity.",
    "what viscosity takes of e, 1 - e(eta)",
    0.02,
    "Kelvin and Voigt's solid in Hertz' contact; e follows from the loss factor alone (Willert 2020, "
    "doi:10.3389/fmech.2020.00003); 2 % of e",
    number,
    fill,
)
