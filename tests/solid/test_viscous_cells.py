"""Maxwell elements of a rod's cells: the decay of a mode, and what a ball gives back."""

from dataclasses import dataclass, field
from math import pi, sqrt

import numpy as np
import pytest

from fem_impact.physics.viscous import PACE, UNITS, linear_solid
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict
from fem_impact.solid.frame import FixedFrame
from fem_impact.solid.state import State
from fem_impact.solid.viscous import MaxwellCells


@dataclass
class OneSpring:
    """An elastic item of one unknown, as the elements take it."""

    k: float
    d: np.ndarray = field(default_factory=lambda: np.zeros(1))
    y: np.ndarray = field(default_factory=lambda: np.zeros(1))
    frame: FixedFrame = field(default_factory=lambda: FixedFrame(np.zeros(1)))

    def apply(self, d, y):
        y[:] = self.k * d

    def add(self, state):
        self.d[:] = state.x
        self.apply(self.d, self.y)
        state.force -= self.y


@pytest.mark.parametrize("eta", [0.05, 0.3])
def test_a_mode_decays_as_the_root_of_its_cubic(eta):
    """s^2 + w^2 c (1 + g s theta / (1 + s theta)) = 0 for unit mass; the ledger closes to round-off."""
    omega, duration = 2 * pi, 0.5  # half a wave a pace: the loss factor holds
    law = linear_solid(eta, duration)
    spring = OneSpring(omega**2)
    cells, state = MaxwellCells.of(spring, law), State(np.zeros(1), np.ones(1), np.zeros(1))
    dt, places = 1e-3, []
    for step in range(6001):
        state.force[:] = 0.0
        spring.add(state)
        cells.add(state)
        half = 0.5 * dt if step else 0.0  # velocities stand half a step before positions, but at the start
        kinetic = 0.5 * float(state.v @ state.v) + half * float(state.v @ state.force)
        total = kinetic + 0.5 * spring.k * float(spring.d @ spring.d) + sum(cells.energies(state))
        assert total == pytest.approx(0.5, abs=1e-12)
        places.append((float(state.x[0]), float((state.v + half * state.force)[0])))
        state.v += (half + 0.5 * dt) * state.force
        state.x += dt * state.v
        state.time += dt
    roots = np.roots([law.theta, 1.0, omega**2 * law.c * (1 + law.g) * law.theta, omega**2 * law.c])
    root = roots[np.argmax(roots.imag)]
    x, v = np.array(places[2000:]).T
    size = np.hypot(x, (v - root.real * x) / root.imag)
    rate = np.polyfit(dt * np.arange(len(size)), np.log(size), 1)[0]
    assert rate == pytest.approx(root.real, rel=2e-3)
    assert -2 * root.real / root.imag == pytest.approx(eta, rel=0.1)


def of_hertz(eta):
    """Return e of a standard linear solid in Hertz' contact, s'' = -c (u + g q) with u = s^1.5."""
    law, dt = linear_solid(eta, UNITS), UNITS / 4000

    def rates(z):
        s, v, q = z
        root = sqrt(max(s, 0.0))
        return np.array([v, -law.c * (s * root + law.g * q), 1.5 * root * v - q / law.theta])

    z = np.array([0.0, 1.0, 0.0])
    while True:
        a = rates(z)
        b = rates(z + 0.5 * dt * a)
        c = rates(z + 0.5 * dt * b)
        z = z + dt / 6 * (a + 2 * b + 2 * c + rates(z + dt * c))
        if z[1] < 0.0 and z[0] * sqrt(max(z[0], 0.0)) + law.g * z[2] <= 0.0:
            return -z[1]


@pytest.mark.parametrize("eta", [0.02, 0.1, 0.3, 1.0, 1.5])
def test_the_law_has_the_stated_loss_and_stiffness_at_its_pace(eta):
    law = linear_solid(eta, 2e-3)
    turned = 1j * pi / 2e-3 * law.theta
    modulus = law.c * (1 + law.g * turned / (1 + turned))
    assert (modulus.real, modulus.imag) == pytest.approx((1.0, eta), rel=1e-12)
    assert abs(turned) == pytest.approx(PACE)
    assert law.stiffest > 1.0


@pytest.mark.parametrize("eta", [0.05, 0.3])
def test_a_ball_gives_back_what_its_solid_does_in_hertz_contact(eta):
    rubber = {"name": "soft", "E": "4.485 MPa", "nu": 0.3, "rho": "1150 kg/m3", "loss_factor": eta}
    scene = {
        "id": "soft-ball",
        "effects": ["vibration", "barrier-rigid", "contact-loss"],
        "projectile": {"shape": "ball", "diameter": "60 mm", "material": rubber},
        "barrier": {"material": "plate-steel"},
        "impact": {"angle": "0 deg", "speed": "0.3 m/s"},
        "accuracy": {"levels": 1, "tip_size": "2.5 mm", "unresolved": "report"},
        "save": {"frames": 0},
    }
    outcome = simulate(read_dict(scene))
    e = outcome.restitution.edge.e
    assert e == pytest.approx(of_hertz(eta), rel=0.025)
    assert abs(outcome.energy.residual) < 1e-9
    assert outcome.energy.damping == pytest.approx(1 - e**2, abs=0.02)
