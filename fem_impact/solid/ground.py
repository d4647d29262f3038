"""Where the barrier's surface stands as a whole, and how it moves: for what compares the rod with it."""

from dataclasses import dataclass

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.layout import DofLayout


@dataclass(frozen=True, slots=True)
class Ground:
    """The motion of a barrier as a whole: that of its foundation.

    Attributes
    ----------
    foundation : (3,) unknowns of its displacement, m; (0,) where the barrier is massive
    turn : (1,) unknown of its angle, rad, from n towards t; (0,) where it does not turn
    centre : (2,) of the foundation's mass centre along t and n at the start, m, where it turns
    """

    foundation: Ints
    turn: Ints
    centre: Array

    @classmethod
    def of(cls, layout: DofLayout, centre: Array) -> "Ground":
        """Return the motion of a barrier whose foundation has its mass ``centre`` (2,), m."""
        return cls(layout.foundation, layout.turn, centre)

    @property
    def turns(self) -> bool:
        """Return whether the barrier may turn."""
        return bool(len(self.turn))

    def risen(self, x: Array) -> float:
        """Return by how much, m, the barrier as a whole has moved along n; 0 for a massive one."""
        return float(x[self.foundation[2]]) if len(self.foundation) else 0.0

    def speed(self, v: Array) -> tuple[float, float]:
        """Return the velocity along n and t, m/s, of the barrier as a whole; 0 for a massive one."""
        if not len(self.foundation):
            return 0.0, 0.0
        return float(v[self.foundation[2]]), float(v[self.foundation[0]])

    def spin(self, v: Array) -> float:
        """Return the angular velocity, rad/s, from n towards t; 0 of a barrier that does not turn."""
        return float(v[self.turn[0]]) if self.turns else 0.0

    def place(self, x: Array) -> Array:
        """Return where the foundation's mass centre is, (2,) along t and n, m."""
        return np.asarray(self.centre + x[self.foundation[[0, 2]]])

    def rate(self, v: Array, x: Array, nodes: Ints) -> float | Array:
        """Return the velocity along n, m/s, of the barrier as a whole at its ``nodes`` (k, 3)."""
        carried = self.speed(v)[0]
        return carried - self.spin(v) * (x[nodes[:, 0]] - self.place(x)[0]) if self.turns else carried

    def levelled(self, t: Array, n: Array, x: Array, ahead: float | Array = 0.0) -> Array:
        """Return heights as over a level surface at the height `risen`, m, of points at t and n, m.

        ``ahead``, rad, is what the barrier turns beyond its present angle.
        """
        if not self.turns:
            return n
        angle, (c_t, c_n) = x[self.turn[0]] + ahead, self.place(x)
        over = (t - c_t) * np.sin(angle) + (n - c_n) * np.cos(angle) + self.centre[1]
        return np.asarray(over + self.risen(x))

    def turned_on(self, places: Array, x: Array, ahead: float) -> Array:
        """Return ``places`` (k, 3), m, of the barrier after it has turned by ``ahead``, rad, more."""
        if not self.turns:
            return places
        (c_t, c_n), moved = self.place(x), places.copy()
        t, n = places[:, 0] - c_t, places[:, 2] - c_n
        moved[:, 0] = c_t + np.cos(ahead) * t + np.sin(ahead) * n
        moved[:, 2] = c_n + np.cos(ahead) * n - np.sin(ahead) * t
        return moved

    def as_before(self, places: Array, x: Array) -> Array:
        """Return ``places`` (k, 3), m, of the barrier turned back to its direction at the start."""
        return self.turned_on(places, x, -float(x[self.turn[0]])) if self.turns else places
