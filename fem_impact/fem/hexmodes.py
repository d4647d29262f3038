"""The trilinear hexahedron in its seven non-translational modes, for blocks of ``LANES`` elements.

x(xi) = a0 + a1 xi + a2 eta + a3 zeta + a4 eta zeta + a5 zeta xi + a6 xi eta + a7 xi eta zeta.
Working with the modes a1..a7 instead of eight nodes halves the arithmetic of an element. A scratch row
holds one number for each of ``LANES`` elements, so that the compiler turns lanes into vector registers.
"""

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.kernels import inlined

# corners of the reference cube in VTK order
SIGNS = np.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
)
# its Gauss points, xi fastest
CORNERS = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) / np.sqrt(3.0)
LANES = 16  # elements of a block
DUMMY_EDGE = 2e-3  # m, of the element that fills up the last block
THIRD = 1.0 / 3.0


def reference_gradients(at: Array) -> Array:
    """Return dN/dxi (points, 8 nodes, 3) of the trilinear hexahedron at points (points, 3) in [-1, 1]^3."""
    factor = 1 + SIGNS[None] * at[:, None]
    product = [factor[..., j] * factor[..., k] for j, k in ((1, 2), (0, 2), (0, 1))]
    return np.asarray(SIGNS[None] * np.stack(product, axis=-1) / 8)


def dummy_element() -> Array:
    """Return the node positions (8, 3), m, of the fixed cube that fills up the last block."""
    return 0.5 * DUMMY_EDGE * SIGNS


@inlined
def node_modes(a0, a1, a2, a3, a4, a5, a6, a7):  # type: ignore[no-untyped-def]
    """Return the modes a1..a7 of eight nodal values in VTK order."""
    s01, d01, s23, d23 = a0 + a1, a1 - a0, a3 + a2, a2 - a3
    s45, d45, s67, d67 = a4 + a5, a5 - a4, a7 + a6, a6 - a7
    low, low_x, low_y, low_xy = s01 + s23, d01 + d23, s23 - s01, d23 - d01
    top, top_x, top_y, top_xy = s45 + s67, d45 + d67, s67 - s45, d67 - d45
    return (
        (low_x + top_x) * 0.125,
        (low_y + top_y) * 0.125,
        (top - low) * 0.125,
        (top_y - low_y) * 0.125,
        (top_x - low_x) * 0.125,
        (low_xy + top_xy) * 0.125,
        (top_xy - low_xy) * 0.125,
    )


@inlined
def slope(w, row, l, X, Y, Z):  # type: ignore[no-untyped-def]
    """Return the nine d(x, y, z)/d(xi, eta, zeta), row-major, of the modes stored from ``row`` on."""
    YZ, ZX, XY = Y * Z, Z * X, X * Y
    o = row * LANES + l
    a4x, a4y, a4z = w[o + 9 * LANES], w[o + 10 * LANES], w[o + 11 * LANES]
    a5x, a5y, a5z = w[o + 12 * LANES], w[o + 13 * LANES], w[o + 14 * LANES]
    a6x, a6y, a6z = w[o + 15 * LANES], w[o + 16 * LANES], w[o + 17 * LANES]
    a7x, a7y, a7z = w[o + 18 * LANES], w[o + 19 * LANES], w[o + 20 * LANES]
    return (
        w[o] + Z * a5x + Y * a6x + YZ * a7x,
        w[o + 3 * LANES] + Z * a4x + X * a6x + ZX * a7x,
        w[o + 6 * LANES] + Y * a4x + X * a5x + XY * a7x,
        w[o + LANES] + Z * a5y + Y * a6y + YZ * a7y,
        w[o + 4 * LANES] + Z * a4y + X * a6y + ZX * a7y,
        w[o + 7 * LANES] + Y * a4y + X * a5y + XY * a7y,
        w[o + 2 * LANES] + Z * a5z + Y * a6z + YZ * a7z,
        w[o + 5 * LANES] + Z * a4z + X * a6z + ZX * a7z,
        w[o + 8 * LANES] + Y * a4z + X * a5z + XY * a7z,
    )


@inlined
def cofactors(j00, j01, j02, j10, j11, j12, j20, j21, j22):  # type: ignore[no-untyped-def]
    """Return the cofactor matrix, row-major: d(det)/d(j)."""
    return (
        j11 * j22 - j12 * j21,
        j12 * j20 - j10 * j22,
        j10 * j21 - j11 * j20,
        j21 * j02 - j22 * j01,
        j22 * j00 - j20 * j02,
        j20 * j01 - j21 * j00,
        j01 * j12 - j02 * j11,
        j02 * j10 - j00 * j12,
        j00 * j11 - j01 * j10,
    )


@inlined
def triple(w, p, q, r):  # type: ignore[no-untyped-def]
    """Return the triple product of the vector modes that start at the flat positions p, q, r."""
    px, py, pz = w[p], w[p + LANES], w[p + 2 * LANES]
    qx, qy, qz = w[q], w[q + LANES], w[q + 2 * LANES]
    rx, ry, rz = w[r], w[r + LANES], w[r + 2 * LANES]
    return px * (qy * rz - qz * ry) + py * (qz * rx - qx * rz) + pz * (qx * ry - qy * rx)


@inlined
def hex_volume(w, row, l):  # type: ignore[no-untyped-def]
    """Return the exact volume, m3, of the trilinear hexahedron, from its modes."""
    a1 = row * LANES + l
    a2, a3, a4, a5, a6 = a1 + 3 * LANES, a1 + 6 * LANES, a1 + 9 * LANES, a1 + 12 * LANES, a1 + 15 * LANES
    bent = triple(w, a6, a2, a4) + triple(w, a5, a4, a3) + triple(w, a1, a6, a5)
    return 8.0 * (triple(w, a1, a2, a3) + THIRD * bent)


@inlined
def gather_modes(values, factor, dof, w):  # type: ignore[no-untyped-def]
    """Fill the 21 scratch rows ``w`` with factor times the modes of a nodal vector field."""
    for c in range(3):
        for l in range(LANES):
            modes = node_modes(
                values[dof[c, 0, l]],
                values[dof[c, 1, l]],
                values[dof[c, 2, l]],
                values[dof[c, 3, l]],
                values[dof[c, 4, l]],
                values[dof[c, 5, l]],
                values[dof[c, 6, l]],
                values[dof[c, 7, l]],
            )
            o = c * LANES + l
            w[o] = factor * modes[0]
            w[o + 3 * LANES] = factor * modes[1]
            w[o + 6 * LANES] = factor * modes[2]
            w[o + 9 * LANES] = factor * modes[3]
            w[o + 12 * LANES] = factor * modes[4]
            w[o + 15 * LANES] = factor * modes[5]
            w[o + 18 * LANES] = factor * modes[6]


@inlined
def nodal_forces(w, nodal):  # type: ignore[no-untyped-def]
    """Set the forces (3, 8, LANES) on nodes whose mode sums stand in the 21 scratch rows ``w``."""
    for c in range(3):
        for l in range(LANES):
            o = c * LANES + l
            m1, m2, m3 = 0.125 * w[o], 0.125 * w[o + 3 * LANES], 0.125 * w[o + 6 * LANES]
            m4, m5, m6 = 0.125 * w[o + 9 * LANES], 0.125 * w[o + 12 * LANES], 0.125 * w[o + 15 * LANES]
            m7 = 0.125 * w[o + 18 * LANES]
            x_top, x_low, y_top, y_low = m1 + m5, m1 - m5, m2 + m4, m2 - m4
            xy_top, xy_low = m6 + m7, m6 - m7
            nodal[c, 0, l] = -x_low - y_low - m3 + xy_low
            nodal[c, 1, l] = x_low - y_low - m3 - xy_low
            nodal[c, 2, l] = x_low + y_low - m3 + xy_low
            nodal[c, 3, l] = -x_low + y_low - m3 - xy_low
            nodal[c, 4, l] = -x_top - y_top + m3 + xy_top
            nodal[c, 5, l] = x_top - y_top + m3 - xy_top
            nodal[c, 6, l] = x_top + y_top + m3 + xy_top
            nodal[c, 7, l] = -x_top + y_top + m3 - xy_top
