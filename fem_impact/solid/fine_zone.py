"""What left the fine zones of a run (skin, yielding), and plastic work at the surface of a body.

Plastic work in the uppermost layer of a body is hard to separate from friction: under a sticking tip the
softer body shears in a layer whose thickness follows from the mesh, as the material law has no length scale.
Finer meshes move work from friction into plastic work right below the surface.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.case.record import ContactRecord
from fem_impact.fem.hexmodes import CORNERS, SIGNS
from fem_impact.physics.hardening import PROOF_STRAIN
from fem_impact.solid.contact.patch import bilinear
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.solid.stepguard import when_and_where
from meshes import SKIN
from meshes.hexmesh import quad_normals

if TYPE_CHECKING:
    from scipy.spatial import Delaunay

    from fem_impact.solid.yielding import YieldingZone


DEPTH = 0.1e-3  # m, thickness of the uppermost layer
SHAPES = np.prod(1 + SIGNS[None] * CORNERS[:, None], axis=2) / 8  # (points, nodes)


def skin_shares(model: Model) -> dict[str, float]:
    """Return the share of the plastic work of ``rod`` and ``barrier`` done above `DEPTH`; 0 if none is."""
    under, shares = depths(model), {}
    for body in ("rod", "barrier"):
        zones = [zone for zone in model.zones if zone.body == body]
        above = sum(_work_above(zone, under[zone.places()[:, :, 2]]) for zone in zones)
        whole = float(sum(zone.spent()[1].sum() for zone in zones))
        shares[body] = above / whole if whole else 0.0
    return shares


def depths(model: Model) -> Array:
    """Return how deep, m, each node lay under the surface of its body, at the place of its unknown along n.

    Of the rod it is the distance from the tangential plane of its skin at the nearest node there.
    """
    from scipy.spatial import KDTree  # as the last of a run: none waits for it before its first step

    x, places, mesh = model.start[0], model.layout.rod, model.geometry.rod.mesh
    under, points = -x, x[places]
    quads = mesh.faces_with(SKIN)
    skin, normals = np.unique(quads), np.zeros((len(points), 3))
    np.add.at(normals, quads, quad_normals(points[quads])[:, None])
    distance, at = KDTree(points[skin]).query(points)
    normal = normals[skin[at]]
    away = np.abs(((points - points[skin[at]]) * normal).sum(axis=1))
    length = np.linalg.norm(normal, axis=1)
    # faces back to back at an edge without thickness have no common normal
    under[places[:, 2]] = np.divide(away, length, out=distance, where=length > 0)
    return np.asarray(under)


def _work_above(zone: YieldingZone, nodes: Array) -> float:
    """Return the work, J, above `DEPTH` of elements whose nodes lie ``nodes`` (m, 8), m, under the surface.

    Within an element work divides as plastic strain does; a Gauss point's is spread over half the height.
    """
    top, bottom = nodes.min(axis=1)[:, None], nodes.max(axis=1)[:, None]
    middle = 0.5 * (top + bottom)
    low = nodes @ SHAPES.T > middle
    # a cell from face to face has nodes alike deep: it lies above or below as a whole
    upper_end, height = np.where(low, middle, top), np.broadcast_to(0.5 * (bottom - top), low.shape)
    whole = np.where(upper_end < DEPTH, 1.0, 0.0)
    above = np.divide(np.clip(DEPTH - upper_end, 0.0, height), height, out=whole, where=height > 0)
    strain, work = zone.spent()
    total = strain.sum(axis=1)
    parts = np.divide((above * strain).sum(axis=1), total, out=np.zeros_like(total), where=total > 0)
    return float(parts @ work)


DEEP = 0.25  # depth over the tip size at which skin outside the contact stops the run
LEVEL = 1e-9  # m, within which a node lies on the barrier's face


class SkinWatch:
    """Observer of the rod's skin outside the contact patch, which must not reach a meshed barrier.

    Skin a little below the barrier's plane, which sinks around the contact, gives a warning. More than `DEEP`
    of the tip size stops the run: no contact force acts there. A plate that is meshed through its thickness
    gives way as a whole: there its deformed surface counts.
    """

    every = 100
    moving: ClassVar[tuple[str, ...]] = ("lowest",)

    def __init__(self, model: Model, bends: bool = False) -> None:
        contact, mesh = model.contact, model.geometry.rod.mesh
        skin = np.unique(mesh.faces_with(SKIN))
        places = model.layout.rod[skin]
        touching = contact.rod.places if isinstance(contact, SurfaceContact) else places
        outside = ~np.isin(places[:, 2], touching[:, 2])
        self.nodes, self.places = skin[outside], places[outside]
        self.ground = model.ground
        self.top: tuple[Ints, Delaunay] | None = None
        if bends:  # the unknowns (k, 3) of the nodes on the barrier's face, and triangles between them
            from scipy.spatial import Delaunay

            x, barrier = model.start[0], model.layout.barrier
            nodes = barrier[np.abs(x[barrier[:, 2]]) < LEVEL]
            self.top = nodes, Delaunay(x[nodes[:, :2]])
        self.lowest = np.inf
        self.deepest = -DEEP * model.geometry.tip_size
        self.reason = ""

    def observe(self, state: State) -> bool:
        """Record the lowest height so far; stop the run when it is too deep."""
        heights = self._heights(state.x)
        self.lowest = min(self.lowest, float(np.min(heights, initial=np.inf)))
        if self.lowest >= self.deepest:
            return False
        place = self.places[int(np.argmin(heights))]
        self.reason = (
            "The rod came down on the barrier outside the meshed contact "
            f"{when_and_where(state, state.x[place])} A larger accuracy.tip_size widens the zone that is "
            "meshed; or use the barrier-rigid effect, or another angle."
        )
        return True

    def _heights(self, x: Array) -> Array:
        """Return how high, m, the skin outside the contact patch stands over the barrier."""
        t, b, n = x[self.places].T
        if self.top is None:
            return self.ground.levelled(t, n, x) - self.ground.risen(x)
        from scipy.interpolate import LinearNDInterpolator  # .4 s, for plates alone

        nodes, cells = self.top
        return np.asarray(n - LinearNDInterpolator(cells, x[nodes[:, 2]], fill_value=0.0)(t, np.abs(b)))

    def with_landed(self, record: ContactRecord, model: Model, x: Array) -> ContactRecord:
        """Return the record with skin that came down outside, if that ended the run, as touched.

        The mesh of the next run is fine there too. Cells outside are wide: the skin between two nodes counts
        as low as a straight line between them.
        """
        if not self.reason:
            return record
        mesh = model.geometry.rod.mesh
        heights = np.full(len(mesh.points), np.inf)
        heights[self.nodes] = self._heights(x)
        quads = mesh.faces_with(SKIN)
        quads = quads[(heights[quads] < 0).any(axis=1) & np.isfinite(heights[quads]).all(axis=1)]
        widest = np.ptp(mesh.points[quads], axis=1).max(initial=0.0)
        s = np.linspace(-1.0, 1.0, 2 + int(widest / record.rod.edge))
        shape = np.stack(bilinear(*np.meshgrid(s, s)), axis=-1).reshape(-1, 4)  # (places, corners)
        low = shape @ heights[quads].T < 0
        rod, now = (
            np.einsum("pc,qcd->pqd", shape, of[quads])[low] for of in (mesh.points, x[model.layout.rod])
        )
        barrier = record.barrier and record.barrier.and_touched(now * (1.0, 1.0, 0.0))
        return replace(record, rod=record.rod.and_touched(rod), barrier=barrier)

    def below(self) -> str:
        """Say that skin went below the barrier's surface, an empty string where none did."""
        if self.lowest >= 0:
            return ""
        return (
            f"Skin of the rod outside its fine zone went {-self.lowest * 1e6:.0f} um below the barrier's "
            "surface without touching: the contact is wider than the fine zone."
        )


def outside_zones(model: Model, watch: SkinWatch) -> tuple[str, ...]:
    """Return sentences on contact and yielding that left the fine zones; empty ones where they did not."""
    said, nodes = [watch.below()], model.book.outside
    for zone in model.zones:
        if (strain := border_strain(model, zone)) > PROOF_STRAIN:  # below it an element has hardly yielded
            said.append(
                f"Yielding reached the edge of the {zone.body}'s fine zone (plastic strain {strain:.3f}): "
                "beyond it the material was taken as elastic. A larger accuracy.tip_size makes the zone "
                "wider."
            )
    if nodes:
        said.append(
            f"{nodes} rod nodes left the fine zone of the barrier while below its surface: "
            'friction and indentation there are missing. accuracy.fine_zone = "even" makes it wider, as does '
            "a larger accuracy.barrier_size."
        )
    return tuple(said)


def left_zones(model: Model, watch: SkinWatch) -> bool:
    """Return whether contact or yielding reached the end of the zones that the mesh held ready for them."""
    strained = any(border_strain(model, zone) > PROOF_STRAIN for zone in model.zones)
    return watch.lowest < 0 or model.book.outside > 0 or strained


def border_strain(model: Model, zone: YieldingZone) -> float:
    """Return the largest mean plastic strain of a yielding element that has a linear neighbour."""
    g = model.geometry
    mesh = g.rod.mesh if zone.body == "rod" or g.barrier is None else g.barrier
    yields = g.may_yield[zone.body]
    border = np.isin(mesh.cells[zone.cells], mesh.cells[~yields]).any(axis=1)
    return float(np.max(zone.plastic_strain(), where=border, initial=0.0))
