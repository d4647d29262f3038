"""What a body is made of: elastic constants, strengths, hardness and the law of its strain rate."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import ClassVar, get_args

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.checks import check_choice, check_numbers, check_text

MOST_STRAIN = 0.1
"""Elastic strain that no metal bears: a perfect crystal shears at G/(2 pi) (Frenkel 1926), in tension it
yields at sqrt(3) G/(2 pi), a tenth of E."""


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
        check_numbers(self, fields.RATES[self.law])


@dataclass(frozen=True, slots=True)
class CowperSymondsRate:
    """Flow stress in proportion to 1 + (rate / D)^(1/q), over that of a static test; D in 1/s."""

    law: ClassVar[str] = "cowper-symonds"
    D: float
    q: float

    def __post_init__(self) -> None:
        check_numbers(self, fields.RATES[self.law])


Rate = JohnsonCookRate | CowperSymondsRate
RATES: dict[str, type[Rate]] = {kind.law: kind for kind in (JohnsonCookRate, CowperSymondsRate)}


@dataclass(frozen=True, slots=True)
class Material:
    """A solid: E, yield_stress and ultimate_stress in Pa, nu dimensionless, rho in kg/m3.

    Attributes
    ----------
    yield_stress, ultimate_stress : Pa, of a tensile test; infinite for a body that never yields
    hardening : plastic modulus d sigma / d eps_p, Pa, of linear hardening; without it flow stress is a power
        law through the yield stress and what ``law`` names
    hardness : Vickers' number HV, kgf/mm2 of the pyramid's faces
    law : ``tensile``, through the ultimate stress, or ``hardness``, through the flow stress of the hardness
    conductivity, heat_capacity : W/(m K), J/(kg K); None: not known
    rate : how flow stress grows with the strain rate; None: no data, no effect
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

    def __post_init__(self) -> None:
        check_text(self.name, "name", 60)
        check_choice(self.law, get_args(fields.FlowLaw), "law")
        # a material that never yields has no strengths
        absent = [key for key in ("yield_stress", "ultimate_stress") if getattr(self, key) == inf]
        check_numbers(self, tuple(p for p in fields.MATERIAL if p.key not in absent))
        _check_strengths(self)
        _check_law(self)

    @property
    def yields(self) -> bool:
        """Return whether the material has a yield stress."""
        return self.yield_stress < inf


def _check_strengths(metal: Material) -> None:
    """Refuse one strength without the other, and what only a body that yields has, without any."""
    if metal.yields and metal.ultimate_stress == inf:
        remedy = "Give it, or leave out yield_stress too: the body then never yields."
        raise SceneError("is missing beside yield_stress.", key="ultimate_stress", remedy=remedy)
    for key in ("ultimate_stress", "hardening", "rate"):
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
    if metal.ultimate_stress < metal.yield_stress:
        raise SceneError(
            "is below the yield stress.",
            key="ultimate_stress",
            value=f"{metal.ultimate_stress / 1e6:.3g} MPa",
            remedy=f"Give at least {metal.yield_stress / 1e6:g} MPa.",
        )


def _check_law(metal: Material) -> None:
    """Refuse a flow stress by hardness without a hardness, or beside a plastic modulus."""
    if metal.law == "tensile":
        return
    if metal.hardness is None or not metal.yields:
        missing = "yield_stress" if metal.hardness else "hardness"
        raise SceneError(f"needs {missing}.", key="law", value=metal.law, remedy=f"Give {missing}.")
    if metal.hardening is not None:
        remedy = 'Leave out hardening, or write law = "tensile".'
        raise SceneError("stands beside a plastic modulus.", key="law", value=metal.law, remedy=remedy)
