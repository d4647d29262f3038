"""Heating of the contact by friction, computed from the motion without acting on it."""

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.flash import Half, Halves, expected_rise


def thermal(bodies: Bodies) -> dict[str, float | None]:
    """Return conductivity and heat capacity of both bodies by the key of [heating] that overrides them."""
    of_metals = {
        f"{body}_{key}": getattr(metal, key)
        for body, metal in bodies.metals.items()
        for key in ("conductivity", "heat_capacity")
    }
    of_scene = {key: getattr(bodies.scene.heating, key) for key in of_metals}
    return {key: of_metals[key] if value is None else value for key, value in of_scene.items()}


def halves(bodies: Bodies) -> Halves:
    """Return the thermal half-spaces of rod and barrier.

    Raises
    ------
    SceneError
        If neither the material nor [heating] states a property.
    """
    values = thermal(bodies)
    if missing := [key for key, value in values.items() if value is None]:
        forced = ", or leave contact-heating out of effects" * ("contact-heating" in bodies.scene.effects)
        problem = "is not known: the material states none."
        wanted = (f"{key}, {'J/(kg K)' if key.endswith('capacity') else 'W/(m K)'}" for key in missing)
        remedy = f"State {' and '.join(wanted)}, in [heating]{forced}."
        raise SceneError(problem, key=f"heating.{missing[0]}", remedy=remedy)
    known = {key: value for key, value in values.items() if value is not None}
    rod, barrier = bodies.contact.rod, bodies.contact.barrier
    return (
        Half(known["rod_conductivity"], rod.rho * known["rod_heat_capacity"]),
        Half(known["barrier_conductivity"], barrier.rho * known["barrier_heat_capacity"]),
    )


def why_off(bodies: Bodies) -> str:
    """Return why the heat of a contact is not followed, and what turns it on."""
    if "friction" not in bodies.effects:
        return "the friction effect is off, so that nothing rubs"
    missing = [f"heating.{key}" for key, value in thermal(bodies).items() if value is None]
    if missing:
        return f"state {', '.join(missing)}"
    return 'the contact-heating effect is off: effects = ["auto", "contact-heating"] turns it on'


def number(bodies: Bodies) -> float:
    """Return the expected flash temperature rise over the rise to ignition, 0 where it is not known."""
    heating = bodies.scene.heating
    if None in thermal(bodies).values():
        return 0.0
    rise = expected_rise(bodies.contact, bodies.friction, halves(bodies))
    return rise / (heating.ignition - heating.ambient)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Turn on the record of the contact's heat; refuse a scene without conductivity and heat capacity."""
    halves(bodies)
    spec.heat = True
