"""The free flight of a rod of beam modes between the kicks of its contact: exact, and many steps at once."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf, pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem_impact.effects.beam import Beam

__all__ = ["Flight", "Rigid"]

Array = NDArray[Any]

BLOCK = 2048  # steps that are looked at together


class Rigid(NamedTuple):
    """Rigid motion: m/s, m/s, rad/s, and the height, m, of the contact point that it gives."""

    V_n: float
    V_t: float
    spin: float
    height: float


@dataclass(slots=True)
class Flight:
    """The motion between kicks, exactly, in steps ``dt``, s; ``swing`` is omega q + i dq/dt of each mode.

    Attributes
    ----------
    table : (modes, BLOCK + 1) turn of each mode after 0, 1, ... steps
    give : (modes,) its height over ``swing``
    g : (2,) what gravity takes from V_n and V_t in a step, m/s
    longest : 1.5 periods of the slowest mode, s: a free rod that has not come back by then is gone
    """

    modes: Beam
    dt: float
    d_c: float
    g: tuple[float, float]
    table: Array = field(init=False)
    give: Array = field(init=False)
    longest: float = field(init=False)

    def __post_init__(self) -> None:
        """Tabulate."""
        omega = self.modes.omega
        self.table = np.exp(-1j * self.dt * np.outer(omega, np.arange(BLOCK + 1)))
        self.give = self.modes.along_n / omega
        self.longest = 3 * pi / float(omega.min(initial=inf)) + 2 * self.dt

    def depth(self, now: Rigid, swing: Array) -> float:
        """Return how deep the contact point is, m."""
        return -now.height - float(self.give @ swing.real)

    def free(self, now: Rigid, swing: Array, crater: float) -> int:
        """Return the steps, one at least and `BLOCK` at most, until the contact point is in its crater."""
        n = np.arange(1, BLOCK + 1)
        below = self._height(now, n) + ((self.give * swing) @ self.table[:, 1:]).real < -crater
        return int(n[np.argmax(below)]) if below.any() else BLOCK

    def gone(self, now: Rigid, swing: Array, crater: float) -> bool:
        """Return whether no vibration brings the contact point back: what falls back strikes anew."""
        return self._away(now) > 0 and now.height + crater > float(np.abs(self.give) @ np.abs(swing))

    def fly(self, now: Rigid, swing: Array, n: int) -> tuple[Rigid, Array]:
        """Return the motion after ``n`` steps."""
        V_n, V_t = now.V_n - n * self.g[0], now.V_t - n * self.g[1]
        return Rigid(V_n, V_t, now.spin, float(self._height(now, n))), self.table[:, n] * swing

    def _height(self, now: Rigid, n: int | Array) -> Any:
        """Return the height, m, that rigid motion gives the contact point after ``n`` steps, of any shape."""
        return now.height + self.dt * n * (self._away(now) - 0.5 * self.g[0] * (n + 1))

    def _away(self, now: Rigid) -> float:
        """Return the speed, m/s, of the contact point off the barrier by rigid motion."""
        return now.V_n + self.d_c * now.spin
