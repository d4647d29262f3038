"""Element operators of the eight-node hexahedron, from scikit-fem's mapping and quadrature."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementHex1, MeshHex

from fem_impact.arrays import Array

Kind = Literal["full", "bbar", "incompatible"]

# scikit-fem's number of each corner in VTK order; its own list comes with an import of all that reads meshes
HEX_MAPPING = (0, 3, 6, 2, 1, 5, 7, 4)
VTK_TO_SKFEM = np.argsort(HEX_MAPPING)


def isotropic_stiffness(E: float, nu: float) -> Array:
    """Return Hooke's matrix (6, 6), Pa, in the order xx, yy, zz, xy, yz, zx with engineering shear."""
    lame, shear = lame_constants(E, nu)
    C = np.diag([2 * shear] * 3 + [shear] * 3)
    C[:3, :3] += lame
    return C


def lame_constants(E: float, nu: float) -> tuple[float, float]:
    """Return Lame's (lambda, G), Pa, of Young's modulus ``E`` in Pa and Poisson's ratio ``nu``."""
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


def _basis(points: Array, cells: NDArray[np.int64]) -> Basis:
    mesh = MeshHex(np.ascontiguousarray(points.T), np.ascontiguousarray(cells[:, VTK_TO_SKFEM].T))
    return Basis(mesh, ElementHex1(), intorder=2)


def shape_gradients(basis: Basis) -> tuple[Array, Array]:
    """Return gradients (m, 8 points, 8 nodes, 3), 1/m, in VTK node order, and weights (m, 8), m3."""
    grad = np.stack([basis.basis[k][0].grad for k in HEX_MAPPING])
    return grad.transpose(2, 3, 0, 1), basis.dx


def strain_matrix(grad: Array) -> Array:
    """Return B (..., 6, 3 k) for gradients (..., k, 3) of k vector-valued functions."""
    B = np.zeros((*grad.shape[:-2], 6, grad.shape[-2], 3))
    for row, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
        B[..., row, :, i] = grad[..., j]
        B[..., row, :, j] = grad[..., i]
    return B.reshape(*grad.shape[:-2], 6, -1)


def mean_dilatation(B: Array, dx: Array) -> Array:
    """Replace the volumetric part of B by its mean over the element (B-bar, Hughes 1980)."""
    trace = B[..., :3, :].sum(axis=-2)
    mean = np.einsum("mqi,mq->mi", trace, dx) / dx.sum(axis=1)[:, None]
    shifted = B.copy()
    shifted[..., :3, :] += (mean[:, None, None, :] - trace[..., None, :]) / 3
    return shifted


def incompatible_gradients(basis: Basis) -> Array:
    """Return gradients (m, 8, 3 modes, 3) of 1 - xi^2, ... with Taylor's centre Jacobian.

    Taylor, Beresford & Wilson (1976), doi:10.1002/nme.1620100602: with the Jacobian of the centre,
    scaled by det0/det, a constant stress does no work on the modes, so the patch test holds.
    """
    centre = np.full((3, 1), 0.5)
    inverse = basis.mapping.invDF(centre)[..., 0]
    scale = np.abs(basis.mapping.detDF(centre)) / np.abs(basis.mapping.detDF(basis.X))
    slope = -8.0 * (basis.X - 0.5)
    return np.asarray(np.einsum("kq,kim,mq->mqki", slope, inverse, scale))


def element_stiffness(points: Array, cells: NDArray[np.int64], C: Array, kind: Kind) -> Array:
    """Return element stiffness matrices, N/m.

    Parameters
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64, VTK node order
    C : (6, 6) float64, Pa
    kind : ``full`` 2x2x2 points, ``bbar`` with mean dilatation, ``incompatible`` modes condensed

    Returns
    -------
    (m, 24, 24) float64, N/m, node-major (node * 3 + component)
    """
    basis = _basis(points, cells)
    grad, dx = shape_gradients(basis)
    B = strain_matrix(grad)
    if kind == "bbar":
        B = mean_dilatation(B, dx)
    if kind != "incompatible":
        return np.asarray(np.einsum("mqsi,mqsj->mij", B, (C @ B) * dx[..., None, None], optimize=True))
    B = np.concatenate([B, strain_matrix(incompatible_gradients(basis))], axis=-1)
    K = np.einsum("mqsi,mqsj->mij", B, (C @ B) * dx[..., None, None], optimize=True)
    return np.asarray(K[:, :24, :24] - K[:, :24, 24:] @ np.linalg.solve(K[:, 24:, 24:], K[:, 24:, :24]))


def lumped_mass(points: Array, cells: NDArray[np.int64], density: float) -> Array:
    """Return row-sum lumped nodal masses (m, 8), kg, of each element."""
    basis = _basis(points, cells)
    values = np.stack([np.broadcast_to(np.asarray(basis.basis[k][0]), basis.dx.shape) for k in HEX_MAPPING])
    return np.asarray(density * np.einsum("kmq,mq->mk", values, basis.dx))
