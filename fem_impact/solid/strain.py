"""The strain along the rod's axis, read from the motion of its sections, and the observer that stores it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from fem_impact.arrays import Array
from fem_impact.fem.flight import FreeVibration
from fem_impact.files.waves import Ringing, Waves, write_waves
from fem_impact.physics.beam import bar_speed, bending_group_speed
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import RodState
from fem_impact.solid.state import State

if TYPE_CHECKING:
    from fem_impact.plan.plan import Plan

IN_PLANE = np.array(
    [1.0, 0.0, 1.0]
)  # the axis lies in the symmetry plane, the mean of half a section does not
HELD = 0.999  # share of the vibration energy in the modes that are stored for the free flight


@dataclass(frozen=True, slots=True)
class Sections:
    """Weights that read mean motion and tilt of each section of the slices.

    The points of a section stand at c + x a: c is their mean, a the change along the section coordinate x.
    The stretch is |c'| - 1 and the bending strain at the surface R a' . c' / |c'|, with slopes along the axis
    (a rod with directors). Neither depends on a rigid motion.

    Attributes
    ----------
    mean, tilt : (n, layers) weights of the section's mass points
    pitch, radius : m, of a slice and of the outermost nodes
    axis : (3,) unit vector from tip to tail at the start
    """

    mean: Array
    tilt: Array
    pitch: float
    radius: float
    axis: Array

    @classmethod
    def of(cls, model: Model) -> Self:
        """Return the weights from the start positions of the mass points."""
        rows = model.layout.slices_of(model.start[0]).reshape(3, -1, model.layout.body_shape[1])
        # the masses of the tail: those of the first layer contain a part of the nose
        mass = np.broadcast_to(
            model.layout.slices_of(model.mass).reshape(rows.shape)[0, :, -1:], rows.shape[1:]
        )
        mean = mass / mass.sum(axis=0)
        centre = (mean * rows).sum(axis=1)
        along = (centre[:, -1] - centre[:, 0]) * IN_PLANE
        axis = along / np.linalg.norm(along)
        # towards the barrier: the axis turned by a quarter from n towards t
        x = (rows - centre[:, None])[0] * axis[2] - (rows - centre[:, None])[2] * axis[0]
        radius = float(np.abs(x[:, 0]).max())  # the nodes of the first layer carry their masses themselves
        tilt = mass * x / (mass * x**2).sum(axis=0)
        return cls(mean, tilt, model.geometry.rod.slice_length, radius, axis)

    def strain(self, rows: Array) -> tuple[Array, Array]:
        """Return stretch and bending strain (slices,) of positions (3, n, layers), m."""
        along, tilt = self._slopes(rows)
        length = np.linalg.norm(along, axis=0)
        return length - 1.0, self.radius * (tilt * along).sum(axis=0) / length

    def linear(self, rows: Array) -> tuple[Array, Array]:
        """Return stretch and bending strain (slices,) of small displacements (3, n, layers), rod frame."""
        along, tilt = self._slopes(rows)
        return self.axis @ along, self.radius * (self.axis @ tilt)

    def _slopes(self, rows: Array) -> tuple[Array, Array]:
        """Return the changes (3, slices) of mean and tilt along the axis, 1 and 1/m."""
        mean, tilt = (np.einsum("nl,cnl->cl", weight, rows) for weight in (self.mean, self.tilt))
        plane = IN_PLANE[:, None] / self.pitch
        return np.diff(mean, axis=1) * plane, np.diff(tilt, axis=1) * plane


@dataclass(slots=True)
class StrainWatch:
    """Observer that stores the strain along the axis every ``interval``, s, and writes it to waves.h5."""

    moving: ClassVar[tuple[str, ...]] = ("due", "samples")
    model: Model
    sections: Sections
    path: Path
    length: float
    speeds: tuple[float, float]
    interval: float
    every: int
    due: float = 0.0
    rows: list[Array] = field(default_factory=list)

    @classmethod
    def of(cls, plan: Plan, model: Model, path: Path) -> Self:
        """Prepare; a wave of speed sqrt(E/rho) crosses one slice in ``save.strain_samples`` intervals."""
        rod, sections = plan.scene.projectile, Sections.of(model)
        speeds = bar_speed(plan.scene), bending_group_speed(plan.scene)
        interval = sections.pitch / speeds[0] / plan.scene.save.strain_samples
        return cls(
            model, sections, path, rod.length, speeds, interval, max(1, int(interval / model.step / 8))
        )

    @property
    def samples(self) -> Array:
        """Return one row a sample: time, stretch and bending of all slices."""
        slices = self.sections.mean.shape[1] - 1
        return np.array(self.rows).reshape(len(self.rows), 1 + 2 * slices)

    @samples.setter
    def samples(self, values: Array) -> None:
        self.rows = list(values)

    def observe(self, state: State) -> bool:
        """Sample when it is due."""
        if state.time >= self.due:
            self.rows.append(np.concatenate([[state.time], *self.sections.strain(self._rows(state.x))]))
            self.due += self.interval
        return False

    def write(self, ringing: Ringing | None = None) -> None:
        """Write the file; nothing before the first sample."""
        if not self.rows:
            return
        rod, half = self.model.geometry.rod, len(self.sections.mean.T) - 1
        position = rod.body_start + self.sections.pitch * (np.arange(half) + 0.5)
        times, stretch, bending = np.split(self.samples, [1, 1 + half], axis=1)
        tail = self.sections.mean[:, -1] @ self.model.geometry.rod_points[rod.body_nodes[:, -1]]
        origin = tail * IN_PLANE - self.length * self.sections.axis
        shown = (self.length, self.sections.radius, *self.speeds, origin, self.sections.axis)
        write_waves(self.path, Waves(times[:, 0], position, stretch, bending, *shown, ringing))

    def ringing(self, view: RodState, state: State, flight: FreeVibration) -> Ringing:
        """Return the free flight from the present state on, by the modes that hold the vibration energy."""
        angle, motion, kept = view.angle(state, self.model), view.rigid(state), _held(flight.energies)
        modes, a, b = flight.modes.shape[:, kept].T, flight.a[kept], flight.b[kept]
        shape = np.array([self._points(mode) for mode in modes]).reshape(len(kept), -1, 3)
        strain = [self.sections.linear(self._rows(mode)) for mode in modes]
        stretch, bending = np.array(strain).reshape(len(kept), 2, -1).transpose(1, 0, 2)
        moved = self.model.nodes(state.x - self.model.start[0])[self.model.layout.rod]
        x = self.model.geometry.rod_points + moved - motion.centre
        c, s = np.cos(angle), np.sin(angle)
        local = np.stack([c * x[:, 0] + s * x[:, 2], x[:, 1], c * x[:, 2] - s * x[:, 0]], axis=1)
        rest = local - np.tensordot(a, shape, 1)
        speed = np.array([motion.V_t, 0.0, motion.V_n])
        turning = (float(angle), -float(motion.Omega))  # Omega is positive from n to t
        moving = (state.time, np.asarray(motion.centre), speed, *turning)
        return Ringing(*moving, flight.modes.omega[kept], a, b, shape, rest, stretch, bending)

    def _rows(self, vector: Array) -> Array:
        """Return the slices' part (3, n, layers) of a vector."""
        return self.model.layout.slices_of(vector).reshape(3, *self.sections.mean.shape)

    def _points(self, mode: Array) -> Array:
        """Return the displacement (n, 3) of all rod points from a mode over the free unknowns."""
        whole = np.zeros(self.model.layout.size)
        whole[: len(mode)] = mode
        self.model.hanging.expand(whole)
        return np.asarray(self.model.nodes(whole)[self.model.layout.rod])


def _held(energies: Array) -> Array:
    """Return the modes that hold the share `HELD` of the vibration energy, the lowest first."""
    order = np.argsort(-energies)
    total = np.cumsum(energies[order])
    count = int(np.searchsorted(total, HELD * total[-1])) + 1 if len(order) else 0
    return np.sort(order[:count])
