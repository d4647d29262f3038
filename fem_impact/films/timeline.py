"""The times that a film shows: slow while the first waves run, faster later."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_impact.errors import UsageError
from fem_impact.films.movement import Movement

PASSES = 2
"""Lengths of the rod that a stretching wave runs in the first part of a film: to the tail and back."""

FRAMES = 144
"""Frames of a film of three parts: 24 while a stretching wave runs once along the rod."""

STUDY_FRAMES, QUICK_FRAMES = 60, 30
"""Frames of the film of each run of a study, and of a quick one."""

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
        raise UsageError("is no number of frames: a film needs one.", key="--frames", value=span.frames)
    if span.first is not None or span.last is not None or span.speed is not None:
        return _even(span, end)
    if movement.waves is None:
        return _stored(movement, span.frames)
    return _parts(movement, end, span.frames or FRAMES)


def _even(span: Span, end: float) -> np.ndarray:
    first, last = span.first or 0.0, end if span.last is None else span.last
    if not 0.0 <= first < last <= end * (1 + 1e-9):
        shown = f"{first * 1e6:.4g} us to {last * 1e6:.4g} us"
        remedy = f"Give times from 0 to {end * 1e6:.4g} us, the first before the last."
        raise UsageError(
            "lies outside what this film can show.", key="--from --until", value=shown, remedy=remedy
        )
    if span.speed is None:
        return np.linspace(first, last, span.frames or FRAMES)
    return np.linspace(first, last, max(2, round((last - first) / span.speed * FPS)))


def _stored(movement: Movement, frames: int | None) -> np.ndarray:
    stored = movement.fields.times
    count = len(stored) if frames is None else min(frames, len(stored))
    return np.asarray(stored[np.unique(np.linspace(0, len(stored) - 1, count).round()).astype(int)])


def _parts(movement: Movement, end: float, frames: int) -> np.ndarray:
    assert movement.waves is not None
    early, run = PASSES * movement.waves.transit, movement.waves.end
    marks = sorted({0.0, *(mark for mark in (early, run) if mark < end * (1 - 1e-9)), end})
    return np.interp(np.linspace(0, len(marks) - 1, frames), np.arange(len(marks)), marks)


def slow_motion(times: np.ndarray, at: int) -> float:
    """Return how many seconds of motion one second of the film shows at a frame."""
    if len(times) < 2:
        return 0.0
    following = min(at + 1, len(times) - 1)
    return float(times[following] - times[following - 1]) * FPS
