"""Observer of where the bodies touch, and the record of a run: places of contact and cells that flowed."""

from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.case.record import BodyRecord, ContactRecord, Site
from fem_impact.solid.contact.moving_plane import MovingPlane
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.dent import border, sunk
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from meshes import HexMesh, edge_lengths

ON_PLANE = 1e-11  # m, within which a node that was stopped at a rigid plane lies on it
FLOWED = 1e-5  # mean plastic strain above which a cell counts as one that flowed
APART = 2.5  # cells between two places of contact
LOOKS, RAREST = 8, 10  # looks at the shortest contact at least, and most steps between two


class ContactWatch:
    """Observer of the skin that is pressed: when, and with which part of the impulse.

    Attributes
    ----------
    every : steps between two looks: so few that the shortest contact is seen `LOOKS` times
    rod : (k,) nodes of the rod's mesh that may touch; barrier : (m,) those of a meshed barrier
    first, last : (k,) s, when each node of the rod was seen pressed first and last
    impulse : (k, 2) along n and t, N s, on each node of the rod, of the half model
    pressed : (m,) whether a node of the barrier was pressed
    deepest : (m,) largest indentation there, m: under the surface before the impact; of a barrier that moves
        or bends under the surface around, whose nodes are ``border``
    """

    moving: ClassVar[tuple[str, ...]] = ("first", "last", "impulse", "pressed", "deepest")

    def __init__(self, model: Model, shortest: float, moves: bool) -> None:
        """Watch a model with contacts of ``shortest``, s, at least; ``moves``: its barrier does or bends."""
        self.model, contact = model, model.contact
        self.every = max(1, min(RAREST, int(shortest / LOOKS / model.step)))
        layout = model.layout
        self.barrier = np.zeros(0, np.int64)
        if isinstance(contact, SurfaceContact):
            places = contact.rod.places
            self.barrier = nodes_of(layout.barrier, contact.barrier.places)
            self.border = border(contact.barrier) if moves else np.zeros(0, np.int64)
        else:
            assert contact is not None, "a run has a contact"
            places = contact.nodes
        self.rod = nodes_of(layout.rod, places)
        self.first, self.last = np.full(len(self.rod), np.inf), np.full(len(self.rod), -np.inf)
        self.impulse = np.zeros((len(self.rod), 2))
        self.pressed, self.deepest = np.zeros(len(self.barrier), bool), np.zeros(len(self.barrier))

    def observe(self, state: State) -> bool:
        """Record which nodes are pressed now."""
        contact = self.model.contact
        if not self.model.book.touching:
            return False
        if isinstance(contact, SurfaceContact):
            # record pressed nodes of both surfaces, and the corners of the quads that they lie on
            p, count = contact.points.memory, len(contact.rod.places)
            over, under = np.flatnonzero(p[:count].any(axis=1)), np.flatnonzero(p[count:].any(axis=1))
            quads, (on, by) = contact.last, (contact.rod.quads, contact.barrier.quads)
            self._add(over, p[:count][:, [2, 0]], state.time)
            corners = on[quads[count + under]]
            share = np.zeros((count, 2))
            np.add.at(share, corners, 0.25 * p[count + under][:, None][:, :, [2, 0]])
            self._add(np.unique(corners), share, state.time)
            nodes = np.union1d(under, by[quads[over]])
            self.pressed[nodes] = True
            if len(self.border):
                deep = sunk(contact.barrier, self.border, state.x)[nodes]
            else:
                deep = -state.x[contact.barrier.places[nodes, 2]]
            self.deepest[nodes] = np.maximum(self.deepest[nodes], deep)
        elif isinstance(contact, MovingPlane):
            self._add(
                np.flatnonzero(contact.points.memory[:, 2]), contact.points.memory[:, [2, 0]], state.time
            )
        elif isinstance(contact, PlaneContact):
            here = np.flatnonzero(np.abs(state.x[contact.nodes[:, 2]]) < ON_PLANE)
            step = np.array([self.model.book.step.impulse_n, self.model.book.step.impulse_t])
            self._add(here, np.broadcast_to(step / max(len(here), 1), (len(self.rod), 2)), state.time)
        return False

    def _add(self, nodes: Ints, impulse: Array, time: float) -> None:
        self.first[nodes] = np.minimum(self.first[nodes], time)
        self.last[nodes] = time
        self.impulse[nodes] += 2 * self.every * impulse[nodes]

    def record(self) -> ContactRecord:
        """Return where the bodies touched and flowed."""
        g = self.model.geometry
        touched = np.isfinite(self.first)
        rod = self._of_body("rod", g.rod.mesh, self.rod[touched])
        barrier = (
            None if g.barrier is None else self._of_body("barrier", g.barrier, self.barrier[self.pressed])
        )
        return ContactRecord(rod, barrier, self._sites(np.flatnonzero(touched)))

    def _of_body(self, name: str, mesh: HexMesh, touched: Ints) -> BodyRecord:
        """Return the record of a body of which these nodes (k,) touched."""
        cells, strain = [np.zeros(0, np.int64)], [np.zeros(0)]
        for zone in self.model.zones:
            if zone.body == name:
                spent = zone.plastic_strain()
                cells.append(zone.cells[spent > FLOWED])
                strain.append(spent[spent > FLOWED])
        flowing = np.concatenate(cells)
        at = np.flatnonzero(np.isin(mesh.cells, touched).any(axis=1))
        edge = float(edge_lengths(mesh, at).mean()) if len(at) else self.model.geometry.tip_size
        size = edge_lengths(mesh, flowing).mean() if len(flowing) else edge
        centres = mesh.points[mesh.cells[flowing]].mean(axis=1)
        return BodyRecord(
            mesh.points[touched], centres, np.concatenate(strain), edge, 1.5 * edge, 1.5 * float(size)
        )

    def _sites(self, touched: Ints) -> tuple[Site, ...]:
        """Return the places of contact: groups of touched nodes that lie close together."""
        g = self.model.geometry
        points = g.rod_points[self.rod[touched]]
        groups = _groups(points, APART * g.tip_size)
        sites = []
        for group in range(groups.max(initial=-1) + 1):
            nodes, at = touched[groups == group], points[groups == group]
            low, high = at[:, :2].min(axis=0), at[:, :2].max(axis=0)
            impulse_n, impulse_t = (float(part) for part in self.impulse[nodes].sum(axis=0))
            depth = 0.0
            if g.barrier is not None:
                place = g.barrier.points[self.barrier, :2]
                inside = ((place >= low - g.tip_size) & (place <= high + g.tip_size)).all(axis=1)
                depth = float(np.max(self.deepest, where=inside, initial=0.0))
            sites.append(
                Site(
                    start=float(self.first[nodes].min()),
                    end=float(self.last[nodes].max()),
                    impulse_n=impulse_n,
                    impulse_t=impulse_t,
                    low=(float(low[0]), float(low[1])),
                    high=(float(high[0]), float(high[1])),
                    depth=depth,
                )
            )
        return tuple(sorted(sites, key=lambda site: site.start))


def nodes_of(layout: Ints, places: Ints) -> Ints:
    """Return the nodes (k,) of a mesh whose unknowns in ``layout`` (n, 3) are ``places`` (k, 3)."""
    order = np.argsort(layout[:, 2])
    return np.asarray(order[np.searchsorted(layout[order, 2], places[:, 2])])


def _groups(points: Array, apart: float) -> Ints:
    """Return the group (k,) of each point: points closer than ``apart``, m, are of one."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    pairs = KDTree(points).query_pairs(apart, output_type="ndarray")
    n = len(points)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1])
