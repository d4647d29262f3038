"""The rod's share of the flat vectors, as nodes, in the barrier frame or turned back with the rod."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from fem_impact.modes import Flight, RigidMotion, RodModes, flight, no_modes, rigid_motion, rod_modes
from fem_impact.modes.eigen import DEFAULT_COUNT
from fem_impact.solid.model import Model
from fem_impact.solid.state import State

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


def modes_of(model: Model, count: int = DEFAULT_COUNT) -> RodModes:
    """Return the modes of the undeformed rod, none of one that cannot vibrate."""
    n, K = model.layout.rod_size, model.rod_stiffness
    mass = model.mass[:n]
    return no_modes(mass) if K is None else rod_modes(K, mass, model.inverse_mass[:n] == 0, count)


@dataclass(frozen=True, slots=True)
class RodView:
    """Reads the rod out of a state.

    Attributes
    ----------
    places : (n, 3) unknowns of the rod's free nodes; mass : (n,) kg of the half rod
    size : length of the rod's part of the flat vectors
    rim : (k, 3) unknowns of the skin nodes in the symmetry plane: the lowest point is always among them
    modes : free-free modes of the undeformed rod, none of one that cannot vibrate
    """

    places: Ints
    mass: Array
    size: int
    rim: Ints
    modes: RodModes

    @classmethod
    def of(cls, model: Model) -> RodView:
        """Compute the modes and pick the rim."""
        mesh, n = model.geometry.rod.mesh, model.layout.rod_size
        places = model.layout.rod[~mesh.is_hanging]
        skin = mesh.free_skin
        rim = skin[np.abs(model.geometry.rod_points[skin, 1]) < 1e-12]
        return cls(places, model.mass[places[:, 0]], n, model.layout.rod[rim], modes_of(model))

    def rigid(self, state: State) -> RigidMotion:
        """Return the rigid part of the present motion."""
        return rigid_motion(state.x[self.places], state.v[self.places], self.mass)

    def angle(self, state: State, model: Model) -> float:
        """Return the angle, rad, by which the rod has turned from t towards n (best fit by mass)."""
        X, x = model.start[0][self.places], state.x[self.places]
        X = X - self.mass @ X / self.mass.sum()
        along = self.mass @ (X[:, 0] * x[:, 0] + X[:, 2] * x[:, 2])
        return float(np.arctan2(self.mass @ (X[:, 0] * x[:, 2] - X[:, 2] * x[:, 0]), along))

    def turned_back(self, vector: Array, angle: float) -> Array:
        """Return the rod's part of a flat vector seen in the turned frame."""
        result = vector[: self.size].copy()
        t, n = self.places[:, 0], self.places[:, 2]
        result[t] = cos(angle) * vector[t] + sin(angle) * vector[n]
        result[n] = cos(angle) * vector[n] - sin(angle) * vector[t]
        return result

    def present(self, state: State, model: Model) -> Array:
        """Return velocities (size,), m/s, at the time of the positions, half a step after the state's own.

        Those of the state would change the vibration energy by up to .0014 of itself.
        """
        n = self.size
        return np.asarray(state.v[:n] + 0.5 * state.dt * model.inverse_mass[:n] * state.force[:n])

    def flight(self, state: State, model: Model) -> Flight:
        """Return the vibration of the present motion; forces must be those of a free rod."""
        angle, v = self.angle(state, model), self.present(state, model)
        return flight(self.modes, self.turned_back(v, angle), self.turned_back(state.force, angle))

    def vibration(self, state: State, model: Model) -> tuple[float, float] | None:
        """Return kinetic and strain energy, J, of all vibration; forces must be those of a free rod.

        Kinetic energy beyond the rigid motion, and what the internal forces release, of all shapes that the
        mesh has: no mode has part in it, so it checks the projection and tells what lies above its highest
        mode. None if that is not found.
        """
        v = self.present(state, model)[self.places]
        kinetic = float(self.mass @ (v**2).sum(axis=1)) - self.rigid(state).kinetic
        strain = self.modes.released(self.turned_back(state.force, self.angle(state, model)))
        return None if strain is None else (kinetic, strain)
