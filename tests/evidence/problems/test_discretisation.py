"""Errors of contacts on square grids of nodes, beside exact solutions of such contacts on a half-space."""

import numpy as np
import pytest

from fem_impact.evidence.problems.discretisation import grid_force_error, grid_radiation_error

CELLS, FINEST = 8, 6.5  # to either side of the middle; over the contact radius
GRID = np.stack(np.meshgrid(np.arange(-CELLS, CELLS + 1.0), np.arange(-CELLS, CELLS + 1.0)), axis=-1)
POINTS = GRID.reshape(-1, 2)  # spacing 1; the plane has E* = 1, the ball radius 1


def flexibility():
    """Return the skin's displacement at each node by a unit of even pressure around another (Love 1929).

    Johnson, Contact Mechanics, 1985, Eq 3.25.
    """
    arm = POINTS[:, None] - POINTS[None]

    def corner(x, y):
        r = np.hypot(x, y)
        return x * np.log(y + r) + y * np.log(x + r)

    ends = [(arm[..., 0] + x, arm[..., 1] + y, 4 * x * y) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
    return sum(sign * corner(x, y) for x, y, sign in ends) / np.pi


def forces(depths):
    """Return the force at each depth, by the nodes that are pressed."""
    C, profile = flexibility(), 0.5 * (POINTS**2).sum(axis=1)
    found, pressed = [], profile == 0.0
    for depth in depths:
        while True:
            p = np.zeros(len(POINTS))
            p[pressed] = np.linalg.solve(C[np.ix_(pressed, pressed)], (depth - profile)[pressed])
            below = (depth - profile - C @ p > 1e-12) & ~pressed
            if not (p < 0).any() and not below.any():
                break
            pressed = (pressed & (p >= 0)) | below * (p >= 0).all()
        found.append(p.sum())
    return np.array(found)


@pytest.fixture(scope="module")
def law():
    """Depths, forces, their slopes and work; a depth of a^2 has a contact radius of a in Hertz' contact."""
    depth = np.linspace(0.0, 1.05 * FINEST**2, 500)
    force = np.r_[0.0, forces(depth[1:])]
    work = np.r_[0.0, np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(depth))]
    return depth, force, np.gradient(force, depth), work


def rate_squared(depth, slope, work, energy):
    """Return the integral of the squared rate of force over time, for a mass of 1."""
    return np.trapezoid(slope**2 * np.sqrt(2 * np.maximum(energy - work, 0.0)), depth)


def misses(law, cells):
    """Return the errors of largest force and radiated energy with so many cells over the contact radius."""
    depth, force, slope, work = law
    energy = 8 / 15 * cells**5
    peak = np.interp(np.interp(energy, work, depth), depth, force)
    exact = rate_squared(depth, 2 * np.sqrt(depth), 8 / 15 * depth**2.5, energy)
    radiated = rate_squared(depth, slope, work, energy)
    return abs(np.array([peak / (4 / 3 * cells**3), radiated / exact]) - 1)


def shares(law):
    """Return both errors over their bounds for many numbers of cells."""
    many = np.geomspace(1.8, FINEST, 40)
    return [misses(law, n) / (grid_force_error(1.0, n), grid_radiation_error(1.0, n)) for n in many]


def test_a_grid_of_nodes_is_within_its_errors_which_are_no_larger_than_needed(law):
    found = np.max(shares(law), axis=0)
    assert (found < 1.0).all() and (found > 0.7).all()
