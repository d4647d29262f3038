"""What a printed hardness says of a hardened layer: all pairs of factor and depth that meet it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf

from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.case.effects.skin import skin_of
from fem_impact.physics.indentation import FRICTIONS, HardnessTest, skin_depth, vickers
from fem_impact.scene.inputs import materials_of
from fem_impact.scene.material import Material
from fem_impact.scene.types import Scene

FACTORS = (1.2, 1.3, 1.5, 2.0, 2.5, 3.0)
LOADS = (5.0, 10.0, 30.0)
"""Loads, kgf, for which curves are told where none is stated."""


@dataclass(frozen=True, slots=True)
class SkinPoint:
    """A layer that meets a hardness: load, kgf; factor; depth, m, with its range.

    ``low`` is 0 where the bulk alone may be as hard, ``high`` infinite where no depth of the factor may
    suffice; ``depth`` is either of them where that holds for the values as stated.
    """

    load: float
    factor: float
    depth: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Hardness:
    """The hardness of a material of a scene.

    Attributes
    ----------
    place : dotted key of the material
    material : its name
    HV : as stated; ``bulk`` : by the flow curve, at each friction of `FRICTIONS` under the pyramid
    reason : why bulk and points are not known: the curve lies outside the indentations computed; else empty
    skin : depth, m, of the layer that the scene states, None without one
    points : layers that meet the stated number, none where it is less than that of the bulk
    """

    place: str
    material: str
    HV: float
    bulk: tuple[float, ...]
    skin: float | None
    points: tuple[SkinPoint, ...]
    reason: str = ""


def hardnesses(scene: Scene, loads: Sequence[float] = (), scatter: float = 0.0) -> Iterator[Hardness]:
    """Return of each material of a scene with a hardness and a flow curve what layers meet it.

    Loads are in kgf, by default those of the scene or `LOADS`. Depths range over friction under the pyramid
    and a ``scatter`` of the hardness, HV.
    """
    for place, metal in materials_of(scene).items():
        if metal.hardness is None or not metal.yields or metal.law == "hardness":
            continue
        law, stated = hardening_of(metal), (place, metal.name, metal.hardness)
        try:
            bulk = tuple(vickers(metal.E, law, friction) for friction in FRICTIONS)
        except ValueError as error:
            yield Hardness(*stated, (), None, (), str(error))
            continue
        skin = skin_of(metal)
        usual = (metal.skin.load,) if metal.skin and metal.skin.load else LOADS
        points = tuple(
            _point(metal, metal.hardness, load, factor, scatter)
            for load in loads or usual
            for factor in sorted({*FACTORS, *([skin.factor] if skin else [])})
        )
        yield Hardness(*stated, bulk, skin.depth if skin else None, points)


def _point(metal: Material, HV: float, load: float, factor: float, scatter: float) -> SkinPoint:
    shape = metal.skin.shape if metal.skin else "even"
    slippery, usual, rough = FRICTIONS

    def depth(number: float, friction: float) -> float:
        law, test = hardening_of(metal), HardnessTest(number, load)
        if vickers(metal.E, law, friction) >= number:
            return 0.0
        try:
            return skin_depth(metal.E, law, test, factor, shape, friction)
        except ValueError:
            return inf  # no depth suffices

    return SkinPoint(
        load, factor, depth(HV, usual), depth(HV - scatter, rough), depth(HV + scatter, slippery)
    )
