"""Vickers' number of a metal, bare or under a hardened layer, and the layers that meet a measured one.

Closed forms of indentations that were computed: a rigid cone with the pyramid's volume, pressed into
axisymmetric elements that yield (`fem_impact.evidence.references.axisymmetric`; ``verify hardness`` presses
it again). No constant comes from an impact or from a measured hardness.

- Without a layer the mean pressure is C times the flow stress at `TABOR_STRAIN`; C, of `CONSTRAINT`, grows
  with stiffness and friction and falls with hardening.
- An even layer of depth d under a contact of radius a raises it by (factor - 1) (1 - exp(-d / (c a))): metal
  counts by how deep it lies, with the weight exp(-z / (c a)). c is `REACH` + `SPREADS` times the exponent of
  the hardening, which spreads the flow, times the factor: a harder layer sinks further into its base. The
  same weights give an exponential layer d / (d + c a), with the mean of its factor and 1 in c.
"""

from math import exp, log, log1p, pi, sqrt
from typing import NamedTuple

import numpy as np

from fem_impact.physics.hardening import KGF_PER_MM2, TABOR_STRAIN, HardeningLaw, Skin
from fem_impact.scene.fields import SkinShape

FACES = 0.927  # projected area over that of the faces of Vickers' pyramid
REACH, SPREADS = 0.3, 1.3
FRICTION = 0.1  # between the pyramid and the metal
FRICTIONS = (0.0, 0.1, 0.2)  # of `CONSTRAINT`: what is not known of it spreads the answers
STIFFNESSES = (100.0, 300.0, 1000.0)  # E over the yield stress
EXPONENTS = (0.04, 0.1, 0.25)  # of the power law of hardening
CONSTRAINT = np.array(
    [  # of each friction a row a stiffness, of each exponent a column
        [[2.637, 2.662, 2.531], [2.681, 2.763, 2.774], [2.69, 2.768, 2.856]],
        [[2.860, 2.804, 2.593], [2.966, 2.978, 2.880], [2.97, 3.012, 2.982]],
        [[2.916, 2.857, 2.621], [3.095, 3.060, 2.923], [3.11, 3.125, 3.039]],
    ]
)


class HardnessTest(NamedTuple):
    """A hardness test: Vickers' number HV, and its load, kgf."""

    hardness: float
    load: float

    @property
    def pressure(self) -> float:
        """The mean pressure over the projected contact, Pa."""
        return self.hardness * KGF_PER_MM2 / FACES

    @property
    def radius(self) -> float:
        """The radius, m, of a circle as large as the projected contact.

        Examples
        --------
        >>> print(round(1e3 * HardnessTest(163, 30).radius, 3))
        0.233
        """
        return sqrt(self.load * KGF_PER_MM2 * 1e-6 / (pi * self.pressure))


def vickers(E: float, law: HardeningLaw, friction: float = FRICTION) -> float:
    """Return Vickers' number of a metal without a layer, of ``friction`` in `FRICTIONS`.

    Raises
    ------
    ValueError
        If no indentation was computed of such a flow curve.
    """
    curve = law.power
    stiffness = E / curve.yield_stress
    if not STIFFNESSES[0] <= stiffness <= STIFFNESSES[-1] or curve.exponent > EXPONENTS[-1]:
        raise ValueError(
            f"E / yield stress {stiffness:.3g} with a hardening exponent of {curve.exponent:.2g} lies "
            f"outside the indentations computed: {STIFFNESSES[0]:g} to {STIFFNESSES[-1]:g}, at most "
            f"{EXPONENTS[-1]:g}."
        )
    at_exponents = [
        float(np.interp(log(stiffness), np.log(STIFFNESSES), of_exponent))
        for of_exponent in CONSTRAINT[FRICTIONS.index(friction)].T
    ]
    constraint = float(np.interp(curve.exponent, EXPONENTS, at_exponents))
    return FACES * constraint * float(curve.flow_stress(TABOR_STRAIN)) / KGF_PER_MM2


def reach(law: HardeningLaw, factor: float, shape: SkinShape) -> float:
    """Return c, the depth over the radius of the contact at which 1/e of the weight is left."""
    mean = factor if shape == "even" else 0.5 * (1 + factor)
    return (REACH + SPREADS * law.power.exponent) * mean


def share(law: HardeningLaw, skin: Skin, radius: float) -> float:
    """Return the part of a layer's gain that counts under a contact of a radius, m."""
    depth = skin.depth / (radius * reach(law, skin.factor, skin.shape))
    return 1 - exp(-depth) if skin.shape == "even" else depth / (1 + depth)


def skin_depth(
    E: float,
    law: HardeningLaw,
    test: HardnessTest,
    factor: float,
    shape: SkinShape,
    friction: float = FRICTION,
) -> float:
    """Return the depth, m, of the layer of a factor with which a metal has a measured hardness.

    Raises
    ------
    ValueError
        If the metal is as hard without it, or stays softer under any depth of it.
    """
    bulk = vickers(E, law, friction)
    if bulk >= test.hardness:
        raise ValueError(f"The bulk has HV {bulk:.0f} by its flow curve, no less than {test.hardness:g}.")
    part = (test.hardness / bulk - 1) / (factor - 1) if factor > 1 else 1.0
    if part >= 1:
        raise ValueError(
            f"HV {test.hardness:g} is {test.hardness / bulk:.2f} times that of the bulk, {bulk:.0f} by its "
            f"flow curve: a factor of {factor:g} is too low at any depth."
        )
    depth = -log1p(-part) if shape == "even" else part / (1 - part)
    return depth * test.radius * reach(law, factor, shape)
