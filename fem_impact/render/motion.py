"""Positions and colours of each frame, with magnification and ranges fixed over the whole film."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.fields_read import FieldFile
from fem_impact.render.kinematics import (
    axis_of,
    hex_volumes,
    magnified,
    nice_factor,
    nodal_volumes,
    rigid_motion,
    stretch,
)


class FieldStyle(NamedTuple):
    """How a field is shown: label, unit, factor from SI, colour map, whether it has a sign."""

    name: str
    unit: str
    scale: float
    colours: str = "YlGnBu"
    signed: bool = False


FIELDS = {
    "mises": FieldStyle("von Mises stress", "MPa", 1e-6),
    "velocity": FieldStyle("speed", "m/s", 1.0),
    "strain": FieldStyle("axial strain", "µm/m", 1e6, "coolwarm", True),
}
"""The fields that can be shown."""

_VISIBLE = 0.35
"""Magnified size of the largest deformation away from the tip, share of the rod's diameter."""


_FURTHEST = 1000.0
"""Displacement, in sizes of the mesh, that no run reaches within its time."""


@dataclass(frozen=True, slots=True)
class FilmData:
    """A field file made ready to be drawn.

    Parameters
    ----------
    fields : FieldFile
    field : str
        One of ``FIELDS``.
    rod_nodes : (n,) bool
        Points of the rod.
    weights : (n,) float64, m3
        Volume at each point, zero off the rod.
    fade : (n,) float64
        Share of the magnification: 1 in the rod, 0 at the contact.
    peak : float
        The factor that is written on the picture.
    contact : (3,) float64, m
        Where the rod first touches, on the barrier's surface.
    span : float, m
        Diameter of the rod.
    near, far : tuple of float
        Fixed colour ranges of the close-up and of the whole rod, in the shown unit.
    """

    fields: FieldFile
    field: str
    rod_nodes: np.ndarray
    weights: np.ndarray
    fade: np.ndarray
    peak: float
    contact: np.ndarray
    span: float
    near: tuple[float, float]
    far: tuple[float, float]

    @property
    def factor(self) -> np.ndarray:
        """Magnification of the deformation ``(n,)``."""
        magnification: np.ndarray = 1.0 + (self.peak - 1.0) * self.fade
        return magnification

    def positions(self, frame: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``(n, 3) m`` positions as they are, and with the rod's deformation magnified."""
        true = self.fields.points + self.fields.point_data("displacement", frame)
        shown, rod = true.copy(), self.rod_nodes
        rigid = rigid_motion(self.fields.points[rod], true[rod], self.weights[rod])
        shown[rod] = magnified(rigid, true[rod], self.factor[rod])
        return true, shown

    def colours(self, frame: int) -> np.ndarray:
        """Return the field at the points ``(n,)`` or in the cells ``(m,)``, in the shown unit."""
        return _colours(self.fields, self.field, frame)


def prepare(fields: FieldFile, field: str, frames: Sequence[int]) -> FilmData:
    """Look through the frames once and fix magnification and colour ranges.

    Raises
    ------
    ResultError
        The file holds no frames, no such field or no rod.
    """
    if field not in FIELDS:
        raise ResultError(f'field "{field}" cannot be drawn; choose one of {", ".join(FIELDS)}.')
    if not len(frames):
        raise ResultError(f"{fields.path}: holds no frames yet, so there is nothing to draw.")
    rod_cells = _rod_cells(fields)
    weights = nodal_volumes(fields.points, rod_cells)
    rod = np.isin(np.arange(len(fields.points)), rod_cells)
    lowest = fields.points[rod][np.argmin(fields.points[rod, 2])]
    span = 2.0 * float(fields.points[rod, 1].max())
    distance = np.linalg.norm(fields.points - lowest, axis=1) / span
    peak = _peak(fields, frames, rod, weights, distance, span)
    near, far = _ranges(fields, field, frames, distance, rod)
    contact = np.array([lowest[0], 0.0, min(lowest[2], 0.0)])
    return FilmData(fields, field, rod, weights, _fade(distance), peak, contact, span, near, far)


def _rod_cells(fields: FieldFile) -> np.ndarray:
    """Return the cells of the rod ``(m, 8)``. Raises ResultError without any, or where one is inside out."""
    cells = fields.cells[fields.static["body"] == 0] if "body" in fields.static else fields.cells[:0]
    if not len(cells):
        raise ResultError(f'{fields.path}: cell data "body" names no rod (0).')
    volumes = hex_volumes(fields.points, cells)
    if not (volumes > 0.0).all():
        problem = f"cell {int(np.argmin(volumes))} of the rod has the volume {volumes.min():.3g} m3"
        raise ResultError(f"{fields.path}: {problem}; the file is damaged.")
    return cells


def _fade(distance: np.ndarray) -> np.ndarray:
    # no magnification within half a diameter of the contact, all of it beyond two diameters
    share = np.clip((distance - 0.5) / 1.5, 0.0, 1.0)
    fade: np.ndarray = share**2 * (3.0 - 2.0 * share)
    return fade


def _peak(
    fields: FieldFile,
    frames: Sequence[int],
    rod: np.ndarray,
    weights: np.ndarray,
    distance: np.ndarray,
    span: float,
) -> float:
    away, largest = distance[rod] > 2.0, 0.0
    for frame in frames:
        moved = fields.point_data("displacement", frame)
        if np.abs(moved).max() > _FURTHEST * np.ptp(fields.points):
            raise ResultError(f"{fields.path}: frame {frame} moves points by {np.abs(moved).max():.3g} m.")
        true = (fields.points + moved)[rod]
        bent = true - rigid_motion(fields.points[rod], true, weights[rod])
        largest = max(largest, float(np.linalg.norm(bent[away], axis=1).max(initial=0.0)))
    return nice_factor(_VISIBLE * span / largest) if largest > 0.0 else 1.0


def _colours(fields: FieldFile, field: str, frame: int) -> np.ndarray:
    scale = FIELDS[field].scale
    if field == "velocity":
        speed: np.ndarray = scale * np.linalg.norm(fields.point_data("velocity", frame), axis=1)
        return speed
    if field == "strain":
        return scale * _strain(fields, frame)
    return scale * fields.cell_data(field, frame)


def _strain(fields: FieldFile, frame: int) -> np.ndarray:
    """Return the strain along the rod's axis ``(m,)``, zero in the barrier."""
    rod = fields.static["body"] == 0
    cells, strain = fields.cells[rod], np.zeros(len(rod))
    moved = fields.points + fields.point_data("displacement", frame)
    axis = axis_of(fields.points[np.unique(cells)])
    strain[rod] = stretch(fields.points, moved, cells, axis) - 1.0
    return strain


def _ranges(
    fields: FieldFile, field: str, frames: Sequence[int], distance: np.ndarray, rod: np.ndarray
) -> tuple[tuple[float, float], tuple[float, float]]:
    in_cells, signed = field != "velocity", FIELDS[field].signed
    place = distance[fields.cells].mean(axis=1) if in_cells else distance
    on_rod = rod[fields.cells].all(axis=1) if in_cells else rod
    tops = np.array([_tops(np.abs(_colours(fields, field, frame)), place, on_rod) for frame in frames])
    near, far = (float(top) for top in np.maximum(tops.max(axis=0), 1e-12))
    return (-near if signed else 0.0, near), (-far if signed else 0.0, far)


def _tops(sizes: np.ndarray, distance: np.ndarray, rod: np.ndarray) -> tuple[float, float]:
    close, body = sizes[distance < 0.5], sizes[rod & (distance > 1.0)]
    near = float(np.percentile(close, 99.5)) if close.size else 0.0
    far = float(np.percentile(body, 99.5)) if body.size else near
    return near, far
