"""The laws in force: how the flow stress of each material of a scene grows, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem_impact.case.metals import YIELDS
from fem_impact.scene.flow import JohnsonCookFlow, RambergOsgoodFlow, TableFlow
from fem_impact.scene.inputs import materials_of
from fem_impact.scene.material import JohnsonCookRate

if TYPE_CHECKING:
    from fem_impact.case.bodies import Bodies
    from fem_impact.scene.flow import Flow
    from fem_impact.scene.material import Material, Rate

FIRST = "projectile.segments[1].material"  # the only segment that may yield


def laws(bodies: Bodies) -> dict[str, str]:
    """Return the law in force of each material of a scene, by the dotted key of its section."""
    return {
        place: f"{metal.name}: {_law(place, metal, bodies)}"
        for place, metal in materials_of(bodies.scene).items()
    }


def _law(place: str, metal: Material, bodies: Bodies) -> str:
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


def _curve(metal: Material) -> str:
    """Return the flow curve in words."""
    start = f"yields at {_MPa(metal.yield_stress)}"
    if metal.plastic_modulus is not None:
        linear = f"then hardens by {_MPa(metal.plastic_modulus)} a unit of plastic strain (bilinear)"
        return f"{start}, {linear if metal.plastic_modulus else 'perfectly plastic'}"
    if metal.flow is not None:
        return f"{start}, {_flow(metal.flow)}"
    if metal.law == "hardness":
        return f"{start}, power law through the flow stress of HV {metal.hardness:g} at 8 %"
    return f"{start}, power law through the ultimate stress {_MPa(metal.ultimate_stress)}"


def _flow(flow: Flow) -> str:
    if isinstance(flow, TableFlow):
        return f"along a table of {len(flow.points)} points, flat behind {flow.points[-1][0]:g}"
    if isinstance(flow, RambergOsgoodFlow):
        return f"its .2 % proof stress, by Ramberg and Osgood with n {flow.n:g}"
    assert isinstance(flow, JohnsonCookFlow)
    heat = ", softened by the heat that stays" if flow.m is not None else ", without temperature"
    return f"by Johnson and Cook with B {_MPa(flow.B)}, n {flow.n:g}{heat}"


def _rate(rate: Rate | None) -> str:
    if rate is None:
        return ", at any strain rate: no rate data"
    if isinstance(rate, JohnsonCookRate):
        return f", times Johnson and Cook's rate factor with C {rate.C:g}"
    return f", times Cowper and Symonds' rate factor with D {rate.D:g} /s, q {rate.q:g}"


def _MPa(stress: float) -> str:
    return f"{stress / 1e6:.4g} MPa"
