"""Contact on the rigid plane, node by node: arrival, cone, no pull, and the work that is booked."""

from types import SimpleNamespace

import numpy as np
import pytest
import solid_shapes as shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from fem_impact.fem.sliding import speed_table
from fem_impact.solid.contact.book import MERGE_GAP, ContactBook, StepRecord
from fem_impact.solid.contact.plane import PlaneContact, touch_plane
from fem_impact.solid.heatwatch import HeatWatch

DT = 2e-8


def _swarm(seed, count=40):
    rng = np.random.default_rng(seed)
    nodes = rng.permutation(3 * count).reshape(-1, 3)
    x, v, force = rng.normal(size=(3, 3 * count)) * np.array([[1e-3], [2.0], [300.0]])
    x[nodes[:, 2]] = rng.uniform(-1e-8, 6e-8, count)
    mass = np.empty(3 * count)
    mass[nodes] = rng.uniform(1e-6, 1e-5, (count, 1))
    inverse = 1 / mass
    mirror = nodes[: count // 4, 1]
    inverse[mirror], v[mirror], force[mirror] = 0.0, 0.0, 0.0
    before = v - DT * inverse * force
    return nodes, x, v, force, inverse, mass, before


@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.3, 1.5]))
@settings(max_examples=40, deadline=None)
def test_every_node_obeys_signorini_and_coulomb(seed, f):
    nodes, x, v, force, inverse, mass, _ = _swarm(seed)
    kicked = v.copy()
    step = touch_plane(nodes, x, v, force, inverse, DT, DT, np.full(len(nodes), f), speed_table(None))
    t, b, n = nodes.T
    p = (v - kicked) * mass
    p_n, p_t = p[n], np.hypot(p[t], p[b])
    held = p_n > 0
    assert (p_n >= 0).all()
    assert held.any() and not held.all()
    assert (x[n] + DT * v[n])[held] == pytest.approx(np.minimum(x[n], 0.0)[held], abs=1e-20)
    assert ((x[n] + DT * kicked[n])[~held] >= np.minimum(x[n], 0)[~held]).all()
    assert np.array_equal(v[nodes[~held]], kicked[nodes[~held]])
    assert (p_t <= f * p_n * (1 + 1e-12)).all()
    slip = np.hypot(v[t], v[b])
    slides = held & (slip > 1e-9)
    assert p_t[slides] == pytest.approx(f * p_n[slides], rel=1e-9)
    assert (p[t] * v[t] + p[b] * v[b] <= 1e-18).all()
    assert [step.impulse_t, step.impulse_n] == pytest.approx([p[t].sum(), p_n.sum()], rel=1e-9, abs=1e-18)
    assert step.moment == pytest.approx((x[t] * p_n - x[n] * p[t]).sum(), rel=1e-9, abs=1e-20)
    assert step.active == held.sum()


@given(st.integers(0, 10**6))
@settings(max_examples=20, deadline=None)
def test_booked_work_is_the_energy_that_is_missing(seed):
    """Kinetic energy gained = work of the forces - friction - closing, all with mean velocities."""
    nodes, x, v, force, inverse, mass, before = _swarm(seed)
    step = touch_plane(nodes, x, v, force, inverse, DT, DT, np.full(len(nodes), 0.4), speed_table(None))
    gained = 0.5 * (mass * (v**2 - before**2)).sum()
    worked = 0.5 * DT * (force * (v + before)).sum()
    assert step.friction > 0
    assert gained - worked == pytest.approx(-step.friction - step.closing, rel=1e-9)


def test_without_forces_nothing_is_created():
    nodes, x, v, force, inverse, mass, _ = _swarm(1, count=200)
    force[:] = 0.0
    before = v.copy()
    step = touch_plane(nodes, x, v, force, inverse, DT, DT, np.full(len(nodes), 0.4), speed_table(None))
    lost = 0.5 * (mass * (before**2 - v**2)).sum()
    assert lost == pytest.approx(step.friction + step.closing, rel=1e-12)
    assert min(step.friction, step.closing) > 0


@pytest.mark.parametrize(("f", "sticks"), [(0.2, False), (0.49, False), (0.51, True), (2.0, True)])
def test_one_node_sticks_or_slips(f, sticks):
    state = shapes.at_rest(np.zeros(3))
    state.v[:] = [-1.0, 0.0, -2.0]
    state.kick = state.dt_next = DT
    contact = PlaneContact(np.array([[0, 1, 2]]), np.full(3, 1e6), np.array([f]))
    contact.resolve(state)
    assert state.v == pytest.approx([0.0 if sticks else -1.0 + 2 * f, 0.0, 0.0], abs=1e-15)
    assert contact.book.intervals[0].impulse_n == pytest.approx(2 * 2e-6)  # both halves
    assert contact.book.intervals[0].impulse_t == pytest.approx(2 * min(f * 2, 1) * 1e-6)
    assert contact.energies(state)[1] == pytest.approx(2e-6)


def test_friction_turns_in_the_plane():
    nodes, v = np.array([[0, 1, 2]]), np.array([3.0, 4.0, -10.0])
    touch_plane(nodes, np.zeros(3), v, np.zeros(3), np.ones(3), DT, DT, np.array([0.1]), speed_table(None))
    assert v == pytest.approx([3.0 * 0.8, 4.0 * 0.8, 0.0])


def _touches(book, times):
    for time in times:
        book.close_step(StepRecord(impulse_t=0.5, impulse_n=1.0, closing=0.25, active=2), time)


def test_short_releases_are_one_contact():
    book = ContactBook()
    _touches(book, [0.0, 1e-6, 1e-6 + 0.9 * MERGE_GAP])
    _touches(book, [1e-4, 1.01e-4])
    assert [(i.start, i.end) for i in book.intervals] == [(0.0, 1e-6 + 0.9 * MERGE_GAP), (1e-4, 1.01e-4)]
    assert [i.impulse_n for i in book.intervals] == [6.0, 4.0]
    assert [i.impulse_t for i in book.intervals] == [3.0, 2.0]
    assert book.impulse == pytest.approx([2.5, 5.0, 0.0])
    assert book.closing == pytest.approx(1.25)
    assert book.touching
    book.close_step(StepRecord(), 2e-4)
    assert not book.touching
    assert len(book.intervals) == 2


def test_impulses_that_cancel_are_rubbed_all_the_same():
    nodes, v, f = np.arange(6).reshape(2, 3), np.array([3.0, 4.0, -2.0, -3.0, -4.0, -2.0]), 0.1
    rest = np.zeros(6)
    step = touch_plane(nodes, rest, v, rest, np.ones(6), DT, DT, np.full(2, f), speed_table(None))
    assert step.impulse_t == pytest.approx(0.0, abs=1e-15)
    assert step.rubbed == pytest.approx(f * step.impulse_n) == pytest.approx(0.4)


@pytest.mark.parametrize("opposed", [False, True])
def test_heat_over_what_was_rubbed_is_the_sliding_speed_of_the_nodes(opposed):
    """Two nodes at 5 m/s, held back by little: whether they slide one way or apart is no matter."""
    v, nodes, rest = np.array([3.0, 4.0, -0.1, 3.0, 4.0, -0.1]), np.arange(6).reshape(2, 3), np.zeros(6)
    v[3:5] *= -1.0 if opposed else 1.0
    book = ContactBook()
    watch = HeatWatch(SimpleNamespace(contact=None, book=book))
    watch.surface = SimpleNamespace(add=lambda state: None, close=lambda: 1e-8)
    step = touch_plane(nodes, rest, v, rest, np.ones(6), DT, DT, np.full(2, 0.2), speed_table(None))
    book.close_step(step, 1e-6)
    watch.observe(SimpleNamespace(time=1e-6))
    assert watch.speed == pytest.approx([5.0 - 0.5 * 0.2 * 0.1])
    assert watch.power == pytest.approx([2 * 0.2 * 0.2 * watch.speed[0] / 1e-6])


def test_a_shorter_gap_parts_contacts_that_a_longer_one_takes_as_one():
    book = ContactBook(gap=0.1 * MERGE_GAP)
    _touches(book, [0.0, 0.05 * MERGE_GAP, 0.9 * MERGE_GAP])
    assert len(book.intervals) == 2
