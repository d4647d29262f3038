"""Viscous-spring boundary of the barrier block: the rest of the half-space as springs and dashpots.

Normal and tangential springs 1.33 G/r and 0.67 G/r per area at distance r from the contact, dashpots
rho c_d and rho c_s per area (Liu, Du, Du, Wang & Wu 2006, Earthquake Engineering and Engineering Vibration
5(1), 93-102, with the coefficients 4/3 and 2/3 of a point source).

A contact lasts many passages of a wave through the block. Its boundary then stands in the near field and
moves as under a static load, and plain dashpots take nearly twice the energy that a half-space radiates under
a slow force (Lamb's problem), however large the block. `radiating_share` is the factor that corrects them.
"""

from math import pi, sqrt

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, cg

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.errors import RunError
from fem_impact.fem.elements import lame_constants
from fem_impact.fem.forms import dashpots, face_basis, hex_mesh, springs
from meshes import OUTER, HexMesh

# 2 pi G c_s times the radiated power over (dF/dt)^2, a polynomial of nu (highest power first) within 0.25 %
# of Lamb's integral (Miller & Pursey 1955, Proc. R. Soc. A)
RADIATION = (0.72091, 0.54936, -1.83562, 1.34367)


def spread_boundary(
    mesh: HexMesh,
    E: float,
    nu: float,
    rho: float,
    cells: Bools | None = None,
    middle: float = 0.0,
    half: float = 0.0,
) -> tuple[Array, Array]:
    """Return spring stiffnesses, N/m, and damping, N s/m, of all mesh nodes, both (n, 3).

    They are those at the outer faces of ``cells``, a mask (m,), or of all, for a load at t = ``middle``, m,
    or over a line along t, ``half`` m long to each side of it.
    The faces are plane and parallel to the axes, so each node's springs are diagonal.
    """
    lame, G = lame_constants(E, nu)
    c_d, c_s = sqrt((lame + 2 * G) / rho), sqrt(G / rho)
    faces, ones = mesh.faces_with(OUTER), np.ones(mesh.points.size)
    if cells is not None:
        faces = faces[np.isin(faces, mesh.cells[cells]).all(axis=1)]
    if not len(faces):
        return np.zeros((len(mesh.points), 3)), np.zeros((len(mesh.points), 3))
    basis = face_basis(hex_mesh(mesh.points, mesh.cells), faces)
    spring = springs.assemble(basis, G=G, middle=middle, half=half) @ ones
    damping = dashpots.assemble(basis, rho=rho, c_d=c_d, c_s=c_s) @ ones
    totals = np.zeros((2, len(mesh.points), 3))
    outer = np.unique(faces)  # nodes inside the cells of these faces have round-off only
    totals[:, outer] = np.stack([spring, damping]).reshape(2, -1, 3)[:, outer]
    return totals[0], totals[1]


def line_share(half: float, lasts: float, material: tuple[float, float, float]) -> float:
    """Return what a force over a line radiates, of what it radiates at a point.

    Rayleigh waves, which take two thirds of it (Miller & Pursey 1955), leave under all angles theta to the
    line; those of its parts add up as sin(x) / x, x = k l cos(theta), of the amplitude.

    Parameters
    ----------
    half : l, m, half of the length of the line
    lasts : time, s, of the force, half a period: k = pi / (c_R lasts), c_R = c_s (0.862 + 1.14 nu) / (1 + nu)
        (Viktorov 1967)
    material : E, nu, rho
    """
    E, nu, rho = material
    c_R = sqrt(lame_constants(E, nu)[1] / rho) * (0.862 + 1.14 * nu) / (1 + nu)
    theta = (np.arange(400) + 0.5) / 400 * pi / 2
    return float(np.mean(np.sinc(half / (c_R * lasts) * np.cos(theta)) ** 2))


def plate_edges(mesh: HexMesh, E: float, nu: float, rho: float, speed: float) -> tuple[Array, Array]:
    """Return springs, N/m, none, and damping, N s/m, at the outer faces of a plate: (n, 3) of all nodes.

    Bending waves of the phase speed c, m/s, that come to an edge at right angles push it with
    Q = rho h c w' and turn it with M = (D / c) theta', so dashpots of these sizes send none of them back:
    rho c a unit area along n, and rho c_p^2 / c along the edge's normal, c_p^2 = E / (rho (1 - nu^2)) (from
    D d4w/dx4 = -rho h d2w/dt2 with w = exp(i (omega t - k x)), k = omega / c). Along the edge they are those
    of shear waves, rho c_s.
    """
    G = E / (2 * (1 + nu))
    c_s, turning = sqrt(G / rho), E / (rho * (1 - nu**2)) / speed
    basis = face_basis(hex_mesh(mesh.points, mesh.cells), mesh.faces_with(OUTER))
    ones, damping = np.ones(mesh.points.size), np.zeros((len(mesh.points), 3))
    outer = np.unique(mesh.faces_with(OUTER))
    normal, along = (
        (dashpots.assemble(basis, rho=rho, c_d=c_d, c_s=c) @ ones).reshape(-1, 3)[outer]
        for c_d, c in ((1.0, 0.0), (0.0, 1.0))
    )
    height = mesh.points[outer, 2] - 0.5 * (mesh.points[:, 2].min() + mesh.points[:, 2].max())
    area = normal.sum(axis=1)
    lumped = float(area @ height**2 / area.sum())  # over h^2 / 12: masses at the nodes lie further out
    turning *= float(np.ptp(mesh.points[:, 2])) ** 2 / 12 / lumped
    damping[outer] = turning * normal + c_s * along
    damping[outer, 2] *= speed / c_s
    return np.zeros_like(damping), damping


def radiating_share(
    K: sp.csr_matrix,
    damping: Array,
    fixed: Bools,
    loaded: int | Ints,
    material: tuple[float, float, float],
) -> float:
    """Return the factor of the plain dashpots with which the block radiates as a half-space does.

    The load is a slow normal force at the contact.

    Parameters
    ----------
    K : (n, n) static stiffness of the half block with its springs, N/m; damping : (n,), N s/m
    fixed : (n,) unknowns on the symmetry plane that cannot move
    loaded : the unknown along n at the contact, or those along a line; material : E, nu, rho

    Raises
    ------
    RunError
        If the static solution does not converge.
    """
    E, nu, rho = material
    G = lame_constants(E, nu)[1]
    load = np.zeros(len(damping))
    load[loaded] = 0.5 / np.size(loaded)  # the half model's part of a unit force
    constrained = LinearOperator(K.shape, lambda u: np.where(fixed, 0.0, K @ u), dtype=np.float64)
    displacement, failed = cg(constrained, load, rtol=1e-4, M=sp.diags(1 / K.diagonal()))
    if failed:
        raise RunError("The static solution of the barrier block was not found.")
    absorbed = 2 * float(damping @ displacement**2)  # of the whole block, W per (N/s)^2
    return float(np.polyval(RADIATION, nu)) / (2 * pi * G * sqrt(G / rho)) / absorbed
