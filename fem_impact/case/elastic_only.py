"""What an elastic answer leaves out of a material that states no yield stress, and when it must be named."""

from fem_impact.case.effects.registry import AUTO
from fem_impact.errors import SceneError
from fem_impact.scene.library import family_of
from fem_impact.scene.material import Material, kind_of
from fem_impact.scene.types import Scene

UPPER = "so that e is an upper bound"
LEFT_OUT = {
    "metal": f"A metal flows: that work is left out, {UPPER}. State yield_stress and how it hardens.",
    "brittle": "A ceramic or a glass cracks instead of yielding; cracks are not followed, nor the energy "
    "that they take.",
    "ground": f"Concrete, rock and soil are crushed and crack; neither is followed, {UPPER}.",
    "plastic": "A plastic is viscous, and flows where it is pressed hard.",
    "rubber": "Rubber does not crack: it is viscous, and its stiffness changes with strain and rate.",
    "wood": "Wood is viscous, and another material along the grain than across; here it is the same in all "
    "directions.",
}
SOFT = (1e8, 2e10)  # Pa: E up to which a body is as soft as a rubber, or as a plastic or a wood
UNSORTED = (
    "A body so soft is viscous, as rubbers and foams are, and does not crack.",
    "So soft are plastics, woods and weak concretes: they are viscous, or are crushed.",
    "Its family is unknown: a metal flows, a ceramic, a glass, a rock or a concrete cracks. Neither is "
    f"followed, nor the energy that it takes, {UPPER}. State its family.",
)
VISCOUS = ("plastic", "rubber", "wood")
NOT_TAKEN = f" What it loses inside is left out, {UPPER}."
DAMPED = (
    " Its loss_factor damps its vibration, by finite elements alone. What its contact loses is left out, "
    f"{UPPER}."
)
NOT_STATED = NOT_TAKEN + " State loss_factor, which says it."
TAKEN = " Its loss_factor says what it loses inside; nothing else of this is followed."
CRUSHED = (
    "crushes and cracks under a contact, and no law of that is known here. An elastic answer leaves out "
    f"crushing, cracks and spall with the energy that they take, {UPPER} and forces are too high."
)


def left_out(material: Material, taken: bool = False, damped: bool = False) -> str:
    """Return what an elastic answer leaves out of a material, by its family, or by how soft it is.

    `taken` says whether the contact takes the material's loss factor, `damped` whether the vibration does.
    """
    kind = kind_of(family_of(material))
    nature = LEFT_OUT[kind] if kind else UNSORTED[sum(material.E > limit for limit in SOFT)]
    if not (kind in VISCOUS or nature in UNSORTED[:2]):
        return nature
    if material.loss_factor is None:
        return nature + NOT_STATED
    return nature + (TAKEN if taken else DAMPED if damped else NOT_TAKEN)


def require_crushing_named(scene: Scene) -> None:
    """Refuse concrete, rock and soil without a law where the scene does not name the elastic answer.

    Raises
    ------
    SceneError
        A body is of such a family, has no yield stress, and `auto` would choose that it is elastic.
    """
    effects, rod = scene.effects, scene.projectile
    named = AUTO not in effects or any(name in effects for name in ("barrier-elastic", "barrier-rigid"))
    for _, material in scene.barrier.strata:
        _refuse_crushed("barrier", material, named, '"barrier-elastic"')
    for material in rod.materials:
        elastic = AUTO not in effects or "-rod-plasticity" in effects
        _refuse_crushed("projectile", material, elastic, '"-rod-plasticity"')


def _refuse_crushed(section: str, material: Material, named: bool, effect: str) -> None:
    if kind_of(family_of(material)) == "ground" and not material.yields and not named:
        remedy = f"Add {effect} to effects for that answer, or state the yield_stress of a law of your own."
        raise SceneError(CRUSHED, key=f"{section}.material", value=material.name, remedy=remedy)
