"""Small meshes and exact measures that the solver's tests share."""

import numpy as np

import meshes
from fem_impact.solid.state import State
from meshes import Zone
from meshes.block import box_cells

E, NU, RHO = 210e9, 0.3, 7850.0


def grid(counts, h):
    """Box of cubes: points (n, 3) and cells (m, 8)."""
    axes = [h * np.arange(c + 1) for c in counts]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3), box_cells(np.array(counts))


def distorted(counts, share, seed, h=1e-3):
    """Box whose nodes are all pushed about by up to a share of the edge."""
    points, cells = grid(counts, h)
    return points + share * h * np.random.default_rng(seed).uniform(-1, 1, points.shape), cells


def inner(points):
    """Nodes of a distorted box that lie well inside."""
    low, high = points.min(axis=0), points.max(axis=0)
    return ((points > low + 0.15 * (high - low)) & (points < high - 0.15 * (high - low))).all(axis=1)


def refined_patch(seed, share=0.15):
    """Block with one level of refinement whose free nodes are pushed about; hanging ones follow."""
    zone = Zone(np.zeros(3), np.eye(3), np.array([-0.9e-3, 0.0, -0.9e-3]), np.array([0.9e-3, 0.9e-3, 0.0]))
    mesh = meshes.block([-3e-3, 0, -3e-3], [3e-3, 3e-3, 0], 1e-3, [zone], buffer=1)
    push = np.random.default_rng(seed).uniform(-1, 1, mesh.points.shape) * 0.5e-3 * share
    return mesh, mesh.tie @ (mesh.points + push)


def dense(K, cells):
    """Assemble element matrices into a full matrix."""
    size = 3 * (int(cells.max()) + 1)
    result = np.zeros((size, size))
    for k, cell in zip(K, cells, strict=True):
        dof = (3 * cell[:, None] + np.arange(3)).ravel()
        result[np.ix_(dof, dof)] += k
    return result


def at_rest(x):
    """State at positions x without motion."""
    return State(x.copy(), np.zeros_like(x), np.zeros_like(x))


def fastest(K, mass):
    """Largest circular frequency of one element."""
    root = np.repeat(mass, 3) ** -0.5
    return np.sqrt(np.linalg.eigvalsh(K * root[:, None] * root)[-1])


def volume(x):
    """Exact volume of a trilinear hexahedron (8, 3), VTK order: flux through its six bilinear faces."""
    total = 0.0
    for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
        a, b, c, d = x[list(face)]
        for p, q in ((s, t) for s in (-1, 1) for t in (-1, 1)):
            u, v = p / np.sqrt(3), q / np.sqrt(3)
            at = (
                (1 - u) * (1 - v) * a + (1 + u) * (1 - v) * b + (1 + u) * (1 + v) * c + (1 - u) * (1 + v) * d
            ) / 4
            along = ((1 - v) * (b - a) + (1 + v) * (c - d)) / 4
            across = ((1 - u) * (d - a) + (1 + u) * (c - b)) / 4
            total += at @ np.cross(along, across) / 3
    return total
