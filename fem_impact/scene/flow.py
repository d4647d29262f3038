"""Flow curves that a material may state in place of its ultimate stress, each by the numbers of its law."""

from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

from fem_impact.errors import SceneError
from fem_impact.scene import fields
from fem_impact.scene.checks import check_numbers

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
        check_numbers(self, fields.FLOWS[self.law])
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
        check_numbers(self, fields.FLOWS[self.law])


@dataclass(frozen=True, slots=True)
class TableFlow:
    """Points (plastic strain, true stress in Pa), the first at strain 0: the yield stress."""

    law: ClassVar[str] = "table"
    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        if not 2 <= len(self.points) <= MOST_POINTS:
            raise SceneError(f"must hold 2 to {MOST_POINTS} points.", key="points", value=len(self.points))
        checked = tuple(
            (
                float(fields.PLASTIC_STRAIN.checked(strain)),
                float(fields.FLOW_STRESS.checked(stress)),
            )
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
