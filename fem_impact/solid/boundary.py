"""Viscous-spring boundary of the barrier block: the rest of the half-space as springs and dashpots.

Normal and tangential springs 1.33 G/r and 0.67 G/r per area at distance r from the contact, dashpots
rho c_d and rho c_s per area (Liu, Du, Du, Wang & Wu 2006, Earthquake Engineering and Engineering Vibration
5(1), 93-102, with the coefficients 4/3 and 2/3 of a point source).
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.elements import lame_constants
from meshes import OUTER, HexMesh

Array = NDArray[np.float64]

NORMAL_SPRING, TANGENTIAL_SPRING = 4 / 3, 2 / 3


def _face_geometry(mesh: HexMesh) -> tuple[Array, Array, Array]:
    corners = mesh.points[mesh.faces_with(OUTER)]
    area = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    size = np.linalg.norm(area, axis=1)
    return size, area / size[:, None], np.linalg.norm(corners.mean(axis=1), axis=1)


def spread_boundary(mesh: HexMesh, E: float, nu: float, rho: float) -> tuple[Array, Array]:
    """Return spring stiffnesses, N/m, and damping, N s/m, of all mesh nodes, both (n, 3).

    The outer faces are plane and parallel to the axes, so each node's springs are diagonal.
    """
    lame, G = lame_constants(E, nu)
    c_d, c_s = sqrt((lame + 2 * G) / rho), sqrt(G / rho)
    size, normal, r = _face_geometry(mesh)
    along = normal**2
    spring = (NORMAL_SPRING * along + TANGENTIAL_SPRING * (1 - along)) * (G * size / r)[:, None]
    damping = (c_d * along + c_s * (1 - along)) * (rho * size)[:, None]
    totals = np.zeros((2, len(mesh.points), 3))
    for corner in mesh.faces_with(OUTER).T:
        np.add.at(totals[0], corner, spring / 4)
        np.add.at(totals[1], corner, damping / 4)
    return totals[0], totals[1]
