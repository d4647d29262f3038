"""Free-free modes against three-dimensional reference frequencies; exact free flight; rigid sums."""

from dataclasses import replace

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.errors import RunError
from fem_impact.fem import eigen
from fem_impact.fem.eigen import rod_modes
from fem_impact.fem.flight import flight, rigid_motion
from fem_impact.physics.beam import bending_frequencies
from fem_impact.scene.shipped import load
from fem_impact.scene.shipped import replace as changed
from fem_impact.solid.build import build
from fem_impact.solid.rodview import modes_of

# bending and longitudinal, Hz: Rayleigh-Ritz of the sharp-edged cylinder (torsion is antisymmetric)
REFERENCE = {0.24: [1526.3, 4092.1, 7728.6, 11000.3], 0.08: [12340.0, 28916.0, 32913.0]}


def _scene(length, across=8, tip=("plain", 0.0), tip_size=2.4e-3):
    base = load("t5b")
    kind, radius = tip
    return replace(
        base,
        measured=None,
        projectile=replace(base.projectile, length=length, tip=kind, tip_radius=radius),
        effects=("vibration", "barrier-rigid"),
        accuracy=replace(base.accuracy, tip_size=tip_size, across=across),
    )


def _model(*args, **kwargs):
    return build(Case.of(_scene(*args, **kwargs)))


def _modes(model, count=12):
    n = model.layout.rod_size
    return rod_modes(model.rod_stiffness, model.mass[:n], model.inverse_mass[:n] == 0, count)


@pytest.fixture(scope="module")
def long():
    model = _model(0.24)
    return model, _modes(model)


def test_frequencies_of_the_long_rod(long):
    assert long[1].frequency[:4] == pytest.approx(REFERENCE[0.24], rel=5e-3)


@pytest.mark.long
def test_runs_with_the_same_rod_find_its_modes_once():
    scene = changed(load("t5b"), "accuracy.tip_size", "1.2 mm")
    first, moved, longer = (
        modes_of(build(Case.of(s)))
        for s in (
            scene,
            changed(scene, "accuracy.grid_shift", 0.5),
            changed(scene, "projectile.length", "81 mm"),
        )
    )
    assert moved is first
    assert longer.omega[0] < 0.99 * first.omega[0]


def test_frequencies_of_the_short_rod():
    assert _modes(_model(0.08, across=12), 6).frequency[:3] == pytest.approx(REFERENCE[0.08], rel=5e-3)


@pytest.mark.slow
def test_frequencies_of_a_rod_of_320_diameters():
    """Its first bending is so slow that two corrections leave the rigid motions too near to it."""
    scene = _scene(6.0, across=6, tip_size=3.2e-3)
    assert _modes(build(Case.of(scene)), 40).omega[:2] == pytest.approx(
        bending_frequencies(scene.projectile)[:2], rel=5e-3
    )


def test_a_factor_that_is_too_large_is_refused(long, monkeypatch):
    def full(*_, **__):
        raise MemoryError

    model, _ = long
    n = model.layout.rod_size
    monkeypatch.setattr(eigen, "splu", full)
    with pytest.raises(RunError, match=r"too large\. Give a smaller accuracy\.across"):
        rod_modes(model.rod_stiffness, model.mass[:n], model.inverse_mass[:n] == 0, 5)


def test_a_banded_factor_gives_the_modes_of_a_sparse_one(long, monkeypatch):
    monkeypatch.setattr(eigen, "splu", None)
    monkeypatch.setattr(eigen, "MANY", 0)
    monkeypatch.setattr(eigen, "BAND", 100.0)
    assert _modes(long[0], 11).omega == pytest.approx(long[1].omega[:11], rel=1e-8)


def test_modes_are_orthonormal_and_solve_the_eigenproblem(long):
    model, modes = long
    n = model.layout.rod_size
    M = model.mass[:n]
    assert modes.shape.T @ (M[:, None] * modes.shape) == pytest.approx(np.eye(12), abs=1e-9)
    free = model.inverse_mass[:n] > 0
    left, right = model.rod_stiffness @ modes.shape, M[:, None] * modes.shape * modes.omega**2
    assert abs(left - right)[free].max() < 3e-6 * abs(right).max()
    assert not modes.shape[~free].any()


def test_modes_carry_no_rigid_momentum(long):
    model, modes = long
    places = model.layout.rod[~model.geometry.rod.mesh.is_hanging]
    x, m = model.start[0][places], model.mass[places[:, 0]]
    for i in range(12):
        motion = rigid_motion(x, modes.shape[:, i][places], m)
        scale = np.sqrt(m.sum())
        assert max(abs(motion.V_n), abs(motion.V_t), abs(motion.Omega) * 0.07) * scale < 1e-6


def test_a_held_rod_is_refused(long):
    model, _ = long
    n = model.layout.rod_size
    fixed = model.inverse_mass[:n] == 0
    fixed = fixed | (np.arange(n) == model.layout.rod[5, 2])
    with pytest.raises(RunError, match="three rigid motions"):
        rod_modes(model.rod_stiffness, model.mass[:n], fixed, 6)


def test_flight_of_a_known_vibration(long):
    model, modes = long
    a, b = np.random.default_rng(1).normal(size=(2, 12)) * 1e-6
    u, v = modes.shape @ a, modes.shape @ (modes.omega * b)
    ahead = flight(modes, v, -(model.rod_stiffness @ u))
    assert ahead.a == pytest.approx(a, rel=1e-6, abs=1e-12)
    assert ahead.b == pytest.approx(b, rel=1e-6, abs=1e-12)
    strain, kinetic = u @ (model.rod_stiffness @ u), model.mass[: len(v)] @ v**2  # whole rod: twice a half
    assert ahead.energy == pytest.approx(strain + kinetic, rel=1e-6)
    assert ahead.strain == pytest.approx(strain, rel=1e-6)
    assert ahead.energies.sum() == pytest.approx(ahead.energy)


def test_released_energy_is_that_of_all_shapes_whoever_knows_them(long):
    """Of 20 modes the last eight are beyond the twelve; a common acceleration releases nothing."""
    model, modes = long
    a = np.random.default_rng(3).normal(size=20) * 1e-6
    u = _modes(model, 20).shape @ a
    force = -(model.rod_stiffness @ u)
    strain = -u @ force  # whole rod: twice a half
    assert modes.released(force) == pytest.approx(strain, rel=1e-6)
    assert flight(modes, 0 * u, force).strain < 0.9 * strain
    along = model.layout.rod[~model.geometry.rod.mesh.is_hanging][:, [0, 2]]
    fall = np.zeros_like(u)
    fall[along] = 1e5 * modes.mass[along]
    assert modes.released(fall) < 1e-6 * strain


def test_flight_moves_as_the_rod_would(long):
    _, modes = long
    a, b = np.random.default_rng(2).normal(size=(2, 12)) * 1e-6
    ahead = replace(flight(modes, np.zeros(len(modes.mass)), np.zeros(len(modes.mass))), a=a, b=b)
    rows, h = np.arange(9), 1e-9
    u = ahead.displacement(rows, np.array([0.0, h, 3e-4]))
    assert u[:, 0] == pytest.approx(modes.shape[rows] @ a)
    assert (u[:, 1] - u[:, 0]) / h == pytest.approx(modes.shape[rows] @ (modes.omega * b), rel=1e-2, abs=1e-8)
    far = modes.shape[rows] @ (a * np.cos(modes.omega * 3e-4) + b * np.sin(modes.omega * 3e-4))
    assert u[:, 2] == pytest.approx(far)


def test_stress_in_balance_with_itself_does_not_vibrate(long):
    """Locked-in stress has no nodal force: a deformed rest shape counts for nothing."""
    _, modes = long
    size = len(modes.mass)
    assert flight(modes, np.zeros(size), np.zeros(size)).energy == 0.0


def test_rigid_motion_does_not_vibrate(long):
    model, modes = long
    n = model.layout.rod_size
    places = model.layout.rod[~model.geometry.rod.mesh.is_hanging]
    x = model.start[0][places]
    v = np.zeros(n)
    v[places[:, 0]], v[places[:, 2]] = -1.0 + 40 * x[:, 2], -2.0 - 40 * x[:, 0]
    kinetic = float(model.mass[:n] @ v**2)
    assert flight(modes, v, np.zeros(n)).energy < 1e-12 * kinetic


def test_rigid_sums():
    rng = np.random.default_rng(3)
    x, m = rng.normal(size=(50, 3)), rng.uniform(1, 2, 50)
    centre = m @ x / m.sum()
    arm = x - centre
    spin, V = 3.0, np.array([-1.0, 0.0, 2.0])
    # turning n towards t: d(t)/dt = Omega n, d(n)/dt = -Omega t
    v = V + spin * np.stack([arm[:, 2], 0 * arm[:, 0], -arm[:, 0]], axis=1)
    motion = rigid_motion(x, v, m)
    assert (motion.V_n, motion.V_t, motion.Omega) == pytest.approx((2.0, -1.0, 3.0))
    assert motion.mass == pytest.approx(2 * m.sum())
    assert motion.kinetic == pytest.approx(float(m @ (v**2).sum(axis=1)))
    noise = rng.normal(size=v.shape)
    rest = rigid_motion(x, v + noise, m)
    left = v + noise - [rest.V_t, 0, rest.V_n]
    left[:, 0] -= rest.Omega * arm[:, 2]
    left[:, 2] += rest.Omega * arm[:, 0]
    noise_b = m @ (v + noise)[:, 1] ** 2
    assert rest.kinetic <= float(m @ ((v + noise) ** 2).sum(axis=1)) - noise_b
    assert m @ (arm[:, 2] * left[:, 0] - arm[:, 0] * left[:, 2]) == pytest.approx(0.0, abs=1e-9)
