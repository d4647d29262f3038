"""Element operators of the eight-node hexahedron, from the weak forms."""

from typing import Any, Literal

import numpy as np
from skfem import ElementHex1, ElementVector

from fem_impact.arrays import Array, Ints
from fem_impact.fem import forms

Kind = Literal["full", "bbar", "incompatible"]

BATCH = 125  # elements computed at once: their shape functions at all points fit the processor's cache
FORMS: dict[Kind, tuple[Any, Any]] = {
    "full": (forms.stiffness, ElementVector(ElementHex1())),
    "bbar": (forms.mean_dilatation_stiffness, ElementVector(ElementHex1())),
    "incompatible": (forms.stiffness, ElementVector(forms.ElementHexModes())),
}


def lame_constants(E: float, nu: float) -> tuple[float, float]:
    """Return Lame's (lambda, G), Pa, of Young's modulus ``E`` in Pa and Poisson's ratio ``nu``."""
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


def element_stiffness(points: Array, cells: Ints, lame: tuple[float, float], kind: Kind) -> Array:
    """Return element stiffness matrices, N/m.

    Parameters
    ----------
    points : (n, 3) float64, m
    cells : (m, 8) int64, VTK node order
    lame : Lame's (lambda, G), Pa
    kind : ``full`` 2x2x2 points, ``bbar`` with mean dilatation, ``incompatible`` modes condensed

    Returns
    -------
    (m, 24, 24) float64, N/m, node-major (node * 3 + component)
    """
    form, element = FORMS[kind]
    meshes = (forms.hex_mesh(points, some) for some in np.split(cells, range(BATCH, len(cells), BATCH)))
    parts = [forms.element_matrices(form, mesh, element, lame=lame[0], G=lame[1]) for mesh in meshes]
    return np.concatenate(parts)


def lumped_mass(points: Array, cells: Ints, density: float) -> Array:
    """Return row-sum lumped nodal masses (m, 8), kg, of each element."""
    mesh = forms.hex_mesh(points, cells)
    return np.asarray(forms.element_matrices(forms.mass, mesh, ElementHex1(), rho=density).sum(axis=2))
