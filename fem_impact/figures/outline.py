"""A projectile drawn in text or as a picture: its section in the plane of motion, or a user's own mesh."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.figures.still import INK, PALETTE, QUIET, WIDTH, figure
from meshes import SKIN, SYMMETRY, HexMesh, owners
from meshes.hexmesh import quad_normals
from rigid import Body, Faceted, Turned

if TYPE_CHECKING:
    from matplotlib.axes import Axes


COLUMNS, MOST_ROWS = 68, 11  # characters
TALL = 2.0  # height of a character over its width
HOLLOW, TOUCH = " ", "o"
SHADES = "#=+%"  # one segment after the other


WITHIN = 65
"""Heights within a row of a drawing in signs at which a wall is looked for."""


def drawn(body: Body, touch: tuple[float, float], joints: Sequence[float] = ()) -> list[str]:
    """Return the lines of a drawing to scale, ``o`` where the projectile touches first, (x, z), m.

    Thin bodies are drawn three rows high at least, not to scale. Segments, between ``joints``, m from the
    tip, have different signs.
    """
    middle, width = 0.0, body.diameter
    if isinstance(body, Faceted):  # which may be bent
        low, high = body.points[:, 0].min(), body.points[:, 0].max()
        middle, width = 0.5 * (low + high), high - low
    rows = min(MOST_ROWS, max(3, round(width / body.length * COLUMNS / TALL)))
    rows += 1 - rows % 2  # one of them in the middle
    z = (np.arange(COLUMNS) + 0.5) / COLUMNS * body.length
    x = middle + width * np.linspace(-0.5, 0.5, rows) * (1 - 0.5 / rows)  # downwards
    X, Z = np.broadcast_arrays(x[:, None], z)
    if isinstance(body, Faceted):
        inside = body.within(X, Z)
    else:
        inside = body.holds(np.abs(X), Z)
        if not inside[rows // 2, COLUMNS // 2]:  # hollow: a wall may lie between the middles of two rows
            for within in np.linspace(-0.5, 0.5, WITHIN) * width / rows:
                inside = inside | body.holds(np.abs(X + within), Z)
    sign = [SHADES[number % len(SHADES)] for number in np.searchsorted(joints, z)]
    cells = [[sign[k] if cell else HOLLOW for k, cell in enumerate(row)] for row in inside]
    row = int(np.argmin(np.abs(x - touch[0])))  # at an angle above 0 the lower side comes down first
    cells[row][min(COLUMNS - 1, int(touch[1] / body.length * COLUMNS))] = TOUCH
    return ["  " + "".join(line).rstrip() for line in cells]


HEIGHT = 3.2  # inches
POINTS = 400
LONG, SHOWN = 15.0, 5.0
"""Lengths in diameters: of a body drawn with a break, and of each of its ends then."""
FILLS = ("sky", "orange", "green", "purple", "yellow", "sand")  # one material after the other
Part = tuple[float, str]
"""End of a segment, m from the tip, and the name of its material."""


def draw(
    body: Body, touch: tuple[float, float], parts: Sequence[Part], path: Path, width: float = WIDTH
) -> None:
    """Draw a projectile to scale: axis, bore, segments by material, first contact and mass centre.

    Of a long one with the same section all along its middle both ends are drawn, and a break between them.

    Parameters
    ----------
    body : rigid projectile
    touch : (x, z), m, of the point that touches first, on the lower side at an angle above 0
    parts : segments from the tip to the tail
    path, width : PNG or SVG file, and how wide it is, inches

    Raises
    ------
    OutputPathError
        The place cannot be written.
    """

    def wall(z: Array) -> tuple[Array, Array]:
        inside = np.clip(z, 1e-6 * body.length, (1 - 1e-6) * body.length)  # at the ends those just inside
        bore = body.inner_radius(inside) if isinstance(body, Turned) else np.zeros_like(z)
        return 1e3 * np.asarray(bore), 1e3 * np.asarray(body.radius(inside))

    end = SHOWN * body.diameter
    middle = np.linspace(end, body.length - end, POINTS)
    alike = all(np.ptp(radius) < 1e-6 for radius in wall(middle))
    joined = any(end < to < body.length - end for to, _ in parts)
    broken = body.length > LONG * body.diameter and alike and not joined
    length = 2 * end if broken else body.length
    with figure(path, min(HEIGHT, 1.2 + width * body.diameter / length), width) as drawn:
        views = np.atleast_1d(drawn.subplots(1, 1 + broken, sharey=True))
        names = list(dict.fromkeys(name for _, name in parts))
        for axes in views:
            begin = 0.0
            for to, name in parts:
                z = np.linspace(begin, to, POINTS)
                inner, outer = wall(z)
                colour = PALETTE[FILLS[names.index(name) % len(FILLS)]]
                for side, label in ((1.0, name), (-1.0, "")):
                    words = {"label": label, "facecolor": colour, "edgecolor": INK, "linewidth": 0.8}
                    axes.fill_between(1e3 * z, side * inner, side * outer, **words)
                begin = to
            mark(axes, touch, (0.0, body.z_c), f", {1e3 * body.z_c:.4g} mm from the tip" if broken else "")
            axes.set(aspect="equal", xlabel="from the tip, mm")
        views[0].set(ylabel="from the axis, mm")
        if broken:
            views[0].set(xlim=(-100 * body.diameter, 1e3 * end))
            views[1].set(xlim=(1e3 * (body.length - end), 1e3 * body.length + 100 * body.diameter))
            views[1].spines["left"].set_visible(False)
            views[1].tick_params(left=False)
            cut = {"marker": [(-0.5, -1.5), (0.5, 1.5)], "markersize": 12, "color": INK, "clip_on": False}
            for axes, at in zip(views, (1.0, 0.0), strict=True):
                axes.plot([at, at], [0.35, 0.65], linestyle="", transform=axes.transAxes, **cut)
        drawn.legend(*views[0].get_legend_handles_labels(), loc="outside upper center", ncols=int(width / 2))


def mark(axes: Axes, touch: tuple[float, float], centre: tuple[float, float], where: str = "") -> None:
    """Draw the axis, the point that touches first and the mass centre, both (x, z), m; x points down."""
    axes.axhline(0.0, color=QUIET, linewidth=0.7, dashes=(12, 3, 2, 3), label="axis")
    axes.plot(1e3 * touch[1], -1e3 * touch[0], "v", color=PALETTE["vermilion"], label="touches first")
    axes.plot(1e3 * centre[1], -1e3 * centre[0], "P", color=INK, label=f"mass centre{where}")


MESH_HEIGHT = 3.6  # inches


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
    OutputPathError
        The place cannot be written.
    """
    mm, tags, cells = 1e3 * half.points, half.face_tag, owners(half)
    # faces (k, 4) and the cell (k,) that each belongs to
    side, front = ((half.faces[tags == tag], cells[tags == tag]) for tag in (SYMMETRY, SKIN))
    with figure(path, MESH_HEIGHT, width) as drawn:
        wide = max(1.0, float(np.ptp(mm[:, 2]) / max(np.ptp(mm[:, 0]), 2 * mm[:, 1].max())))
        left, right = drawn.subplots(1, 2, width_ratios=(min(wide, 4.0), 1.0))
        _fill(left, mm[side[0]][:, :, [2, 0]] * [1, -1], of[side[1]], names)
        mark(left, touch, centre)
        left.set(aspect="equal", xlabel="z, from the tip, mm", ylabel="-x, mm")
        corners = mm[front[0]]
        normal = quad_normals(corners)
        seen = normal[:, 2] < 0.0
        order = np.argsort(-corners[seen][:, :, 2].mean(axis=1))  # those nearest to the barrier last
        for sign in (1, -1):
            _fill(right, corners[seen][order][:, :, [1, 0]] * [sign, -1], of[front[1][seen][order]], ())
        right.axvline(0.0, color=QUIET, linewidth=0.7, dashes=(12, 3, 2, 3))
        right.autoscale_view()
        right.set(aspect="equal", xlabel="y, mm")
        drawn.legend(loc="outside upper center", ncols=int(width / 2))


def _fill(axes: Axes, polygons: Array, of: Ints, names: Sequence[str]) -> None:
    """Fill polygons (k, 4, 2), mm, in the colours of their materials, with a word for each of ``names``."""
    from matplotlib.collections import PolyCollection

    colours = [PALETTE[FILLS[int(number) % len(FILLS)]] for number in of]
    axes.add_collection(PolyCollection(list(polygons), facecolors=colours, edgecolors=INK, linewidths=0.3))
    for number, name in enumerate(names):
        axes.fill([], [], facecolor=PALETTE[FILLS[number % len(FILLS)]], edgecolor=INK, label=name)
    axes.autoscale_view()
