"""The end of the impact: the rod's exact free flight has no further contact."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.case.case import before_other_end
from fem_impact.fem.flight import FreeVibration, RigidMotion
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.frame import turned
from fem_impact.solid.model import Model
from fem_impact.solid.observers import OF_IMPACT, QUIET
from fem_impact.solid.rodview import RodState
from fem_impact.solid.state import State

SAMPLES = 500  # of the flight that is looked ahead: more than 300 a bending period


@dataclass(slots=True)
class Separation:
    """Observer that stops the run at the last separation.

    The free flight, rigid drift plus all modes, must keep the rod above the barrier for the ``horizon``, s.
    As long as its surface may be lower than the barrier's highest node, the tip in flight is compared with
    the barrier's surface, with its crater, node by node. Where the tail cannot touch in the model, ``tail``
    (k, 3), m, holds the corners of the other end at the start: their strike is another impact. Where it can,
    ``behind`` (m,) marks nodes of the rim in the half of the other end: its strike is another impact as long
    as none of it has ``touched`` in this one. ``other_end`` is how much later, s, it comes.
    """

    moving: ClassVar[tuple[str, ...]] = ()
    model: Model
    view: RodState
    limit: float
    horizon: float
    tail: Array = field(default_factory=lambda: np.zeros((0, 3)))
    behind: Bools = field(default_factory=lambda: np.zeros(0, bool))
    touched: Callable[[], bool] = lambda: False
    every: int = 100
    reason: str = ""
    finished: bool = False
    other_end: float = np.inf

    @property
    def quiet(self) -> float:
        """Time, s, without contact before the free flight is evaluated."""
        return min(QUIET, OF_IMPACT * self.horizon)

    @property
    def _sample(self) -> float:
        """Interval, s, at which the free flight is evaluated."""
        return self.horizon / SAMPLES

    def observe(self, state: State) -> bool:
        """Return True when the impact is over or the time is up."""
        if state.time >= self.limit:
            self.reason = (
                f"Reached max_time = {self.limit * 1e3:g} ms before the last separation was certain: "
                "give a longer accuracy.max_time."
            )
            return True
        book = self.model.book
        if not book.intervals or book.touching or state.time - book.last_touch < self.quiet:
            return False
        motion, (u_n, u_t) = self.view.rigid(state), self.model.ground.speed(state.v)
        motion = replace(motion, V_n=motion.V_n - u_n, V_t=motion.V_t - u_t)  # as seen from the barrier
        flight = self.view.flight(state, self.model)
        half = self._half_strikes(state, motion, flight)
        ahead = min(self.horizon, self._tail_strikes(state, motion), half)
        until, alone = max(ahead, self._sample), half == ahead < self.horizon
        if not self._stays_away(state, motion, flight, until, alone):
            return False
        self.finished = True
        self.reason = (
            f"The rod does not touch again within the next {self.horizon * 1e3:.3g} ms of free flight."
        )
        if ahead < self.horizon:
            self.other_end, self.reason = ahead, before_other_end(ahead)
        return True

    def _tail_strikes(self, state: State, motion: RigidMotion) -> float:
        """Return the time, s from now, until the tail reaches the barrier; infinite if it does not."""
        if not len(self.tail):
            return np.inf
        start, t = self.model.start[0][self.view.places], np.arange(0.0, self.horizon, self._sample)
        arm = self.tail - self.view.mass @ start / self.view.mass.sum()
        angle, ground = -self.view.angle(state, self.model), self.model.ground  # from n towards t
        heights = _rigid_heights(arm, motion, t, angle)
        if ground.turns:
            along = _rigid_along(arm, motion, t, angle)
            heights = ground.levelled(along, heights, state.x, ground.spin(state.v) * t)
        down = heights.min(axis=0) < ground.risen(state.x)
        return float(t[np.argmax(down)]) if down.any() else np.inf

    def _half_strikes(self, state: State, motion: RigidMotion, flight: FreeVibration) -> float:
        """Return the time, s from now, until the half of the other end is first to touch; infinite if not."""
        if not self.behind.any() or self.touched():
            return np.inf
        t = np.arange(0.0, self.horizon, self._sample)
        down = self._rim_heights(state, motion, flight, t) <= self.model.ground.risen(state.x)
        first = int(np.argmax(down.any(axis=0)))
        alone = down[self.behind, first].any() and not down[~self.behind, first].any()
        return float(t[first]) if alone else np.inf

    def _stays_away(
        self, state: State, motion: RigidMotion, flight: FreeVibration, until: float, but_behind: bool
    ) -> bool:
        """Return whether the flight of the next ``until``, s, has no contact but that of the half behind."""
        t, contact = np.arange(0.0, until, self._sample), self.model.contact
        ground, x = self.model.ground, state.x
        rim, risen = self._rim_heights(state, motion, flight, t), ground.risen(x)
        lowest = rim.min(axis=0)
        if not isinstance(contact, SurfaceContact):
            return bool(lowest.min() > risen)
        surface = contact.barrier.places
        # allows the barrier to move on for the time `quiet` at its present speed
        base = risen if self.model.in_plate_frame else 0.0  # of the barrier's positions
        carried = 0.0 if self.model.in_plate_frame else ground.rate(state.v, x, surface)
        margin = self.quiet * float(np.abs(state.v[surface[:, 2]] - carried).max())
        top = max(risen - base, float(ground.levelled(x[surface[:, 0]], x[surface[:, 2]], x).max()))
        near = top + margin + contact.rod.sag
        closed = (rim[self.behind].min(axis=0) - base <= near) if but_behind else np.zeros(len(t), bool)
        deep = t[(lowest - base <= near) & ~np.logical_or.accumulate(closed)]
        places, spin = contact.rod.places, ground.spin(state.v)

        def clearance(s: float) -> float:
            moved = flown(x, places, motion, flight, s)
            moved[places[:, 2]] -= base
            moved[surface] = ground.turned_on(moved[surface], x, spin * s)
            return contact.clearance(moved)

        return all(clearance(s) > margin for s in deep)

    def _rim_heights(self, state: State, motion: RigidMotion, ahead: FreeVibration, t: Array) -> Array:
        """Return heights (k, times), m, of the rim in free flight, as over a barrier that does not turn."""
        x, rim, ground = state.x[self.view.rim], self.view.rim, self.model.ground
        heights = flight_heights(x, rim[:, 2], motion, ahead, t)
        if not ground.turns:
            return heights
        along = _rigid_along(x - motion.centre, motion, t) + _shake(ahead, rim[:, 0], t)
        return ground.levelled(along, heights, state.x, ground.spin(state.v) * t)


def flown(x: Array, places: Ints, motion: RigidMotion, ahead: FreeVibration, t: float) -> Array:
    """Return a copy of positions ``x`` in which nodes ``places`` (k, 3) flew on freely for a time, s."""
    moved, drift = x.copy(), (motion.V_t * t, 0.0, motion.V_n * t)
    shake = _shake(ahead, places.ravel(), np.array([t])).reshape(-1, 3)
    moved[places] = motion.centre + drift + turned(x[places] - motion.centre, motion.Omega * t) + shake
    return moved


def flight_heights(x: Array, rows: Ints, motion: RigidMotion, ahead: FreeVibration, t: Array) -> Array:
    """Return heights n (k, times), m, of nodes at x (k, 3) in free flight after times t, s."""
    return _rigid_heights(x - motion.centre, motion, t) + _shake(ahead, rows, t)


def _shake(ahead: FreeVibration, rows: Ints, t: Array) -> Array:
    """Return how far, m, unknowns move by vibration from now to times t, s, (k, times)."""
    return ahead.displacement(rows, t) - ahead.displacement(rows, np.zeros(1))


def _rigid_heights(arm: Array, motion: RigidMotion, t: Array, angle: float = 0.0) -> Array:
    """Return heights n (k, times), m, of points that stand at ``arm`` (k, 3) turned by ``angle``, rad."""
    turn = angle + motion.Omega * t
    rise = np.outer(arm[:, 2], np.cos(turn)) - np.outer(arm[:, 0], np.sin(turn))
    return np.asarray(motion.centre[2] + motion.V_n * t + rise)


def _rigid_along(arm: Array, motion: RigidMotion, t: Array, angle: float = 0.0) -> Array:
    """Return places t (k, times), m, of points that stand at ``arm`` (k, 3) turned by ``angle``, rad."""
    turn = angle + motion.Omega * t
    moved = np.outer(arm[:, 0], np.cos(turn)) + np.outer(arm[:, 2], np.sin(turn))
    return np.asarray(motion.centre[0] + motion.V_t * t + moved)
