"""Numbering of the unknowns in the flat vectors of the time loop, and the mass points of the rod's slices."""

from dataclasses import dataclass
from math import pi

import numpy as np
import scipy.sparse as sp

from fem_impact.arrays import Array, Ints
from fem_impact.fem.eigen import MassStiffness
from fem_impact.fem.kernels import kernel
from meshes import HexMesh, RodMesh


@dataclass(frozen=True, slots=True)
class DofLayout:
    """Indices of all degrees of freedom in one flat vector.

    Order: rod slices as (component, section node, layer) so that a layer's neighbours are contiguous,
    free nose nodes, free barrier nodes, hanging nodes, the foundation, its angle, one dummy element that
    fills up blocks.

    Attributes
    ----------
    rod : (n, 3) int64, indices of the unknowns of all rod nodes
    barrier : (n, 3) int64, those of all barrier nodes (no rows for a rigid barrier)
    body_shape : number of rows (3 * section nodes) and of layers of the slices
    rod_size, free_size, size : ends of the rod's free part, of all free parts, of the vector
    dummy : (8, 3) int64, indices of the dummy element's unknowns
    foundation : (3,) int64, indices of the barrier's motion as a whole; (0,) where it is massive
    turn : (1,) int64, index of the barrier's angle, rad, from n towards t; (0,) where it does not turn
    """

    rod: Ints
    barrier: Ints
    body_shape: tuple[int, int]
    rod_size: int
    free_size: int
    size: int
    dummy: Ints
    foundation: Ints
    turn: Ints

    @property
    def barrier_slice(self) -> slice:
        """Return the barrier's free part."""
        return slice(self.rod_size, self.free_size)

    def ends(self, places: Ints) -> Ints:
        """Return the unknown of the foundation in the direction of each unknown of the barrier's nodes."""
        return np.asarray(self.foundation[(places - self.rod_size) % 3])

    def slices_of(self, vector: Array) -> Array:
        """Return the slices' part of a vector, a view of shape ``body_shape``."""
        rows, layers = self.body_shape
        return vector[: rows * layers].reshape(rows, layers)


def _triples(start: int, count: int) -> Ints:
    """Return the indices (count, 3) of ``count`` nodes numbered one after the other from ``start`` on."""
    return start + np.arange(3 * count, dtype=np.int64).reshape(count, 3)


def number(rod: RodMesh, barrier: HexMesh | None, foundation: bool = False, turns: bool = False) -> DofLayout:
    """Return the numbering of a rod and, if meshed, its barrier.

    A ``foundation`` lets the barrier move as a whole; it may have an angle, too, if it ``turns``.
    """
    n_section, n_layers = rod.body_nodes.shape
    places = np.full((len(rod.mesh.points), 3), -1, dtype=np.int64)
    grid = np.arange(3 * n_section * n_layers, dtype=np.int64).reshape(3, n_section, n_layers)
    places[rod.body_nodes] = grid.transpose(1, 2, 0)
    rest = (places[:, 0] < 0) & ~rod.mesh.is_hanging
    places[rest] = _triples(3 * n_section * n_layers, int(rest.sum()))
    rod_size = int(places.max()) + 1
    hangs = barrier.is_hanging if barrier is not None else np.zeros(0, dtype=bool)
    n_rod, n_block = int(rod.mesh.is_hanging.sum()), int(hangs.sum())
    free_size = rod_size + 3 * (len(hangs) - n_block)
    block = np.zeros((len(hangs), 3), dtype=np.int64)
    block[~hangs] = _triples(rod_size, len(hangs) - n_block)
    places[rod.mesh.is_hanging] = _triples(free_size, n_rod)
    block[hangs] = _triples(free_size + 3 * n_rod, n_block)
    end = free_size + 3 * (n_rod + n_block)
    whole = end + np.arange(3 * foundation, dtype=np.int64)
    turn = end + len(whole) + np.arange(turns, dtype=np.int64)
    end, shape = end + len(whole) + len(turn), (3 * n_section, n_layers)
    return DofLayout(places, block, shape, rod_size, free_size, end + 24, _triples(end, 8), whole, turn)


# section coordinate, x (0) or y (1), in which motions along t, b, n are linear: motions symmetric about the
# plane b = 0, as the solver's are, and antisymmetric ones
MIRRORED, TWISTING = (0, 1, 0), (1, 0, 1)


@dataclass(frozen=True, slots=True)
class MassPoints:
    """Mass points of the slices, in all layers but the first, whose nodes belong to the nose or may touch.

    Each mass lies closer to the axis than its node, so that a section has the polar moment of a circle.

    Attributes
    ----------
    lever, weight : (3 n,) over (component, section node): section coordinate l / sqrt(J) and m l / sqrt(J)
        of t, b, n, where J = sum(m l^2), so that the linear part of w is lever (weight . w)
    inward : (3,) section coordinate of a mass over that of its node, 1 where there are no slices
    room : (layers,) work space for sums over a section
    """

    lever: Array
    weight: Array
    inward: Array
    room: Array

    @classmethod
    def of_rod(
        cls,
        rod: RodMesh,
        mass: Array,
        density: float,
        linear: tuple[int, int, int] = MIRRORED,
        bore: float = 0.0,
    ) -> "MassPoints":
        """Return the mass points of a rod with row-sum masses ``mass`` (cells, 8), kg.

        The section is taken as the circle of its area, or as the ring around a ``bore`` of a radius, m. A
        body without slices has no mass points inside. ``linear`` says which section coordinate, x (0) or y
        (1), the motions along t, b, n are linear in.
        """
        if not rod.body_cells.size:
            return cls(np.zeros(0), np.zeros(0), np.ones(3), np.zeros(0))
        cells, tail = rod.body_cells[:, -1], rod.body_nodes[:, -1]
        upper = rod.mesh.cells[cells, 4:].ravel()
        m = np.bincount(upper, mass[cells, 4:].ravel(), minlength=len(rod.mesh.points))[tail]
        level = rod.mesh.points[tail][:, linear].T
        moment = (m * level**2).sum(axis=1)
        half_area = mass[cells].sum() / (density * rod.slice_length)
        # m (R^2 + r^2) / 4 with pi (R^2 - r^2) / 2 = half_area
        round_moment = m.sum() * half_area / (2 * pi) + m.sum() * bore**2 / 2
        root = np.sqrt(moment)[:, None]
        lever, weight = (level / root).ravel(), (m * level / root).ravel()
        return cls(lever, weight, np.sqrt(round_moment / moment), np.zeros(rod.body_nodes.shape[1]))

    def condense(self, rows: Array) -> None:
        """Convert, in place, positions of nodes (3 n, layers) into positions of mass points."""
        add_linear(self.lever, self.weight, self.inward - 1, self.room, rows)

    def expand(self, rows: Array) -> None:
        """Convert, in place, positions or velocities of mass points (3 n, layers) to the nodes'."""
        add_linear(self.lever, self.weight, 1 / self.inward - 1, self.room, rows)

    def gather(self, rows: Array) -> None:
        """Convert, in place, forces on nodes (3 n, layers) to mass points: `expand` transposed."""
        add_linear(self.weight, self.lever, 1 / self.inward - 1, self.room, rows)

    def section(self) -> sp.csr_matrix:
        """Return the matrix P (3 n, 3 n) of `expand` for one layer."""
        blocks = zip(self.lever.reshape(3, -1), self.weight.reshape(3, -1), 1 / self.inward - 1, strict=True)
        return sp.csr_matrix(sp.block_diag([np.eye(len(l)) + g * np.outer(l, w) for l, w, g in blocks]))

    def matrix(self, layers: int, size: int) -> sp.csr_matrix:
        """Return the matrix P (size, size) of `expand` over a flat vector; the slices' rows come first."""
        if not len(self.lever):
            return sp.identity(size, format="csr")
        inside = sp.diags(np.arange(layers) > 0, dtype=np.float64)
        slices = sp.kron(self.section() - sp.identity(len(self.lever)), inside)
        rest = size - slices.shape[0]
        return sp.csr_matrix(sp.block_diag([slices, sp.csr_matrix((rest, rest))]) + sp.identity(size))

    def reduced(self, parts: tuple[sp.csr_matrix, ...], layers: int) -> MassStiffness:
        """Return P^T K P, N/m, over the mass points; the sum of ``parts`` (size, size) is K."""
        return MassStiffness(parts, self.matrix(layers, parts[0].shape[0]))


@kernel
def add_linear(out, into, amount, part, rows):  # type: ignore[no-untyped-def]
    """Add amount[c] out (into . rows) to the rows of each component c, in all layers but the first."""
    n, layers = len(out) // 3, rows.shape[1]
    for c in range(3):
        part[:] = 0.0
        for a in range(c * n, (c + 1) * n):
            for k in range(1, layers):
                part[k] += into[a] * rows[a, k]
        for a in range(c * n, (c + 1) * n):
            share = amount[c] * out[a]
            for k in range(1, layers):
                rows[a, k] += share * part[k]
