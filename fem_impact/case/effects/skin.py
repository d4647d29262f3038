"""The layer at the surface of a body that machining has hardened.

Turning and milling strain the metal under the tool; a thin layer is left harder than the bulk. Its factor
and depth belong to the material that touches (``skin``). No source with numbers for carbon steel could be
read, so no shipped material has any; a hardness leaves a curve of them (`fem_impact.physics.indentation`).
"""

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.hardening import Skin
from fem_impact.physics.indentation import HardnessTest, skin_depth
from fem_impact.scene.inputs import materials_of
from fem_impact.scene.material import Material


def skin_of(metal: Material) -> Skin | None:
    """Return the hardened layer of a material, None of one that states none.

    Raises
    ------
    SceneError
        If no depth meets the hardness, or the bulk has a flow curve that the indentations do not cover.
    """
    spec = metal.skin
    if spec is None:
        return None
    if spec.depth is not None:
        return Skin(spec.depth, spec.factor, spec.shape)
    assert metal.hardness is not None and spec.load is not None, "the material refuses a load without these"
    try:
        test = HardnessTest(metal.hardness, spec.load)
        depth = skin_depth(metal.E, hardening_of(metal), test, spec.factor, spec.shape)
    except ValueError as error:
        raise SceneError(
            str(error),
            key=f"skin of {metal.name}",
            value=f"factor {spec.factor:g}, load {spec.load:g} kgf",
            remedy="`fem-impact hardness SCENE` prints the factors that can; or give skin.depth.",
        ) from None
    return Skin(depth, spec.factor, spec.shape)


def number(bodies: Bodies) -> float:
    """Return the mean gain of the flow stress within a contact radius of the surface, of the harder layer."""
    skins = [skin_of(metal) for metal in (bodies.contact.rod, bodies.contact.barrier)]
    radius = bodies.estimate.radius
    return max((float(skin.mean(0.0, radius)) - 1 for skin in skins if skin), default=0.0)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Set the layers.

    Raises
    ------
    SceneError
        If no material that touches states one.
    """
    spec.rod_skin, spec.barrier_skin = skin_of(bodies.contact.rod), skin_of(bodies.contact.barrier)
    if not (spec.rod_skin or spec.barrier_skin):
        raise SceneError(
            'names "machined-skin", but no material that touches states a skin.',
            key="effects",
            remedy="Give projectile.material.skin or barrier.material.skin, or leave the effect out.",
        )


NOT_RIGID = "The hardened layer does not enter: rigid theory takes the restitution as a number."


def require_skins(bodies: Bodies, fidelity: str) -> None:
    """Refuse a hardened layer where nothing touches it, and in the reduced model (SceneError)."""
    for place, metal in materials_of(bodies.scene).items():
        if metal.skin and metal not in (bodies.contact.rod, bodies.contact.barrier):
            problem = "is that of a material which does not touch."
            raise SceneError(problem, key=f"{place}.skin", remedy="Leave it out.")
    if fidelity == "modal" and "machined-skin" in bodies.effects:
        raise SceneError(
            "holds machined-skin, which the reduced model does not compute: its contact has one flow curve.",
            key="effects",
            remedy='Use fidelity solid, or add "-machined-skin" to effects.',
        )
