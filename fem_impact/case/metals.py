"""What a scene's materials do not say, and what that leaves out of the model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.effects.heating import thermal
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.physics.hardening import TABOR_STRAIN, rate_gain, rate_law

if TYPE_CHECKING:
    from fem_impact.case.bodies import Bodies
    from fem_impact.scene.material import Material


RATES = (1e2, 1e3, 1e4)  # 1/s, at which flow stresses are told
STEELS = ("rod-steel", "plate-steel", "steel-4340")  # of the pair that the shipped frictions were read for
YIELDS = {"rod": "rod-plasticity", "barrier": "barrier-elastoplastic"}


def flow_stresses(bodies: Bodies) -> dict[str, list[float]]:
    """Return the flow stress, Pa, of each body that yields, at `TABOR_STRAIN`: at rest and at ``RATES``."""
    return {
        body: [float(flow) * (1 + gain) for gain in (0.0, *(rate_gain(metal, rate) for rate in RATES))]
        for body, metal in _metals(bodies).items()
        if YIELDS[body] in bodies.effects
        for flow in [hardening_of(metal).flow_stress(TABOR_STRAIN)]
    }


def unknowns(bodies: Bodies) -> tuple[str, ...]:
    """Return a sentence for each thing that a material does not say and the model would use."""
    under = [("barrier", metal) for _, metal in bodies.barrier.strata[1:]]
    of_metals = [_body(body, metal, bodies) for body, metal in (*_metals(bodies).items(), *under)]
    sentences = (*dict.fromkeys(of_metals), _heat(bodies), _friction(bodies))
    return tuple(sentence for sentence in sentences if sentence)


def _metals(bodies: Bodies) -> dict[str, Material]:
    return {"rod": bodies.contact.rod, "barrier": bodies.contact.barrier}


def _body(body: str, metal: Material, bodies: Bodies) -> str:
    used, effects = body == "rod" or bodies.contact.compliant, bodies.scene.effects
    if used and not metal.yields:
        return (
            f"The {body} ({metal.name}) has no yield stress and stays elastic. A ceramic or a glass cracks "
            "instead of yielding; cracks are not followed, nor the energy that they take."
        )
    rate_wanted = "rate-hardening" in effects or ("auto" in effects and "-rate-hardening" not in effects)
    if YIELDS[body] in bodies.effects and rate_wanted and rate_law(metal) is None:
        return (
            f"The {body} ({metal.name}) has no rate data: its flow stress does not grow with the strain "
            "rate, and no other metal's law takes its place. e may be too low."
        )
    return ""


def _friction(bodies: Bodies) -> str:
    """Return that a shipped friction is that of steel on steel, where a body is of another material."""
    surface = bodies.scene.surface
    others = [metal.name for metal in _metals(bodies).values() if metal.name.split(" (")[0] not in STEELS]
    if not others or "friction" not in bodies.effects or surface.state == "custom":
        return ""
    return (
        f"Friction f = {surface.friction:g} is that of steel on steel; it is not known for "
        f"{' and '.join(dict.fromkeys(others))}. State surface.friction with its source."
    )


def _heat(bodies: Bodies) -> str:
    missing = [key for key, value in thermal(bodies).items() if value is None]
    if not missing or "friction" not in bodies.effects:
        return ""
    return (
        f"The heat of the contact is not known: no material states {' and '.join(missing)}, "
        "nor does [heating] of the scene."
    )
