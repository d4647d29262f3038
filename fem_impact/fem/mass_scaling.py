"""Selective mass scaling: small cells get more mass, so that they do not set the step of the run.

The step of explicit integration is a share of the time in which a pressure wave crosses the thinnest cell. A
cell that is crossed faster than wanted gets as much mass as slows the wave down to that (conventional
selective mass scaling, node by node; Olovsson, Simonsson and Unosson 2005, doi:10.1002/nme.1293). What a free
rod gains in small cells is taken off its larger ones, so that its mass, centre and moment of inertia stay.
"""

from math import sqrt

import numpy as np

from fem_impact.arrays import Array, Bools
from fem_impact.case.recorded import AnyZones
from fem_impact.fem.hexmodes import CORNERS, reference_gradients
from fem_impact.physics.contact import pressure_speed
from fem_impact.scene.material import Material
from meshes import HexMesh

# height, over the size asked for, of a cell that gets no mass at a scaling of 1: rows of cells drawn together
# at the barrier's skin are lower, and would set the step. With 0.8, e of t5b fell by .001 on 0.59 and 0.30 mm
# and the closing loss rose to 4e-4 and 1.2e-4 of E_0; both grow with the square
LOW = 0.65
MOST_REMOVED = 0.6  # largest share of a cell's mass that may be taken off
ROUND_OFF = 1e-12  # of the rod's mass
BACK = 0.9  # over the last mass scaling tried, where the rod could not make up for that
LEAST = 0.15  # scaling at which thin rows of a rod, a quarter as high as its cells, gain no mass


def reference_time(zones: AnyZones, materials: dict[str, Material]) -> float:
    """Return the time, s, in which a wave crosses a cell `LOW` of the finest size high, of the faster body.

    ``materials`` are those of the meshed bodies, ``rod`` and ``barrier``.
    """
    sizes = {"rod": zones.tip_size, "barrier": zones.barrier_size}
    return LOW * min(sizes[body] / pressure_speed(steel) for body, steel in materials.items())


def crossing_times(mesh: HexMesh, points: Array, steel: Material) -> Array:
    """Return the time (m,), s, in which a pressure wave crosses each cell of a mesh where it is thinnest."""
    jacobian = np.einsum("qai,maj->mqij", reference_gradients(CORNERS), points[mesh.cells])
    half = np.linalg.svd(jacobian, compute_uv=False)[:, :, -1].min(axis=1)
    return np.asarray(2.0 * half / pressure_speed(steel))


def mass_factors(crossing: Array, wanted: float) -> Array:
    """Return the factors (m,) on the masses of cells by which no crossing takes less than ``wanted``, s."""
    return np.asarray(np.maximum(1.0, wanted / crossing) ** 2)


def scaled_rod(
    mass: Array,
    place: Array,
    free: Bools,
    crossing: Array,
    reference: float,
    scaling: float,
    least: float = 1.0,
) -> tuple[Array, float]:
    """Add mass to a free rod's small cells and take as much off its large ones.

    The rod's mass, mass centre and moment of inertia about the b axis stay. The share of its mass that a cell
    loses is a combination of 1, t, n and t^2 + n^2 at its centre, times how much it may lose before it sets
    the step itself. Where a cell would have to lose more than `MOST_REMOVED`, a smaller scaling is tried.

    Parameters
    ----------
    mass : (m, 8) true masses of each cell at its nodes, kg
    place : (m, 8, 3) their positions (t, b, n), m
    free : (m,) cells whose mass may change
    crossing : (m,), s, as `crossing_times` gives it; reference : s, as `reference_time`
    scaling : largest one to try, 1 or more: free cells get so much mass that a wave takes at least
        reference sqrt(scaling) to cross each
    least : smallest one to try; below 1 it concerns thin rows alone

    Returns
    -------
    masses : (m, 8) of each cell at its nodes, kg
    reached : the scaling that they have, at least 1 and at most the one asked for
    """
    moments = np.stack(
        [np.ones(mass.shape), place[:, :, 0], place[:, :, 2], (place[:, :, ::2] ** 2).sum(axis=2)]
    )
    moments /= np.abs(moments).max(axis=(1, 2))[:, None, None]
    while scaling > least:
        wanted = reference * sqrt(scaling)
        added = mass * (free * (mass_factors(crossing, wanted) - 1))[:, None]
        shapes = free * (1 - np.minimum(1.0, wanted / crossing) ** 2) * moments.mean(axis=2)
        lost = np.einsum("kca,jc,ca->kj", moments, shapes, mass)
        gained = np.einsum("kca,ca->k", moments, added)
        parts = np.linalg.lstsq(lost, gained, rcond=None)[0]
        share, missed = parts @ shapes, np.abs(lost @ parts - gained).max()
        if np.abs(share).max() <= MOST_REMOVED and missed <= ROUND_OFF * mass.sum():
            return mass + added - share[:, None] * mass, max(scaling, 1.0)
        scaling *= BACK
    return mass, 1.0
