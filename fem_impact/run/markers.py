"""The camera's measurement replayed: two markers, mean velocity over 40 frames at 10 kHz.

The mean velocity of a tracked position is its difference over the window T, divided by T, so vibration of
a marker by u adds (u(T) - u(0)) / T. The lever of the lower marker from the mass centre is from a regression
on the published velocities (52 and 32 mm for the rods of 0.12 and 0.08 m). For the rod of 0.24 m it gives
124 mm, beyond the tip, so the marker is taken at the tip there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fem_impact.arrays import Array
from fem_impact.outcome.groups import Markers

if TYPE_CHECKING:
    from fem_impact.solid.run import SolidResult


WINDOW = 4e-3  # s, time T of 40 frames
LEVER = {0.24: 0.124, 0.12: 0.052, 0.08: 0.032}  # m, by rod length, m
OTHER_LEVER = 0.42  # lever over rod length, for rods that were not measured


def lever_of(length: float) -> float:
    """Return the lower marker's distance from the mass centre, m, at most to the tip."""
    return min(LEVER.get(round(length, 6), OTHER_LEVER * length), 0.5 * length)


def replay(result: SolidResult, V_n: float, V_t: float) -> Markers:
    """Return the motion as the camera would have measured it in the free flight after the run.

    ``V_n`` and ``V_t`` are the velocities of the mass centre, m/s, without gravity, as is the result.
    """
    alpha, turn = result.case.scene.impact.angle, result.motion.Omega * WINDOW
    axis = np.array([np.sin(alpha), 0.0, np.cos(alpha)])
    across = np.array([np.cos(alpha), 0.0, -np.sin(alpha)])
    arm = -lever_of(result.case.scene.projectile.length) * axis
    free = ~result.model.geometry.rod.mesh.is_hanging
    points, unknowns = result.model.geometry.rod_points[free], result.model.layout.rod[free]
    centre = result.view.mass @ points / result.view.mass.sum() * [1.0, 0.0, 1.0]
    nearest = [((points - place) ** 2).sum(axis=1).argmin() for place in (centre, centre + arm)]
    u = result.flight.displacement(unknowns[nearest].ravel(), np.array([0.0, WINDOW]))
    by_vibration = (u[:, 1] - u[:, 0]).reshape(-1, 3) / WINDOW  # (markers, 3) m/s
    upper = np.array([V_t, 0.0, V_n]) + by_vibration[0]
    lower = np.array([V_t, 0.0, V_n]) + by_vibration[1] + (_turned(arm, turn) - arm) / WINDOW
    line = (upper - lower) * WINDOW - arm
    angle = float(np.arctan2(line @ across, line @ axis))
    angle += 2 * np.pi * round((turn - angle) / (2 * np.pi))  # the film shows the number of full turns
    return Markers(
        V_n=float(upper[2]),
        V_t=float(upper[0]),
        Omega=angle / WINDOW,
        V_cn=float(lower[2]),
        V_ct=float(lower[0]),
    )


def _turned(arm: Array, angle: float) -> Array:
    """Return a vector turned from n towards t."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * arm[0] + s * arm[2], 0.0, c * arm[2] - s * arm[0]])
