"""Rod and barrier at any time of a film, and the times that a film shows."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np

from fem_impact.errors import ResultError, UsageError
from fem_impact.files.fields import FieldFile, read_fields
from fem_impact.files.waves import Ringing, Waves, read_waves


@dataclass(frozen=True, slots=True)
class Movement:
    """The stored motion of a run.

    Positions and stored fields between two frames are interpolated; the strain of the cylinder along its axis
    comes from waves.h5, which resolves every wave. ``waves``, strain along the axis and free flight, are None
    where the run did not store them.
    """

    fields: FieldFile
    waves: Waves | None = None
    _read: Callable[[str, int], np.ndarray] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Keep what was read last: a picture asks several times for the frames around it."""
        object.__setattr__(self, "_read", lru_cache(maxsize=8)(self.fields.point_data))

    @property
    def ringing(self) -> Ringing | None:
        """Return the flight after the run."""
        return self.waves.ringing if self.waves else None

    @property
    def stored_end(self) -> float:
        """Return the time of the last stored frame, s."""
        return float(self.fields.times[-1])

    @property
    def end(self) -> float:
        """Return the time until which a film may run, s: two periods of the slowest mode after the run."""
        if self.ringing is None or not len(self.ringing.omega):
            return self.stored_end
        return self.ringing.start + 4 * np.pi / float(self.ringing.omega.min())

    def points(self, time: float) -> np.ndarray:
        """Return the positions ``(n, 3)``, m, of all points."""
        ringing = self.ringing
        if ringing is None or time <= self.stored_end:
            return np.asarray(self.fields.points + self.point_data("displacement", time))
        last = self.fields.points + self.point_data("displacement", self.stored_end)
        free, moved = ringing.points(max(time, ringing.start)), last.copy()
        share = min((time - self.stored_end) / max(ringing.start - self.stored_end, 1e-30), 1.0)
        moved[: len(free)] += share * (free - last[: len(free)])
        return np.asarray(moved)

    def velocity(self, time: float, weights: np.ndarray) -> np.ndarray:
        """Return the velocity ``(3,)``, m/s, of the centre of points with ``weights``; b is 0 by symmetry."""
        if self.ringing is not None and time >= self.ringing.start:
            return self.ringing.velocity
        mean: np.ndarray = weights @ self.velocities(time) / weights.sum()
        return mean * [1.0, 0.0, 1.0]

    def velocities(self, time: float) -> np.ndarray:
        """Return the velocities ``(n, 3)``, m/s, of all points: those of a parabola through three frames."""
        times, read = self.fields.times, self._read
        first = int(np.clip(np.searchsorted(times, time) - 1, 0, max(len(times) - 3, 0)))
        near = times[first : first + 3]
        if len(near) == 1:
            return np.zeros_like(self.fields.points)
        places = np.stack([read("displacement", first + at).astype(float) for at in range(len(near))])
        rates = np.gradient(places, near, axis=0, edge_order=2 if len(near) == 3 else 1)
        share = min((time - near[0]) / (near[-1] - near[0]), 1.0)
        return np.asarray(rates[0] + share * (rates[-1] - rates[0]))

    def point_data(self, name: str, time: float) -> np.ndarray:
        """Return stored point data at a time, the last ones after the last frame."""
        return self._between_frames(self._read, name, time)

    def cell_data(self, name: str, time: float) -> np.ndarray:
        """Return stored cell data at a time, the last ones after the last frame."""
        return self._between_frames(self.fields.cell_data, name, time)

    def _between_frames(self, read: Callable[[str, int], np.ndarray], name: str, time: float) -> np.ndarray:
        times = self.fields.times
        after = int(np.clip(np.searchsorted(times, time), 0, len(times) - 1))
        before, share = max(after - 1, 0), 0.0
        if times[after] <= time or before == after:
            before = after
        else:
            share = float(max(0.0, (time - times[before]) / (times[after] - times[before])))
        first = read(name, before).astype(float)
        return np.asarray((1 - share) * first + share * read(name, after))


def read_movement(folder: Path) -> tuple[Movement, list[str]]:
    """Return the stored motion of a run, and a note where the strain along the axis is missing.

    Raises
    ------
    ResultError
        The fields, or the waves, are damaged; there are no fields.
    """
    fields = read_fields(folder / "fields.vtkhdf")
    if not len(fields.times):
        raise ResultError(f"{fields.path}: holds no frames yet, so there is nothing to draw.")
    if not (folder / "waves.h5").is_file():
        missing = "The run stored no waves.h5: strains are those of the stored frames, without free ringing."
        return Movement(fields), [missing]
    waves = read_waves(folder / "waves.h5")
    if waves.ringing is not None and len(waves.ringing.rest) > len(fields.points):
        raise ResultError(f"{folder / 'waves.h5'}: holds other points than fields.vtkhdf.")
    return Movement(fields, waves), []


PASSES = 2
"""Lengths of the rod that a stretching wave runs in the first part of a film: to the tail and back."""

FRAMES = 144
"""Frames of a film of three parts: 24 while a stretching wave runs once along the rod."""

STUDY_FRAMES = 60
"""Frames of the film of each run of a study."""

FPS = 20
"""Frames a second of a film."""


@dataclass(frozen=True, slots=True)
class Span:
    """What a film shall show: first and last time, s; number of frames; motion in a second of film, s."""

    first: float | None = None
    last: float | None = None
    frames: int | None = None
    speed: float | None = None


WHOLE = Span()
"""All of the motion."""


def film_times(movement: Movement, field: str, span: Span) -> np.ndarray:
    """Return the times, s, of the frames.

    Without a span: equal numbers of frames for the time in which a stretching wave runs to the tail and back,
    for the rest of the run, and for the free ringing. Fields other than the strain end with the last stored
    frame.

    Raises
    ------
    UsageError
        The span is empty, lies outside the run, or has no frames.
    """
    end = movement.end if field == "strain" else movement.stored_end
    if span.frames is not None and span.frames < 1:
        raise UsageError("is no number of frames: a film needs one.", key="frames=", value=span.frames)
    if span.first is not None or span.last is not None or span.speed is not None:
        first, last = span.first or 0.0, end if span.last is None else span.last
        if not 0.0 <= first < last <= end * (1 + 1e-9):
            shown = f"{first * 1e6:.4g} us to {last * 1e6:.4g} us"
            remedy = f"Give times from 0 to {end * 1e6:.4g} us, the first before the last."
            raise UsageError(
                "lies outside what this film can show.",
                key="the span of the film",
                value=shown,
                remedy=remedy,
            )
        if span.speed is None:
            return np.linspace(first, last, span.frames or FRAMES)
        return np.linspace(first, last, max(2, round((last - first) / span.speed * FPS)))
    if movement.waves is None:
        stored = movement.fields.times
        count = len(stored) if span.frames is None else min(span.frames, len(stored))
        return evenly(stored, count)
    parts = (PASSES * movement.waves.transit, movement.waves.end)
    marks = sorted({0.0, *(mark for mark in parts if mark < end * (1 - 1e-9)), end})
    return np.interp(np.linspace(0, len(marks) - 1, span.frames or FRAMES), np.arange(len(marks)), marks)


def evenly(times: np.ndarray, most: int) -> np.ndarray:
    """Return so many of the times at most, evenly from the first to the last."""
    at = np.linspace(0, len(times) - 1, most).round()
    return np.asarray(times[np.unique(at).astype(int)])


def slow_motion(times: np.ndarray, at: int) -> float:
    """Return how many seconds of motion one second of the film shows at a frame."""
    if len(times) < 2:
        return 0.0
    following = min(at + 1, len(times) - 1)
    return float(times[following] - times[following - 1]) * FPS
