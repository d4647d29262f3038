"""What a scene's materials do not say, and what that leaves out of the model."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.physics.flash import thermal
from fem_impact.physics.hardening import TABOR_STRAIN, rate_gain, rate_law

if TYPE_CHECKING:
    from fem_impact.scene.material import Material
    from fem_impact.scene.types import Scene


RATES = (1e2, 1e3, 1e4)  # 1/s, at which flow stresses are told
STEELS = ("rod-steel", "plate-steel", "steel-4340")  # of the pair that the shipped frictions were read for
YIELDS = {"rod": "rod-plasticity", "barrier": "barrier-elastoplastic"}


def bodies(scene: Scene) -> dict[str, Material]:
    """Return the materials of rod and barrier."""
    return {"rod": scene.projectile.material, "barrier": scene.barrier.struck}


def flow_stresses(scene: Scene, active: Collection[str]) -> dict[str, list[float]]:
    """Return the flow stress, Pa, of each body that yields, at `TABOR_STRAIN`: at rest and at ``RATES``."""
    return {
        body: [float(flow) * (1 + gain) for gain in (0.0, *(rate_gain(metal, rate) for rate in RATES))]
        for body, metal in bodies(scene).items()
        if YIELDS[body] in active
        for flow in [hardening_of(metal).flow_stress(TABOR_STRAIN)]
    }


def unknowns(scene: Scene, active: Collection[str]) -> tuple[str, ...]:
    """Return a sentence for each thing that a material does not say and the model would use."""
    under = [("barrier", metal) for _, metal in scene.barrier.strata[1:]]
    metals = [*bodies(scene).items(), *under]
    told = [_body(body, metal, active, _rate_wanted(scene)) for body, metal in metals]
    return tuple(
        sentence
        for sentence in (*dict.fromkeys(told), _heat(scene, active), _friction(scene, active))
        if sentence
    )


def _rate_wanted(scene: Scene) -> bool:
    effects = scene.effects
    return "rate-hardening" in effects or ("auto" in effects and "-rate-hardening" not in effects)


def _body(body: str, metal: Material, active: Collection[str], rate_wanted: bool) -> str:
    used = body == "rod" or "barrier-rigid" not in active
    if used and not metal.yields:
        return (
            f"The {body} ({metal.name}) has no yield stress and stays elastic. A ceramic or a glass cracks "
            "instead of yielding; cracks are not followed, nor the energy that they take."
        )
    if YIELDS[body] in active and rate_wanted and rate_law(metal) is None:
        return (
            f"The {body} ({metal.name}) has no rate data: its flow stress does not grow with the strain "
            "rate, and no other metal's law takes its place. e may be too low."
        )
    return ""


def _friction(scene: Scene, active: Collection[str]) -> str:
    """Return that a shipped friction is that of steel on steel, where a body is of another material."""
    others = [metal.name for metal in bodies(scene).values() if metal.name.split(" (")[0] not in STEELS]
    if not others or "friction" not in active or scene.surface.state == "custom":
        return ""
    return (
        f"Friction f = {scene.surface.friction:g} is that of steel on steel; it is not known for "
        f"{' and '.join(dict.fromkeys(others))}. State surface.friction with its source."
    )


def _heat(scene: Scene, active: Collection[str]) -> str:
    missing = [key for key, value in thermal(scene).items() if value is None]
    if not missing or "friction" not in active:
        return ""
    return (
        f"The heat of the contact is not known: no material states {' and '.join(missing)}, "
        "nor does [heating] of the scene."
    )
