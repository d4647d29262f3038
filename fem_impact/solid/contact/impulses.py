"""Coulomb contact impulses of many coupled point contacts, by projected Gauss-Seidel sweeps.

A point contact k joins five nodes with signed weights s: +1 or shape functions on the rod, minus those
on the barrier. Its relative velocity is sum(s v), an impulse p changes node velocities by s p / m.
"""

import numpy as np

from fem_impact.fem.kernels import inlined, kernel

MOST_SWEEPS = 60
TOLERANCE = 1e-9  # largest change of an impulse in a sweep over the largest impulse


@inlined
def relative(v, nodes, s):  # type: ignore[no-untyped-def]
    """Return the relative velocity of one contact."""
    t, b, n = 0.0, 0.0, 0.0
    for a in range(5):
        t += s[a] * v[nodes[a, 0]]
        b += s[a] * v[nodes[a, 1]]
        n += s[a] * v[nodes[a, 2]]
    return t, b, n


@inlined
def push(v, inverse_mass, nodes, s, p_t, p_b, p_n):  # type: ignore[no-untyped-def]
    """Change the node velocities of one contact by an impulse."""
    for a in range(5):
        t, b, n = nodes[a, 0], nodes[a, 1], nodes[a, 2]
        v[t] += inverse_mass[t] * s[a] * p_t
        v[b] += inverse_mass[b] * s[a] * p_b
        v[n] += inverse_mass[n] * s[a] * p_n


@kernel
def _compliance(inverse_mass, nodes, s, normal):  # type: ignore[no-untyped-def]
    """Return the inverse effective mass along the normal, and its bound in the tangent plane."""
    along, across = 0.0, 0.0
    for a in range(5):
        w = s[a] * s[a]
        m_t, m_b, m_n = inverse_mass[nodes[a, 0]], inverse_mass[nodes[a, 1]], inverse_mass[nodes[a, 2]]
        along += w * (normal[0] ** 2 * m_t + normal[1] ** 2 * m_b + normal[2] ** 2 * m_n)
        across += w * max(m_t, m_n)
    return along, across


@kernel
def _project(p, normal, f, rel_t, rel_b, rel_n, target, along, across):  # type: ignore[no-untyped-def]
    """Return the impulse that makes one contact obey Signorini and Coulomb, others held."""
    rate = rel_t * normal[0] + rel_b * normal[1] + rel_n * normal[2]
    old = p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2]
    pressed = max(0.0, old - (rate - target) / along)
    q_t = p[0] - old * normal[0] - (rel_t - rate * normal[0]) / across
    q_b = p[1] - old * normal[1] - (rel_b - rate * normal[1]) / across
    q_n = p[2] - old * normal[2] - (rel_n - rate * normal[2]) / across
    size = np.sqrt(q_t * q_t + q_b * q_b + q_n * q_n)
    share = min(1.0, f * pressed / size) if size > 0.0 else 0.0
    return (
        pressed * normal[0] + share * q_t,
        pressed * normal[1] + share * q_b,
        pressed * normal[2] + share * q_n,
    )


@kernel
def solve(count, v, inverse_mass, nodes, s, normal, target, f, p):  # type: ignore[no-untyped-def]
    """Sweep until the impulses ``p`` (count, 3) stand still; velocities follow. Returns the sweeps.

    ``f`` (count,) are the Coulomb coefficients of the contacts.
    """
    for k in range(count):
        push(v, inverse_mass, nodes[k], s[k], p[k, 0], p[k, 1], p[k, 2])
    for sweep in range(MOST_SWEEPS):
        largest, change = 0.0, 0.0
        for k in range(count):
            along, across = _compliance(inverse_mass, nodes[k], s[k], normal[k])
            rel_t, rel_b, rel_n = relative(v, nodes[k], s[k])
            q_t, q_b, q_n = _project(p[k], normal[k], f[k], rel_t, rel_b, rel_n, target[k], along, across)
            d_t, d_b, d_n = q_t - p[k, 0], q_b - p[k, 1], q_n - p[k, 2]
            push(v, inverse_mass, nodes[k], s[k], d_t, d_b, d_n)
            p[k, 0], p[k, 1], p[k, 2] = q_t, q_b, q_n
            largest = max(largest, abs(q_t), abs(q_b), abs(q_n))
            change = max(change, abs(d_t), abs(d_b), abs(d_n))
        if change <= TOLERANCE * largest:
            return sweep + 1
    return MOST_SWEEPS
