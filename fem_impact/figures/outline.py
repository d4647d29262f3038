"""A projectile drawn in text: its section in the plane of motion, tip to the left."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from rigid import Body


WIDTH, MOST_ROWS = 68, 11  # characters
TALL = 2.0  # height of a character over its width
HOLLOW, TOUCH = " ", "o"
SHADES = "#=+%"  # one segment after the other


def drawn(body: Body, touch: tuple[float, float], joints: Sequence[float] = ()) -> list[str]:
    """Return the lines of a drawing to scale, ``o`` where the projectile touches first, (rho, z), m.

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
    row = int(np.argmin(np.abs(x + touch[0])))  # the lower side comes down first
    cells[row][min(WIDTH - 1, int(touch[1] / body.length * WIDTH))] = TOUCH
    return ["  " + "".join(line).rstrip() for line in cells]
