"""The nose of a rod in its meridian half plane: a plug wrapped in a layer that follows the surface.

The plug carries the inner part of the section and ends in the point C of the half plane; the layer
leaves the face, turns around the edge and runs up the side. Plug, face layer and side layer meet in C,
one layer deep, so that the grid at the surface is regular along the whole meridian. The turn lies where the
rod touches, and cells next to it are one pitch long on both sides, whatever the pitch.
"""

from dataclasses import dataclass

import numpy as np

from meshes.common import FloatArray
from meshes.meridian import Meridian
from meshes.section import Section

# Depth of C below the surface over the depth that gives an even layer, from the same scan as the section.
DEPTH = 0.85
# Over the arc of the face, for the inner nodes of its outermost cells: largest outward shift, by which cells
# lean, and smallest distance from the axis, which is left to the other cells of the face.
LEAN = 0.145
FURTHEST_IN = 0.56


@dataclass(frozen=True, slots=True)
class NoseMesh:
    """Nodes of the nose in the half plane, (rho, z) in m.

    Attributes
    ----------
    face : (p, 2)
        Below each node of the plug's section, on the surface.
    plug : (rows + 1, p, 2)
        Nodes of the plug, row 0 above the face layer, the last row at the body.
    side : (rows + 1, 2)
        Surface nodes of the side layer; row 0 is the end of the face.
    """

    face: FloatArray
    plug: FloatArray
    side: FloatArray


def lay_nose(
    meridian: Meridian,
    height: float,
    split: float,
    half: Section,
    pitch: float,
    hole: tuple[float, float] = (0.0, 0.0),
    disc: bool = False,
) -> NoseMesh:
    """Lay the nose grid.

    Parameters
    ----------
    meridian : Meridian
    height : float, m
        Where the body begins.
    split : float, m
        Arc length at which the layer turns from the face to the side, see `Meridian.shoulder`.
    half : Section
        Section of the body.
    pitch : float, m
        Wanted height of the rows.
    hole : (float, float), m
        Radius of an open bore at the face and where the body begins; nodes inside it are on its surface.
    disc : bool
        Whether a bore begins at `height`: then two layers of cells, as thin as need be, may fill the nose.
    """
    curve = meridian.extended(height)
    end = float(curve.line[-1, 0])  # radius where the body begins
    share = half.radius[: half.plug_nodes] / half.plug
    if hole[0] > 0.0:
        share = np.clip((share * half.plug - half.bore) / (half.plug - half.bore), 0.0, 1.0)
    layer = (1.0 - half.plug) * meridian.radius
    layer_above = (1.0 - half.plug) * end
    deepest = 0.5 * height if disc else np.inf
    corner = inner_corner(meridian, split, half.plug, deepest)
    deep = corner - curve.at(np.array(split))
    length = curve.arc[-1] - split
    fewest = 1 + int((curve.corners() > split).sum()) if disc else 2
    rows = max(fewest, round(0.5 * (length + height - corner[1]) / pitch))
    side = curve.at(_along(split, curve.arc[-1], rows, pitch, curve.corners()))
    inside = float(np.clip(1.0 - pitch / split, FURTHEST_IN, half.inner + LEAN))
    along = np.interp(share, [0.0, half.inner, 1.0], [0.0, inside, 1.0]) if hole[0] <= 0.0 else share
    face = curve.at(hole[0] + (split - hole[0]) * along)
    pole = min(max(layer, float(corner[1])), deepest)
    bottom = np.stack([hole[0] + (corner[0] - hole[0]) * share, pole + (corner[1] - pole) * share], axis=1)
    fade = np.linspace(0.0, 1.0, rows + 1)
    wall = side + np.outer(1.0 - fade, deep) + np.outer(fade, [-layer_above, 0.0])
    return NoseMesh(face, _filled(bottom, wall, share, height, hole), side)


def inner_corner(meridian: Meridian, split: float, plug: float, deepest: float = np.inf) -> FloatArray:
    """(2,) point C (rho, z), m, where plug, face layer and side layer meet.

    `split` is the arc length of the turn, m; `plug` the radius of the plug over that of the rod; `deepest`
    the largest z, m.
    """
    curve = meridian.extended(meridian.height + meridian.radius)
    layer = (1.0 - plug) * meridian.radius
    end = curve.at(np.array(split))
    rounding = float(np.hypot(meridian.radius - end[0], end[1]))  # 0 for a sharp edge
    depth = DEPTH * max(float(np.sqrt(2.0)) * layer - rounding, 0.8 * layer)
    corner = np.asarray(end + depth * curve.inward(split, 0.5 * layer))
    return np.array([corner[0], min(corner[1], deepest)])


def _along(start: float, end: float, rows: int, pitch: float, corners: FloatArray) -> FloatArray:
    """(rows + 1,) arc lengths, m: one pitch, then equal steps; with edges, equal steps between them."""
    even = np.linspace(start, end, rows + 1)
    if rows == 1:
        return even
    inside = corners[(corners > start + 0.3 * (even[1] - start)) & (corners < end - 0.3 * (even[1] - start))]
    if not len(inside):
        first = min(pitch, 1.2 * (even[1] - start))
        return np.concatenate([[start], np.linspace(start + first, end, rows)])
    row = np.clip(np.rint((inside - start) / (even[1] - start)), 1, rows - 1)
    row, first = np.unique(row, return_index=True)
    places = np.concatenate([[start], inside[first], [end]])
    return np.asarray(np.interp(np.arange(rows + 1), np.concatenate([[0], row, [rows]]), places))


def _filled(
    bottom: FloatArray, wall: FloatArray, share: FloatArray, height: float, hole: tuple[float, float]
) -> FloatArray:
    """(rows + 1, p, 2) transfinite plug between its bottom, wall, axis or hole and the plane of the body."""
    u = np.linspace(0.0, 1.0, len(wall))[:, None, None]
    s = share[None, :, None]
    pole = np.array([hole[0], bottom[np.argmin(share), 1]])
    top = np.stack([hole[1] + share * (wall[-1, 0] - hole[1]), np.full(len(share), height)], axis=1)
    axis = pole + u * (np.array([hole[1], height]) - pole)
    straight = (1.0 - u) * ((1.0 - s) * pole + s * wall[0]) + u * top
    return np.asarray((1.0 - u) * bottom + u * top + (1.0 - s) * axis + s * wall[:, None] - straight)
