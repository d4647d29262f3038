"""A yielding round bar on a frictionless rigid wall, in axisymmetric elements: nodes stop at the wall."""

from __future__ import annotations

import numpy as np

from fem_impact.evidence.references.axisymmetric import Body, Metal, grid


def taylor_bar(
    metal: Metal, length: float, radius: float, speed: float, time: float, cells: int = 4
) -> tuple[float, float]:
    """Return length and foot radius, m, at a time, s, with so many cells over the radius.

    Examples
    --------
    >>> copper = Metal(117e9, 0.35, 8930.0, 400e6, slope=0.25)
    >>> [round(1e3 * size, 1) for size in taylor_bar(copper, 32.4e-3, 3.2e-3, 227.0, 80e-6, 2)]
    [21.5, 6.9]
    """
    along = max(2, round(cells * length / radius))
    x, corners = grid(np.linspace(0, radius, cells + 1), np.linspace(0, length, along + 1))
    bar = Body(metal, x, np.tile([0.0, -speed], (len(x), 1)), corners)
    axis = x[:, 0] == 0.0

    def stop(bar: Body) -> None:
        bar.v[axis, 0] = 0.0
        bar.v[:, 1] = np.maximum(bar.v[:, 1], -bar.x[:, 1] / bar.dt)

    while bar.time < time:
        bar.advance(stop)
    return float(np.ptp(bar.x[:, 1])), float(bar.x[: cells + 1, 0].max())
