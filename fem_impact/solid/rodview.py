"""The rod's motion and the fields, read from a state in the barrier frame or in the rod's own frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from fem_impact.arrays import Array, Ints
from fem_impact.case.bodies import Bodies
from fem_impact.fem.eigen import DEFAULT_COUNT, RodModes, no_modes, rod_modes
from fem_impact.fem.elements import lame_constants
from fem_impact.fem.flight import FreeVibration, RigidMotion, flight, rigid_motion
from fem_impact.fem.hexmodes import reference_gradients
from fem_impact.scene.material import Material
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from meshes import HexMesh


def modes_of(model: Model, count: int = DEFAULT_COUNT) -> RodModes:
    """Return the modes of the undeformed rod, none of one that cannot vibrate."""
    n, K = model.layout.rod_size, model.rod_stiffness
    mass = model.mass[:n]
    return no_modes(mass) if K is None else rod_modes(K, mass, model.inverse_mass[:n] == 0, count)


@dataclass(frozen=True, slots=True)
class RodState:
    """Reads the rod's motion from a state.

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
    def of(cls, model: Model, modes: RodModes | None = None) -> RodState:
        """Compute the modes, unless they are known, and pick the rim."""
        mesh, n = model.geometry.rod.mesh, model.layout.rod_size
        places = model.layout.rod[~mesh.is_hanging]
        skin = mesh.free_skin
        rim = skin[np.abs(model.geometry.rod_points[skin, 1]) < 1e-12]
        return cls(places, model.mass[places[:, 0]], n, model.layout.rod[rim], modes or modes_of(model))

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
        """Return velocities (size,), m/s, at the time of the positions; the state's are half a step older.

        The latter would change the vibration energy by up to .0014 of itself.
        """
        n = self.size
        return np.asarray(state.v[:n] + 0.5 * state.dt * model.inverse_mass[:n] * state.force[:n])

    def flight(self, state: State, model: Model) -> FreeVibration:
        """Return the vibration of the present motion; forces must be those of a free rod."""
        angle, v = self.angle(state, model), self.present(state, model)
        return flight(self.modes, self.turned_back(v, angle), self.turned_back(state.force, angle))

    def vibration(self, state: State, model: Model) -> tuple[float, float] | None:
        """Return kinetic and strain energy, J, of all vibration; forces must be those of a free rod.

        These are the kinetic energy beyond the rigid motion, as the ledger counts it, and the strain energy
        that the internal forces release, of all shapes of the mesh. No modes are used, so this checks the
        projection on modes and includes the energy above the highest mode. None if the iteration does not
        converge.
        """
        v, force = state.v[self.places], state.force[self.places]
        kinetic = float(self.mass @ (v**2).sum(axis=1)) + state.dt * float((v * force).sum())
        kinetic -= self.rigid(state).kinetic
        strain = self.modes.released(self.turned_back(state.force, self.angle(state, model)))
        return None if strain is None else (kinetic, strain)


def centre_gradients(points: Array, cells: Ints) -> Array:
    """Return shape gradients (m, 8, 3), 1/m, at the cell centres."""
    (centre,) = reference_gradients(np.zeros((1, 3)))
    J = np.einsum("ai,maj->mij", centre, points[cells])
    return np.asarray(np.einsum("ai,mji->maj", centre, np.linalg.inv(J)))


def cell_shear(bodies: Bodies, mesh: HexMesh, depth: Array) -> Array:
    """Return the shear moduli, Pa, of the cells of the rod's mesh, then of the barrier's at ``depth``, m."""
    rod, strata = bodies.rod, bodies.barrier.strata
    z, metals = mesh.points[mesh.cells, 2].mean(axis=1), rod.materials
    if mesh.region is not None:
        own = np.array([lame_constants(m.E, m.nu)[1] for m in metals])[rod.cell_materials()[mesh.region]]
    else:
        own = _shear([part.to for part in rod.segments[:-1]], metals, z)
    return np.concatenate(
        [
            own,
            _shear([end for end, _ in strata[:-1]], [material for _, material in strata], depth),
        ]
    )


def _shear(ends: Sequence[float], materials: Sequence[Material], place: Array) -> Array:
    """Return the shear moduli, Pa, at places, m, among materials that end at ``ends``, m, the last open."""
    moduli = np.array([lame_constants(m.E, m.nu)[1] for m in materials])
    return np.asarray(moduli[np.searchsorted(np.array(ends), place)])


def mises(gradient: Array, u: Array, shear: Array) -> Array:
    """Return von Mises stress (m,), Pa, of element displacements u (m, 8, 3) at the centres.

    ``shear`` (m,), Pa, is the shear modulus.
    """
    H = np.einsum("mai,maj->mij", u, gradient)
    strain = 0.5 * (H + H.transpose(0, 2, 1))
    deviator = strain - np.trace(strain, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    return np.asarray(2 * shear * np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))))


@dataclass(slots=True)
class FieldSampler:
    """Node and cell data of rod and barrier, one after the other, in the barrier frame.

    Attributes
    ----------
    points : (n, 3) reference positions, m; cells : (m, 8); body : (m,) 0 rod, 1 barrier
    shear : (m,) shear modulus, Pa
    """

    model: Model
    view: RodState
    shear: Array
    points: Array
    cells: Ints
    body: NDArray[np.int8]
    places: Ints
    gradient: Array

    @classmethod
    def of(cls, model: Model, view: RodState, bodies: Bodies) -> FieldSampler:
        """Prepare."""
        g = model.geometry
        points, cells, places = g.rod_points, g.rod.mesh.cells, model.layout.rod
        depth = np.zeros(0)
        if g.barrier is not None:
            depth = -g.barrier.points[g.barrier.cells, 2].mean(axis=1)
            cells = np.concatenate([cells, g.barrier.cells + len(points)])
            points = np.concatenate([points, g.barrier.points])
            places = np.concatenate([places, model.layout.barrier])
        body = (np.arange(len(cells)) >= len(g.rod.mesh.cells)).astype(np.int8)
        shear = cell_shear(bodies, g.rod.mesh, depth)
        return cls(model, view, shear, points, cells, body, places, centre_gradients(points, cells))

    def sample(self, state: State) -> tuple[dict[str, Array], dict[str, Array]]:
        """Return point data and cell data of the present state."""
        u = self.model.nodes(state.x - self.model.start[0])[self.places]
        if self.model.in_plate_frame:
            u[len(self.model.geometry.rod_points) :, 2] += self.model.ground.risen(state.x)
        v = self.model.nodes(state.v)[self.places]
        return {"displacement": u, "velocity": v}, self._cells(state, self.points + u)

    def _cells(self, state: State, x: Array) -> dict[str, Array]:
        n = len(self.model.geometry.rod_points)
        local = x - self.points
        local[:n] = self._turned_back(state, x[:n]) - self.points[:n]
        local[n:] = self.model.ground.as_before(x[n:], state.x) - self.points[n:]
        stress, strain = mises(self.gradient, local[self.cells], self.shear), np.zeros(len(self.cells))
        for zone in self.model.zones:
            rows = zone.cells + (0 if zone.body == "rod" else len(self.model.geometry.rod.mesh.cells))
            stress[rows], strain[rows] = zone.mises(), zone.plastic_strain()
        return {"mises": stress, "plastic_strain": strain}

    def _turned_back(self, state: State, x: Array) -> Array:
        angle = self.view.angle(state, self.model)
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([c * x[:, 0] + s * x[:, 2], x[:, 1], c * x[:, 2] - s * x[:, 0]], axis=1)
