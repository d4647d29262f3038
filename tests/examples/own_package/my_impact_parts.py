"""A package of a user's own that adds a material, a tip and an effect to fem-impact."""

from math import hypot, pi

from fem_impact.case.effects.slots import Effect
from rigid import Nose

ALUMINIUM = {
    "E": "70 GPa",
    "nu": 0.33,
    "rho": "2700 kg/m3",
    "yield_stress": "260 MPa",
    "ultimate_stress": "310 MPa",
    "sources": {"E": "certificate of the bar", "yield_stress": "tension test of the bar"},
}


def ball(radius, tip_radius):
    """Return a hemispherical end."""
    return Nose(radius, 0.0, tip_radius, pi / 2)


MOON = 1.62  # m/s2


def number(bodies):
    """Speed gained during the contact over the impact speed."""
    return MOON * bodies.estimate.duration / hypot(bodies.contact.v_n, bodies.contact.v_t)


def fill(bodies, spec):
    """Let the Moon pull."""
    spec.gravity = MOON


LUNAR_GRAVITY = Effect(
    name="lunar-gravity",
    sentence="The Moon pulls the rod down.",
    absence="No Moon under the plate.",
    measure="g tau/v",
    threshold=0.005,
    source="a quarter of the 2 % that e may be off",
    number=number,
    fill=fill,
)
