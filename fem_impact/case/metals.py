"""What a scene's materials say of their flow stress, what they do not say, and what that leaves out."""

import json
from itertools import pairwise
from math import sqrt

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.heating import number as flash_number
from fem_impact.case.effects.heating import thermal
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.case.effects.registry import is_wanted
from fem_impact.case.elastic_only import left_out
from fem_impact.errors import SceneError
from fem_impact.physics.contact import ContactEstimate
from fem_impact.physics.hardening import TABOR_STRAIN, rate_gain, rate_law, tabor_stress
from fem_impact.scene import material as materials
from fem_impact.scene.inputs import first_melting, materials_of, melting
from fem_impact.scene.library import family_of
from fem_impact.scene.material import kind_of
from fem_impact.scene.surface_table import known_pair
from fem_impact.scene.types import Heating, Scene
from fem_impact.scene.units import format_quantity

RATES = (1e2, 1e3, 1e4)  # 1/s, at which flow stresses are told
HOT = 0.3  # expected flash rise over that to ignition; finite elements gave up to 3.3 times the expected rise
NEAR_ROOM = 50.0  # K from 20 degC within which strengths and moduli are those of 20 degC
HEAVY, SOFT = 2500.0, 1e9  # kg/m3, Pa: no usual solid is heavier and softer
HARDEST, MOST_HARDENED = 1200.0, 5.0  # HV, and its flow stress over the yield stress: no usual metal has more
YIELDS = {"rod": "rod-plasticity", "barrier": "barrier-elastoplastic"}


def flow_stresses(bodies: Bodies) -> dict[str, list[float]]:
    """Return the flow stress, Pa, of each body that yields, at `TABOR_STRAIN`: at rest and at ``RATES``."""
    return {
        body: [float(flow) * (1 + gain) for gain in (0.0, *(rate_gain(metal, rate) for rate in RATES))]
        for body, metal in bodies.metals.items()
        if YIELDS[body] in bodies.effects
        for flow in [hardening_of(metal).flow_stress(TABOR_STRAIN)]
    }


def unknowns(bodies: Bodies) -> tuple[str, ...]:
    """Return what materials do not say and the model would use, a sentence each; heat, one number, last."""
    under = [("barrier", metal, depth) for (depth, _), (_, metal) in pairwise(bodies.barrier.strata)]
    touching = [(body, metal, 0.0) for body, metal in bodies.metals.items()]
    of_metals = [_body(*one, bodies) for one in (*touching, *under)]
    stated = materials_of(bodies.scene).items()
    unlikely = [ask(key, metal) for key, metal in stated for ask in (_unlike_solids, _unlike_hardness)]
    ambient = _ambient(bodies.scene.heating)
    sentences = (*unlikely, ambient, *dict.fromkeys(of_metals), _friction(bodies), _heat(bodies))
    return tuple(sentence for sentence in sentences if sentence)


def require_solid(scene: Scene) -> None:
    """Refuse a temperature before the impact at which a body of known melting point melts (SceneError)."""
    ambient, (limit, name) = scene.heating.ambient, first_melting(scene)
    if ambient >= limit:
        problem = f"is not below the temperature at which {name} begins to melt, {limit:g} K."
        raise SceneError(problem, key="heating.ambient", value=f"{ambient:g} K", remedy="Give a lower one.")


def _ambient(heating: Heating) -> str:
    """Return that strengths are those of room temperature where the bodies are much warmer or colder."""
    if abs(heating.ambient - Heating().ambient) <= NEAR_ROOM:
        return ""
    return (
        f"heating.ambient = {heating.ambient:g} K adds to the heat alone: strengths and moduli are used as "
        "stated, those of shipped materials at 20 degC, so that forces, dents and e at that temperature are "
        "not known. State strengths and E of that temperature."
    )


def _body(body: str, metal: materials.Material, depth: float, bodies: Bodies) -> str:
    if not metal.yields and (body == "rod" or bodies.contact.compliant):
        damped = body == "rod" and "material-damping" in bodies.effects
        lost = left_out(metal, "contact-loss" in bodies.effects, damped)
        breaks = _breaking(metal, bodies.estimate, depth)
        return f"The {body} ({metal.name}) has no yield stress and stays elastic. {lost}{breaks}"
    hardens = YIELDS[body] in bodies.effects and is_wanted("rate-hardening", bodies.scene.effects)
    if hardens and rate_law(metal) is None:
        return (
            f"The {body} ({metal.name}) has no rate data: its flow stress does not grow with the strain "
            "rate, and no other metal's law takes its place. e and the force may be too low, dents too deep."
        )
    return ""


def _unlike_solids(key: str, metal: materials.Material) -> str:
    """Return the question whether a unit is right where a body is heavy and soft, or light and stiff.

    Of a body that yields, one that is as light is refused.
    """
    E, rho = format_quantity(metal.E, "stress"), format_quantity(metal.rho, "density")
    if metal.rho > HEAVY and metal.E < SOFT:
        return (
            f"{key}.E = {E} ({metal.name}): is its unit right? Metals, ceramics and stones, as heavy as its "
            f"rho = {rho}, have 10 to 400 GPa; rubbers, woods and plastics, which are as soft, are lighter."
        )
    if metal.E <= materials.STIFFEST and (speed := sqrt(metal.E / metal.rho)) > materials.MOST_SPEED:
        return (
            f"{key}.rho = {rho} ({metal.name}): is its unit right? With E = {metal.E / 1e9:.4g} GPa, "
            f"sqrt(E/rho), the speed of waves, is {speed / 1e3:.3g} km/s; metals, ceramics and stones have 1 "
            f"to {materials.MOST_SPEED / 1e3:g} km/s."
        )
    return ""


def _unlike_hardness(key: str, metal: materials.Material) -> str:
    """Return the question whether a hardness is a number HV where no metal is as hard for its yield stress.

    The ratio is 1.1 to 3.5 of the shipped metals: annealed copper has the most.
    """
    if metal.hardness is None or not metal.yields or kind_of(family_of(metal)) not in ("metal", None):
        return ""
    flow = tabor_stress(metal.hardness)
    if metal.hardness <= HARDEST and flow <= MOST_HARDENED * metal.yield_stress:
        return ""
    return (
        f"{key}.hardness = {metal.hardness:g} ({metal.name}): is it Vickers' number HV, and no MPa? It "
        f"stands for a flow stress of {_MPa(flow)}, {flow / metal.yield_stress:.3g} times the yield stress. "
        "Hardened steel has HV 900, and no shipped metal more than 3.5 times its yield stress."
    )


def _breaking(metal: materials.Material, contact: ContactEstimate, depth: float) -> str:
    """Return what breaks a body: the contact's mean pressure beside the strength of a brittle one.

    A metal or a plastic flows where a round contact presses it with three times its yield stress (Tabor).

    At its edge a round contact pulls the surface with (1 - 2 nu) / 3 of the largest pressure, 3/2 of the
    mean; ``depth`` m under it, beneath layers, p0 / (1 + (z/a)^2) is left of that pressure, taken as in one
    body (Johnson 1985, Contact Mechanics, section 3.4, doi:10.1017/CBO9781139171731).
    """
    kind, pressure, how = kind_of(family_of(metal)), contact.pressure, "in the mean"
    if depth:
        pressure *= 1.5 / (1 + (depth / contact.radius) ** 2)
        how = f"{1e3 * depth:.3g} mm deep"
    presses = f" The contact, estimated, presses it with {_MPa(pressure)} {how}"
    if kind in ("plastic", "metal"):
        flows = "beyond three times its yield stress it flows, and e and the forces told are too high"
        return f"{presses}: {flows}."
    of_edge = kind == "brittle"
    if kind not in ("ground", "brittle") or (of_edge and depth):
        return ""
    stress = 0.5 * (1 - 2 * metal.nu) * pressure if of_edge else pressure
    edge = f", and pulls its surface at the edge with some {_MPa(stress)}" if of_edge else ""
    told = f"{presses}{edge}"
    mode = "tension" if of_edge else "compression"
    if metal.strength is None:
        return f"{told}. State its strength in {mode} to see how far that is beyond it."
    ratio = stress / metal.strength
    means = "it breaks there, and the forces told are too high" if ratio > 1 else "it holds by this estimate"
    return f"{told}, {ratio:.2g} times its strength in {mode}, {_MPa(metal.strength)}: {means}."


def _friction(bodies: Bodies) -> str:
    """Return where a friction comes from that the scene does not state, or is of another pair."""
    surface, metals = bodies.scene.surface, bodies.metals
    if "friction" not in bodies.effects or surface.state == "custom":
        return ""
    low, high = surface.friction_low, surface.friction_high
    if surface.state == "pair":
        return (
            f"No friction is stated: f = {surface.friction:g} is the middle of {low:g} to {high:g} "
            f"({surface.source}). State surface.friction with its source."
        )
    others = [metal.name for metal in metals.values() if "steel" != family_of(metal)]
    if not others:
        return ""
    pair = known_pair(metals["rod"], metals["barrier"])
    known = (
        f' surface.state = "pair" takes {pair.friction_low:g} to {pair.friction_high:g} ({pair.source}).'
        if pair
        else ""
    )
    return (
        f"Friction f = {surface.friction:g} is that of steel on steel, not of "
        f"{' and '.join(dict.fromkeys(others))}. State surface.friction with its source.{known}"
    )


def _heat(bodies: Bodies) -> str:
    """Return what the heat of the contact lacks, or that nothing follows it up to an ignition as stated."""
    heating, effects = bodies.scene.heating, bodies.scene.effects
    missing = [key for key, value in thermal(bodies).items() if value is None]
    if "friction" not in bodies.effects:
        return ""
    if missing:
        own = " and ".join(dict.fromkeys(key.split("_", 1)[1] for key in missing))
        return (
            "The heat of the contact is not known: neither [heating] of the scene states "
            f"{' and '.join(missing)} nor a material its {own}."
        )
    if "contact-heating" not in bodies.effects:
        if heating.ignition == Heating().ignition or "-contact-heating" in effects:
            return ""
        return (
            f"The heat of the contact is not followed: its rise is expected to be {flash_number(bodies):.2g} "
            f"of that to heating.ignition, {format_quantity(heating.ignition, 'temperature')}. With "
            f"effects = {json.dumps([*effects, 'contact-heating'])} finite elements follow it."
        )
    metals, known = bodies.metals, melting(bodies.scene)
    unmelted = [body for body in metals if body not in known]
    if not unmelted or flash_number(bodies) < HOT:
        return ""
    names = " and ".join(dict.fromkeys(metals[body].name for body in unmelted))
    return (
        f"The melting point of {names} is not known: a flash temperature above it is too high. State "
        f"{' and '.join(f'heating.{body}_melting' for body in unmelted)}."
    )


FIRST = "projectile.segments[1].material"  # the only segment that may yield


def laws(bodies: Bodies) -> dict[str, str]:
    """Return the law in force of each material of a scene, by the dotted key of its section."""
    return {
        place: f"{metal.name}: {_law(place, metal, bodies)}"
        for place, metal in materials_of(bodies.scene).items()
    }


def _law(place: str, metal: materials.Material, bodies: Bodies) -> str:
    body = "rod" if place.startswith("projectile") else "barrier"
    later, effects = ".segments[" in place and place != FIRST, bodies.effects
    inner = later or ".mesh_materials." in place
    if body == "barrier" and not bodies.contact.compliant:
        return "rigid, the effect barrier-rigid is on"
    if not metal.yields:
        return "elastic, it states no yield stress"
    if inner or YIELDS[body] not in effects:
        first = "first segment" if later else "material that touches"
        why = f"only the {first} may yield" if inner else f"the effect {YIELDS[body]} is off"
        return f"elastic: {why}"
    rate = _rate(metal.rate) if "rate-hardening" in effects else ", at any strain rate"
    return f"{_curve(metal)}{rate}"


def _curve(metal: materials.Material) -> str:
    """Return the flow curve in words."""
    start = f"yields at {_MPa(metal.yield_stress)},"
    if metal.plastic_modulus is not None:
        linear = f"then hardens by {_MPa(metal.plastic_modulus)} a unit of plastic strain (bilinear)"
        return f"{start} {linear if metal.plastic_modulus else 'perfectly plastic'}"
    match metal.flow:
        case materials.TableFlow(points):
            return f"{start} along a table of {len(points)} points, flat behind {points[-1][0]:g}"
        case materials.RambergOsgoodFlow(n):
            return f"{start} its .2 % proof stress, by Ramberg and Osgood with n {n:g}"
        case materials.JohnsonCookFlow(B, n, m):
            heat = "softened by the heat that stays" if m is not None else "without temperature"
            return f"{start} by Johnson and Cook with B {_MPa(B)}, n {n:g}, {heat}"
    if metal.law == "hardness":
        return f"{start} power law through the flow stress of HV {metal.hardness:g} at 8 %"
    return f"{start} power law through the ultimate stress {_MPa(metal.ultimate_stress)}"


def _rate(rate: materials.Rate | None) -> str:
    if rate is None:
        return ", at any strain rate: no rate data"
    if isinstance(rate, materials.JohnsonCookRate):
        return f", times Johnson and Cook's rate factor with C {rate.C:g}"
    return f", times Cowper and Symonds' rate factor with D {rate.D:g} /s, q {rate.q:g}"


def _MPa(stress: float) -> str:
    return f"{stress / 1e6:.4g} MPa"
