"""Laws of the local contact: Hertz, Thornton's elastic and perfectly plastic law, the flow of a round tip.

Thornton (1997), doi:10.1115/1.2787319: the contact yields when Hertz' peak pressure reaches p_y = 2.8
times the yield stress of the softer body; from there on the force rises by pi p_y R a metre of approach,
and it unloads by Hertz with the flatter radius R_p that the indentation leaves behind. The round contact
stands for the elliptic one of principal radii R1, R2 by R = sqrt(R1 R2).

Constants of the yielding contact of a round tip are closed forms of the flow curve of the body that flows,
none of them from an impact:

- hardness H = 3 times the flow stress at the strain .2 a/R (Tabor 1951, The Hardness of Metals), and below
  that of a ball by finite elements (Jackson and Green 2005, doi:10.1115/1.1866166), elastic up to 1.9 times
  the depth of its first yield, or of Johnson's expanding cavity (1985, Contact Mechanics, eq 6.32) if more,
- of a tip that is flattened, whose steeper flank meets the contact at an angle theta,
  (1 + pi/2 - theta) / (1 + pi/2) of that: by Hencky's relation pressure grows by 2 k times the angle by which
  slip lines turn on their way from a free surface to the contact, and metal flows to that side where they
  turn least (the least upper bound, Hill 1950); of one in its groove the mean of both flanks counts. Tabor's
  3 is that of dents, lip and slope included,
- shear yield stress k = sigma(1) / sqrt(3) of the skin, von Mises, which is sheared by strains of about one;
  that of the weaker body of two that flow.

`STUCK` and `RUN_IN` have no closed form for a growing contact of a hardening body. They were chosen on a grid
by least difference of e, mu, vibration and sheared skin from finite elements, on six oblique impacts of other
lengths, tips, angles, speeds, frictions and flow curves than the measured ones
(`fem_impact.evidence.studies.reduced.CALIBRATION`), with an ellipse in place of Green's curve, another form
of what is piled up (`fem_impact.modal.groove`) and a contact elastic up to p_y, and hold for every scene.
"""

from math import inf, pi, sqrt
from typing import NamedTuple

from fem_impact.physics.contact import LIMIT_PRESSURE, ContactPair
from fem_impact.physics.hardening import Hardening, HardeningLaw, rate_factor, strain_rate
from fem_impact.physics.viscous import relaxation

# s: contacts with a shorter gap count as one; a few passages of a wave across the tip
MERGE_GAP = 10e-6
# of the time within which what touches again is one impact: the longest gap in a small scene
MERGED = 0.1
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


BEGINS = 1.1  # mean pressure over the yield stress at which a round contact begins to yield (Johnson)
FULLY_PLASTIC = 3.0  # H over the flow stress (Tabor)
REPRESENTATIVE = 0.2  # strain of an indentation over a/R (Tabor)
SKIN_STRAIN = 1.0  # of the sheared skin
STUCK = 0.45  # K / H of a contact that sticks and has not slid
RUN_IN = 0.1  # way over which a contact of radius 1 turns from sticking to sliding


class FlowLaw(NamedTuple):
    """Constants of a yielding contact, SI.

    Attributes
    ----------
    R1, R2, R : m, radii of the tip along t and across, and of the round contact that stands for them
    E_star, nu : Pa, -
    normal, shear : stiffnesses of the row of cells a metre, Pa
    yield_stress, slope, exponent : of the flow curve, see `fem_impact.physics.hardening.Hardening`
    skin : k, Pa
    friction : Coulomb's f
    ploughs : whether the barrier takes the groove; otherwise the tip is flattened
    yields : whether this law holds; otherwise nothing flows
    other_yield_stress, other_slope, other_exponent : of the flow curve of the other body, which bears no more
        than its own hardness; infinite of one that does not yield
    """

    R1: float
    R2: float
    R: float
    E_star: float
    nu: float
    normal: float
    shear: float
    yield_stress: float
    slope: float
    exponent: float
    skin: float
    friction: float
    ploughs: bool
    yields: bool
    other_yield_stress: float = inf
    other_slope: float = 0.0
    other_exponent: float = 0.0


def longer(ratio: float) -> float:
    """Return the stiffness of an elliptic punch of a ratio of its axes over that of a round one of its area.

    Johnson (1985), Contact Mechanics, 3.5: F = pi E* a d / K(e), with its longer half axis a.

    Examples
    --------
    >>> [round(longer(ratio), 2) for ratio in (1.0, 0.5, 0.01)]
    [1.0, 1.03, 2.62]
    """
    from scipy.special import ellipk

    ratio = min(ratio, 1.0 / ratio)
    return float(pi / 2 / sqrt(ratio) / ellipk(1.0 - ratio**2))


def begins_to_yield(pair: ContactPair) -> bool:
    """Return whether the first contact reaches the pressure at which a round one begins to yield."""
    return pair.softer is not None and pair.estimate.pressure >= BEGINS * pair.softer.yield_stress


def flow_law(pair: ContactPair, rod: HardeningLaw | None, barrier: HardeningLaw | None) -> FlowLaw:
    """Return the law of two bodies and their flow curves, None of one that does not yield.

    The softer body flows, at the strain rate of the indentation, if the first contact reaches the pressure at
    which a round one begins to yield; the curve of a body that does not yield here does not count. A table
    of its flow stress is stood for by the nearest power law.
    """
    size, soft, E_star = pair.estimate, pair.softer, pair.modulus
    R1, R2, flows = size.R1, size.R2, begins_to_yield(pair)
    flowing = [(barrier, pair.barrier)] * pair.barrier_yields + [(rod, pair.rod)] * pair.rod_yields
    flowing.sort(key=lambda one: one[1] != soft)  # the softer first
    never = Hardening(inf, 0.0, 0.0)
    curve, other, *_ = (*(law.power for law, _ in flowing if law), never, never)
    faster, other_faster = (rate_factor(of.rate, strain_rate(size)) for of in (curve, other))
    skins = (curve, faster), (other, other_faster)
    skin = min(rate * float(of.flow_stress(SKIN_STRAIN)) for of, rate in skins) / sqrt(3)
    over_length = (R2 / R1) ** 0.25  # an ellipse is shorter along t than the circle of its area
    if pair.spans:  # as long as an edge; of a turned body the factor is below 1.05
        over_length *= longer(sqrt(R1 / R2))
    return FlowLaw(
        R1=R1,
        R2=R2,
        R=sqrt(R1 * R2),
        E_star=E_star,
        nu=(soft or pair.rod).nu,
        normal=E_star * over_length,
        shear=0.5 * pair.shear_stiffness * over_length,
        yield_stress=faster * curve.yield_stress,
        slope=curve.slope,
        exponent=curve.exponent,
        skin=skin,
        friction=pair.f,
        ploughs=flows and pair.barrier_yields and soft == pair.barrier,
        yields=flows,
        other_yield_stress=other_faster * other.yield_stress,
        other_slope=other.slope,
        other_exponent=other.exponent,
    )
