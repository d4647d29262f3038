"""A package of a user's own that adds a material, a tip and an effect to fem-impact."""

from math import hypot, pi

from fem_impact.case.effects.slots import Effect, Harm, bodies_of
from fem_impact.physics.contact import contact_estimate
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


def number(scene):
    """Speed gained during the contact over the impact speed."""
    return MOON * contact_estimate(bodies_of(scene)).duration / hypot(scene.impact.v_n, scene.impact.v_t)


def fill(scene, spec):
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
    harm=lambda scene: Harm(number(scene), 0.0),
    fill=fill,
)
