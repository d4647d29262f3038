"""What a body is made of: family, constants, strengths, flow curve, law of the rate; its surface's state."""

import re
from dataclasses import dataclass
from itertools import pairwise
from math import inf, sqrt
from typing import ClassVar, Literal, NamedTuple, get_args

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.sliding import SlidingLaw
from fem_impact.scene.units import data_tables

Kind = Literal["metal", "brittle", "ground", "plastic", "rubber", "wood"]


class Family(NamedTuple):
    """What its materials do beyond elasticity, wider families that hold it, and words of their names."""

    kind: Kind
    wider: tuple[str, ...]
    words: tuple[str, ...]


FAMILIES: dict[str, Family] = {
    name: Family(one["kind"], tuple(one["wider"]), tuple(one["words"]))
    for name, one in data_tables("families.toml").items()
}


def families_by_words(name: str) -> tuple[str, ...]:
    """Return the families whose words stand in the name of a material, in the order of their last words."""
    parts = re.findall(r"[a-z]+\d*[a-z]*|\d+[a-z]*", name.lower())
    places = {
        family: max(at for at, part in enumerate(parts) if part in of.words)
        for family, of in FAMILIES.items()
        if set(parts) & set(of.words)
    }
    return tuple(sorted(places, key=places.__getitem__))


def family_by_words(name: str) -> str:
    """Return the family that the words of a name tell, empty where none does or several of different kinds.

    The narrower of two comes first, as in stainless steel, else the last, as in aluminium bronze.
    """
    found = families_by_words(name)
    if len({kind_of(family) for family in found}) > 1:
        return ""
    wider = {one for family in found for one in FAMILIES[family].wider}
    return next((family for family in reversed(found) if family not in wider), "")


def kind_of(family: str) -> Kind | None:
    """Return the kind of a family, None of no family."""
    return FAMILIES[family].kind if family else None


def widening(family: str) -> tuple[str, ...]:
    """Return a family and the wider ones that hold it, the narrowest first; none of no family."""
    return (family, *FAMILIES[family].wider) if family else ()


MOST_POINTS = 200  # of a table
THERMAL = ("m", "melting", "reference", "heat_share")


@dataclass(frozen=True, slots=True)
class JohnsonCookFlow:
    """Flow stress (yield_stress + B p^n) (1 - T*^m) at plastic strain p, as Johnson and Cook write it.

    Attributes
    ----------
    B : Pa; n : exponent of the plastic strain
    m, melting, reference : exponent and temperatures, K, of T* = (T - reference) / (melting - reference)
    heat_share : of the plastic work that becomes heat, which stays where it is made; with any of these four
        all are stated, without them temperature has no effect
    """

    law: ClassVar[str] = "johnson-cook"
    B: float
    n: float
    m: float | None = None
    melting: float | None = None
    reference: float | None = None
    heat_share: float | None = None

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.FLOWS[self.law])
        missing = [key for key in THERMAL if getattr(self, key) is None]
        if missing and len(missing) < len(THERMAL):
            remedy = f"Give all of {', '.join(THERMAL)}, or none: temperature then has no effect."
            raise SceneError("is missing beside the other numbers of heat.", key=missing[0], remedy=remedy)
        if self.melting is not None and self.reference is not None and self.melting <= self.reference:
            value = f"{self.melting:g} K"
            raise SceneError(f"is not above reference, {self.reference:g} K.", key="melting", value=value)


@dataclass(frozen=True, slots=True)
class RambergOsgoodFlow:
    """Plastic strain .002 (sigma / yield_stress)^n, of which the yield stress is the .2 % proof stress."""

    law: ClassVar[str] = "ramberg-osgood"
    n: float

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.FLOWS[self.law])


@dataclass(frozen=True, slots=True)
class TableFlow:
    """Points (plastic strain, true stress in Pa), the first at strain 0: the yield stress."""

    law: ClassVar[str] = "table"
    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        if not 2 <= len(self.points) <= MOST_POINTS:
            raise SceneError(f"must hold 2 to {MOST_POINTS} points.", key="points", value=len(self.points))
        checked = tuple(
            (float(fields.PLASTIC_STRAIN.checked(strain)), float(fields.FLOW_STRESS.checked(stress)))
            for strain, stress in self.points
        )
        object.__setattr__(self, "points", checked)
        if checked[0][0] != 0:
            remedy = "Its stress is the yield stress."
            raise SceneError("must begin at a plastic strain of 0.", key="points", remedy=remedy)
        for (strain, stress), (later, after) in pairwise(checked):
            if later <= strain or after < stress:
                raise SceneError(
                    f"must have growing strains and stresses that do not fall, after {strain:g}: "
                    "a softening material has no unique answer on any mesh.",
                    key="points",
                    remedy="Hold the stress at its largest value.",
                )


Flow = JohnsonCookFlow | RambergOsgoodFlow | TableFlow
FLOWS: dict[str, type[Flow]] = {kind.law: kind for kind in (JohnsonCookFlow, RambergOsgoodFlow, TableFlow)}


MOST_STRAIN = 0.1
"""Elastic strain that no metal bears: a perfect crystal shears at G/(2 pi) (Frenkel 1926), in tension it
yields at sqrt(3) G/(2 pi), a tenth of E."""
MOST_SPEED, STIFFEST = 14e3, 7e11
"""Speed sqrt(E/rho) of waves along a rod, m/s, that no metal has: beryllium has 12.8 km/s. E, Pa, of hard
metal: beyond it a body stands for a rigid one, of any density."""


@dataclass(frozen=True, slots=True)
class JohnsonCookRate:
    """Flow stress in proportion to 1 + C ln(rate / reference), as Johnson and Cook write it.

    ``reference`` is the strain rate of the curve that the law multiplies, 1/s; ``tested`` is that of the
    tests which gave the strengths. The factor over the strengths is the law's value over that at ``tested``.
    """

    law: ClassVar[str] = "johnson-cook"
    C: float
    reference: float
    tested: float

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.RATES[self.law])


def tested_at(flow: Flow | None, reference: float) -> float:
    """Return the rate, 1/s, of the tests that gave the strengths of a metal where that is not stated.

    The numbers of a curve of Johnson and Cook hold at the ``reference`` rate of their law, 1/s.
    """
    default = next(f.default for f in fields.RATES[JohnsonCookRate.law] if f.key == "tested")
    return reference if isinstance(flow, JohnsonCookFlow) or default is None else default


@dataclass(frozen=True, slots=True)
class CowperSymondsRate:
    """Flow stress in proportion to 1 + (rate / D)^(1/q), over that of a static test; D in 1/s."""

    law: ClassVar[str] = "cowper-symonds"
    D: float
    q: float

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.RATES[self.law])


Rate = JohnsonCookRate | CowperSymondsRate
RATES: dict[str, type[Rate]] = {kind.law: kind for kind in (JohnsonCookRate, CowperSymondsRate)}


@dataclass(frozen=True, slots=True)
class SkinSpec:
    """A layer that machining has hardened, at the surface of a body of the material.

    Attributes
    ----------
    factor : flow stress at the surface over that of the bulk
    depth : m; None: it follows from the hardness of the material, measured with a load
    load : kgf, of the hardness test; None: the depth is stated
    shape : of the gain over the depth
    """

    factor: float
    depth: float | None = None
    load: float | None = None
    shape: fields.SkinShape = "even"

    def __post_init__(self) -> None:
        fields.check_numbers(self, fields.SKIN)
        fields.check_choice(self.shape, get_args(fields.SkinShape), "shape")
        if self.depth is None and self.load is None:
            remedy = "Give it, or the load of the hardness test, from which the depth then follows."
            raise SceneError("is missing.", key="depth", remedy=remedy)
        if self.depth is not None and self.load is not None:
            raise SceneError("stands beside depth.", key="load", remedy="Keep one of the two.")


@dataclass(frozen=True, slots=True)
class Material:
    """A solid: E, yield_stress and ultimate_stress in Pa, nu dimensionless, rho in kg/m3.

    Attributes
    ----------
    yield_stress, ultimate_stress : Pa, of a tensile test; infinite for a body that never yields
    hardening, tangent_modulus : Pa, d sigma / d eps_p or d sigma / d eps of linear hardening
    flow : curve of the flow stress by another law; without any of these three it is a power law through the
        yield stress and what ``law`` names
    hardness : Vickers' number HV, kgf/mm2 of the pyramid's faces
    law : ``tensile``, through the ultimate stress, or ``hardness``, through the flow stress of the hardness
    loss_factor : E'' / E' at the pace of the contact; None: it loses nothing by viscosity
    strength : Pa, at which a brittle body breaks; it changes no number; None: not known
    conductivity, heat_capacity : W/(m K), J/(kg K); None: not known
    family : by which friction is looked up and what an elastic body leaves out is told; empty: by its name
    sources : key and source of values, as the user states them
    rate : how flow stress grows with the strain rate; None: no data, no effect
    skin : the hardened layer at the surface; None: none is known
    """

    name: str
    E: float
    nu: float
    rho: float
    yield_stress: float = inf
    ultimate_stress: float = inf
    hardening: float | None = None
    hardness: float | None = None
    conductivity: float | None = None
    heat_capacity: float | None = None
    law: fields.FlowLaw = "tensile"
    rate: Rate | None = None
    tangent_modulus: float | None = None
    flow: Flow | None = None
    family: str = ""
    loss_factor: float | None = None
    strength: float | None = None
    sources: tuple[tuple[str, str], ...] = ()
    skin: SkinSpec | None = None

    def __post_init__(self) -> None:
        fields.check_text(self.name, "name", 60)
        fields.check_choice(self.law, get_args(fields.FlowLaw), "law")
        fields.check_choice(self.family, ("", *FAMILIES), "family")
        # a material that never yields has no strengths
        absent = [key for key in ("yield_stress", "ultimate_stress") if getattr(self, key) == inf]
        fields.check_numbers(self, tuple(p for p in fields.MATERIAL if p.key not in absent))
        _check_strengths(self)
        _check_law(self)

    @property
    def yields(self) -> bool:
        """Return whether the material has a yield stress."""
        return self.yield_stress < inf

    @property
    def plastic_modulus(self) -> float | None:
        """The modulus d sigma / d eps_p, Pa, of linear hardening, None of another law."""
        if self.tangent_modulus is None:
            return self.hardening
        return self.tangent_modulus / (1 - self.tangent_modulus / self.E)

    @property
    def curves(self) -> tuple[str, ...]:
        """The keys that state how the flow stress grows, beside the strength that ``law`` names."""
        return tuple(key for key in CURVES if getattr(self, key) is not None)


CURVES = ("hardening", "tangent_modulus", "flow")


def _check_strengths(metal: Material) -> None:
    """Refuse a yield stress alone, what only a body that yields has without it, and what no metal has."""
    if metal.yields and metal.ultimate_stress == inf and metal.law == "tensile" and not metal.curves:
        remedy = (
            'Give it, or tangent_modulus or hardening ("0 MPa": perfectly plastic), or a table flow; or '
            "leave out yield_stress too: the body then never yields."
        )
        raise SceneError("is missing beside yield_stress.", key="ultimate_stress", remedy=remedy)
    for key in ("ultimate_stress", *CURVES, "rate", "skin"):
        if getattr(metal, key) not in (None, inf) and not metal.yields:
            raise SceneError("means nothing without yield_stress.", key=key, remedy="Leave it out.")
    if metal.yields and metal.yield_stress > MOST_STRAIN * metal.E:
        raise SceneError(
            f"is too soft for a yield stress of {metal.yield_stress / 1e6:.4g} MPa: it would be stretched by "
            f"{metal.yield_stress / metal.E:.2g} of its length, no metal by more than {MOST_STRAIN:g}.",
            key="E",
            value=f"{metal.E / 1e9:.4g} GPa",
            remedy="Is its unit right? Metals have 10 to 400 GPa.",
        )
    if metal.yields and metal.E <= STIFFEST and (speed := sqrt(metal.E / metal.rho)) > MOST_SPEED:
        raise SceneError(
            f"is too light for E = {metal.E / 1e9:.4g} GPa: waves would run along a rod at "
            f"{speed / 1e3:.3g} km/s, in no metal above {MOST_SPEED / 1e3:g} km/s.",
            key="rho",
            value=f"{metal.rho:.4g} kg/m3",
            remedy="Are both units right? Metals have 1700 to 22600 kg/m3 and 10 to 400 GPa.",
        )
    if metal.ultimate_stress < metal.yield_stress:
        raise SceneError(
            "is below the yield stress.",
            key="ultimate_stress",
            value=f"{metal.ultimate_stress / 1e6:.3g} MPa",
            remedy=f"Give at least {metal.yield_stress / 1e6:g} MPa.",
        )


def _check_law(metal: Material) -> None:
    """Refuse a flow stress or a skin that is stated twice, or without the numbers that it needs."""
    if metal.law == "hardness" and (metal.hardness is None or not metal.yields):
        missing = "yield_stress" if metal.hardness else "hardness"
        raise SceneError(f"needs {missing}.", key="law", value=metal.law, remedy=f"Give {missing}.")
    if metal.law == "hardness" and metal.curves:
        remedy = f'Leave out {metal.curves[0]}, or write law = "tensile".'
        other = "a plastic modulus" if metal.curves[0] == "hardening" else metal.curves[0]
        raise SceneError(f"stands beside {other}.", key="law", value=metal.law, remedy=remedy)
    if len(metal.curves) > 1:
        first, second, *_ = metal.curves
        raise SceneError(f"stands beside {second}.", key=first, remedy="Keep one of the two.")
    if metal.tangent_modulus is not None and metal.tangent_modulus >= metal.E:
        value = f"{metal.tangent_modulus / 1e9:.4g} GPa"
        raise SceneError("is not below E, the slope before yield.", key="tangent_modulus", value=value)
    # refuse a table that does not begin at the yield stress, and heat without a heat capacity
    flow = metal.flow
    if isinstance(flow, TableFlow) and flow.points[0][1] != metal.yield_stress:
        first = f"{flow.points[0][1] / 1e6:g} MPa"
        remedy = f"Leave it out: it is the first point's stress, {first}."
        value = f"{metal.yield_stress / 1e6:g} MPa"
        raise SceneError("is not that of the table.", key="yield_stress", value=value, remedy=remedy)
    if isinstance(flow, JohnsonCookFlow) and flow.m is not None and metal.heat_capacity is None:
        remedy = "Give it, or leave out m, melting, reference and heat_share."
        raise SceneError("is missing for the heat of the flow.", key="heat_capacity", remedy=remedy)
    # the depth of a skin follows from a hardness that must be stated, and not be that of the bulk
    by_hardness = metal.skin is not None and metal.skin.load is not None
    if by_hardness and metal.hardness is None:
        remedy = "Give it, or skin.depth in place of skin.load."
        raise SceneError("is missing beside skin.load.", key="hardness", remedy=remedy)
    if by_hardness and metal.law == "hardness":
        remedy = 'Write law = "tensile", or give skin.depth.'
        problem = "gives the bulk the hardness that the skin is to explain."
        raise SceneError(problem, key="law", value=metal.law, remedy=remedy)


@dataclass(frozen=True, slots=True)
class Surface:
    """State of the two surfaces: Coulomb f that goes in, its interval and where they come from.

    ``pair`` is that of a table of dry pairs of materials, for a scene that states no surface.
    ``sliding_law`` is how friction changes with speed; None: it does not.
    """

    state: fields.SurfaceState
    friction: float
    friction_low: float
    friction_high: float
    source: str
    sliding_law: SlidingLaw | None = None

    def __post_init__(self) -> None:
        fields.check_choice(self.state, get_args(fields.SurfaceState), "state")
        fields.check_numbers(self, fields.SURFACE)
        if not fields.check_text(self.source, "source", 1000).strip():
            raise SceneError("says nothing.", key="source", remedy="Say where the friction is known from.")
        if not self.friction_low <= self.friction <= self.friction_high:
            raise SceneError(
                f"lies outside its own interval, {self.friction_low:g} to {self.friction_high:g}.",
                key="friction",
                value=self.friction,
                remedy="Give friction_low <= friction <= friction_high.",
            )
