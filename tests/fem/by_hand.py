"""Operators written out by hand, in strain matrices instead of forms, for the forms to be held to."""

import numpy as np

from meshes import OUTER
from meshes.gauss import GRADIENTS
from meshes.hexmesh import CORNERS

POINTS = (2 * CORNERS - 1) / np.sqrt(3)  # in [-1, 1]^3, weights 1
SHAPES = (1 + POINTS[:, None, :] * (2 * CORNERS - 1)).prod(axis=2) / 8  # (8, 8) of each corner at each point


def hooke(E, nu):
    """Return Hooke's matrix (6, 6), Pa, in the order xx, yy, zz, xy, yz, zx with engineering shear."""
    shear = E / (2 * (1 + nu))
    C = np.diag([2 * shear] * 3 + [shear] * 3)
    C[:3, :3] += E * nu / ((1 + nu) * (1 - 2 * nu))
    return C


def jacobian(gradients, x):
    """Return dx/dxi (m, points, 3, 3) of cells x (m, 8, 3) at points with gradients (points, 8, 3)."""
    return np.einsum("qaj,mai->mqij", gradients, x)


def strain_matrix(grad):
    """Return B (..., 6, 3 k) for gradients (..., k, 3) of k vector-valued functions."""
    B = np.zeros((*grad.shape[:-2], 6, grad.shape[-2], 3))
    for row, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
        B[..., row, :, i] = grad[..., j]
        B[..., row, :, j] = grad[..., i]
    return B.reshape(*grad.shape[:-2], 6, -1)


def mean_dilatation(B, dx):
    """Replace the volumetric part of B by its mean over the cell."""
    trace = B[..., :3, :].sum(axis=-2)
    mean = np.einsum("mqi,mq->mi", trace, dx) / dx.sum(axis=1)[:, None]
    shifted = B.copy()
    shifted[..., :3, :] += (mean[:, None, None, :] - trace[..., None, :]) / 3
    return shifted


def modes(x, det):
    """Return gradients (m, points, 3 modes, 3) of 1 - xi^2, ... by the centre's Jacobian and det0 / det."""
    centre = jacobian((2 * CORNERS[None] - 1) / 8, x)[:, 0]
    scale = np.linalg.det(centre)[:, None] / det
    return np.einsum("qk,mki,mq->mqki", -2 * POINTS, np.linalg.inv(centre), scale)


def element_stiffness(points, cells, C, kind):
    """Return element stiffness matrices (m, 24, 24), N/m."""
    x = points[cells]
    J = jacobian(GRADIENTS, x)
    dx = np.linalg.det(J)
    B = strain_matrix(np.einsum("qaj,mqji->mqai", GRADIENTS, np.linalg.inv(J)))
    if kind == "bbar":
        B = mean_dilatation(B, dx)
    if kind == "incompatible":
        B = np.concatenate([B, strain_matrix(modes(x, dx))], axis=-1)
    K = np.einsum("mqsi,mqsj->mij", B, (C @ B) * dx[..., None, None])
    inner = np.linalg.solve(K[:, 24:, 24:], K[:, 24:, :24]) if kind == "incompatible" else K[:, 24:, :24]
    return K[:, :24, :24] - K[:, :24, 24:] @ inner


def lumped_mass(points, cells, rho):
    """Return row-sum lumped nodal masses (m, 8), kg."""
    return rho * np.linalg.det(jacobian(GRADIENTS, points[cells])) @ SHAPES


def boundary(mesh, G, rho, c_d, c_s):
    """Return springs, N/m, and dashpots, N s/m, (n, 3): a quarter of each face at each of its corners."""
    quads = mesh.faces_with(OUTER)
    x = mesh.points[quads]
    area = 0.5 * np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
    size, r = np.linalg.norm(area, axis=1)[:, None], np.linalg.norm(x.mean(axis=1), axis=1)[:, None]
    along = (area / size) ** 2
    totals = np.zeros((2, *mesh.points.shape))
    for corner in quads.T:
        np.add.at(totals[0], corner, G * size / r * (4 * along + 2 * (1 - along)) / 12)
        np.add.at(totals[1], corner, rho * size * (c_d * along + c_s * (1 - along)) / 4)
    return totals
