"""The turning frame: a force that is the gradient of an energy, without net force or torque."""

import numpy as np
import pytest
import solid_shapes as shapes

from fem_impact.fem.elements import element_stiffness, lame_constants
from fem_impact.solid.frame import FixedFrame, TurningFrame


class Body:
    """A few elements whose stiffness acts in a turning frame."""

    def __init__(self, seed=1):
        points, cells = shapes.distorted((2, 1, 3), 0.1, seed)
        self.size = points.size
        self.places = np.random.default_rng(seed).permutation(self.size).reshape(-1, 3)
        self.mass = np.empty(self.size)
        self.mass[self.places] = np.random.default_rng(seed + 1).uniform(0.5, 2.0, (len(points), 1))
        m = self.mass[self.places[:, 0]]
        self.points = points - m @ points / m.sum()
        self.reference = np.empty(self.size)
        self.reference[self.places] = self.points
        t, b, n = (np.ascontiguousarray(self.places[:, c]) for c in range(3))
        self.frame = TurningFrame(self.reference, self.mass, t, b, n)
        elastic = shapes.dense(
            element_stiffness(points, cells, lame_constants(shapes.E, shapes.NU), "full"), cells
        )
        self.K = np.empty((self.size, self.size))
        self.K[np.ix_(self.places.ravel(), self.places.ravel())] = elastic
        self.d = np.zeros(self.size)

    def energy(self, x):
        self.frame.localise(x, self.d)
        return 0.5 * self.d @ self.K @ self.d

    def force(self, x):
        self.frame.localise(x, self.d)
        f = np.zeros(self.size)
        self.frame.add_force(self.d, self.K @ self.d, f)
        return f

    def moved(self, angle, strain, seed=3):
        c, s = np.cos(angle), np.sin(angle)
        R = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])  # n from t
        rng = np.random.default_rng(seed)
        x = np.empty(self.size)
        x[self.places] = (self.points + strain * 1e-3 * rng.normal(size=self.points.shape)) @ R.T + [
            3e-3,
            0,
            -1e-3,
        ]
        return x


@pytest.mark.parametrize("angle", [0.0, 0.4, 2.5])
def test_force_is_the_gradient_of_the_energy(angle):
    body = Body()
    x = body.moved(angle, 0.1)
    force, h = body.force(x), 1e-9
    unit = np.eye(body.size) * h
    slope = np.array([(body.energy(x + e) - body.energy(x - e)) / (2 * h) for e in unit])
    assert abs(force + slope).max() < 1e-6 * abs(force).max()


@pytest.mark.parametrize("angle", [0.02, 1.0, -2.0])
def test_no_net_force_and_no_torque(angle):
    body = Body()
    x = body.moved(angle, 0.2)
    f, size = body.force(x)[body.places], abs(body.force(x)).max()
    assert abs(f.sum(axis=0)).max() < 1e-9 * size
    arm = x[body.places] - x[body.places].mean(axis=0)
    assert abs((arm[:, 0] * f[:, 2] - arm[:, 2] * f[:, 0]).sum()) < 1e-9 * size * abs(arm).max()


@pytest.mark.parametrize("angle", [1e-3, 0.5, 3.0, -1.2])
def test_turning_costs_nothing(angle):
    body = Body()
    x = body.moved(angle, 0.0)
    assert body.energy(x) < 1e-20 * shapes.E * 1e-9
    assert abs(body.force(x)).max() < 1e-10 * abs(body.K).max() * 1e-3
    assert body.frame.angle == pytest.approx(angle, abs=1e-12)


def test_strain_turns_with_the_frame():
    body = Body()
    straight, turned = body.force(body.moved(0.0, 0.01)), body.force(body.moved(0.8, 0.01))
    c, s = np.cos(0.8), np.sin(0.8)
    f, g = straight[body.places], turned[body.places]
    back = np.stack([c * g[:, 0] + s * g[:, 2], g[:, 1], c * g[:, 2] - s * g[:, 0]], axis=1)
    assert abs(back - f).max() < 1e-9 * abs(f).max()


def test_fixed_frame_takes_differences():
    X, x, y = np.random.default_rng(5).normal(size=(3, 9))
    d, force = np.zeros(9), np.ones(9)
    frame = FixedFrame(X)
    frame.localise(x, d)
    frame.add_force(d, y, force)
    assert np.array_equal(d, x - X)
    assert np.array_equal(force, 1 - y)
    assert frame.angle == 0.0
