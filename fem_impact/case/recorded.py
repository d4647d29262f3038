"""Fine zones of the meshes from the record of a coarser run, or from what may touch at first."""

from dataclasses import dataclass
from math import floor, log2, sqrt

import numpy as np

from fem_impact.arrays import Array, Bools
from fem_impact.case.bodies import Bodies
from fem_impact.case.effects.skin import skin_of
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.case.plates import is_thin
from fem_impact.case.record import BodyRecord, ContactRecord
from fem_impact.case.zones import (
    MOST_ROWS,
    SKIN_ROWS,
    Corners,
    Zones,
    base_cells,
    follows_skin,
    rows_for,
    skin_rows,
)
from fem_impact.physics.plate import plate_waves
from meshes import Cloud, HexMesh, thin_skin_rise

# Plastic strain above which metal gets cells of the finest level, and half-widths of the contact around the
# skin that is pressed in which all does: small cells pay where metal flows most, right under the contact
FLOWING, UNDER = 0.02, 0.6
LINE = 2.0  # cells of the body, half of the length by which a contact is longer than wide, to be a line
ROD_ROWS = 2  # thin rows under the pressed skin of a rod that yields: three ask for a smaller step, or mass


@dataclass(frozen=True, slots=True)
class RecordedZones:
    """Fine zones around all places where two bodies touched and flowed, m; the names are those of `Zones`.

    Attributes
    ----------
    base, rod_base : edges of the cells of barrier and rod where they touch, before they are split
    levels, below : how often those of the rod and of the barrier are split
    record : where they touched and flowed
    conforming : the barrier flows under all of the contact; skin_rows : thin rows of cells at its top
    rod_rows : the same under the skin of the rod
    layered : a hardened layer of the rod lies in them: cells are fine deep enough for all of them
    edges : how far a plate that is meshed through its thickness goes beyond its fine zone; else 0
    """

    base: float
    rod_base: float
    levels: int
    below: int
    record: ContactRecord
    conforming: bool
    skin_rows: int
    rod_rows: int
    layered: bool = False
    edges: float = 0.0

    @property
    def tip_size(self) -> float:
        """Return the finest cell edge of the rod, m."""
        return self.rod_base * 0.5**self.levels

    @property
    def barrier_size(self) -> float:
        """Return the finest cell edge of the barrier along t and b, m."""
        return self.base * 0.5**self.below

    @property
    def rise(self) -> float:
        """Return by how much, m, the barrier's bottom rises where the rows at its skin are drawn together."""
        return thin_skin_rise(self.skin_rows) * self.barrier_size

    @property
    def middle(self) -> float:
        """Return the place along t, m, about which the block is struck: the middle of all that is pressed."""
        if self.record.barrier is None:
            return 0.0
        touched = self.record.barrier.touched[:, 0]
        return 0.5 * float(touched.min() + touched.max())

    @property
    def line(self) -> float:
        """Return half of the length, m, by which a contact is longer than wide; 0 of a short one.

        It is pressed all along: a tip and a tail that strike one after the other are no line.
        """
        if self.record.barrier is None:
            return 0.0
        touched = self.record.barrier.touched
        t = np.sort(touched[:, 0])
        half = 0.5 * float(t[-1] - t[0]) - float(np.abs(touched[:, 1]).max())
        return half if half > LINE * self.base and np.diff(t).max() < half / 2 else 0.0

    @property
    def lasts(self) -> float | None:
        """Return how long, s, the place that took most of the impulse was touched; None before a run."""
        strongest = max(self.record.sites, key=lambda site: site.impulse_n, default=None)
        return None if strongest is None else strongest.end - strongest.start

    @property
    def ends(self) -> tuple[float, float] | None:
        """Return the places along t, m, at which a contact that was found ends on a barrier that flows."""
        if self.record.crushed or not (self.conforming and self.record.sites):
            return None
        touched = self._of_barrier.touched[:, 0]
        return float(touched.min()), float(touched.max())

    @property
    def _of_barrier(self) -> BodyRecord:
        barrier = self.record.barrier
        assert barrier is not None, "a rigid barrier has no zones"
        return barrier

    def in_rod(self, lowest: Array, turn: Array) -> list[Cloud]:
        """Return the zone of each level in the frame of the projectile's mesh, as `Zones.in_rod`."""
        clouds = _clouds(self.record.rod, self.levels)
        if self.layered and clouds:
            finest, under = clouds[-1], self._pressed(turn)
            clouds[-1] = Cloud(
                np.vstack([finest.points, under.points]), np.concatenate([finest.radii, under.radii])
            )
        return clouds

    def _pressed(self, turn: Array) -> Cloud:
        """Return where rows are drawn: about the pressed skin, and as deep under it as those of a layer need.

        ``turn`` is as in `in_rod`.
        """
        rod = self.record.rod
        down = self.tip_size * np.arange(2 * self.rod_rows if self.layered else 1)
        points = (rod.touched + down[:, None, None] * turn[2]).reshape(-1, 3)
        return Cloud(points, np.full(len(points), rod.reach + self.layered * self.rod_rows * self.tip_size))

    def in_barrier(self) -> list[Cloud]:
        """Return the zone of each level along t, b and n, before the rows at the skin are drawn together."""
        clouds = _clouds(self._of_barrier, self.below)
        if not self.rise:
            return clouds
        sunk = np.array([0.0, 0.0, self.rise])
        return [
            Cloud(np.vstack([c.points, c.points - sunk]), np.concatenate([c.radii, c.radii])) for c in clouds
        ]

    def block(self, margin: float) -> Corners:
        """Return the corners of the barrier's block, ``margin``, m, wider than the zone that may yield."""
        corners = _flow(self._of_barrier).corners()
        low, high = corners.min(axis=0), corners.max(axis=0)
        low[2] -= self.rise
        low, high = low - margin, high + margin
        return np.array([low[0], 0.0, low[2]]), np.array([high[0], high[1], 0.0])

    def touching(self, mesh: HexMesh, points: Array) -> Bools:
        """Return the mask (m,) of the rod's cells that may touch: the finest, all of an unsplit mesh."""
        return mesh.finest

    def pressed(self, mesh: HexMesh, turn: Array) -> Bools:
        """Return the mask (m,) of the rod's finest cells at the skin that is pressed.

        Only they get thin rows: more of them need more mass, which the rest of a light rod cannot give.
        """
        return np.asarray(mesh.finest & _near(self._pressed(turn), mesh))

    def rod_flow(self, mesh: HexMesh, points: Array) -> Bools:
        """Return the mask (m,) of the rod's cells that may yield."""
        return _near(_flow(self.record.rod), mesh)

    def barrier_flow(self, mesh: HexMesh) -> Bools:
        """Return the mask (m,) of the barrier's cells that may yield."""
        return _near(_flow(self._of_barrier), mesh)


AnyZones = Zones | RecordedZones
"""Fine zones of the meshes, from an estimate or from a record."""


def recorded_zones(bodies: Bodies, record: ContactRecord) -> RecordedZones:
    """Return the fine zones of two bodies around the places of a record."""
    base, rod_base, levels, below = base_cells(bodies)
    conforming = bodies.contact.barrier_conforms
    rows = skin_rows(bodies, base / 2**below) if conforming and bodies.contact.f > 0 else 0
    edges = plate_waves(bodies.contact)[1] if is_thin(bodies) else 0.0
    rod_rows = ROD_ROWS if levels and bodies.contact.rod_yields else 0
    layer = skin_of(bodies.contact.rod) if rod_rows and "machined-skin" in bodies.effects else None
    layered = follows_skin(bodies, layer, h := rod_base / 2**levels) and not record.crushed
    if layer:
        rod_rows = max(SKIN_ROWS, rows_for(layer.depth, h) if layered else 0)
    if record.crushed:
        rows = rod_rows = 0
    return RecordedZones(base, rod_base, levels, below, record, conforming, rows, rod_rows, layered, edges)


def rows_within(depth: float, h: float, rows: int) -> float:
    """Return how many rows lie within a ``depth``, m, of which so many are drawn together, of height ``h``.

    Examples
    --------
    >>> [round(rows_within(depth, 0.4, 2), 9) for depth in (0.3, 1.1)]
    [2.0, 4.0]
    """
    drawn = log2(1 + depth / h * 2**rows)
    return drawn if drawn <= rows else rows + depth / h - 1 + 0.5**rows


def unresolved_skins(spec: ModelSpec, zones: AnyZones) -> tuple[str, ...]:
    """Say of each body that yields in how few rows of cells its hardened layer lies."""
    told, of_rod = [], zones.rod_rows
    if not (isinstance(zones, RecordedZones) and zones.layered):
        of_rod = min(of_rod, ROD_ROWS)  # the fine cells under its pressed skin are too few for more
    for body, law, skin, h, drawn in (
        ("rod", spec.rod_law, spec.rod_skin, zones.tip_size, of_rod),
        ("barrier", spec.barrier_law, spec.barrier_skin, zones.barrier_size, zones.skin_rows),
    ):
        rows = rows_within(skin.depth, h, drawn) if law and skin else SKIN_ROWS
        if rows < SKIN_ROWS and skin:
            # halving comes as near to a stated size as it can
            size = 1e3 * skin.depth * 2**MOST_ROWS / (2**SKIN_ROWS - 1) / sqrt(2)
            told.append(
                f"The hardened layer of the {body}, {1e3 * skin.depth:.2g} mm, lies in {rows:.2g} rows of "
                f'cells, where {SKIN_ROWS} resolve it: give accuracy.fine_zone = "skin" and '
                f"accuracy.tip_size = {floor(100 * size) / 100:g} mm or less."
            )
    return tuple(told)


def patch_radius(record: BodyRecord) -> float:
    """Return the radius, m, of the contact: of all skin that was pressed, of the whole body.

    It is the geometric mean of the half-widths; of a long contact no more than twice the smaller one.
    """
    span = np.ptp(record.touched, axis=0)
    across = max(float(record.touched[:, 1].max()), 0.5 * record.edge)
    along = max(0.5 * float(np.hypot(span[0], span[2])), 0.5 * record.edge)
    return min(sqrt(across * along), 2 * min(across, along))


def _clouds(record: BodyRecord, levels: int) -> list[Cloud]:
    """Return the zone of each level: that of the finest alone is narrower than all that may yield."""
    fine = max(record.reach, UNDER * patch_radius(record))
    flows = record.strain >= FLOWING
    points = np.vstack([record.touched, record.flowed[flows]])
    radii = np.concatenate([np.full(len(record.touched), fine), np.full(flows.sum(), 0.5 * record.edge)])
    finest, others = Cloud(points, radii), max(levels - 1, 0) * [_flow(record)]
    return [*others, finest][:levels] if levels else []


def _flow(record: BodyRecord) -> Cloud:
    """Return the zone whose cells may yield; skin that is pressed is always in it."""
    points = np.vstack([record.touched, record.flowed])
    reach, spread = (
        np.full(len(part), far)
        for part, far in ((record.touched, record.reach), (record.flowed, record.spread))
    )
    return Cloud(points, np.concatenate([reach, spread]))


def _near(cloud: Cloud, mesh: HexMesh) -> Bools:
    return np.asarray(cloud.gap(mesh.points[mesh.cells], np.zeros(len(mesh.cells))) <= 0)
