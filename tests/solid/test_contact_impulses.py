"""Coupled contact impulses: Signorini and Coulomb at every contact, momentum, closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fem_impact.fem.sliding import speed_table
from fem_impact.solid.contact.book import ContactBook
from fem_impact.solid.contact.impulses import MOST_SWEEPS, push, relative, solve
from fem_impact.solid.contact.patch import bilinear
from fem_impact.solid.contact.points import PointState, make_points, settle


def system(seed, count=8, tilt=0.2, masters=12):
    """Contacts of own slave nodes with quads drawn from a common pool, as two passes make them."""
    rng = np.random.default_rng(seed)
    size = 3 * (count + masters)
    pool = count + np.arange(masters)
    nodes = np.empty((count, 5, 3), dtype=np.int64)
    weights = np.empty((count, 5))
    for k in range(count):
        chosen = rng.choice(pool, 4, replace=False)
        nodes[k] = 3 * np.array([k, *chosen])[:, None] + np.arange(3)
        weights[k] = [1.0, *(-np.array(bilinear(*rng.uniform(-1, 1, 2))))]
    weights *= rng.choice([-1.0, 1.0], (count, 1)) if seed % 2 else 1.0
    inverse = np.repeat(1 / rng.uniform(0.5, 2.0, count + masters), 3)
    inverse[3 * rng.choice(pool, 3, replace=False) + 1] = 0.0  # symmetry plane
    normal = np.column_stack([rng.uniform(-tilt, tilt, (count, 2)), np.ones(count)])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    v = rng.normal(size=size)
    v[inverse == 0] = 0.0
    target = -rng.uniform(0, 0.5, count)
    return nodes, weights, inverse, normal, target, v


@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.2, 0.7]))
@settings(max_examples=60, deadline=None)
def test_signorini_and_coulomb_hold_at_every_contact(seed, f):
    nodes, s, inverse, normal, target, v = system(seed)
    before, p = v.copy(), np.zeros((len(s), 3))
    sweeps = solve(len(s), v, inverse, nodes, s, normal, target, np.full(len(s), f), p)
    assert sweeps < MOST_SWEEPS
    size = abs(p).max() + 1e-12
    exact = before.copy()
    for k in range(len(s)):
        np.add.at(exact, nodes[k].ravel(), (inverse[nodes[k]] * s[k][:, None] * p[k]).ravel())
    assert v == pytest.approx(exact, abs=1e-9 * size)
    for k in range(len(s)):
        rel = np.array(relative(v, nodes[k], s[k]))
        rate, pressed = rel @ normal[k], p[k] @ normal[k]
        slip, drag = rel - rate * normal[k], p[k] - pressed * normal[k]
        assert rate >= target[k] - 1e-6 * size
        assert pressed >= -1e-12
        assert pressed * (rate - target[k]) == pytest.approx(0.0, abs=1e-6 * size**2)
        assert np.linalg.norm(drag) <= f * pressed + 1e-9 * size
        slip[1] = 0.0 if (inverse[nodes[k, :, 1]] == 0).any() else slip[1]
        if pressed > 1e-6 * size and np.linalg.norm(slip) > 1e-4 * size:
            assert np.linalg.norm(drag) == pytest.approx(f * pressed, rel=1e-4, abs=1e-7 * size)
            assert drag @ slip <= 1e-9


@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.5]))
@settings(max_examples=40, deadline=None)
def test_momentum_of_two_bodies_is_kept_and_energy_never_made(seed, f):
    nodes, s, inverse, normal, _, v = system(seed)
    inverse[:] = np.repeat(inverse[::3], 3)
    v[nodes[0, 0, 2]] = -8.0 * s[0, 0]  # one pair at least closes
    mass, before = 1 / inverse, v.copy()
    solve(len(s), v, inverse, nodes, s, normal, np.zeros(len(s)), np.full(len(s), f), np.zeros((len(s), 3)))
    gained = (mass * (v - before)).reshape(-1, 3).sum(axis=0)
    assert gained == pytest.approx(0.0, abs=1e-12)
    assert abs(v - before).max() > 1e-3
    assert (mass * v**2).sum() <= (mass * before**2).sum() * (1 + 1e-9)


def _block(v, f, normal=(0.0, 0.0, 1.0), inverse=2.0, target=0.0):
    """One node on an immovable quad."""
    v = np.concatenate([v, np.zeros(12)])
    masses = np.concatenate([np.full(3, inverse), np.zeros(12)])
    nodes = np.arange(15).reshape(1, 5, 3)
    p = np.zeros((1, 3))
    s = np.array([[1.0, -0.25, -0.25, -0.25, -0.25]])
    solve(1, v, masses, nodes, s, np.array([normal]), np.array([target]), np.array([f]), p)
    return v[:3], p[0]


@pytest.mark.parametrize(("f", "left"), [(0.0, 3.0), (0.3, 1.8), (0.74, 0.04), (0.76, 0.0), (5.0, 0.0)])
def test_one_block_slips_or_sticks(f, left):
    v, p = _block([3.0, 0.0, -4.0], f)
    assert v == pytest.approx([left, 0.0, 0.0], abs=1e-12)
    assert p == pytest.approx([(left - 3.0) / 2, 0.0, 2.0])


def test_one_block_on_a_slope():
    c, s = np.cos(0.3), np.sin(0.3)
    v, p = _block([1.0, 0.0, -2.0], 0.1, (-s, 0.0, c))
    pressed = (2 * c + s) / 2
    along = np.array([c, 0.0, s])
    assert p == pytest.approx(pressed * np.array([-s, 0, c]) - 0.1 * pressed * along)
    assert v @ [-s, 0.0, c] == pytest.approx(0.0, abs=1e-12)


def test_an_allowed_gap_may_close():
    v, p = _block([0.0, 0.0, -2.0], 0.3, target=-0.5)
    assert v == pytest.approx([0.0, 0.0, -0.5])
    v, p = _block([0.0, 0.0, -0.4], 0.3, target=-0.5)
    assert not p.any()


def test_a_good_guess_is_kept_and_a_bad_one_let_go():
    nodes, s, inverse, normal, target, v = system(5)
    cold, p = v.copy(), np.zeros((len(s), 3))
    sweeps = solve(len(s), cold, inverse, nodes, s, normal, target, np.full(len(s), 0.3), p)
    warm = v.copy()
    assert solve(len(s), warm, inverse, nodes, s, normal, target, np.full(len(s), 0.3), p) < sweeps
    assert warm == pytest.approx(cold, abs=1e-8)
    parted = np.abs(v)  # rod nodes leave upwards: nothing may stick
    parted[3 * len(s) :] = 0.0
    start, guess = parted.copy(), np.full((len(s), 3), 0.1)
    solve(
        len(s),
        parted,
        inverse,
        nodes,
        np.abs(s) * np.sign([1, -1, -1, -1, -1]),
        np.tile([0.0, 0, 1], (len(s), 1)),
        target,
        np.full(len(s), 0.3),
        guess,
    )
    assert not guess.any()
    assert parted == pytest.approx(start, abs=1e-12)


def test_push_and_relative_are_adjoint():
    rng = np.random.default_rng(6)
    nodes, s = np.arange(15).reshape(5, 3), rng.normal(size=5)
    v, p = rng.normal(size=15), rng.normal(size=3)
    w = np.zeros(15)
    push(w, np.ones(15), nodes, s, *p)
    assert np.array(relative(v, nodes, s)) @ p == pytest.approx(v @ w)


def _apart(slope, f):
    """Let two nodes slide apart over immovable quads that lean both ways; return the book of the step."""
    points, v = make_points(2, speed_table(None)), np.zeros(30)
    v[:3], v[15:18] = [3.0, 0.0, -1.0], [-3.0, 0.0, -1.0]
    inverse = np.concatenate([np.ones(3), np.zeros(12), np.ones(3), np.zeros(12)])
    points.nodes[:] = np.arange(30).reshape(2, 5, 3)
    points.weights[:] = [1.0, -0.25, -0.25, -0.25, -0.25]
    points.normal[:] = np.array([[-slope, 0.0, 1.0], [slope, 0.0, 1.0]]) / np.hypot(1.0, slope)
    points.before[:], points.f[:], points.owner[:] = [v[:3], v[15:18]], f, [0, 1]
    book, motion = ContactBook(), PointState(np.zeros(30), v, np.zeros(30), inverse, 1e-8, 1e-8)
    settle(2, motion, points, book, 1e-8)
    return book


@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_friction_of_contacts_that_slide_apart_does_not_cancel(slope):
    book, f = _apart(slope, 0.1), 0.1
    assert book.step.impulse_t == pytest.approx(0.0, abs=1e-15) and book.step.active == 2
    length = np.hypot(1.0, slope)
    pressed, along = (1.0 + 3.0 * slope) / length, (3.0 - slope) / length
    assert book.step.rubbed == pytest.approx(2 * f * pressed)
    assert book.friction / book.step.rubbed == pytest.approx(along - 0.5 * f * pressed)
    assert _apart(slope, 0.0).step.rubbed == pytest.approx(0.0, abs=1e-7)
