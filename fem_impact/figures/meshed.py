"""A user's mesh as it is taken: its cells in the plane of symmetry, and its tip as the barrier sees it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.figures.outline import FILLS, mark
from fem_impact.figures.style import INK, PALETTE, QUIET, WIDTH, figure
from meshes import SKIN, SYMMETRY, owners

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes

    from fem_impact.arrays import Array, Ints
    from meshes import HexMesh

HEIGHT = 3.6  # inches


def draw_mesh(
    half: HexMesh,
    centre: tuple[float, float],
    touch: tuple[float, float],
    of: Ints,
    names: Sequence[str],
    path: Path,
    width: float = WIDTH,
) -> None:
    """Draw the half of a mesh from the side, tip to the left, and its whole from the tip.

    Parameters
    ----------
    half : the half y >= 0, its tip at z = 0
    centre : (x, z), m, of its mass
    touch : (x, z), m, of the point that touches first; it lies on the lower side
    of, names : which of the materials ``names`` each cell (m,) is of
    path, width : PNG or SVG file, and how wide it is, inches

    Raises
    ------
    MissingLibraryError
        matplotlib is not installed.
    OutputPathError
        The place cannot be written.
    """
    mm = 1e3 * half.points
    side, front = _faces(half, SYMMETRY), _faces(half, SKIN)
    with figure(path, HEIGHT, width) as drawn:
        wide = max(1.0, float(np.ptp(mm[:, 2]) / max(np.ptp(mm[:, 0]), 2 * mm[:, 1].max())))
        left, right = drawn.subplots(1, 2, width_ratios=(min(wide, 4.0), 1.0))
        _fill(left, mm[side[0]][:, :, [2, 0]] * [1, -1], of[side[1]], names)
        mark(left, touch, centre)
        left.set(aspect="equal", xlabel="z, from the tip, mm", ylabel="-x, mm")
        corners = mm[front[0]]
        normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        seen = normal[:, 2] < 0.0
        order = np.argsort(-corners[seen][:, :, 2].mean(axis=1))  # those nearest to the barrier last
        for sign in (1, -1):
            _fill(right, corners[seen][order][:, :, [1, 0]] * [sign, -1], of[front[1][seen][order]], ())
        right.axvline(0.0, color=QUIET, linewidth=0.7, dashes=(12, 3, 2, 3))
        right.autoscale_view()
        right.set(aspect="equal", xlabel="y, mm")
        drawn.legend(loc="outside upper center", ncols=int(width / 2))


def _faces(half: HexMesh, tag: int) -> tuple[Ints, Ints]:
    """Return the faces (k, 4) of a tag and the cell (k,) that each belongs to."""
    chosen = half.face_tag == tag
    return half.faces[chosen], owners(half)[chosen]


def _fill(axes: Axes, polygons: Array, of: Ints, names: Sequence[str]) -> None:
    """Fill polygons (k, 4, 2), mm, in the colours of their materials, with a word for each of ``names``."""
    from matplotlib.collections import PolyCollection

    colours = [PALETTE[FILLS[int(number) % len(FILLS)]] for number in of]
    axes.add_collection(PolyCollection(list(polygons), facecolors=colours, edgecolors=INK, linewidths=0.3))
    for number, name in enumerate(names):
        axes.fill([], [], facecolor=PALETTE[FILLS[number % len(FILLS)]], edgecolor=INK, label=name)
    axes.autoscale_view()
