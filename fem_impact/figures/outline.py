"""A projectile drawn in text or as a picture: its section in the plane of motion, tip to the left."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.figures.style import INK, PALETTE, QUIET, figure

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes

    from rigid import Body


WIDTH, MOST_ROWS = 68, 11  # characters
TALL = 2.0  # height of a character over its width
HOLLOW, TOUCH = " ", "o"
SHADES = "#=+%"  # one segment after the other


def drawn(body: Body, touch: tuple[float, float], joints: Sequence[float] = ()) -> list[str]:
    """Return the lines of a drawing to scale, ``o`` where the projectile touches first, (x, z), m.

    Thin bodies are drawn three rows high at least, not to scale. Segments, between ``joints``, m from the
    tip, have different signs.
    """
    rows = min(MOST_ROWS, max(3, round(body.diameter / body.length * WIDTH / TALL)))
    rows += 1 - rows % 2  # one of them on the axis
    z = (np.arange(WIDTH) + 0.5) / WIDTH * body.length
    x = np.linspace(1.0, -1.0, rows) * 0.5 * body.diameter * (1 - 0.5 / rows)
    inside = body.holds(np.abs(x)[:, None] + 0.0 * z, z + 0.0 * x[:, None])
    sign = [SHADES[number % len(SHADES)] for number in np.searchsorted(joints, z)]
    cells = [[sign[k] if cell else HOLLOW for k, cell in enumerate(row)] for row in inside]
    row = int(np.argmin(np.abs(x + touch[0])))  # at an angle above 0 the lower side comes down first
    cells[row][min(WIDTH - 1, int(touch[1] / body.length * WIDTH))] = TOUCH
    return ["  " + "".join(line).rstrip() for line in cells]


HEIGHT = 3.2  # inches
POINTS = 400
FILLS = ("sky", "orange", "green", "purple", "yellow", "sand")  # one material after the other
Part = tuple[float, str]
"""End of a segment, m from the tip, and the name of its material."""


def draw(body: Body, touch: tuple[float, float], parts: Sequence[Part], path: Path) -> None:
    """Draw a projectile to scale: axis, bore, segments by material, first contact and mass centre.

    Parameters
    ----------
    body : rigid projectile
    touch : (x, z), m, of the point that touches first, on the lower side at an angle above 0
    parts : segments from the tip to the tail
    path : PNG or SVG file

    Raises
    ------
    MissingLibraryError
        matplotlib is not installed.
    OutputPathError
        The place cannot be written.
    """
    with figure(path, HEIGHT) as drawn:
        axes = drawn.add_subplot()
        # fill the wall of each segment above and below the axis in the colour of its material
        from rigid import Turned

        names = list(dict.fromkeys(name for _, name in parts))
        begin = 0.0
        for end, name in parts:
            z = np.linspace(begin, end, POINTS)
            inside = np.clip(z, 1e-6 * body.length, (1 - 1e-6) * body.length)  # at the ends those just inside
            bore = body.inner_radius(inside) if isinstance(body, Turned) else np.zeros_like(z)
            inner, outer = 1e3 * np.asarray(bore), 1e3 * np.asarray(body.radius(inside))
            for side, label in ((1.0, name), (-1.0, "")):
                axes.fill_between(
                    1e3 * z,
                    side * inner,
                    side * outer,
                    label=label,
                    linewidth=0.8,
                    facecolor=PALETTE[FILLS[names.index(name) % len(FILLS)]],
                    edgecolor=INK,
                )
            begin = end
        mark(axes, touch, (0.0, body.z_c))
        axes.set(aspect="equal", xlabel="from the tip, mm", ylabel="from the axis, mm")
        drawn.legend(loc="outside upper center", ncols=4)


def mark(axes: Axes, touch: tuple[float, float], centre: tuple[float, float]) -> None:
    """Draw the axis, the point that touches first and the mass centre, both (x, z), m; x points down."""
    axes.axhline(0.0, color=QUIET, linewidth=0.7, dashes=(12, 3, 2, 3), label="axis")
    axes.plot(1e3 * touch[1], -1e3 * touch[0], "v", color=PALETTE["vermilion"], label="touches first")
    axes.plot(1e3 * centre[1], -1e3 * centre[0], "P", color=INK, label="mass centre")
