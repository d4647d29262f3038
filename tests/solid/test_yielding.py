"""The yielding zone: stiffness at rest, objectivity, closed forms, work, and the flow curve."""

from dataclasses import replace

import numba
import numpy as np
import pytest
import solid_shapes as shapes

from fem_impact.fem.elements import element_stiffness, lame_constants
from fem_impact.fem.hexmodes import LANES, dummy_element
from fem_impact.physics.hardening import (
    CowperSymonds,
    JohnsonCook,
    PowerLaw,
    TabulatedHardening,
    linear_hardening,
    power_hardening,
)
from fem_impact.solid.plastic_return import RETURN_ROWS, _hardened_increment, return_map
from fem_impact.solid.yielding import YieldingZone

E, NU = shapes.E, shapes.NU
LAME, G = lame_constants(E, NU)
BULK = LAME + 2 * G / 3
HARD = linear_hardening(1e12, 0.0)  # never yields
DT = 1e-8


@numba.njit
def increment(q, flow, strain, law, rate, dt):
    return _hardened_increment(q, flow, strain, 3 * G, law, rate, dt)


class Rig:
    """A yielding zone whose nodes are led by hand."""

    def __init__(self, points, cells, law=HARD, full=False):
        n = len(points)
        self.places = np.arange(3 * n).reshape(-1, 3)
        self.dummy = 3 * n + np.arange(24).reshape(8, 3)
        x = np.concatenate([points.ravel(), dummy_element().ravel()])
        self.state = shapes.at_rest(x)
        self.zone = YieldingZone.of("rod", self.places[cells], points[cells], E, NU, law, self.dummy, full)
        self.state.dt = DT
        self.work = 0.0
        self.force = np.zeros((n, 3))

    @property
    def points(self):
        return self.state.x[self.places]

    def lead(self, points):
        """Move the nodes to new places and return the nodal forces of the elements on them."""
        step = (points - self.points).ravel()
        self.state.v[: step.size] = step / DT
        self.state.x[: step.size] += step
        self.state.force[:] = 0.0
        self.zone.add(self.state)
        now = -self.state.force[self.places]
        self.work += 0.5 * float(((self.force + now) * step.reshape(-1, 3)).sum())
        self.force = now
        return now

    def plastic_work(self):
        return self.zone.energies(self.state)[1]

    def energy(self):
        return self.zone.energies(self.state)[0]

    def stress(self):
        """Kirchhoff deviators of the true elements: (m, 8 points, 6)."""
        s = self.zone.blocks.stress.reshape(-1, 8, 6, LANES).transpose(0, 3, 1, 2)
        return s.reshape(-1, 8, 6)[: self.zone.count]

    def flat(self, name):
        """Point values (m, 8) of the true elements."""
        return getattr(self.zone.blocks, name).transpose(0, 2, 1).reshape(-1, 8)[: self.zone.count]


def mises(s):
    return np.sqrt(1.5 * (s[..., :3] ** 2).sum(axis=-1) + 3 * (s[..., 3:] ** 2).sum(axis=-1))


def turn(axis, angle):
    k = np.asarray(axis) / np.linalg.norm(axis)
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


@pytest.mark.parametrize("kind", ["bbar", "full"])
@pytest.mark.parametrize("counts", [(1, 1, 1), (3, 3, 2)])
def test_small_increments_see_the_stiffness_of_their_element(counts, kind):
    points, cells = shapes.distorted(counts, 0.2, seed=1)
    rig = Rig(points, cells, full=kind == "full")
    u = 1e-9 * np.random.default_rng(2).normal(size=points.shape) * 1e-3
    force = rig.lead(points + u)
    K = shapes.dense(element_stiffness(points, cells, lame_constants(E, NU), kind), cells)
    exact = (K @ u.ravel()).reshape(-1, 3)
    assert abs(force - exact).max() < 1e-5 * abs(exact).max()
    assert rig.energy() == pytest.approx(0.5 * u.ravel() @ K @ u.ravel(), rel=1e-5)


def test_volumes_are_exact():
    points, cells = shapes.distorted((3, 2, 3), 0.2, seed=3)
    rig = Rig(points, cells)
    before = np.array([shapes.volume(points[c]) for c in cells])
    assert rig.zone.blocks.volume.ravel()[: len(cells)] == pytest.approx(before, rel=1e-12)
    assert rig.flat("weight").sum(axis=1) == pytest.approx(before, rel=1e-12)
    moved = shapes.distorted((3, 2, 3), 0.25, seed=4)[0]
    rig.lead(moved)
    J = np.array([shapes.volume(moved[c]) for c in cells]) / before
    assert abs(J - 1).max() > 0.1
    assert rig.zone.blocks.pressure.ravel()[: len(cells)] == pytest.approx(BULK * np.log(J) / J, rel=1e-9)


@pytest.mark.parametrize("axis", [(0, 1, 0), (1, 2, -0.5)])
def test_turning_an_unstressed_element_leaves_it_unstressed(axis):
    points, cells = shapes.distorted((1, 1, 1), 0.2, seed=5)
    rig = Rig(points, cells)
    for k in range(1, 101):
        rig.lead(points @ turn(axis, 0.01 * k).T)
    # one step of 0.01 rad without reference to its middle would leave 2 G 5e-5
    assert mises(rig.stress()).max() < 2 * G * 1e-6
    assert abs(rig.zone.blocks.pressure.ravel()[0]) < 1e-12 * BULK


def test_turning_a_stressed_element_turns_its_stress_with_it():
    points, cells = shapes.grid((1, 1, 1), 1e-3)
    rig = Rig(points, cells)
    H = np.array([[1.0, 0.4, 0.0], [0.0, -0.3, 0.2], [0.5, 0.0, 0.2]]) * 1e-3
    stretched = points @ (np.eye(3) + H).T
    before = rig.lead(stretched).copy()
    size, energy = mises(rig.stress()).copy(), rig.energy()
    axis, angle, steps = (1.0, 2.0, -0.5), np.pi / 2, 6000
    for k in range(1, steps + 1):
        after = rig.lead(stretched @ turn(axis, angle * k / steps).T)
    # a turn to first order adds the square of a step's angle with every step: 3e-4 in all
    assert mises(rig.stress()) == pytest.approx(size, rel=1e-8)
    assert rig.energy() == pytest.approx(energy, rel=1e-8)
    assert abs(after - before @ turn(axis, angle).T).max() < 1e-6 * abs(before).max()


def test_an_element_that_rocks_keeps_neither_stress_nor_energy():
    """Stretch and spin in phase, 8 steps a cycle, as cells ring."""
    points, cells = shapes.grid((1, 1, 1), 1e-3)
    rig, shear = Rig(points, cells), 2e-3
    rocking, energies = np.outer([1, 2, -2], [2, 1, 2]) / 9, []  # a shear, skew to the element
    for k in range(1, 801):
        rig.lead(points + shear * np.sin(2 * np.pi * k / 8) * points @ rocking.T)
        energies.append(rig.energy())
    # where the spin turns the stress before the step, 23 % of it and 5 % of the energy stay, of no work
    assert mises(rig.stress()).max() < 1e-9 * np.sqrt(3) * G * shear
    assert rig.energy() < 1e-9 * energies[1]
    assert abs(rig.work) < 1e-9 * energies[1]


def _compress(rig, strain, steps):
    """Confined compression along n by a logarithmic strain; returns the axial force on the top."""
    points = rig.points.copy()
    for k in range(1, steps + 1):
        force = rig.lead(points * [1, 1, np.exp(-strain * k / steps)])
    return force[np.isclose(points[:, 2], points[:, 2].max()), 2].sum()


RATE = JohnsonCook(C=0.05, slowest=2.0)
FACTORS = {
    RATE: lambda rate: 1 + 0.05 * np.log(rate / 2.0),
    CowperSymonds(3200.0, 5.0): lambda rate: 1 + (rate / 3200.0) ** 0.2,
}


@pytest.mark.parametrize("modulus", [0.0, 5e9])
def test_confined_compression_against_the_closed_form(modulus):
    h, law, e = 1e-3, linear_hardening(300e6, modulus), 0.05
    rig = Rig(*shapes.grid((1, 1, 1), h), law)
    force = _compress(rig, e, 400)
    plastic = (2 * G * e - 300e6) / (3 * G + modulus)
    flow = 300e6 + modulus * plastic
    assert rig.flat("strain") == pytest.approx(plastic, rel=1e-4)
    assert mises(rig.stress()) == pytest.approx(flow, rel=1e-4)
    assert force == pytest.approx(-(BULK * e + 2 / 3 * flow) * np.exp(e) * h**2, rel=1e-4)
    assert rig.plastic_work() == pytest.approx((300e6 + flow) / 2 * plastic * h**3, rel=1e-4)


CORNERED = TabulatedHardening(((0.0, 300e6), (0.01, 301e6), (0.02, 420e6), (0.03, 430e6)))


@pytest.mark.parametrize("rate", [None, RATE])
@pytest.mark.parametrize(
    "strain", [pytest.param(0.012, marks=pytest.mark.long), 0.025, pytest.param(0.08, marks=pytest.mark.long)]
)
def test_confined_compression_along_a_table(strain, rate):
    """However many corners were passed, the flow stress is that of the table at the plastic strain."""
    h, steps = 1e-3, 400
    rig = Rig(*shapes.grid((1, 1, 1), h), replace(CORNERED, rate=rate))
    _compress(rig, strain, steps)
    plastic = rig.flat("strain")
    cold = np.interp(plastic, *np.transpose(CORNERED.points))
    assert rig.flat("flow") == pytest.approx(cold, rel=1e-9)
    factor = (2 * G * strain / plastic - 3 * G) * plastic / cold
    dp = plastic / (steps * DT)  # mean rate; on the flat end it is that of the last step too
    near = 1.0 if rate is None else FACTORS[RATE](dp)
    assert factor == pytest.approx(near, rel=2e-4 if rate is None else 0.02)


def test_a_table_of_one_line_is_linear_hardening():
    h, law = 1e-3, linear_hardening(300e6, 5e9)
    line = TabulatedHardening(((0.0, 300e6), (0.5, 300e6 + 0.5 * 5e9), (1.0, 300e6 + 5e9)))
    forces = []
    for one in (law, line):
        rig = Rig(*shapes.grid((1, 1, 1), h), replace(one, rate=RATE))
        forces.append(_compress(rig, 0.05, 100))
    assert forces[1] == pytest.approx(forces[0], rel=1e-9)


def test_confined_compression_before_yield():
    h = 1e-3
    rig = Rig(*shapes.grid((1, 1, 1), h), linear_hardening(300e6, 5e9))
    assert _compress(rig, 1e-3, 20) == pytest.approx(-(LAME + 2 * G) * 1e-3 * np.exp(1e-3) * h**2, rel=1e-6)
    assert rig.plastic_work() == 0.0
    assert rig.flat("strain").max() == 0.0


@pytest.mark.long
@pytest.mark.parametrize("rate", FACTORS)
@pytest.mark.parametrize("modulus", [0.0, 5e9])
def test_confined_compression_at_a_constant_rate(modulus, rate):
    """Once the flow is steady, p' = 2 G e' / (3 G + H factor), so the factor is known in closed form."""
    h, e, steps = 1e-3, 0.05, 400
    rig = Rig(*shapes.grid((1, 1, 1), h), replace(linear_hardening(300e6, modulus), rate=rate))
    force, factor_at = _compress(rig, e, steps), FACTORS[rate]
    factor = factor_at(2 / 3 * e / (steps * DT))
    factor = factor_at(2 * G * e / (steps * DT) / (3 * G + modulus * factor))
    plastic = rig.flat("strain")
    assert plastic == pytest.approx((2 * G * e - 300e6 * factor) / (3 * G + modulus * factor), rel=2e-4)
    flow = (300e6 + modulus * plastic) * factor
    assert mises(rig.stress()) == pytest.approx(flow, rel=2e-4)
    assert force == pytest.approx(-(BULK * e + 2 / 3 * flow.mean()) * np.exp(e) * h**2, rel=2e-4)


def test_strip_pulled_at_a_constant_rate():
    """Uniaxial stress: sigma = sigma_y (1 + C ln(e' / slowest)), the sides free of force."""
    h, e, steps = 1e-3, 0.02, 400
    rate = e / (steps * DT)
    sigma = 300e6 * FACTORS[RATE](rate)
    rig = Rig(*shapes.grid((1, 1, 1), h), replace(linear_hardening(300e6, 0.0), rate=RATE))
    start = rig.points.copy()
    for k in range(1, steps + 1):
        along = e * k / steps
        stress = min(E * along, sigma)
        sides = -NU * stress / E - 0.5 * (along - stress / E)
        force = rig.lead(start * np.exp([sides, sides, along]))
    top, side = np.isclose(start[:, 2], h), np.isclose(start[:, 0], h)
    assert force[top, 2].sum() == pytest.approx(sigma * h**2 * np.exp(-e), rel=1e-3)
    assert abs(force[side, 0].sum()) < 1e-3 * sigma * h**2


LAWS = pytest.mark.parametrize(
    "rate", [JohnsonCook(0.022), CowperSymonds(40.4, 5.0), CowperSymonds(6844.0, 3.91)]
)


POWER = PowerLaw(320e6, 640.0, 0.1)


def flow_stress(law, strain):
    return law.yield_stress * (1 + law.slope * strain) ** law.exponent


@LAWS
@pytest.mark.parametrize("over", np.logspace(-9, -1, 17))
def test_the_increment_obeys_its_law_however_far_the_trial_is_out(over, rate):
    """The stress returned is that of the trial less 3 G dp, and that of the law at the rate dp/dt."""
    law, flow, dt = POWER, 400e6, 2.5e-8
    strain = ((flow / law.yield_stress) ** (1 / law.exponent) - 1) / law.slope
    q = flow * (1 + over)
    dp, new, slow = increment(q, flow, strain, law, rate, dt)
    assert new == pytest.approx(q - 3 * G * dp, rel=1e-10)
    assert slow == pytest.approx(flow_stress(law, strain + dp), rel=1e-10)
    assert new == pytest.approx(slow * rate.factor(dp / dt), rel=1e-10)


@LAWS
@pytest.mark.parametrize("strain", [0.0, 0.02, 1.0])
def test_lanes_together_return_like_one_alone(strain, rate):
    """Elastic, slow, usual and far trials side by side; the mean stress does the work of the increment."""
    law, dt = POWER, 2.5e-8
    yield_stress = flow_stress(law, strain)
    q = yield_stress * (1 + np.array([-0.5, -1e-12, *np.logspace(-12, 0, LANES - 2)]))
    stress, rotated = np.zeros((6, LANES)), np.zeros((6, LANES))
    stress[3], rotated[3] = q / np.sqrt(3), 0.9 * q / np.sqrt(3)  # shear
    flow, strains, work = np.full(LANES, yield_stress), np.full(LANES, strain), np.zeros(LANES)
    room, weight = np.zeros(RETURN_ROWS * LANES), np.full(LANES, 2e-12)
    flat = stress.ravel()
    return_map(room, q**2, rotated.ravel(), flat, weight, flow, strains, work, 3 * G, law, rate, dt)
    for l in range(LANES):
        alone = 0.0, q[l], yield_stress
        if l > 1:
            alone = increment(q[l], yield_stress, strain, law, rate, dt)
        assert strains[l] - strain == pytest.approx(alone[0], rel=1e-9, abs=4e-16)
        assert flat[3 * LANES + l] * np.sqrt(3) == pytest.approx(alone[1], rel=1e-12)
        assert flow[l] == pytest.approx(alone[2], rel=1e-12)
        assert work[l] == pytest.approx(0.5 * (alone[1] + 0.9 * q[l]) * alone[0] * 2e-12, rel=1e-9)


def test_below_the_slowest_rate_the_factor_is_one():
    law, slow = power_hardening(E, 300e6, 450e6), JohnsonCook(C=0.05, slowest=1e9)
    assert np.array_equal(_wander(law, 0.004).force, _wander(replace(law, rate=slow), 0.004).force)


def test_work_closes_with_rate_hardening():
    rig = _wander(replace(linear_hardening(300e6, 5e9), rate=RATE), 0.004, steps=600)
    assert rig.plastic_work() > 10 * rig.energy() > 0
    assert rig.work == pytest.approx(rig.energy() + rig.plastic_work(), rel=1e-3)


def _wander(law, amplitude, steps=300, seed=6, counts=(2, 1, 1), full=False):
    """Lead the nodes along a smooth closed random path."""
    points, cells = shapes.distorted(counts, 0.15, seed=seed)
    rig, rng = Rig(points, cells, law, full), np.random.default_rng(seed)
    a, b = rng.normal(size=(2, *points.shape)) * amplitude * 1e-3
    for k in range(1, steps + 1):
        s = 2 * np.pi * k / steps
        rig.lead(points + a * np.sin(s) + b * (1 - np.cos(s)))
    return rig


@pytest.mark.parametrize("full", [False, True])
def test_work_of_the_forces_is_elastic_energy_plus_plastic_work(full):
    rig = _wander(linear_hardening(300e6, 5e9), 0.004, steps=600, full=full)
    assert rig.plastic_work() > 10 * rig.energy() > 0
    assert rig.work == pytest.approx(rig.energy() + rig.plastic_work(), rel=1e-3)


def test_elastic_path_gives_everything_back():
    rig = _wander(HARD, 0.0005)
    assert rig.plastic_work() == 0.0
    assert mises(rig.stress()).max() < 1e-5 * G  # closed path
    half = Rig(*shapes.distorted((2, 1, 1), 0.15, seed=6))
    assert abs(rig.work) < 1e-3 * _stretched_energy(half)


def _stretched_energy(rig):
    rng = np.random.default_rng(6)
    rig.lead(rig.points + rng.normal(size=rig.points.shape) * 0.0005e-3)
    return rig.energy()


def test_plastic_flow_is_isochoric():
    rig = _wander(linear_hardening(300e6, 5e9), 0.01, steps=400)
    assert rig.flat("strain").min() > 0.01
    points, cells = shapes.distorted((2, 1, 1), 0.15, seed=6)
    before = np.array([shapes.volume(points[c]) for c in cells])
    rig.lead(points + 0.02e-3 * np.random.default_rng(7).normal(size=points.shape))
    after = np.array([shapes.volume(rig.points[c]) for c in cells])
    # all change of volume is elastic, whatever was squeezed before
    assert rig.zone.blocks.pressure.ravel()[:2] == pytest.approx(
        BULK * np.log(after / before) * before / after, rel=1e-9
    )
    assert abs(rig.stress()[..., :3].sum(axis=-1)).max() < 1e-9 * mises(rig.stress()).max()


def test_flow_stress_stays_on_the_power_law():
    law = power_hardening(E, 300e6, 450e6)
    rig = _wander(law, 0.02, steps=200)
    strain, flow = rig.flat("strain"), rig.flat("flow")
    assert strain.min() > 0.05
    assert flow == pytest.approx(law.flow_stress(strain), rel=1e-10)
    assert (mises(rig.stress()) <= flow * (1 + 1e-9)).all()
    straight = Rig(*shapes.grid((1, 1, 1), 1e-3), law)
    _compress(straight, 0.1, 50)
    assert mises(straight.stress()) == pytest.approx(law.flow_stress(straight.flat("strain")), rel=1e-10)


def test_one_large_increment_returns_to_the_curve():
    law = power_hardening(E, 300e6, 450e6)
    rig = Rig(*shapes.grid((1, 1, 1), 1e-3), law)
    rig.lead(rig.points * [1.04, 1, 1])
    assert rig.flat("strain").min() > 0.02
    assert mises(rig.stress()) == pytest.approx(law.flow_stress(rig.flat("strain")), rel=1e-9)


def test_padding_is_inert():
    points, cells = shapes.distorted((LANES + 1, 1, 1), 0.1, seed=8)
    moved = points + 5e-6 * np.random.default_rng(9).normal(size=points.shape)
    law = linear_hardening(300e6, 5e9)
    rig = Rig(points, cells, law)
    rig.lead(moved)
    assert abs(rig.state.force[rig.dummy]).max() == 0.0
    alone = [Rig(points, cells[i : i + 1], law) for i in range(len(cells))]
    force = sum(one.lead(moved) for one in alone)
    assert rig.force == pytest.approx(force, rel=1e-10, abs=1e-10 * abs(force).max())
    assert [rig.energy(), rig.plastic_work()] == pytest.approx(
        [sum(one.energy() for one in alone), sum(one.plastic_work() for one in alone)], rel=1e-12
    )
    assert rig.zone.plastic_strain().shape == rig.zone.mises().shape == (LANES + 1,)


def test_forces_are_in_balance():
    rig = _wander(linear_hardening(300e6, 5e9), 0.01, steps=50)
    size = abs(rig.force).max()
    assert abs(rig.force.sum(axis=0)).max() < 1e-9 * size
    assert abs(np.cross(rig.points, rig.force).sum(axis=0)).max() < 1e-9 * size * 1e-3


def test_reported_fields_belong_to_their_elements():
    points, cells = shapes.grid((3, 1, 1), 1e-3)
    rig = Rig(points, cells, linear_hardening(300e6, 0.0))
    push = np.where(points[:, :1] > 2.5e-3, 0.01, 0.0)  # only the last element is stretched
    rig.lead(points + 1e-3 * push * [1, 0, 0])
    assert rig.zone.plastic_strain()[:2] == pytest.approx(0.0, abs=1e-15)
    assert rig.zone.plastic_strain()[2] == pytest.approx(rig.flat("strain")[2].mean())
    assert rig.zone.mises()[2] == pytest.approx(300e6, rel=1e-9)
