"""The weak forms of the model, as scikit-fem forms on `MeshHex` bases.

Small-strain motion u of an isotropic body: for all v

    (rho u'', v) + (lambda div u, div v) + (2 G eps(u), eps(v)) + <s u, v> + <c u', v> = <t, v>,

where (.,.) is the integral over the body, <.,.> that over its outer faces, eps the symmetric gradient, lambda
and G Lame's constants, Pa. Springs s, N/m3, and dashpots c, N s/m3, stand for the half-space outside a block;
t is a traction, Pa. Parameters of a form are attributes of its last argument ``w``, in SI units.

Cells are trilinear, integrated at 2 x 2 x 2 Gauss points. Masses, springs and dashpots are lumped: row sums.
"""

from types import SimpleNamespace
from typing import Any

import numpy as np
from skfem import (
    Basis,
    BilinearForm,
    DiscreteField,
    ElementHex1,
    ElementVector,
    FacetBasis,
    MeshHex,
)
from skfem.helpers import ddot, div, dot, inner, sym_grad

from fem_impact.arrays import Array, Ints
from meshes.hexmesh import face_keys

NORMAL_SPRING, TANGENTIAL_SPRING = 4 / 3, 2 / 3  # of G / r, for a point source (Liu et al. 2006)


@BilinearForm
def mass(u, v, w):  # type: ignore[no-untyped-def]
    """Inertia (rho u, v) of a scalar or vector field; ``rho``, kg/m3."""
    return w.rho * inner(u, v)


@BilinearForm
def stiffness(u, v, w):  # type: ignore[no-untyped-def]
    """Hooke's law (lambda div u, div v) + (2 G eps(u), eps(v)); ``lame`` and ``G``, Pa."""
    return w.lame * div(u) * div(v) + 2 * w.G * ddot(sym_grad(u), sym_grad(v))


@BilinearForm
def mean_dilatation_stiffness(u, v, w):  # type: ignore[no-untyped-def]
    """Hooke's law with the mean of div u over each cell instead of div u (B-bar, Hughes 1980).

    The pressure follows from the cell's mean volume change, the deviator from the strain at the point. ``dx``
    (cells, points) are the weights of the Gauss points, m3.
    """
    bulk = w.lame + 2 * w.G / 3
    deviators = ddot(sym_grad(u), sym_grad(v)) - div(u) * div(v) / 3
    return bulk * cell_mean(div(u), w.dx) * cell_mean(div(v), w.dx) + 2 * w.G * deviators


@BilinearForm
def springs(u, v, w):  # type: ignore[no-untyped-def]
    """Springs of a half-space, ``G``, Pa, loaded r away from the face's centre.

    That is at t = ``middle``, m, or over a line along t, ``half`` m long to each side of it.
    """
    t, b, n = w.x.mean(axis=-1, keepdims=True)
    r = np.sqrt(np.maximum(np.abs(t - w.middle) - w.half, 0.0) ** 2 + b**2 + n**2)
    return w.G / r * along_and_across(u, v, w.n, NORMAL_SPRING, TANGENTIAL_SPRING)


@BilinearForm
def dashpots(u, v, w):  # type: ignore[no-untyped-def]
    """Dashpots rho c_d and rho c_s, which absorb plane waves; ``rho``, kg/m3; ``c_d`` and ``c_s``, m/s."""
    return w.rho * along_and_across(u, v, w.n, w.c_d, w.c_s)


def cell_mean(field: Array, dx: Array) -> Array:
    """Return the mean (cells, 1) of point values (cells, points) over each cell."""
    return np.asarray((field * dx).sum(axis=-1, keepdims=True) / dx.sum(axis=-1, keepdims=True))


def along_and_across(u: Array, v: Array, n: Array, normal: float, tangential: float) -> Array:
    """Return normal u_n v_n + tangential (u . v - u_n v_n), where u_n = u . n."""
    u_n, v_n = dot(u, n), dot(v, n)
    return np.asarray(normal * u_n * v_n + tangential * (dot(u, v) - u_n * v_n))


class ElementHexModes(ElementHex1):  # type: ignore[misc]
    """The trilinear hexahedron with three incompatible modes 1 - xi^2, ... inside each cell.

    Taylor, Beresford & Wilson (1976), doi:10.1002/nme.1620100602: with the Jacobian of the centre, scaled by
    det0/det, a constant stress does no work on the modes, so the patch test holds.
    """

    interior_dofs = 3
    dofnames = ("u", "a", "a", "a")
    doflocs = np.concatenate([ElementHex1.doflocs, np.full((3, 3), 0.5)])

    def gbasis(self, mapping, X, i, tind=None):  # type: ignore[no-untyped-def]
        """Return trilinear function ``i`` or, from 8 on, a mode; X in [0, 1]^3."""
        if i < 8:
            return super().gbasis(mapping, X, i, tind)
        axis, centre = i - 8, np.full((3, 1), 0.5)
        scale = np.abs(mapping.detDF(centre, tind) / mapping.detDF(X, tind))
        slope = -8.0 * (X[axis] - 0.5)  # of 1 - (2 X - 1)^2
        grad = mapping.invDF(centre, tind)[axis] * (scale * slope)
        return (DiscreteField(np.broadcast_to(1 - (2 * X[axis] - 1) ** 2, scale.shape), grad),)


# scikit-fem's number of each corner, listed in the VTK order that the meshes use. It stands here because
# scikit-fem's own list is in the module that imports all mesh readers. Node numbers and the index of an
# unknown, 3 node + component, are the same in both.
HEX_MAPPING = (0, 3, 6, 2, 1, 5, 7, 4)


def hex_mesh(points: Array, cells: Ints) -> MeshHex:
    """Return the mesh of points (n, 3), m, and cells (m, 8) in VTK order."""
    corners = cells[:, np.argsort(HEX_MAPPING)]
    return MeshHex(np.ascontiguousarray(points.T), np.ascontiguousarray(corners.T))


def face_basis(mesh: MeshHex, quads: Ints) -> FacetBasis:
    """Return the vector basis on the faces with corners ``quads`` (k, 4), in the order of the mesh."""
    facets = np.flatnonzero(np.isin(face_keys(mesh.facets.T.astype(np.int64)), face_keys(quads)))
    return FacetBasis(mesh, ElementVector(ElementHex1()), intorder=2, facets=facets)


def element_matrices(form: BilinearForm, mesh: MeshHex, element: Any = None, **parameters: float) -> Array:
    """Return the symmetric element matrices (m, 8 k, 8 k) of a form, node-major in VTK order.

    ``element`` (default: `ElementHex1` in three components) has k unknowns at each node. Unknowns inside a
    cell, which carry no load, are condensed.
    """
    basis = Basis(mesh, element or ElementVector(ElementHex1()), intorder=2, disable_doflocs=True)
    trials, w = [field for (field,) in basis.basis], SimpleNamespace(dx=basis.dx, **parameters)
    # one call of the form for all test functions: a call takes far longer than its arithmetic
    v = DiscreteField(np.stack(trials, axis=-3), np.stack([u.grad for u in trials], axis=-3))
    K = np.stack([np.einsum("imp,mp->mi", form.form(u, v, w), basis.dx) for u in trials], axis=1)
    k = basis.elem.nodal_dofs
    order = (k * np.array(HEX_MAPPING)[:, None] + np.arange(k)).ravel()
    inside = np.arange(8 * k, K.shape[1])
    nodal, mixed = K[:, order[:, None], order], K[:, inside[:, None], order]
    if not len(inside):
        return np.asarray(nodal)
    return np.asarray(nodal - mixed.swapaxes(1, 2) @ np.linalg.solve(K[:, inside[:, None], inside], mixed))
