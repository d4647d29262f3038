"""The state of a run: positions, velocities, forces, and time."""

from dataclasses import dataclass
from typing import ClassVar

from fem_impact.arrays import Array


@dataclass(slots=True)
class State:
    """State of a run; all vectors are flat and numbered by :class:`~fem_impact.fem.layout.DofLayout`.

    Attributes
    ----------
    x, v, force : (size,) float64, m, m/s (half a step behind x), N
    time : s
    step : number of steps done
    dt : step that led to ``x`` (s); 0 before the first
    dt_next : step to take, s
    kick : time over which the present forces act on the velocities, s
    """

    moving: ClassVar[tuple[str, ...]] = ("x", "v", "force", "time", "step", "dt", "dt_next", "kick")
    x: Array
    v: Array
    force: Array
    time: float = 0.0
    step: int = 0
    dt: float = 0.0
    dt_next: float = 0.0
    kick: float = 0.0
