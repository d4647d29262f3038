"""A half-space of layers as one material under a round contact: closed forms of its stiffness and hardness.

Of the give of a contact of radius a the share I0 lies above the depth z (Gao, Chiu & Lee 1992,
doi:10.1016/0020-7683(92)90004-D), so that shear compliances 1/G add up by these shares (Rar, Song & Pharr
2002, doi:10.1557/PROC-695-L10.10.1); Poisson's ratios add up by I1 of the same source. Hardness is that of
Bhattacharya & Nix 1988, doi:10.1016/0020-7683(88)90039-X, from finite elements of cones of 136 degrees; a
dent of the radius a counts as one of theirs, of the depth h = a / tan(68 degrees).
"""

from collections.abc import Sequence
from itertools import pairwise
from math import atan, exp, inf, log1p, pi, radians, sqrt, tan

from fem_impact.scene.material import Material

CONE = tan(radians(68.0))  # radius over depth of the indentations from which the hardness is known


def elastic(strata: Sequence[tuple[float, Material]], radius: float) -> tuple[float, float]:
    """Return E, Pa, and nu of the material that gives as much under a contact of a ``radius``, m, as layers.

    ``strata`` are materials from the top down, each with the depth, m, at which it ends; inf for the last.

    Examples
    --------
    >>> from dataclasses import replace
    >>> steel = Material("steel", 210e9, 0.3, 7850.0)
    >>> E, nu = elastic([(1e-3, replace(steel, E=70e9)), (inf, steel)], 1e-3)
    >>> print(f"{E / 1e9:.0f} GPa, {nu:.2f}")
    111 GPa, 0.30
    """
    base = strata[-1][1]
    nu = base.nu
    for (depth, upper), (_, lower) in pairwise(strata):
        z = depth / radius
        nu += (upper.nu - lower.nu) * (2 * atan(z) + z * log1p(z**-2)) / pi
    give = _shear_give(base)
    for (depth, upper), (_, lower) in pairwise(strata):
        z = depth / radius
        above = ((1 - 2 * nu) * z * log1p(z**-2) - z / (1 + z * z)) / (2 * pi * (1 - nu))
        give += (_shear_give(upper) - _shear_give(lower)) * (2 * atan(z) / pi + above)
    return 2 * (1 + nu) / give, nu


def hardness(depth: float, radius: float, upper: tuple[float, float], lower: tuple[float, float]) -> float:
    """Return the flow stress, Pa, by which a layer and what lies under it resist a dent of a ``radius``, m.

    ``depth``, m, is where the layer ends; ``upper`` and ``lower`` are flow stress and Young's modulus, Pa, of
    either. Where either never flows (inf) it is that of the layer.

    Examples
    --------
    >>> hard, soft = (900e6, 210e9), (300e6, 210e9)
    >>> [round(hardness(t, 1.0, hard, soft) / 1e6) for t in (0.1, 1.0, 10.0)]
    [311, 701, 876]
    """
    (film, E_film), (base, E_base) = upper, lower
    if inf in (film, base):
        return film
    pressed = radius / CONE / depth
    if film < base:
        share = exp(-film / base * E_base / E_film * pressed**2)
    else:
        share = exp(-sqrt(E_base / E_film) * pressed)
    return base + (film - base) * share


def _shear_give(metal: Material) -> float:
    return 2 * (1 + metal.nu) / metal.E
