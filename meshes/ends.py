"""The end of a body of revolution: how far its nose grid goes, chosen by the quality of its cells."""

from dataclasses import dataclass, replace

import numpy as np

from meshes.common import ClosedEndError, FloatArray, MeshError
from meshes.hexmesh import EDGES
from meshes.meridian import Meridian
from meshes.nose import NoseMesh, inner_corner, lay_nose
from meshes.quality import corner_jacobians
from meshes.rod import nose_cells
from meshes.section import Section, section

# The nose grid ends where the surface is steeper than this, rad from the radial direction; scaled sections
# lean as the surface does
STEEP = np.deg2rad(50.0)
CANDIDATES = 12  # ends of the nose grid that are tried
FAIR = 0.4  # least scaled Jacobian beyond which the length of the shortest edge decides
LONGEST = 2.0  # length of a nose grid's shape over its radius
SLIM = 4.0  # longest over shortest edge of a cell that counts as no fault
WIDE = 1.35  # widest part of a flange over the height of its nose grid, room for a shoulder's cone included
HALF = 0.485  # of the length, that a nose may take of a body that is closed at both ends
POOR = 0.15  # least scaled Jacobian of a nose


@dataclass(frozen=True, slots=True)
class ShapeEnd:
    """One end of a body, its own tip at z = 0.

    Attributes
    ----------
    start : height, m, at which the sections begin
    grid : nodes of the nose in the half plane
    radius, top : of the body where its nose's shape ends, and where the sections begin, m
    hollow : whether the end is open
    """

    start: float
    grid: NoseMesh
    radius: float
    top: float
    hollow: bool


def end_of(
    line: FloatArray,
    half: Section,
    across: int,
    near: FloatArray | None = None,
    levels: int = 0,
    bore: FloatArray | None = None,
    closed: float = np.inf,
) -> ShapeEnd:
    """Return the best nose grid of an end.

    Parameters
    ----------
    line : (k, 2) float64, m
        Surface, (rho, z), from the axis at (0, 0).
    near : (2,) float64, m, optional
        Place (rho, z) that is to be the middle of a cell split `levels` times, if that folds no cell.
    bore : (j, 2) float64, m, optional
        Inner surface (rho, z) of an open end, from z = 0.
    closed : float, m
        Height at which the bore of a closed end begins.

    Raises
    ------
    MeshError
        If the end is too sharp, or closed by a disc that is too thin.
    """
    builder = _Builder(line, half, across, bore, closed)
    score, cut, plain = builder.best()
    if not score >= POOR:  # where a chamfer ends there may be room that there is not where it begins
        late = replace(builder, late=True)
        score, cut, plain, builder = max(
            (score, cut, plain, builder), (*late.best(), late), key=lambda of: of[0]
        )
    if plain is None or not score >= POOR:
        if np.isfinite(closed) and replace(builder, closed=np.inf).best()[0] >= POOR:
            raise ClosedEndError(closed)
        _require_width(builder)
        if bore is not None:
            raise MeshError(
                f"the wall at the open end, {bore[0, 0]:.6g} m and more from the axis, is too thin for the "
                "rounding of its edge: give a smaller bore or a smaller radius of the edge"
            )
        radius = float(line[:, 0].max())
        if half.bore and _Builder(line, section(across), across, None, np.inf).best()[0] >= POOR:
            raise MeshError(
                f"a wall of {1.0 - half.bore:.2g} of the outer radius is too thin beside {across} cells "
                "across"
            )
        raise MeshError(
            f"an end is too sharp for hexahedra: round it with a radius of {0.1 * radius:.2g} m or more, or "
            "cut it off flat"
        )
    shifted = builder.tried(cut, near, levels) if near is not None else None
    return shifted if shifted and builder.score(shifted)[0] >= 0.8 * score else plain


@dataclass(frozen=True, slots=True)
class _Builder:
    """Builds nose grids of one end."""

    line: FloatArray
    half: Section
    across: int
    bore: FloatArray | None
    closed: float
    late: bool = False

    def best(self) -> tuple[float, int, ShapeEnd | None]:
        """Return the score of the best nose grid, the vertex of the line at which it ends, and the grid."""
        line, step = self.line, np.diff(self.line, axis=0)
        slope = np.arctan2(step[:, 1], step[:, 0])
        shrinks = slope > 0.5 * np.pi + 1e-9
        last = int(np.argmax(shrinks)) if shrinks.any() else len(slope)
        # where it may end: steep behind, never shrinking before
        steep = 1 + np.flatnonzero(slope[1 : last + 1] >= STEEP)
        steep = steep[line[steep, 1] <= LONGEST * line[steep, 0]]
        if not len(steep):
            return 0.0, 0, None
        # spread over the turn of the surface and its length
        turned = slope[np.minimum(steep, len(slope) - 1)] + line[steep, 1] / line[:, 0].max()
        wanted = np.linspace(turned.min(), turned.max(), CANDIDATES)
        picked = steep[np.abs(turned[:, None] - wanted).argmin(axis=0)]
        tried = [(cut, self.tried(cut)) for cut in np.unique([steep[0], steep[-1], *picked]).tolist()]
        scored = [(self.score(end), cut, end) for cut, end in tried if end is not None]
        score, cut, end = max(scored, key=lambda one: one[:2], default=((0.0, 0.0), 0, None))
        return score[0], cut, end

    def tried(self, cut: int, near: FloatArray | None = None, levels: int = 0) -> ShapeEnd | None:
        """Return the nose grid that ends at a vertex of the line, or None where there is no room for it."""
        shape, line = Meridian(self.line[: cut + 1], self.line[cut:]), self.line
        pitch = 2.0 * shape.radius / self.across
        on_nose = near is not None and near[1] <= shape.height
        split = shape.shoulder(near if on_nose else None, pitch / 2**levels)
        if self.late:
            split = float(shape.arc[-1])
        corner = inner_corner(shape, split, self.half.plug)
        start = max(shape.height + pitch, float(corner[1]) + 1.5 * pitch, 2.0 * shape.radius / 3.0)
        disc = self.closed < start + 0.5 * pitch
        start = self.closed if disc else start
        room = line[-1, 1] if line[-1, 0] > 0.0 else HALF * line[-1, 1]
        hole = self.hole(start)
        if not max(shape.height, shape.at(np.array(split))[1]) <= start < room or corner[0] <= hole[0]:
            return None
        grid = lay_nose(shape, start, split, self.half, pitch, hole, disc)
        top = float(np.interp(start, line[cut:, 1], line[cut:, 0]))
        return ShapeEnd(start, grid, shape.radius, top, self.bore is not None)

    def hole(self, start: float) -> tuple[float, float]:
        """Return the radius of an open bore at the face and at a height, m; 0 where the end is closed."""
        if self.bore is None:
            return 0.0, 0.0
        return float(self.bore[0, 0]), float(np.interp(start, self.bore[:, 1], self.bore[:, 0]))

    def score(self, end: ShapeEnd) -> tuple[float, float]:
        """Return how good the cells of an end are: their shape, up to `FAIR`, then their shortest edge, m."""
        half, hole = self.half, self.hole(end.start)[1]
        radius = end.top * half.radius  # of the section at which the end meets the body
        if self.bore is not None:
            radius = hole + (end.top - hole) * (half.radius - half.bore) / (1.0 - half.bore)
        layer = np.column_stack([radius[:, None] * half.direction, np.full(len(radius), end.start)])
        nose, cells = nose_cells(half, end.grid, len(half.unit), np.arange(len(half.unit)), end.hollow)
        corners = np.concatenate([layer, nose])[cells]
        worst = float(corner_jacobians(corners).min())
        edges = np.linalg.norm(corners[:, EDGES[:, 1]] - corners[:, EDGES[:, 0]], axis=-1)
        slim = float((edges.max(axis=1) / edges.min(axis=1)).max())
        return min(worst, FAIR) * min(1.0, SLIM / slim), float(edges.min())


def _require_width(builder: _Builder) -> None:
    """Refuse (MeshError) an end that would be filled if the body kept its width behind it, as a flange."""
    line = builder.line
    narrows = np.append(np.flatnonzero(np.diff(line[:, 0]) < 0.0), -1)[0]
    radius, height = line[narrows]
    straight = np.concatenate([line[: narrows + 1], [[radius, line[-1, 1]]]])
    score, _, end = replace(builder, line=straight).best() if height < line[-1, 1] else (0.0, 0, None)
    if end is not None and score >= POOR:
        raise MeshError(
            f"an end is a flange: behind it the body narrows too soon for the cells that fill it. Keep its "
            f"radius of {radius:.4g} m up to {WIDE * end.start:.2g} m from the end or more, or "
            "give a mesh of your own"
        )
