"""Where two bodies touched and flowed in a run, for the meshes of the next; what may touch at first."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from hashlib import sha256
from io import BytesIO
from math import cos, pi, sin
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.bodies import Bodies
from fem_impact.case.zones import SLIDE
from fem_impact.errors import ResultError
from fem_impact.files.atomic import check_digest, write_bytes
from fem_impact.physics.contact import FLAT
from rigid import Faceted, Projectile

AROUND = 16  # places of half a round surface at which its height is looked at
ABOVE = 0.35  # of a cell, within which skin of the lowest point may touch in a run on such cells
# cells beside a line of a user's nodes: in a single row that is split every face has hanging nodes
BESIDE = 1.05
MOST = 1_000_000  # places of skin that may touch: no machine holds a mesh with cells for more of them
DEEP = 1.5  # radii of the estimated contact, and cells, up to which metal may flow from where it may touch


@dataclass(frozen=True, slots=True)
class BodyRecord:
    """Where one body touched and flowed: places of its material before the impact, m.

    Those of the projectile are in the frame of its mesh (x, y, z), those of the barrier along (t, b, n).

    Attributes
    ----------
    touched : (k, 3) nodes of the skin that were pressed
    flowed : (m, 3) centres of the cells that flowed; strain : (m,) their mean plastic strain
    edge : mean edge of the cells there: the record knows places no better
    reach : how far beyond ``touched`` another mesh may be pressed; spread : the same of ``flowed``
    """

    touched: Array
    flowed: Array
    strain: Array
    edge: float
    reach: float
    spread: float

    def wider(self, factor: float) -> "BodyRecord":
        """Return the record with so many times the room around it."""
        return replace(self, reach=factor * self.reach, spread=factor * self.spread)

    def and_touched(self, places: Array) -> "BodyRecord":
        """Return the record with more ``places`` (k, 3) of skin that was pressed."""
        return replace(self, touched=np.concatenate([self.touched, places]))


@dataclass(frozen=True, slots=True)
class Site:
    """One place of contact of the whole projectile.

    Attributes
    ----------
    start, end : s, of the first and the last touch there
    impulse_n, impulse_t : N s, on the projectile
    low, high : (2,) along t and b, m, of the projectile's skin that was pressed, as it lies before the
        impact, from its lowest point; b is 0 or more, the other half is its mirror image
    depth : largest indentation of the barrier there, m; 0 of a rigid one
    """

    start: float
    end: float
    impulse_n: float
    impulse_t: float
    low: tuple[float, float]
    high: tuple[float, float]
    depth: float


@dataclass(frozen=True, slots=True)
class ContactRecord:
    """Where projectile and barrier touched and flowed; the barrier's part is None of a rigid one.

    Attributes
    ----------
    sites : places of contact in the order of their first touch; none of a record of what may happen
    left : contact or flow reached the end of what the mesh held ready for it
    resolved : enough nodes were pressed at once for coefficients and shares of the run to be given
    crushed : the run ended because a cell folded or was crushed; a mesh that follows has no thin cells
    """

    rod: BodyRecord
    barrier: BodyRecord | None
    sites: tuple[Site, ...] = field(default_factory=tuple)
    left: bool = False
    resolved: bool = False
    crushed: bool = False

    @property
    def rows(self) -> int:
        """Rows of nodes across the narrow side of the site with the largest impulse; 0 without a site."""
        if not self.sites:
            return 0
        site = max(self.sites, key=lambda one: one.impulse_n)
        along = site.high[0] - site.low[0]
        # a patch that reaches the plane of symmetry goes on behind it
        across = site.high[1] - site.low[1] if site.low[1] > self.rod.edge else 2 * site.high[1]
        return 1 + round(min(along, across) / self.rod.edge)

    def digest(self) -> str:
        """Return the SHA-256 of all its numbers."""
        return sha256(self._packed()).hexdigest()

    def write(self, path: Path) -> None:
        """Write the record as one atomic step (OutputPathError: it cannot be written)."""
        write_bytes(path, self._packed())

    def _packed(self) -> bytes:
        rows = [
            (site.start, site.end, site.impulse_n, site.impulse_t, *site.low, *site.high, site.depth)
            for site in self.sites
        ]
        arrays = {"sites": np.array(rows).reshape(-1, len(SITE))}
        arrays["flags"] = np.array([self.left, self.resolved, self.crushed])
        for name, body in (("rod", self.rod), ("barrier", self.barrier)):
            if body is not None:
                arrays |= {f"{name}_{key}": np.asarray(getattr(body, key)) for key in BODY}
        held = BytesIO()
        np.savez(held, allow_pickle=False, **arrays)
        return held.getvalue()

    @classmethod
    def read(cls, path: Path) -> "ContactRecord":
        """Read a record back (ResultError: it is missing, damaged or of another run)."""
        check_digest(path)
        try:
            with np.load(BytesIO(path.read_bytes())) as held:
                rod = _body(held, "rod")
                barrier = _body(held, "barrier") if "barrier_edge" in held else None
                left, resolved, crushed = map(bool, held["flags"])
                rows = held["sites"].tolist()
        except (OSError, EOFError, ValueError, KeyError, BadZipFile) as error:
            raise ResultError(f"{path}: holds no record of a contact: {error}") from None
        sites = tuple(
            Site(row[0], row[1], row[2], row[3], (row[4], row[5]), (row[6], row[7]), row[8]) for row in rows
        )
        return cls(rod, barrier, sites, left, resolved, crushed)

    def wider(self, factor: float = 2.0) -> "ContactRecord":
        """Return a record after which the next mesh holds more room ready around what is known."""
        barrier = self.barrier and self.barrier.wider(factor)
        return replace(self, rod=self.rod.wider(factor), barrier=barrier)


def together(records: Sequence[ContactRecord]) -> ContactRecord:
    """Return what several runs on one mesh found as one record, with the sites of the first."""
    first, *others = records
    if not others:
        return first
    barriers = [record.barrier for record in records if record.barrier is not None]
    return ContactRecord(
        joined([record.rod for record in records]),
        joined(barriers) if barriers else None,
        first.sites,
        any(record.left for record in records),
        all(record.resolved for record in records),
        any(record.crushed for record in records),
    )


def joined(bodies: Sequence[BodyRecord]) -> BodyRecord:
    """Return where a body touched and flowed in one run or another."""
    touched, flowed, strain = (
        np.concatenate([getattr(body, key) for body in bodies]) for key in ("touched", "flowed", "strain")
    )
    reach, spread = (max(getattr(body, key) for body in bodies) for key in ("reach", "spread"))
    return BodyRecord(touched, flowed, strain, bodies[0].edge, reach, spread)


BODY = ("touched", "flowed", "strain", "edge", "reach", "spread")
"""Names of what the file of a record holds of each body."""
SITE = ("start", "end", "impulse_n", "impulse_t", "low_t", "low_b", "high_t", "high_b", "depth")
"""Columns of its table of sites."""


def _body(held: Mapping[str, Array], name: str) -> BodyRecord:
    """Return the record of a body from the arrays of the file (KeyError: some are missing)."""
    touched, flowed, strain, *lengths = (held[f"{name}_{key}"] for key in BODY)
    edge, reach, spread = map(float, lengths)
    return BodyRecord(touched, flowed, strain, edge, reach, spread)


def expected_record(bodies: Bodies, rod_edge: float, barrier_edge: float) -> ContactRecord:
    """Return what may touch and flow on cells of these edges, m, from the shapes alone.

    May touch what lies no higher over the barrier than `FLAT` estimated depths or `ABOVE` of a cell,
    whichever is more.
    """
    size, turn = bodies.estimate, bodies.mesh_inclination
    edge = max(rod_edge, barrier_edge)
    high = max(FLAT * size.depth, ABOVE * edge)
    touched, apart = low_skin(bodies, 0.5 * rod_edge, high)
    away = touched - bodies.lowest_point
    t = away[:, 0] * cos(turn) + away[:, 2] * sin(turn)
    under = np.stack([t, away[:, 1], np.zeros(len(t))], axis=1)
    # no wider than what may touch, which a flat face or a flank limits
    radius = min(size.radius, 0.5 * float(np.linalg.norm(np.ptp(under, axis=0))) + 0.5 * edge)
    spread = DEEP * max(edge, radius)
    slid = SLIDE * size.depth * bodies.contact.sliding / max(bodies.contact.approach, 1e-6)
    steps = np.linspace(0.0, slid, 2 + int(abs(slid) / max(edge, 2 * apart))) if slid else np.zeros(1)
    under = np.concatenate([under + np.array([step, 0.0, 0.0]) for step in steps])
    rod = BodyRecord(touched, touched, np.zeros(len(touched)), rod_edge, 2 * apart, spread)
    reach = barrier_edge * (BESIDE if isinstance(bodies.body, Faceted) else 1.0)
    barrier = BodyRecord(under, under, np.zeros(len(under)), barrier_edge, reach, spread)
    return ContactRecord(rod, barrier if bodies.contact.compliant else None)


def low_skin(bodies: Bodies, apart: float, high: float) -> tuple[Array, float]:
    """Return places (k, 3), m, of the half projectile's skin in its own frame, and how far they are apart, m.

    They are those no higher than ``high``, m, over its lowest point, about ``apart`` or, where that makes
    more than `MOST`, farther apart.
    """
    body, turn = bodies.body, bodies.mesh_inclination
    if isinstance(body, Faceted):
        corners = body.points[body.facets]
        skin = np.concatenate([body.points[np.unique(body.facets)], corners.mean(axis=1)])
        return skin[_height(bodies, skin) <= high], apart
    line = body.meridian()
    if isinstance(body, Projectile):
        line = np.vstack([line, [body.diameter / 2, body.length], [0.0, body.length]])
    elif line[-1, 0] > 0.0:
        line = np.vstack([line, [0.0, body.length]])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    apart = max(apart, pi * along[-1] / MOST)
    arc = np.linspace(0.0, along[-1], 2 + int(along[-1] / apart))
    arc = np.unique(np.concatenate([arc, along]))
    rho, z = np.interp(arc, along, line[:, 0]), np.interp(arc, along, line[:, 1])
    around = np.linspace(0.0, pi, 1 + max(AROUND, int(pi * rho.max() / apart)))
    # whole circles, then whole meridians, none of whose places is low: the skin of a whole rod is many times
    # that of a contact
    axis = _height(bodies, np.stack([np.zeros_like(rho), np.zeros_like(rho), z], axis=1))
    leaning = rho * abs(sin(turn))
    near = axis - leaning <= high
    rho, z, axis, leaning = rho[near], z[near], axis[near], leaning[near]
    if leaning.min() > 0.0:
        lowest_cosine = ((axis - high) / leaning).min()
        around = around[np.cos(around) * np.sign(sin(turn)) >= lowest_cosine]
    if len(rho) * len(around) > MOST:
        return low_skin(bodies, 2 * apart, high)
    skin = np.stack(
        [np.outer(rho, np.cos(around)), np.outer(rho, np.sin(around)), np.outer(z, np.ones(len(around)))],
        axis=-1,
    ).reshape(-1, 3)
    return np.asarray(skin[_height(bodies, skin) <= high]), apart


def _height(bodies: Bodies, places: Array) -> Array:
    """Return the height, m, of places (k, 3) of the projectile over its lowest point."""
    away, turn = places - bodies.lowest_point, bodies.mesh_inclination
    return np.asarray(away[:, 2] * cos(turn) - away[:, 0] * sin(turn))
