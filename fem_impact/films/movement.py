"""Rod and barrier at any time of a film: between stored frames, and after the run by the rod's modes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem_impact.errors import ResultError
from fem_impact.files.fields_read import FieldFile, read_fields
from fem_impact.files.waves import Ringing, Waves, read_waves


@dataclass(frozen=True, slots=True)
class Movement:
    """The stored motion of a run.

    Positions and stored fields between two frames are interpolated; the strain of the cylinder along its axis
    comes from waves.h5, which resolves every wave.

    Parameters
    ----------
    fields : FieldFile
    waves : Waves, optional
        Strain along the axis and free flight; None where the run did not store them.
    """

    fields: FieldFile
    waves: Waves | None = None

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
        mean: np.ndarray = weights @ self.point_data("velocity", time) / weights.sum()
        return mean * [1.0, 0.0, 1.0]

    def point_data(self, name: str, time: float) -> np.ndarray:
        """Return stored point data at a time, the last ones after the last frame."""
        before, after, share = self._between(time)
        first = self.fields.point_data(name, before).astype(float)
        return np.asarray((1 - share) * first + share * self.fields.point_data(name, after))

    def cell_data(self, name: str, time: float) -> np.ndarray:
        """Return stored cell data at a time, the last ones after the last frame."""
        before, after, share = self._between(time)
        first = self.fields.cell_data(name, before).astype(float)
        return np.asarray((1 - share) * first + share * self.fields.cell_data(name, after))

    def _between(self, time: float) -> tuple[int, int, float]:
        """Return the frames around a time and the share of the later one."""
        times = self.fields.times
        after = int(np.clip(np.searchsorted(times, time), 0, len(times) - 1))
        before = max(after - 1, 0)
        if times[after] <= time or before == after:
            return after, after, 0.0
        return before, after, float(max(0.0, (time - times[before]) / (times[after] - times[before])))


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
