"""Strain along the rod's axis over time and the free flight after the last contact: the file waves.h5."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from fem_impact.errors import ResultError, UsageError
from fem_impact.files.atomic import atomic_path, check_digest
from fem_impact.files.fields import check_finite, check_times

ROUND_OFF = 1e-9  # of the tilt of an axis, rad


@dataclass(frozen=True, slots=True)
class Ringing:
    """Free flight of the rod from ``start`` on: rigid motion and free vibration by modes.

    Attributes
    ----------
    start : s, time at which the run ended
    centre : (3,) m, mass centre then; velocity : (3,) m/s in (t, b, n)
    angle, spin : rad, turn from t towards n then, and its rate, rad/s
    omega : (k,) circular frequencies, rad/s; a, b : (k,) amplitudes of cosine and sine, sqrt(kg) m
    shape : (k, n, 3) mode shapes at the rod's points, kg^-1/2, in the rod's frame
    rest : (n, 3) m, points without vibration, from the mass centre in the rod's frame
    stretch, bending : (k, m) strain of the modes along the axis, kg^-1/2 m^-1
    """

    start: float
    centre: np.ndarray
    velocity: np.ndarray
    angle: float
    spin: float
    omega: np.ndarray
    a: np.ndarray
    b: np.ndarray
    shape: np.ndarray
    rest: np.ndarray
    stretch: np.ndarray
    bending: np.ndarray

    def points(self, time: float) -> np.ndarray:
        """Return the positions ``(n, 3)``, m, of the rod's points at a time of the run, s."""
        local = self.rest + np.tensordot(self._amplitudes(np.array([time]))[:, 0], self.shape, 1)
        turn = self.angle + self.spin * (time - self.start)
        c, s = np.cos(turn), np.sin(turn)
        turned = np.stack(
            [c * local[:, 0] - s * local[:, 2], local[:, 1], s * local[:, 0] + c * local[:, 2]], axis=1
        )
        moved: np.ndarray = self.centre + self.velocity * (time - self.start) + turned
        return moved

    def strain(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return stretch and bending ``(times, m)`` along the axis at times of the run, s."""
        q = self._amplitudes(times).T
        return q @ self.stretch, q @ self.bending

    def _amplitudes(self, times: np.ndarray) -> np.ndarray:
        phase = np.outer(self.omega, times - self.start)
        q: np.ndarray = self.a[:, None] * np.cos(phase) + self.b[:, None] * np.sin(phase)
        return q


@dataclass(frozen=True, slots=True)
class Waves:
    """Strain along the axis of the rod's cylinder.

    The strain at a distance x from the axis is ``stretch + bending x / radius``; x is positive on the side
    that faces the barrier.

    Attributes
    ----------
    times : (k,) s
    position : (m,) m along the axis from the tip
    stretch, bending : (k, m) mean strain of a section, and its linear part at the surface
    length, radius : m, of the rod and of its section
    speed, bending_speed : m/s, sqrt(E/rho) of its material; largest group speed of its bending waves
    origin, axis : (3,) the tip, m, and the unit vector from it along the axis at the start, in (t, b, n)
    ringing : the flight after the last contact, None where the run did not come to it
    """

    times: np.ndarray
    position: np.ndarray
    stretch: np.ndarray
    bending: np.ndarray
    length: float
    radius: float
    speed: float
    bending_speed: float
    origin: np.ndarray
    axis: np.ndarray
    ringing: Ringing | None = None

    @property
    def across(self) -> np.ndarray:
        """Return the unit vector (3,) across the axis, in (t, b, n), to the side that faces the barrier."""
        t, _, n = self.axis
        # of an upright rod, whose axis is along n to round-off, the side towards t counts as that
        return np.array([n, 0.0, -t]) * (-1.0 if t < -ROUND_OFF else 1.0)

    @property
    def end(self) -> float:
        """Return the last time that is stored, s."""
        return float(self.times[-1])

    @property
    def transit(self) -> float:
        """Return the time, s, in which a stretching wave runs once along the rod."""
        return self.length / self.speed

    def strain(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return stretch and bending ``(times, m)``: between the samples linear, after them by the modes."""
        at = np.clip(np.searchsorted(self.times, times) - 1, 0, max(len(self.times) - 2, 0))
        following = np.minimum(at + 1, len(self.times) - 1)
        span = np.maximum(self.times[following] - self.times[at], 1e-30)
        share = np.clip((times - self.times[at]) / span, 0.0, 1.0)[:, None]
        within = [(1 - share) * rows[at] + share * rows[following] for rows in (self.stretch, self.bending)]
        after = times > self.end
        if self.ringing is not None and after.any():
            for rows, free in zip(within, self.ringing.strain(times[after]), strict=True):
                rows[after] = free
        return within[0], within[1]

    def gauge(self, position: float, across: float = 1.0) -> np.ndarray:
        """Return the strain ``(k,)`` over `times` that a gauge along the axis shows.

        ``position``, m from the tip; ``across``, radii from the axis: 1 on the side that faces the barrier,
        -1 on the other, 0 the mean of both. Raises UsageError for a place off the cylinder.
        """
        places, strain = self.position, self.stretch + across * self.bending
        if not places[0] <= position <= places[-1] or abs(across) > 1:
            remedy = f"Give {places[0]:.4g} to {places[-1]:.4g} m, and -1 to 1 across."
            raise UsageError("lies off the cylinder.", key="gauge=", value=(position, across), remedy=remedy)
        after = int(np.clip(np.searchsorted(places, position), 1, len(places) - 1))
        share = (position - places[after - 1]) / (places[after] - places[after - 1])
        shown: np.ndarray = (1 - share) * strain[:, after - 1] + share * strain[:, after]
        return shown


def write_waves(path: Path, waves: Waves) -> None:
    """Write the file in one step; strains and shapes in single precision. Raises OutputPathError."""
    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        _put(file, waves)
        if waves.ringing is not None:
            _put(file.create_group("ringing"), waves.ringing)


def _put(group: h5py.Group, record: Waves | Ringing) -> None:
    for entry in fields(record):
        value = getattr(record, entry.name)
        if isinstance(value, float):
            group.attrs[entry.name] = value
        elif isinstance(value, np.ndarray):
            group.create_dataset(entry.name, data=value.astype("f4" if value.ndim > 1 else "f8"))


def read_waves(path: str | Path) -> Waves:
    """Read the file ``waves.h5`` of a run.

    Raises
    ------
    ResultError
        It is missing, damaged, or not the one that its run wrote.
    """
    path = Path(path)
    if not path.is_file():
        raise ResultError(f"{path}: there is no such file; run the scene with save.strain_samples = 1.")
    check_digest(path)
    try:
        with h5py.File(path, "r") as file:
            ringing = Ringing(**_taken(file["ringing"])) if "ringing" in file else None
            waves = Waves(**_taken(file), ringing=ringing)
        check_times(waves.times, len(waves.times))
        shape = (len(waves.times), len(waves.position))
        for name in ("stretch", "bending"):
            if getattr(waves, name).shape != shape or not shape[0]:
                raise ValueError(f"{name} has shape {getattr(waves, name).shape}, not {shape}")
        if ringing is not None and ringing.shape.shape != (len(ringing.omega), len(ringing.rest), 3):
            raise ValueError(f"the mode shapes have shape {ringing.shape.shape}")
    except (OSError, LookupError, ValueError, RuntimeError, AttributeError, TypeError) as error:
        raise ResultError(f"{path}: not a readable file of waves ({str(error).rstrip('.')}).") from error
    return waves


def _taken(group: h5py.Group) -> dict[str, Any]:
    arrays = {name: entry[...] for name, entry in group.items() if isinstance(entry, h5py.Dataset)}
    for name, values in arrays.items():
        check_finite(name, values)
    numbers = {name: float(value) for name, value in group.attrs.items()}
    check_finite("attributes", np.array(list(numbers.values())))
    return arrays | numbers
