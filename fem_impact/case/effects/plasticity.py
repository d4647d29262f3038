"""Yielding of the rod's tip (J2, isotropic hardening)."""

from math import atan, inf, pi, sqrt

from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics import hardening
from fem_impact.physics.contact import FLATTEST, LIMIT_PRESSURE, ON_SIDE, ContactPair
from fem_impact.scene.material import Material, RambergOsgoodFlow, TableFlow

DEEP = 1.6  # peak Hertz pressure over yield stress at first yield, below the surface (Johnson 1985, eq 6.9)
WIDE = 2.0  # estimated radii of the contact, under which a layer is told to be thin
HARDEST = 1.0  # plastic strain that no dent of a slender body exceeds by much: the largest seen is .95


def first_yield_ratio(pair: ContactPair, material: Material, other: Material | None) -> float:
    """Return the peak pressure over that of first yield, min(1.6, 1/(sqrt(3) f)) sigma_y.

    The pressure is the elastic one, or the limit pressure of the ``other`` body where that is less and may
    yield; None of one that may not.
    """
    first = min(DEEP, 1 / (sqrt(3) * pair.f)) if pair.f > 0 else DEEP
    return _peak(pair, other) / (first * material.yield_stress)


def buried_yield_ratio(pair: ContactPair, material: Material, depth: float) -> float:
    """Return von Mises' stress over the yield stress of a material under layers, at ``depth``, m.

    Stresses are those of Hertz's contact on a body of the first layer alone (Johnson 1985, eq 3.45).
    """
    z, nu = depth / pair.elastic.estimate.radius, pair.barrier.nu
    across = (1 + nu) * (1 - z * atan(1 / z)) - 0.5 / (1 + z * z)
    stress = abs(1 / (1 + z * z) - across) * _peak(pair, pair.rod if pair.rod_yields else None)
    return stress / material.yield_stress


def _peak(pair: ContactPair, other: Material | None) -> float:
    """Return the peak pressure, Pa, of the elastic contact, or the limit pressure of ``other`` if less."""
    peak = max(1.5 * pair.elastic.estimate.pressure, _on_side(pair))
    if pair.compliant and other is not None:
        peak = min(peak, LIMIT_PRESSURE * strength_of(other))
    return peak


def _on_side(pair: ContactPair) -> float:
    """Return the peak pressure, Pa, of Hertz's line contact of a round side that lands flat, 0 of others.

    The body is rigid on a bed as stiff as a lying cylinder's; p0^2 = F' E* / (pi R) (Johnson 1985, 4.2c).
    """
    radius, length = pair.principal_radii[1], pair.touch.length
    if not length or not pair.angle or radius >= FLATTEST * pair.body.diameter:
        return 0.0
    force = pair.approach * sqrt(pair.effective_mass * ON_SIDE * pair.modulus * length)
    return sqrt(force / length * pair.modulus / (pi * radius))


def strength_of(material: Material) -> float:
    """Return the larger of yield and ultimate stress, Pa, infinite of a material that never yields.

    Without an ultimate stress it is the flow stress at the plastic strain `HARDEST`.
    """
    if not material.yields or material.ultimate_stress < inf:
        return max(material.yield_stress, material.ultimate_stress)
    return float(hardening_of(material).flow_stress(HARDEST))


def hardening_of(material: Material) -> hardening.HardeningLaw:
    """Return the hardening law of a material, by whichever of its values states one.

    Raises
    ------
    SceneError
        If the material never yields, no power law reaches the ultimate stress, or the hardness stands for
        less than the yield stress.
    """
    if not material.yields:
        remedy = "Give it, or leave the effect by which the body yields out of effects."
        raise SceneError("is not stated.", key=f"yield_stress of {material.name}", remedy=remedy)
    if material.plastic_modulus is not None:
        return hardening.linear_hardening(material.yield_stress, material.plastic_modulus)
    if material.flow is not None:
        flow = material.flow
        if isinstance(flow, TableFlow):
            return hardening.TabulatedHardening(flow.points)
        if isinstance(flow, RambergOsgoodFlow):
            return hardening.ramberg_osgood(material.yield_stress, flow.n)
        cold = (material.yield_stress, flow.B, flow.n)
        stated = (material.heat_capacity, flow.m, flow.melting, flow.reference, flow.heat_share)
        if None in stated:
            return hardening.johnson_cook(*cold)
        capacity, m, melting, reference, share = (number for number in stated if number is not None)
        return hardening.johnson_cook(
            *cold, heat=share / (material.rho * capacity), span=melting - reference, m=m
        )
    key, value = "ultimate_stress", f"{material.ultimate_stress / 1e6:g} MPa"
    try:
        if material.law == "hardness" and material.hardness is not None:
            key, value = "hardness", f"{material.hardness:g}"
            return hardening.hardness_hardening(material.E, material.yield_stress, material.hardness)
        return hardening.power_hardening(material.E, material.yield_stress, material.ultimate_stress)
    except ValueError as error:
        instead = "law and hardness" if key == "hardness" else key
        remedy = f"Give one that fits, or in place of {instead} a tangent_modulus, hardening or flow curve."
        raise SceneError(str(error), key=f"{key} of {material.name}", value=value, remedy=remedy) from None


def struck(bodies: Bodies) -> list[Material]:
    """Return the materials of the barrier that the contact presses, those that begin within `WIDE` radii."""
    reach = WIDE * bodies.estimate.radius
    begins = [0.0, *(depth for depth, _ in bodies.barrier.strata)]
    return [metal for z, (_, metal) in zip(begins, bodies.barrier.strata, strict=False) if z <= reach]


def number(bodies: Bodies) -> float:
    """Return the peak pressure over that of first yield in the rod, by the strongest that it strikes."""
    pair = bodies.contact
    limits = struck(bodies) if pair.barrier_yields else [None]
    return max(first_yield_ratio(pair, pair.rod, metal) for metal in limits)


def fill(bodies: Bodies, spec: ModelSpec) -> None:
    """Let the rod's tip yield."""
    spec.rod_law = hardening_of(bodies.contact.rod)
