"""Positions and colours of each frame, with magnification and ranges fixed over the whole film."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.fields import CORNERS, FieldFile, jacobian
from fem_impact.films.movement import Movement, evenly


def hex_volumes(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return ``(m,) m3`` volumes by the Jacobian at the centre of ``(m, 8)`` hexahedra (one-point rule)."""
    volumes: np.ndarray = 8.0 * np.linalg.det(jacobian(points, cells))
    return volumes


def fibres(points: np.ndarray, cells: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Return weights ``(m, 8)`` of the corners of cells: their sum of places is F a, F = dx/dX at the centre.

    ``points`` are the reference positions ``(n, 3) m``, ``axis`` is the unit vector a ``(3,)`` in them.
    """
    along = np.linalg.solve(jacobian(points, cells).transpose(0, 2, 1), axis[:, None])[:, :, 0]
    return np.asarray(along @ CORNERS.T / 8.0)


def stretch(weights: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return the stretch |F a| ``(m,)`` of `fibres` with their ``weights``, of moved corners ``(m, 8, 3)``.

    It does not depend on the rigid motion.
    """
    return np.asarray(np.linalg.norm(np.einsum("mk,mkj->mj", weights, corners), axis=1))


def axis_of(points: np.ndarray) -> np.ndarray:
    """Return the unit vector ``(3,)`` in the plane (t, n) of the largest spread of the points."""
    arm = points[:, [0, 2]] - points[:, [0, 2]].mean(axis=0)
    t, n = np.linalg.svd(arm, full_matrices=False)[2][0]
    return np.array([t, 0.0, n])


def nodal_volumes(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return ``(n,) m3``: an eighth of each hexahedron's volume at each of its nodes."""
    share = np.repeat(hex_volumes(points, cells) / 8.0, 8)
    return np.bincount(cells.ravel(), weights=share, minlength=len(points))


def to_points(cells: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Return ``(count,)``: at each point the mean of the ``(m,)`` values of the cells around it."""
    total = np.bincount(cells.ravel(), weights=np.repeat(values, cells.shape[1]), minlength=count)
    return total / np.maximum(np.bincount(cells.ravel(), minlength=count), 1)


def rigid_motion(points: np.ndarray, moved: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the points ``(n, 3) m`` moved by the best-fitting rigid motion in the plane (t, n).

    The rotation about b that minimises the weighted square distance to the moved half has the tangent
    ``sum w (X x x)_b / sum w X . x``, with the reference positions X and the present ones x, ``moved``, taken
    from their centres weighted by the volumes w at the points.
    """
    plane = [0, 2]
    centre = np.average(points[:, plane], axis=0, weights=weights)
    present = np.average(moved[:, plane], axis=0, weights=weights)
    arm, now = points[:, plane] - centre, moved[:, plane] - present
    cross = weights @ (arm[:, 0] * now[:, 1] - arm[:, 1] * now[:, 0])
    angle = np.arctan2(cross, weights @ np.einsum("ij,ij->i", arm, now))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    carried = points.copy()
    carried[:, plane] = arm @ turn + present
    return carried


def nice_factor(limit: float) -> float:
    """Return the largest of 1, 2, 5, 10, 20, 50, ... not above ``limit``, and 1 at least."""
    if not np.isfinite(limit) or limit <= 1.0:
        return 1.0
    decade = 10.0 ** np.floor(np.log10(limit))
    return float(decade * max(step for step in (1.0, 2.0, 5.0) if step * decade <= limit * (1.0 + 1e-12)))


class FieldStyle(NamedTuple):
    """How a field is shown: label, unit, factor from SI, name in the file, colours, whether it has a sign."""

    name: str
    unit: str
    scale: float
    stored: str = ""
    colours: str = "YlGnBu"
    signed: bool = False


FIELDS = {
    "strain": FieldStyle("axial strain", "µm/m", 1e6, colours="coolwarm", signed=True),
    "stress": FieldStyle("von Mises stress", "MPa", 1e-6, "mises"),
    "velocity": FieldStyle("speed", "m/s", 1.0),
    "plastic": FieldStyle("plastic strain", "%", 100.0, "plastic_strain", "YlOrRd"),
}
"""The fields that can be shown, the default first."""

LOOKED = 48
"""Frames at most, evenly over the film, that fix magnification and colour ranges."""

_VISIBLE = 0.35
"""Magnified size of the largest deformation away from the tip, share of the rod's diameter."""


_FURTHEST = 1000.0
"""Displacement, in sizes of the mesh, that no run reaches within its time."""


Colours = Callable[[float], np.ndarray]


@dataclass(frozen=True, slots=True)
class FilmData:
    """The motion of a run made ready to be drawn.

    Attributes
    ----------
    field : one of `FIELDS`
    rod_nodes : (n,) bool, points of the rod
    weights : (n,) m3, volume at each point, zero off the rod
    fade : (n,) share of the magnification: 1 in the rod, 0 at the contact
    peak : the factor that is written on the picture
    contact : (3,) m, where the rod first touches, on the barrier's surface
    span : diameter of the rod, m
    colours : function of a time, s, to the field at the points (n,) or in the cells (m,), in the shown unit
    near, far : fixed colour ranges of the close-up and of the whole rod, in the shown unit
    """

    movement: Movement
    field: str
    rod_nodes: np.ndarray
    weights: np.ndarray
    fade: np.ndarray
    peak: float
    contact: np.ndarray
    span: float
    colours: Colours
    near: tuple[float, float]
    far: tuple[float, float]

    @property
    def fields(self) -> FieldFile:
        """Return the field file, for its mesh."""
        return self.movement.fields

    @property
    def factor(self) -> np.ndarray:
        """Magnification of the deformation ``(n,)``."""
        magnification: np.ndarray = 1.0 + (self.peak - 1.0) * self.fade
        return magnification

    def positions(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return ``(n, 3) m`` positions as they are, and with the rod's deformation magnified."""
        true = self.movement.points(time)
        shown, rod = true.copy(), self.rod_nodes
        rigid = rigid_motion(self.fields.points[rod], true[rod], self.weights[rod])
        shown[rod] = rigid + self.factor[rod][:, None] * (true[rod] - rigid)
        return true, shown


def prepare(movement: Movement, field: str, times: Sequence[float] | np.ndarray) -> FilmData:
    """Look through the film once and fix magnification and colour ranges.

    Raises
    ------
    ResultError
        There is no such field or no rod.
    """
    fields = movement.fields
    if field not in FIELDS:
        raise ResultError(f'field "{field}" cannot be drawn; choose one of {", ".join(FIELDS)}.')
    rod_cells = fields.cells[fields.static["body"] == 0] if "body" in fields.static else fields.cells[:0]
    if not len(rod_cells):
        raise ResultError(f'{fields.path}: cell data "body" names no rod (0).')
    volumes = hex_volumes(fields.points, rod_cells)
    if not (volumes > 0.0).all():
        problem = f"cell {int(np.argmin(volumes))} of the rod has the volume {volumes.min():.3g} m3"
        raise ResultError(f"{fields.path}: {problem}; the file is damaged.")
    weights = nodal_volumes(fields.points, rod_cells)
    rod = np.isin(np.arange(len(fields.points)), rod_cells)
    lowest = fields.points[rod][np.argmin(fields.points[rod, 2])]
    span = 2.0 * float(fields.points[rod, 1].max())
    distance = np.linalg.norm(fields.points - lowest, axis=1) / span
    looked = evenly(np.asarray(times), LOOKED)
    away, largest = distance[rod] > 2.0, 0.0
    for time in looked:
        moved = movement.points(time)
        furthest = float(np.abs(moved - fields.points).max())
        if furthest > _FURTHEST * np.ptp(fields.points):
            raise ResultError(f"{fields.path}: at {time:.6g} s the motion moves points by {furthest:.3g} m.")
        bent = moved[rod] - rigid_motion(fields.points[rod], moved[rod], weights[rod])
        largest = max(largest, float(np.linalg.norm(bent[away], axis=1).max(initial=0.0)))
    peak = nice_factor(_VISIBLE * span / largest) if largest > 0.0 else 1.0
    colours = _colours_of(movement, field)
    near, far = _ranges(movement, field, np.array([np.abs(colours(time)) for time in looked]), distance, rod)
    contact = np.array([lowest[0], 0.0, min(lowest[2], 0.0)])
    # no magnification within half a diameter of the contact, all of it beyond two diameters
    share = np.clip((distance - 0.5) / 1.5, 0.0, 1.0)
    fade = share**2 * (3.0 - 2.0 * share)
    return FilmData(movement, field, rod, weights, fade, peak, contact, span, colours, near, far)


def _colours_of(movement: Movement, field: str) -> Colours:
    style = FIELDS[field]
    if field == "velocity":
        return lambda time: style.scale * np.linalg.norm(movement.velocities(time), axis=1)
    if field == "strain":
        strain = _axial_strain(movement)
        return lambda time: style.scale * strain(time)
    return lambda time: style.scale * movement.cell_data(style.stored, time)


def _axial_strain(movement: Movement) -> Colours:
    """Return the strain along the rod's axis at a time, in the cells ``(m,)``; zero in the barrier.

    That of the cylinder's cells is stretch and bending of waves.h5, where the run stored it.
    """
    fields, waves = movement.fields, movement.waves
    rod = np.flatnonzero(fields.static["body"] == 0)
    cells = fields.cells[rod]
    axis, body = axis_of(fields.points[np.unique(cells)]), np.zeros(len(rod), bool)
    if waves is not None:
        arm = fields.points[cells].mean(axis=1) - waves.origin
        along, across = arm @ waves.axis, arm @ waves.across
        body = along > waves.position[0]
        along, across = along[body], across[body]
    corners = cells[~body]
    weights = fibres(fields.points, corners, axis)

    def at(time: float) -> np.ndarray:
        strain = np.zeros(len(fields.cells))
        strain[rod[~body]] = stretch(weights, movement.points(time)[corners]) - 1.0
        if waves is not None:
            rows = waves.strain(np.array([time]))
            mean, bent = (np.interp(along, waves.position, row[0]) for row in rows)
            strain[rod[body]] = mean + bent * across / waves.radius
        return strain

    return at


def _ranges(
    movement: Movement, field: str, sizes: np.ndarray, distance: np.ndarray, rod: np.ndarray
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the colour ranges of the close-up and the whole rod, from ``sizes`` at each looked time.

    A rod without any, such as one that yields at its tip alone, has those of the close-up.
    """
    in_cells, signed, cells = field != "velocity", FIELDS[field].signed, movement.fields.cells
    place = distance[cells].mean(axis=1) if in_cells else distance
    on_rod = rod[cells].all(axis=1) if in_cells else rod
    close, body = sizes[:, place < 0.5], sizes[:, on_rod & (place > 1.0)]
    near = float(np.percentile(close, 99.5, axis=1).max()) if close.size else 0.0
    far = float(np.percentile(body, 99.5, axis=1).max()) if body.size else near
    near = max(near, 1e-12)
    far = far if far > 1e-6 * near else near
    return (-near if signed else 0.0, near), (-far if signed else 0.0, far)
