"""The strain along the rod's axis, read from the motion of its sections, and the observer that stores it."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar, Self

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.case.mesh import off_gauge
from fem_impact.fem.flight import FreeVibration
from fem_impact.files.waves import Ringing, Waves, write_waves
from fem_impact.physics.beam import bar_speed, bending_group_speed
from fem_impact.solid.frame import turned
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import RodState
from fem_impact.solid.state import State

HELD = 0.999  # share of the vibration energy in the modes that are stored for the free flight


@dataclass(frozen=True, slots=True)
class StrainSections:
    """Weights that read mean motion and tilt of each section of the slices.

    The points of a section stand at c + x a: c is their mean, a the change along the section coordinate x.
    The stretch is |c'| - 1 and the bending strain at the surface R a' . c' / |c'|, with slopes along the axis
    (a rod with directors). Neither depends on a rigid motion.

    The first layer is left out: its nodes belong to the nose and carry their masses themselves.

    Attributes
    ----------
    weights : (2, n) of the section's mass points, for c and for a
    pitch, radius : m, of a slice and of the outermost nodes
    axis : (2,) unit vector from tip to tail at the start, along t and n
    """

    weights: Array
    pitch: float
    radius: float
    axis: Array

    @classmethod
    def of(cls, model: Model, side: float = 1.0) -> Self:
        """Return the weights from the start positions of the mass points.

        ``side`` is 1 of a body whose tail leans towards t in its first strike, -1 of one that leans back.
        """
        rows = _in_plane(model, model.start[0])
        mass = model.layout.slices_of(model.mass).reshape(3, -1, model.layout.body_shape[1])[0, :, -1]
        mean = mass / mass.sum()
        centre = mean @ rows
        along = centre[:, -1] - centre[:, 1]
        axis = along / np.linalg.norm(along)
        # to the side that faces the barrier: the axis turned by a quarter from n towards t, or back
        t, n = rows - centre[:, None]
        x = side * (t * axis[1] - n * axis[0])
        weights = np.stack([mean, mass * x[:, -1] / (mass @ x[:, -1] ** 2)])
        return cls(weights, model.geometry.rod.slice_length, float(np.abs(x[:, 0]).max()), axis)

    def strain(self, rows: Array) -> tuple[Array, Array]:
        """Return stretch and bending strain (slices,) of positions (2, n, layers), m, along t and n."""
        along, tilt = self._slopes(rows)
        length = np.hypot(*along)
        return length - 1.0, self.radius * (tilt * along).sum(axis=0) / length

    def linear(self, rows: Array) -> tuple[Array, Array]:
        """Return stretch and bending strain (slices,) of small displacements (2, n, layers), rod frame."""
        along, tilt = self._slopes(rows)
        return self.axis @ along, self.radius * (self.axis @ tilt)

    def _slopes(self, rows: Array) -> tuple[Array, Array]:
        """Return the changes (2, slices) along the axis of c and of a, 1 and 1/m."""
        read = np.matmul(self.weights, rows)[:, :, 1:]
        slopes = (read[:, :, 1:] - read[:, :, :-1]) / self.pitch
        return slopes[:, 0], slopes[:, 1]


def _in_plane(model: Model, vector: Array) -> Array:
    """Return the slices' part of a vector along t and n, (2, n, layers)."""
    return model.layout.slices_of(vector).reshape(3, -1, model.layout.body_shape[1])[::2]


@dataclass(slots=True)
class StrainWatch:
    """Observer of the strain along the axis every ``interval``, s; ``path``: file to write, None of none."""

    moving: ClassVar[tuple[str, ...]] = ("due", "samples")
    model: Model
    sections: StrainSections
    path: Path | None
    length: float
    speeds: tuple[float, float]
    interval: float
    every: int
    due: float = 0.0
    rows: list[Array] = field(default_factory=list)

    @classmethod
    def of(cls, case: Case, model: Model, path: Path | None) -> Self:
        """Prepare; a wave of speed sqrt(E/rho) crosses one slice in ``save.strain_samples`` intervals.

        Raises SceneError where a strain gauge lies off the part that is read.
        """
        # of the first strike: a gauge stays on its side of the body in later ones
        rod, side = case.scene.projectile, -1.0 if case.scene.impact.angle < 0.0 else 1.0
        sections = StrainSections.of(model, side)
        speeds = bar_speed(rod.material), bending_group_speed(rod)
        interval = sections.pitch / speeds[0] / max(case.scene.save.strain_samples, 1)
        every = max(1, int(interval / model.step / 8))
        watch = cls(model, sections, path, rod.length, speeds, interval, every)
        gauge, places = case.scene.save.gauge, watch._position
        if gauge is not None and not places[0] <= gauge <= places[-1]:
            raise off_gauge(gauge, places[0], places[-1])
        return watch

    @property
    def samples(self) -> Array:
        """Return one row a sample: time, stretch and bending of all slices."""
        return np.array(self.rows).reshape(len(self.rows), 1 + 2 * self._count)

    @samples.setter
    def samples(self, values: Array) -> None:
        self.rows = list(values)

    def observe(self, state: State) -> bool:
        """Sample when it is due."""
        if state.time >= self.due:
            self.rows.append(
                np.concatenate([[state.time], *self.sections.strain(_in_plane(self.model, state.x))])
            )
            self.due += self.interval
        return False

    def write(self, ringing: Ringing | None = None) -> None:
        """Write the file; nothing before the first sample."""
        if self.path is not None and self.rows:
            write_waves(self.path, self.waves(ringing))

    def waves(self, ringing: Ringing | None = None) -> Waves:
        """Return the strain up to now."""
        rod = self.model.geometry.rod
        times, stretch, bending = np.split(self.samples, [1, 1 + self._count], axis=1)
        t, n = self.sections.axis
        axis, tail = np.array([t, 0.0, n]), rod.body_nodes[:, -1]
        end = self.sections.weights[0] @ self.model.geometry.rod_points[tail] * [1.0, 0.0, 1.0]
        shown = (self.length, self.sections.radius, *self.speeds, end - self.length * axis, axis)
        return Waves(times[:, 0], self._position, stretch, bending, *shown, ringing)

    @property
    def _position(self) -> Array:
        """Return the distance from the tip of each place that is read, m."""
        # the first slice is left out, see `StrainSections`
        start, count = self.model.geometry.rod.body_start, self._count
        return np.asarray(start + self.sections.pitch * (np.arange(count) + 1.5))

    @property
    def _count(self) -> int:
        """Return the number of slices that are read."""
        return self.model.layout.body_shape[1] - 2

    def ringing(self, view: RodState, state: State, flight: FreeVibration) -> Ringing:
        """Return the free flight from the present state on, by the modes that hold the vibration energy."""
        angle, motion, kept = view.angle(state, self.model), view.rigid(state), _held(flight.energies)
        modes, a, b = flight.modes.shape[:, kept].T, flight.a[kept], flight.b[kept]
        rod = self.model.layout.rod  # all of its nodes
        moves = [self.model.nodes(self.model.with_ties(mode))[rod] for mode in modes]
        shape = np.array(moves).reshape(len(kept), -1, 3)
        strain = [self.sections.linear(_in_plane(self.model, mode)) for mode in modes]
        stretch, bending = np.array(strain).reshape(len(kept), 2, -1).transpose(1, 0, 2)
        moved = self.model.nodes(state.x - self.model.start[0])[rod]
        x = self.model.geometry.rod_points + moved - motion.centre
        rest = turned(x, angle) - np.tensordot(a, shape, 1)
        speed = np.array([motion.V_t, 0.0, motion.V_n])
        # Omega is positive from n to t
        moving = (state.time, motion.centre, speed, angle, -motion.Omega)
        return Ringing(*moving, flight.modes.omega[kept], a, b, shape, rest, stretch, bending)


def _held(energies: Array) -> Array:
    """Return the modes that hold the share `HELD` of the vibration energy, the lowest first."""
    order = np.argsort(-energies)
    total = np.cumsum(energies[order])
    count = int(np.searchsorted(total, HELD * total[-1])) + 1 if len(order) else 0
    return np.sort(order[:count])
