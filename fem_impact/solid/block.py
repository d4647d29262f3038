"""A meshed barrier as items of the model: its linear part, and what stands for all that lies around it."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array
from fem_impact.fem.body import MeshedBody, stiffness_of
from fem_impact.fem.boundary import line_share, plate_edges, radiating_share, spread_boundary
from fem_impact.fem.layout import DofLayout
from fem_impact.fem.sparse import NodeProduct, tie_operator
from fem_impact.solid.elastic import Dashpots, ElasticBlock


@dataclass(frozen=True, slots=True)
class ElasticBlockParts:
    """Operators of a meshed barrier and of the half-space around it.

    Attributes
    ----------
    linear : the item of its linear part
    stiffness : (size, size) of all its cells, N/m
    springs, pots : (size, size), N/m, and (size,), N s/m, of the half-space
    middle, half : place along t where the block is struck, m, and how far it is to each side of it
    """

    linear: ElasticBlock
    stiffness: sp.csr_matrix
    springs: sp.dia_matrix
    pots: Array
    middle: float
    half: float


def elastic_block(
    body: MeshedBody,
    layout: DofLayout,
    x: Array,
    effect: str = "barrier-elastic",
    bending: float | None = None,
    middle: float = 0.0,
    half: float = 0.0,
) -> ElasticBlockParts:
    """Return a meshed barrier at positions ``x`` (size,) struck at t = ``middle``, m, and what is around it.

    A contact that is a line goes ``half``, m, to each side of that.

    A plate meshed through its thickness has no springs, and dashpots at its edges for bending waves of the
    phase speed ``bending``, m/s.
    """
    place = layout.barrier_slice
    shifted, n = body.places - place.start, place.stop - place.start
    T = tie_operator(body.mesh.tie, shifted, n)
    around = [
        plate_edges(body.mesh, m.E, m.nu, m.rho, bending)
        if bending
        else spread_boundary(body.mesh, m.E, m.nu, m.rho, cells, middle, half)
        for m, cells in body.parts
    ]
    spring, damping = (sum(parts[1:], parts[0]) for parts in zip(*around, strict=True))
    springs, pots = sp.diags(T.T @ spring.ravel()), T.T @ damping.ravel()
    linear = stiffness_of(body, ~body.yields, n, place.start)
    K = sp.csr_matrix(linear + springs)
    K.eliminate_zeros()  # nodes inside the yielding zone have no linear part
    item = ElasticBlock(NodeProduct.of(K, shifted[~body.mesh.is_hanging], x[place]), place, effect)
    whole = linear + stiffness_of(body, body.yields, n, place.start)
    return ElasticBlockParts(item, whole, springs, pots, middle, half)


def dashpots(
    body: MeshedBody, layout: DofLayout, inverse_mass: Array, block: ElasticBlockParts, lasts: float = inf
) -> Dashpots:
    """Return the dashpots around a block, which take the radiated energy of a contact that ``lasts``, s."""
    place, (m, _) = layout.barrier_slice, body.parts[-1]  # slow waves are far longer than layers are thick
    along = body.points - [block.middle, 0.0, 0.0]
    along[:, 0] = np.maximum(np.abs(along[:, 0]) - block.half, 0.0)
    away = np.linalg.norm(along, axis=1) + body.mesh.is_hanging
    nearest = np.flatnonzero(away <= away.min()) if block.half else int(away.argmin())
    loaded, material = body.places[nearest, 2] - place.start, (m.E, m.nu, m.rho)
    fixed, K = inverse_mass[place] == 0, sp.csr_matrix(block.stiffness + block.springs)
    share = radiating_share(K, block.pots, fixed, loaded, material)
    if block.half:
        share *= line_share(block.half, lasts, material)
    return _dashpots(block.pots * share, layout, inverse_mass)


def plate_dashpots(layout: DofLayout, inverse_mass: Array, block: ElasticBlockParts) -> Dashpots:
    """Return the dashpots at the edges of a plate meshed through its thickness, which take bending waves."""
    return replace(_dashpots(block.pots, layout, inverse_mass), effect="plate-bending", accounts=("plate",))


def _dashpots(damping: Array, layout: DofLayout, inverse_mass: Array) -> Dashpots:
    place = layout.barrier_slice
    places = place.start + np.flatnonzero(damping)
    places = places[inverse_mass[places] > 0]
    ends = layout.ends(places) if len(layout.foundation) else places[:0]
    return Dashpots(
        places, damping[places - place.start], inverse_mass[places], ends, inverse_mass[ends].copy()
    )
