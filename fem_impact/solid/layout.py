"""Numbering of the unknowns: every vector of the march is flat, and this is who stands where."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes import HexMesh, RodMesh

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Layout:
    """Places of all degrees of freedom in one flat vector.

    Order: rod slices as (component, section node, layer) so that a layer's neighbours are contiguous,
    free nose nodes, free barrier nodes, hanging nodes, one dummy element that fills up blocks.

    Attributes
    ----------
    rod : (n, 3) int64, places of every rod mesh node
    barrier : (n, 3) int64, places of every barrier mesh node (no rows on a rigid barrier)
    body_shape : rows (3 * section nodes) and layers of the slices
    rod_size, free_size, size : ends of the rod's free part, of all free parts, of the vector
    dummy : (8, 3) int64
    """

    rod: Ints
    barrier: Ints
    body_shape: tuple[int, int]
    rod_size: int
    free_size: int
    size: int
    dummy: Ints

    @property
    def barrier_slice(self) -> slice:
        """Return the barrier's free part."""
        return slice(self.rod_size, self.free_size)

    def slices_of(self, vector: Array) -> Array:
        """Return the slices' part of a vector, a view of shape ``body_shape``."""
        rows, layers = self.body_shape
        return vector[: rows * layers].reshape(rows, layers)


def _triples(start: int, count: int) -> Ints:
    return start + np.arange(3 * count, dtype=np.int64).reshape(count, 3)


def _body_places(n_section: int, n_layers: int) -> Ints:
    """Return (n_section, n_layers, 3) places of the slice nodes."""
    grid = np.arange(3 * n_section * n_layers, dtype=np.int64)
    return grid.reshape(3, n_section, n_layers).transpose(1, 2, 0)


def number(rod: RodMesh, barrier: HexMesh | None) -> Layout:
    """Return the numbering of a rod and, if meshed, its barrier."""
    n_section, n_layers = rod.body_nodes.shape
    places = np.full((len(rod.mesh.points), 3), -1, dtype=np.int64)
    places[rod.body_nodes] = _body_places(n_section, n_layers)
    rest = (places[:, 0] < 0) & ~rod.mesh.is_hanging
    places[rest] = _triples(3 * n_section * n_layers, int(rest.sum()))
    rod_size = int(places.max()) + 1
    hanging_barrier = barrier.is_hanging if barrier is not None else np.zeros(0, dtype=bool)
    block = np.full((len(hanging_barrier), 3), -1, dtype=np.int64)
    block[~hanging_barrier] = _triples(rod_size, int((~hanging_barrier).sum()))
    free_size = rod_size + 3 * int((~hanging_barrier).sum())
    n_hanging = int(rod.mesh.is_hanging.sum())
    places[rod.mesh.is_hanging] = _triples(free_size, n_hanging)
    block[hanging_barrier] = _triples(free_size + 3 * n_hanging, int(hanging_barrier.sum()))
    end = free_size + 3 * (n_hanging + int(hanging_barrier.sum()))
    shape = (3 * n_section, n_layers)
    return Layout(places, block, shape, rod_size, free_size, end + 24, _triples(end, 8))
