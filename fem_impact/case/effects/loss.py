"""Viscous loss of the contact: bodies of rubber, plastic or wood give back less than they take up.

A rod that vibrates loses by the same factor in its modes (see `damping`); here it is what the contact itself
takes, which the closed forms of the rigid and the reduced model know. In finite elements all cells of the
rod are a standard linear solid with that loss factor at the pace of the contact, which damps its modes, too.
"""

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.viscous import viscous_restitution


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
    """Refuse a viscous contact where the fidelity has it not (SceneError).

    Finite elements have viscous cells of a rod of one material that does not yield, on a barrier that is not
    viscous; the reduced model has no contact that is viscous and flows.
    """
    flows, where = bool(spec.rod_law or spec.barrier_law), ""
    if spec.contact_loss is None or fidelity == "rigid":
        return
    if fidelity == "modal":
        where = "a contact that yields in the reduced model" * flows
    elif any(metal.loss_factor for _, metal in bodies.barrier.strata) and bodies.contact.compliant:
        where = "a barrier of finite elements"
    elif spec.rod_law is not None:
        where = "a rod of finite elements that yields"
    elif len(bodies.rod.materials) > 1:
        where = "a rod of several materials of finite elements"
    if not where:
        return
    metals = [*bodies.rod.materials, *(metal for _, metal in bodies.barrier.strata)]
    lossy = {metal.name: metal for metal in metals if metal.loss_factor}
    viscous, other = " and ".join(lossy), " or modal" * (fidelity == "solid" and not flows)
    raise SceneError(
        f"of {viscous} calls for contact-loss, which {where} does not have: an answer without it has e too "
        f"high by about {number(bodies):.2g}.",
        key="loss_factor",
        value=", ".join(f"{metal.loss_factor:g}" for metal in lossy.values()),
        remedy=f'Use fidelity rigid{other}, or add "-contact-loss" to effects.',
    )
