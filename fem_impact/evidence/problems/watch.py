"""Runs of the verification, and their observers: contact force and mechanical energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fem_impact.errors import RunError
from fem_impact.evidence.problems.bodies import rigid_of
from fem_impact.fem.flight import RigidMotion
from fem_impact.solid.ledger import Ledger
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.solid.stepguard import SMALLEST, StepGuard

SMOOTHING = 0.05  # window of the peak force over the contact time
MECHANICAL = ("kinetic_rod", "strain_rod", "kinetic_barrier", "strain_barrier")


class ForceRecorder:
    """Records the normal force, N, of the whole body on the plane over each step."""

    every = 1

    def __init__(self, model: Model) -> None:
        self.book = model.book
        self.times: list[float] = []
        self.values: list[float] = []

    def observe(self, state: State) -> bool:
        """Take the impulse of the step that led here."""
        if state.step:
            self.times.append(state.time - 0.5 * state.dt)
            self.values.append(2 * self.book.step.impulse_n / state.kick)
        return False

    @property
    def touches(self) -> int:
        """Return how often force sets in after having been absent."""
        on = np.array(self.values) > 0
        return int((np.diff(np.concatenate([[0], on.astype(int)])) == 1).sum())

    @property
    def span(self) -> tuple[float, float]:
        """Return the times of the first and the last force, s."""
        on = np.flatnonzero(np.array(self.values) > 0)
        return self.times[int(on[0])], self.times[int(on[-1])]

    def mean(self, start: float, end: float) -> float:
        """Return the mean force between two times after the first touch."""
        t = np.array(self.times) - self.span[0]
        return float(np.array(self.values)[(t >= start) & (t <= end)].mean())

    def peak(self, window: float) -> float:
        """Return the largest force averaged over a window, s: single nodes close in small jerks."""
        t, y = np.array(self.times), np.array(self.values)
        width = max(1, round(window / float(np.diff(t).mean())))
        return float(np.convolve(y, np.ones(width) / width, "valid").max())


class Until:
    """Watches mechanical energy over that of the start, until a time or a condition."""

    def __init__(
        self, ledger: Ledger, end: float, done: Callable[[], bool] = lambda: False, every: int = 10
    ) -> None:
        self.ledger, self.end, self.done, self.every = ledger, end, done, every
        self.most = 0.0

    def observe(self, state: State) -> bool:
        """Sample; stop at the end."""
        found = self.ledger.sample(state)
        self.most = max(self.most, sum(found[name] for name in MECHANICAL) / self.ledger.start)
        return state.time >= self.end or self.done()


def follow(model: Model, state: State, until: Until, every: int, crushed: float = SMALLEST) -> None:
    """March a body that yields to its end, the step following its cells ``every`` so many steps.

    The run ends where the step falls below ``crushed`` of the first.

    Raises
    ------
    RunError
        If a cell folds or is crushed.
    """
    guard = StepGuard(model, every, crushed)
    march(model, state, [guard, until])
    if guard.reason:
        raise RunError(guard.reason)


@dataclass(frozen=True, slots=True)
class TipImpact:
    """End of a strike.

    Attributes
    ----------
    force, duration : largest force, N; contact time, s
    motion : rigid motion after it
    radiated, closing : energy that left through the block's boundary, and that closing nodes lost, J
    most : largest energy on the way over E_0
    """

    force: float
    duration: float
    motion: RigidMotion
    radiated: float
    closing: float
    most: float
    state: State

    def kept(self, speed: float) -> float:
        """Return the energy of the rebound and what was radiated over that of the approach at ``speed``."""
        return (self.motion.kinetic + self.radiated) / (0.5 * self.motion.mass * speed**2)


def run_strike(model: Model, end: float, expected: float) -> TipImpact:
    """March until ``end`` s and read the contact."""
    state, force = model.initial_state(), ForceRecorder(model)
    energy = Until(model.ledger(), end, every=20)
    march(model, state, [force, energy])
    start, stop = force.span
    peak = force.peak(SMOOTHING * expected)
    spent = energy.ledger.sample(state)
    motion = rigid_of(model, state)
    return TipImpact(peak, stop - start, motion, spent["radiated"], spent["closing"], energy.most, state)
