"""A package of a user's own: a material, a tip, a law of friction, two effects."""

from dataclasses import dataclass
from math import hypot, pi
from typing import ClassVar

import numpy as np

from fem_impact.case.effects.slots import Effect
from fem_impact.scene.sliding import SlidingLaw
from rigid import Nose

ALUMINIUM = {
    "E": "70 GPa",
    "nu": 0.33,
    "rho": "2700 kg/m3",
    "yield_stress": "260 MPa",
    "ultimate_stress": "310 MPa",
    "sources": {"E": "certificate of the bar", "yield_stress": "tension test of the bar"},
}


WAXED = SlidingLaw.of(
    lambda speed, pressure, temperature: 0.1 + 0.1 / (1 + speed), (0.0, 1.0, 3.0, 9.0), source="our tests"
)


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
    fidelities=("modal", "solid"),
)

PULL = 50.0  # N, of a magnet under the plate on the whole rod


@dataclass
class Pull:
    """A constant force on the half rod that is meshed, spread over its mass."""

    body: ClassVar[str] = "rod"
    effect: ClassVar[str] = "magnet"  # whose run time it counts to
    accounts: ClassVar[tuple[str, ...]] = ("magnet",)  # a column of the ledger that no other item books in
    moving: ClassVar[tuple[str, ...]] = ()  # what a checkpoint has to keep
    force: np.ndarray  # (n,), N, along each unknown of the rod
    start: np.ndarray  # (n,), m

    def add(self, state):
        """Add the force, N."""
        state.force[: len(self.force)] += self.force

    def energies(self, state):
        """Return the potential energy since the start, J."""
        return (-float(self.force @ (state.x[: len(self.force)] - self.start)),)


def pulls(builder):
    """Return the item of a model that is being built."""
    meshed, n = builder.meshed, builder.meshed.layout.rod_size
    normal = np.zeros(meshed.layout.size)
    normal[meshed.rod.places[:, 2]] = 1.0
    mass = meshed.mass[:n] * normal[:n]
    return [Pull(-0.5 * PULL * mass / mass.sum(), meshed.x[:n].copy())]


MAGNET = Effect(
    name="magnet",
    sentence="A magnet under the plate pulls the rod.",
    absence="No magnet.",
    measure="F tau/(m v)",
    threshold=0.005,
    source="a quarter of the 2 % that e may be off",
    number=lambda bodies: PULL * bodies.estimate.duration / (bodies.body.mass * -bodies.contact.v_n),
    fill=lambda bodies, spec: None,
    fidelities=("solid",),
    forces=pulls,
)
