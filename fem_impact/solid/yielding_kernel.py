"""Compiled update of hexahedra with J2 plasticity in the current configuration.

Per step and Gauss point: gradient of the displacement increment referred to the middle of the step,
Jaumann-rotated deviatoric stress, radial return; the pressure comes from the element's exact volume
(mean dilatation, B-bar), so that one pressure per element replaces eight; with plain full integration each
Gauss point has that of its own volume.

Stresses are Kirchhoff's and every integral runs over the reference volume: the deviator works on weights
that never change and the pressure p = K ln(J) / J is the exact derivative of K ln(J)^2 V_0 / 2. With
Cauchy stresses on current volumes elastic energy would leak by stress over modulus, 1e-4 of E_0 here.
"""

from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.hexmodes import (
    CORNERS,
    LANES,
    THIRD,
    cofactors,
    gather_modes,
    hex_volume,
    nodal_forces,
    slope,
)
from fem_impact.fem.kernels import Counts, inlined, kernel
from fem_impact.solid.plastic_return import RETURN_ROWS, return_map

# scratch rows: modes of x, of the increment and of the force (21 each), then point values
POSITION, INCREMENT, FORCE, COFACTOR, ROTATED, TRIAL2, DET, RETURN = 0, 21, 42, 63, 72, 78, 79, 80
ROWS = RETURN + RETURN_ROWS


@inlined
def _mid_step(g00, g01, g02, g10, g11, g12, g20, g21, g22):  # type: ignore[no-untyped-def]
    """Refer du/dx(new) to the mid-step configuration: g (1 - g/2)^-1 = g + g g / 2 + O(g^3)."""
    return (
        g00 + 0.5 * (g00 * g00 + g01 * g10 + g02 * g20),
        g01 + 0.5 * (g00 * g01 + g01 * g11 + g02 * g21),
        g02 + 0.5 * (g00 * g02 + g01 * g12 + g02 * g22),
        g10 + 0.5 * (g10 * g00 + g11 * g10 + g12 * g20),
        g11 + 0.5 * (g10 * g01 + g11 * g11 + g12 * g21),
        g12 + 0.5 * (g10 * g02 + g11 * g12 + g12 * g22),
        g20 + 0.5 * (g20 * g00 + g21 * g10 + g22 * g20),
        g21 + 0.5 * (g20 * g01 + g21 * g11 + g22 * g21),
        g22 + 0.5 * (g20 * g02 + g21 * g12 + g22 * g22),
    )


@inlined
def _increment_gradient(w, l, X, Y, Z):  # type: ignore[no-untyped-def]
    """Return the mid-step gradient of the displacement increment; keep cofactors and determinant."""
    j = slope(w, POSITION, l, X, Y, Z)
    c = cofactors(*j)
    k = COFACTOR * LANES + l
    w[k], w[k + LANES], w[k + 2 * LANES] = c[0], c[1], c[2]
    w[k + 3 * LANES], w[k + 4 * LANES], w[k + 5 * LANES] = c[3], c[4], c[5]
    w[k + 6 * LANES], w[k + 7 * LANES], w[k + 8 * LANES] = c[6], c[7], c[8]
    det = j[0] * c[0] + j[3] * c[3] + j[6] * c[6]
    w[DET * LANES + l] = det
    u00, u01, u02, u10, u11, u12, u20, u21, u22 = slope(w, INCREMENT, l, X, Y, Z)
    r = 1.0 / det
    return _mid_step(
        (u00 * c[0] + u01 * c[1] + u02 * c[2]) * r,
        (u00 * c[3] + u01 * c[4] + u02 * c[5]) * r,
        (u00 * c[6] + u01 * c[7] + u02 * c[8]) * r,
        (u10 * c[0] + u11 * c[1] + u12 * c[2]) * r,
        (u10 * c[3] + u11 * c[4] + u12 * c[5]) * r,
        (u10 * c[6] + u11 * c[7] + u12 * c[8]) * r,
        (u20 * c[0] + u21 * c[1] + u22 * c[2]) * r,
        (u20 * c[3] + u21 * c[4] + u22 * c[5]) * r,
        (u20 * c[6] + u21 * c[7] + u22 * c[8]) * r,
    )


@inlined
def _spun(s0, s1, s2, s3, s4, s5, w01, w12, w02):  # type: ignore[no-untyped-def]
    """Return the change of the deviator (xx, yy, zz, xy, yz, zx) by an increment of spin, Jaumann's term."""
    return (
        2.0 * (w01 * s3 + w02 * s5),
        2.0 * (w12 * s4 - w01 * s3),
        -2.0 * (w02 * s5 + w12 * s4),
        w01 * (s1 - s0) + w02 * s4 + w12 * s5,
        w12 * (s2 - s1) - w01 * s5 - w02 * s3,
        w02 * (s2 - s0) + w01 * s4 - w12 * s3,
    )


@inlined
def _stretched(w, l, G2, X, Y, Z):  # type: ignore[no-untyped-def]
    """Return the increments of the elastic deviator, Pa, and of spin of one Gauss point's lane."""
    h00, h01, h02, h10, h11, h12, h20, h21, h22 = _increment_gradient(w, l, X, Y, Z)
    mean = (h00 + h11 + h22) * THIRD
    return (
        G2 * (h00 - mean),
        G2 * (h11 - mean),
        G2 * (h22 - mean),
        0.5 * G2 * (h01 + h10),
        0.5 * G2 * (h12 + h21),
        0.5 * G2 * (h02 + h20),
        0.5 * (h01 - h10),
        0.5 * (h12 - h21),
        0.5 * (h02 - h20),
    )


@inlined
def _trial(w, stress, G2, X, Y, Z):  # type: ignore[no-untyped-def]
    """Write the elastic trial deviator of one Gauss point into ``stress``.

    The spin turns the stress of the middle of the step, to second order. The stress before the step, turned
    to first order, gives elements that ring a little more energy with every step: 2e-3 of E_0 in 1.7 ms.
    """
    for l in range(LANES):
        s0, s1, s2 = stress[l], stress[l + LANES], stress[l + 2 * LANES]
        s3, s4, s5 = stress[l + 3 * LANES], stress[l + 4 * LANES], stress[l + 5 * LANES]
        d0, d1, d2, d3, d4, d5, w01, w12, w02 = _stretched(w, l, G2, X, Y, Z)
        m0, m1, m2 = s0 + 0.5 * d0, s1 + 0.5 * d1, s2 + 0.5 * d2
        m3, m4, m5 = s3 + 0.5 * d3, s4 + 0.5 * d4, s5 + 0.5 * d5
        a0, a1, a2, a3, a4, a5 = _spun(m0, m1, m2, m3, m4, m5, w01, w12, w02)
        m0, m1, m2 = m0 + 0.5 * a0, m1 + 0.5 * a1, m2 + 0.5 * a2
        m3, m4, m5 = m3 + 0.5 * a3, m4 + 0.5 * a4, m5 + 0.5 * a5
        a0, a1, a2, a3, a4, a5 = _spun(m0, m1, m2, m3, m4, m5, w01, w12, w02)
        t0, t1, t2, t3, t4, t5 = s0 + a0, s1 + a1, s2 + a2, s3 + a3, s4 + a4, s5 + a5
        r = ROTATED * LANES + l
        w[r], w[r + LANES], w[r + 2 * LANES] = t0, t1, t2
        w[r + 3 * LANES], w[r + 4 * LANES], w[r + 5 * LANES] = t3, t4, t5
        t0, t1, t2, t3, t4, t5 = t0 + d0, t1 + d1, t2 + d2, t3 + d3, t4 + d4, t5 + d5
        stress[l], stress[l + LANES], stress[l + 2 * LANES] = t0, t1, t2
        stress[l + 3 * LANES], stress[l + 4 * LANES], stress[l + 5 * LANES] = t3, t4, t5
        w[TRIAL2 * LANES + l] = 1.5 * (t0 * t0 + t1 * t1 + t2 * t2) + 3.0 * (t3 * t3 + t4 * t4 + t5 * t5)


@inlined
def _yielding_lanes(w, flow):  # type: ignore[no-untyped-def]
    """Return how many lanes are beyond their flow stress; counting has no branch, so lanes go together."""
    count = 0
    for l in range(LANES):
        count += w[TRIAL2 * LANES + l] > flow[l] * flow[l]
    return count


@inlined
def _add_force(w, stress, weight, pressure, X, Y, Z):  # type: ignore[no-untyped-def]
    """Add one Gauss point's stress times cofactors to the force modes."""
    for l in range(LANES):
        share, p = weight[l] / w[DET * LANES + l], pressure[l]
        s0, s1, s2 = share * stress[l] + p, share * stress[l + LANES] + p, share * stress[l + 2 * LANES] + p
        s3, s4 = share * stress[l + 3 * LANES], share * stress[l + 4 * LANES]
        s5 = share * stress[l + 5 * LANES]
        for i in range(3):
            a, b, c = (s0, s3, s5) if i == 0 else ((s3, s1, s4) if i == 1 else (s5, s4, s2))
            k = COFACTOR * LANES + l
            p0 = a * w[k] + b * w[k + 3 * LANES] + c * w[k + 6 * LANES]
            p1 = a * w[k + LANES] + b * w[k + 4 * LANES] + c * w[k + 7 * LANES]
            p2 = a * w[k + 2 * LANES] + b * w[k + 5 * LANES] + c * w[k + 8 * LANES]
            f = (FORCE + i) * LANES + l
            w[f] += p0
            w[f + 3 * LANES] += p1
            w[f + 6 * LANES] += p2
            w[f + 9 * LANES] += Z * p1 + Y * p2
            w[f + 12 * LANES] += Z * p0 + X * p2
            w[f + 15 * LANES] += Y * p0 + X * p1
            w[f + 18 * LANES] += Y * Z * p0 + Z * X * p1 + X * Y * p2


@inlined
def _update_pressure(w, volume, pressure, K):  # type: ignore[no-untyped-def]
    """Set the element pressures from the volume ratio."""
    for l in range(LANES):
        J = hex_volume(w, POSITION, l) / volume[l]
        pressure[l] = K * np.log(J) / J


@inlined
def _update_point_pressure(w, weight, pressure, K):  # type: ignore[no-untyped-def]
    """Set the pressures of one Gauss point from its own volume ratio: plain full integration."""
    for l in range(LANES):
        J = w[DET * LANES + l] / weight[l]
        pressure[l] = K * np.log(J) / J


class Blocks(NamedTuple):
    """State of all elements in blocks of ``LANES`` (a named tuple, so that compiled code reads it).

    Attributes
    ----------
    dof : (blocks, 3, 8, LANES) uint32: a place that may be negative would be tested at every reading
    stress : (blocks, 8, 6 * LANES) Kirchhoff deviator, Pa
    strain, flow : (blocks, 8, LANES) equivalent plastic strain, flow stress at vanishing rate in Pa
    weight : (blocks, 8, LANES) reference volume of each Gauss point, m3
    pressure, volume : (blocks, LANES), Pa (tension positive), reference m3
    work : (blocks, LANES) plastic work so far, J
    nodal : (blocks, 3, 8, LANES) forces of the elements on their nodes, N
    """

    dof: Counts
    stress: Array
    strain: Array
    flow: Array
    weight: Array
    pressure: Array
    volume: Array
    work: Array
    nodal: Array


@kernel
def update(x, v, dt, z, G, K, law, rate, full, w):  # type: ignore[no-untyped-def]
    """Advance blocks ``z`` by the increment ``dt v`` to ``x`` and set their nodal forces.

    ``full`` takes plain full integration in place of the mean dilatation; ``w`` (ROWS * LANES,) is work
    space.
    """
    for b in range(len(z.dof)):
        gather_modes(x, 1.0, z.dof[b], w[POSITION * LANES :])
        gather_modes(v, dt, z.dof[b], w[INCREMENT * LANES :])
        w[FORCE * LANES : (FORCE + 21) * LANES] = 0.0
        _update_pressure(w, z.volume[b], z.pressure[b], K)
        for g in range(8):
            X, Y, Z = CORNERS[g, 0], CORNERS[g, 1], CORNERS[g, 2]
            stress, weight, flow = z.stress[b, g], z.weight[b, g], z.flow[b, g]
            _trial(w, stress, 2.0 * G, X, Y, Z)
            if _yielding_lanes(w, flow):
                trial2, rotated = w[TRIAL2 * LANES :], w[ROTATED * LANES :]
                strain, work, room = z.strain[b, g], z.work[b], w[RETURN * LANES :]
                return_map(room, trial2, rotated, stress, weight, flow, strain, work, 3.0 * G, law, rate, dt)
            if full:
                _update_point_pressure(w, weight, z.pressure[b], K)
            _add_force(w, stress, weight, z.pressure[b], X, Y, Z)
        nodal_forces(w[FORCE * LANES :], z.nodal[b])


@kernel
def subtract_nodal(places, start, entries, nodal, force):  # type: ignore[no-untyped-def]
    """Subtract the forces of all elements around each node, always in the same order.

    ``entries`` are the places of the first components in the flat ``nodal``, in rows over nodes.
    """
    for i in range(len(places)):
        t, b, n = 0.0, 0.0, 0.0
        for p in range(start[i], start[i + 1]):
            k = entries[p]
            t += nodal[k]
            b += nodal[k + 8 * LANES]
            n += nodal[k + 16 * LANES]
        force[places[i, 0]] -= t
        force[places[i, 1]] -= b
        force[places[i, 2]] -= n


@kernel
def _add_energy(sums, stress, weight, G4):  # type: ignore[no-untyped-def]
    """Add one Gauss point's shear energy to each lane's sum, J."""
    for l in range(LANES):
        square = stress[l] ** 2 + stress[l + LANES] ** 2 + stress[l + 2 * LANES] ** 2
        shear = stress[l + 3 * LANES] ** 2 + stress[l + 4 * LANES] ** 2 + stress[l + 5 * LANES] ** 2
        sums[l] += (square + 2.0 * shear) * weight[l] / G4


@inlined
def _add_swelling(sums, w, weight, K, X, Y, Z):  # type: ignore[no-untyped-def]
    """Add the energy of one Gauss point's volume ratio to each lane's sum, J."""
    for l in range(LANES):
        j = slope(w, POSITION, l, X, Y, Z)
        c = cofactors(*j)
        swelling = np.log((j[0] * c[0] + j[3] * c[3] + j[6] * c[6]) / weight[l])
        sums[l] += 0.5 * K * swelling * swelling * weight[l]


@kernel
def elastic_energy(x, z, G, K, full, w):  # type: ignore[no-untyped-def]
    """Return the elastic energy, J, of all blocks ``z`` at the positions ``x`` of the last update."""
    sums = w[FORCE * LANES : (FORCE + 1) * LANES]
    sums[:] = 0.0
    for b in range(z.dof.shape[0]):
        gather_modes(x, 1.0, z.dof[b], w[POSITION * LANES :])
        if full:
            for g in range(8):
                _add_swelling(sums, w, z.weight[b, g], K, CORNERS[g, 0], CORNERS[g, 1], CORNERS[g, 2])
        else:
            for l in range(LANES):
                swelling = np.log(hex_volume(w, POSITION, l) / z.volume[b, l])
                sums[l] += 0.5 * K * swelling * swelling * z.volume[b, l]
        for g in range(8):
            _add_energy(sums, z.stress[b, g], z.weight[b, g], 4.0 * G)
    return sums.sum()
