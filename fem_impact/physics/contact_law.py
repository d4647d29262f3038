"""The local contact: Hertz, Thornton's elastic and perfectly plastic law, and tangential stiffness.

Thornton (1997), doi:10.1115/1.2787319: the contact yields when Hertz' peak pressure reaches p_y = 2.8
times the yield stress of the softer body; from there on the force rises by pi p_y R a metre of approach,
and it unloads by Hertz with the flatter radius R_p that the indentation leaves behind. The round contact
stands for the elliptic one of principal radii R1, R2 by R = sqrt(R1 R2).
"""

from math import inf, pi, sqrt
from typing import NamedTuple

from fem_impact.physics.contact import LIMIT_PRESSURE, ContactPair
from fem_impact.physics.viscous import relaxation

# s: contacts with a shorter gap count as one; a few passages of a wave across the tip
MERGE_GAP = 10e-6
# least impulse of a step, over the largest of the run, that counts as contact
FAINT = 1e-3


class ContactLaw(NamedTuple):
    """Constants of a contact, SI.

    Attributes
    ----------
    R, E_star : m, Pa; limit : p_y, Pa, infinite where nothing yields
    stiffness : F = stiffness d^1.5 while elastic, N/m^1.5
    yield_depth, yield_force : where yielding begins, m, N
    slope : dF/dd beyond it, N/m
    shear : tangential stiffness over contact radius, N/m2
    friction : Coulomb's f
    lag : theta of a viscous contact, s, see `fem_impact.physics.viscous`; 0 without loss
    """

    R: float
    E_star: float
    limit: float
    stiffness: float
    yield_depth: float
    yield_force: float
    slope: float
    shear: float
    friction: float
    lag: float = 0.0


def contact_law(pair: ContactPair, loss_factor: float | None = None) -> ContactLaw:
    """Return the contact law of two bodies, viscous with a loss factor."""
    size, E_star, soft = pair.estimate, pair.modulus, pair.softer
    R = sqrt(size.R1 * size.R2)
    limit = LIMIT_PRESSURE * soft.yield_stress if soft else inf
    stiffness = 4 / 3 * E_star * sqrt(R)
    depth = (pi * limit / (2 * E_star)) ** 2 * R
    force = stiffness * depth**1.5
    slope, shear = pi * limit * R, pair.shear_stiffness
    lag = relaxation(loss_factor, pair.elastic.estimate.duration) if loss_factor else 0.0
    return ContactLaw(R, E_star, limit, stiffness, depth, force, slope, shear, pair.f, lag)


def restitution(law: ContactLaw, mass: float, speed: float) -> float:
    """Return Thornton's e (energetic, of the normal direction) of a mass, kg, at a speed, m/s.

    Examples
    --------
    >>> law = ContactLaw(5e-3, 1e11, 9e8, 9.4e9, 1e-6, 9.4, 1.4e7, 3e11, 0.57)
    >>> restitution(law, 0.1, 16.0) / restitution(law, 0.1, 1.0) < 0.6
    True
    """
    return thornton(speed / sqrt(2 / mass * 0.4 * law.yield_force * law.yield_depth))


def thornton(ratio: float) -> float:
    """Return e of an elastic-perfectly-plastic sphere at a speed over the yield speed, Thornton's eq 41."""
    if ratio <= 1:
        return 1.0
    y = 1 / ratio
    losses = (y / (y + 2 * sqrt(6 / 5 - y**2 / 5))) ** 0.25
    return float(sqrt(6 * sqrt(3) / 5) * sqrt(1 - y**2 / 6) * losses)
