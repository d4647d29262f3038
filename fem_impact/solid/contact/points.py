"""The point contacts of one step: their search on both surfaces, their impulses and their work."""

from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.kernels import inlined, kernel
from fem_impact.fem.sliding import factor_at
from fem_impact.solid.contact.book import ContactBook, StepRecord
from fem_impact.solid.contact.impulses import relative, solve
from fem_impact.solid.contact.patch import bilinear, height_from, locate


class PointState(NamedTuple):
    """Positions, kicked velocities, the forces and step lengths of the kick, inverse masses."""

    x: Array
    v: Array
    force: Array
    inverse_mass: Array
    kick: float
    dt: float


class Points(NamedTuple):
    """Workspace of the point contacts of one step; the first ``count`` rows are in use.

    Attributes
    ----------
    nodes : (k, 5, 3) int64, unknowns of the five nodes; one with equal unknowns stands for a body's angle
    weights : (k, 5), signed
    normal : (k, 3); target : (k,) lowest normal rate, m/s; before : (k, 3) rates before the kick
    f : (k,) Coulomb coefficients; p : (k, 3) impulses on the rod, N s
    owner : (k,) slave node; memory : (slaves, 3) last impulses
    over_speed : factors of f, a `fem_impact.fem.sliding.speed_table`
    """

    nodes: Ints
    weights: Array
    normal: Array
    target: Array
    before: Array
    f: Array
    p: Array
    owner: Ints
    memory: Array
    over_speed: Array


def make_points(n: int, over_speed: Array) -> Points:
    """Return space for ``n`` slave nodes."""
    return Points(
        np.zeros((n, 5, 3), dtype=np.int64),
        np.zeros((n, 5)),
        np.zeros((n, 3)),
        np.zeros(n),
        np.zeros((n, 3)),
        np.zeros(n),
        np.zeros((n, 3)),
        np.zeros(n, dtype=np.int64),
        np.zeros((n, 3)),
        over_speed,
    )


@kernel
def _enter(k, slave, gap, band, motion, c):  # type: ignore[no-untyped-def]
    """Complete row k of the workspace; False when the pair stays apart in this step."""
    old_t, old_b, old_n = 0.0, 0.0, 0.0
    for a in range(5):
        t, b, n, s = c.nodes[k, a, 0], c.nodes[k, a, 1], c.nodes[k, a, 2], c.weights[k, a]
        old_t += s * (motion.v[t] - motion.kick * motion.inverse_mass[t] * motion.force[t])
        old_b += s * (motion.v[b] - motion.kick * motion.inverse_mass[b] * motion.force[b])
        old_n += s * (motion.v[n] - motion.kick * motion.inverse_mass[n] * motion.force[n])
    m, normal = c.memory[slave], c.normal[k]
    pressed = m[0] * normal[0] + m[1] * normal[1] + m[2] * normal[2] > 0.0
    allowed = 0.0 if pressed and gap <= band else max(gap, 0.0)
    rate = old_t * normal[0] + old_b * normal[1] + old_n * normal[2]
    # only pairs that can meet within a few steps take part in the sweeps
    if not pressed and allowed > 3.0 * motion.dt * max(-rate, 0.1):
        return False
    c.target[k] = -allowed / motion.dt
    slid = np.sqrt(max(old_t * old_t + old_b * old_b + old_n * old_n - rate * rate, 0.0))
    c.f[k] *= factor_at(slid, c.over_speed)
    c.before[k, 0], c.before[k, 1], c.before[k, 2] = old_t, old_b, old_n
    for i in range(3):
        c.p[k, i] = m[i] if pressed else 0.0
    c.owner[k] = slave
    return True


@inlined
def _join(c, k, a, places, weight):  # type: ignore[no-untyped-def]
    """Make a node with unknowns ``places`` (3,) number ``a`` of row k."""
    c.weights[k, a] = weight
    for i in range(3):
        c.nodes[k, a, i] = places[i]


@kernel
def rod_over_barrier(count, rod, f, barrier, normals, last, play, band, motion, c):  # type: ignore[no-untyped-def]
    """Append contacts of rod nodes more than ``play`` under barrier quads; ``f`` (rod nodes,) is Coulomb's.

    Returns the new number of contacts, and that of rod nodes below the surface that lie beside all quads.
    """
    x, top, outside = motion.x, 0.0, 0
    for i in range(len(barrier.places)):
        top = max(top, x[barrier.places[i, 2]])
    for i in range(len(rod.places)):
        n = x[rod.places[i, 2]]
        if n > top + band:
            continue
        t, b = x[rod.places[i, 0]], x[rod.places[i, 1]]
        q, xi, eta = locate(x, barrier.places, barrier.quads, barrier.neighbours, max(last[i], 0), t, b)
        if q < 0:
            outside += 1 if n < -band else 0
            continue
        last[i] = q
        w = bilinear(xi, eta)
        surface, n_t, n_b, n_n = 0.0, 0.0, 0.0, 0.0
        _join(c, count, 0, rod.places[i], 1.0)
        for a in range(4):
            node = barrier.quads[q, a]
            _join(c, count, a + 1, barrier.places[node], -w[a])
            surface += w[a] * x[barrier.places[node, 2]]
            n_t += w[a] * normals[node, 0]
            n_b += w[a] * normals[node, 1]
            n_n += w[a] * normals[node, 2]
        length = np.sqrt(n_t * n_t + n_b * n_b + n_n * n_n)
        c.normal[count, 0], c.normal[count, 1], c.normal[count, 2] = n_t / length, n_b / length, n_n / length
        c.f[count] = f[i]
        count += _enter(count, i, (n - surface) * c.normal[count, 2] + play, band, motion, c)
    return count, outside


@kernel
def over_plane(nodes, f, plane, motion, c):  # type: ignore[no-untyped-def]
    """Collect contacts of ``nodes`` (k, 3) with a plane of unknowns ``plane``; returns the number.

    ``f`` (k,) are the nodes' Coulomb coefficients.
    """
    x, count = motion.x, 0
    for i in range(len(nodes)):
        _join(c, count, 0, nodes[i], 1.0)
        _join(c, count, 1, plane, -1.0)
        for a in range(2, 5):
            _join(c, count, a, plane, 0.0)
        c.normal[count, 0], c.normal[count, 1], c.normal[count, 2] = 0.0, 0.0, 1.0
        c.f[count] = f[i]
        count += _enter(count, i, x[nodes[i, 2]] - x[plane[2]], 0.0, motion, c)
    return count


@kernel
def over_turning_plane(nodes, f, plane, turn, centre, motion, c):  # type: ignore[no-untyped-def]
    """Collect contacts of ``nodes`` (k, 3) with a plane that turns; returns the number.

    ``f`` (k,) are the nodes' Coulomb coefficients. ``plane`` (3,) and ``turn`` are the unknowns of its body's
    place and angle, ``centre`` (2,), m, is where that body's mass centre was at the start, when the plane was
    n = 0.
    """
    x, count, still = motion.x, 0, plane[1]
    s, cos = np.sin(x[turn]), np.cos(x[turn])
    for i in range(len(nodes)):
        t, n = x[nodes[i, 0]] - centre[0] - x[plane[0]], x[nodes[i, 2]] - centre[1] - x[plane[2]]
        _join(c, count, 0, nodes[i], 1.0)
        _join(c, count, 1, plane, -1.0)
        # the plane's spin moves it by n along t and by -t along n, where the impulse acts on both bodies
        _join(c, count, 2, (turn, still, still), -n)
        _join(c, count, 3, (still, still, turn), t)
        _join(c, count, 4, plane, 0.0)
        c.normal[count, 0], c.normal[count, 1], c.normal[count, 2] = s, 0.0, cos
        c.f[count] = f[i]
        count += _enter(count, i, t * s + n * cos + centre[1], 0.0, motion, c)
    return count


@inlined
def _reach(rod, x, height):  # type: ignore[no-untyped-def]
    """Return the box (t, t, b, b) around all rod quads that come down to ``height``."""
    low_t, high_t, low_b, high_b = np.inf, -np.inf, np.inf, -np.inf
    for q in range(len(rod.quads)):
        lowest = np.inf
        for a in range(4):
            lowest = min(lowest, x[rod.places[rod.quads[q, a], 2]])
        if lowest > height:
            continue
        for a in range(4):
            t, b = x[rod.places[rod.quads[q, a], 0]], x[rod.places[rod.quads[q, a], 1]]
            low_t, high_t, low_b, high_b = min(low_t, t), max(high_t, t), min(low_b, b), max(high_b, b)
    return low_t, high_t, low_b, high_b


@kernel
def barrier_under_rod(rod, f, rod_normals, barrier, normals, last, band, motion, c):  # type: ignore[no-untyped-def]
    """Collect contacts of barrier nodes with the rod's surface; returns their number.

    ``f`` (rod nodes,) are Coulomb coefficients, between which those of the places on a quad are weighted.
    """
    x, first, top, count = motion.x, len(rod.places), 0.0, 0
    for i in range(len(barrier.places)):
        top = max(top, x[barrier.places[i, 2]])
    low_t, high_t, low_b, high_b = _reach(rod, x, top + band + rod.sag)
    for i in range(len(barrier.places)):
        t, b, n = x[barrier.places[i, 0]], x[barrier.places[i, 1]], x[barrier.places[i, 2]]
        if t < low_t or t > high_t or b < low_b - band or b > high_b:
            continue
        q, xi, eta = locate(x, rod.places, rod.quads, rod.neighbours, max(last[first + i], 0), t, b)
        if q < 0:
            continue
        last[first + i] = q
        w = bilinear(xi, eta)
        surface, flat, n_t, n_b, n_n = 0.0, False, 0.0, 0.0, 0.0
        c.f[count] = 0.0
        for a in range(4):
            node = rod.quads[q, a]
            _join(c, count, a + 1, rod.places[node], w[a])
            c.f[count] += w[a] * f[node]
            flat = flat or rod.bend[node] == 0.0
            n_t += w[a] * rod_normals[node, 0]
            n_b += w[a] * rod_normals[node, 1]
            n_n += w[a] * rod_normals[node, 2]
            surface += w[a] * height_from(x, rod, rod_normals, node, t, b)
        _join(c, count, 0, barrier.places[i], -1.0)
        if flat:
            n_t, n_b, n_n = normals[i, 0], normals[i, 1], normals[i, 2]
        length = np.sqrt(n_t * n_t + n_b * n_b + n_n * n_n)
        c.normal[count, 0], c.normal[count, 1], c.normal[count, 2] = n_t / length, n_b / length, n_n / length
        count += _enter(count, first + i, (surface - n) * c.normal[count, 2], band, motion, c)
    return count


def settle(
    count: int, motion: PointState, c: Points, book: ContactBook, time: float, outside: int = 0
) -> None:
    """Solve the impulses of the collected contacts, book their work and close the step."""
    if count:
        solve(count, motion.v, motion.inverse_mass, c.nodes, c.weights, c.normal, c.target, c.f, c.p)
    book.close_step(work_of_points(count, motion, c, outside), time)


@kernel
def work_of_points(count, motion, c, outside):  # type: ignore[no-untyped-def]
    """Return the step's record of the impulses on the rod and their work; remember the impulses."""
    x = motion.x
    impulse_t, impulse_n, moment, friction, closing, rubbed, active = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    c.memory[:, :] = 0.0
    for k in range(count):
        t, b, n = relative(motion.v, c.nodes[k], c.weights[k])
        m_t, m_b, m_n = 0.5 * (c.before[k, 0] + t), 0.5 * (c.before[k, 1] + b), 0.5 * (c.before[k, 2] + n)
        p, normal = c.p[k], c.normal[k]
        pressed = p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2]
        stopping = pressed * (m_t * normal[0] + m_b * normal[1] + m_n * normal[2])
        closing -= stopping
        friction -= p[0] * m_t + p[1] * m_b + p[2] * m_n - stopping
        impulse_t += p[0]
        impulse_n += p[2]
        rubbed += np.sqrt(max(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - pressed * pressed, 0.0))
        active += 1 if pressed > 0.0 else 0
        for a in range(5):
            i, j, l = c.nodes[k, a]
            angle = i == j or j == l
            if c.weights[k, a] > 0.0 and not angle:
                at_t, at_n = x[c.nodes[k, a, 0]], x[c.nodes[k, a, 2]]
                moment += c.weights[k, a] * (at_t * p[2] - at_n * p[0])
        for i in range(3):
            c.memory[c.owner[k], i] = p[i]
    return StepRecord(impulse_t, impulse_n, moment, friction, closing, rubbed, active, outside)
