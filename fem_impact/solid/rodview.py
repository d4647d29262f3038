"""The rod's motion and the fields, read from a state in the barrier frame or in the rod's own frame."""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from fem_impact.arrays import Array, Ints
from fem_impact.case.bodies import Bodies
from fem_impact.fem.eigen import DEFAULT_COUNT, RodModes, no_modes, rod_modes
from fem_impact.fem.elements import lame_constants
from fem_impact.fem.flight import FreeVibration, RigidMotion, flight, rigid_motion
from fem_impact.fem.geometry import material_numbers
from fem_impact.fem.hexmodes import reference_gradients
from fem_impact.solid.frame import turned_at
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from meshes import HexMesh


def modes_of(model: Model, count: int = DEFAULT_COUNT, step: Callable[[], None] = lambda: None) -> RodModes:
    """Return the modes of the undeformed rod, none of one that cannot vibrate; ``step`` as of `rod_modes`."""
    n, K = model.layout.rod_size, model.rod_stiffness
    mass = model.mass[:n]
    return no_modes(mass) if K is None else rod_modes(K, mass, model.inverse_mass[:n] == 0, count, step)


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
    def of(cls, model: Model, modes: RodModes | None = None) -> "RodState":
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
        return turned_at(vector[: self.size], self.places, angle)

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


def cell_lame(bodies: Bodies, mesh: HexMesh, depth: Array) -> Array:
    """Return Lame's (m, 2) lambda and G, Pa, of the rod's cells, then of the barrier's at ``depth``, m."""
    own, (ends, layers) = bodies.rod.materials, zip(*bodies.barrier.strata, strict=True)
    constants = np.array([lame_constants(m.E, m.nu) for m in (*own, *layers)])
    below = len(own) + np.searchsorted(ends[:-1], depth)
    return np.asarray(constants[np.concatenate([material_numbers(bodies.rod, mesh), below])])


def elastic_stress(gradient: Array, u: Array, lame: Array) -> Array:
    """Return the stress (m, 3, 3), Pa, of element displacements u (m, 8, 3) at the centres, small strains.

    ``lame`` (m, 2), Pa, are lambda and G.
    """
    H = np.einsum("mai,maj->mij", u, gradient)
    mean = np.trace(H, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    return np.asarray(lame[:, :1, None] * mean + lame[:, 1:, None] * (H + H.transpose(0, 2, 1)))


def mises(stress: Array) -> Array:
    """Return the von Mises stress (m,), Pa, of stresses (m, 3, 3), Pa."""
    deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    return np.asarray(np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))))


@dataclass(slots=True)
class FieldSampler:
    """Node and cell data of rod and barrier, one after the other, in the barrier frame.

    Attributes
    ----------
    points : (n, 3) reference positions, m; cells : (m, 8); body : (m,) 0 rod, 1 barrier
    lame : (m, 2) Lame's lambda and G, Pa
    whole : whether to give velocities and the stress tensor too
    """

    model: Model
    view: RodState
    lame: Array
    points: Array
    cells: Ints
    body: NDArray[np.int8]
    places: Ints
    gradient: Array
    whole: bool

    @classmethod
    def of(cls, model: Model, view: RodState, bodies: Bodies) -> "FieldSampler":
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
        lame, gradient = cell_lame(bodies, g.rod.mesh, depth), centre_gradients(points, cells)
        whole = bodies.scene.save.fields == "all"
        return cls(model, view, lame, points, cells, body, places, gradient, whole)

    def sample(self, state: State) -> tuple[dict[str, Array], dict[str, Array]]:
        """Return point data and cell data of the present state."""
        n, rods = len(self.model.geometry.rod_points), len(self.model.geometry.rod.mesh.cells)
        u = self.model.nodes(state.x - self.model.start[0])[self.places]
        if self.model.in_plate_frame:
            u[n:, 2] += self.model.ground.risen(state.x)
        # elastic stresses are those of the displacements that each body sees in its own frame
        x, local, angle = self.points + u, np.empty_like(u), self.view.angle(state, self.model)
        c, s = cos(angle), sin(angle)
        turn = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])  # of the rod, from t towards n
        local[:n] = x[:n] @ turn - self.points[:n]
        local[n:] = self.model.ground.as_before(x[n:], state.x) - self.points[n:]
        stress = elastic_stress(self.gradient, local[self.cells], self.lame)
        size, strain = mises(stress), np.zeros(len(self.cells))
        stress[:rods] = turn @ stress[:rods] @ turn.T
        for zone in self.model.zones:
            rows = zone.cells + (0 if zone.body == "rod" else rods)
            size[rows], strain[rows], stress[rows] = zone.mises(), zone.plastic_strain(), zone.tensor()
        in_cells = {"mises": size, "plastic_strain": strain}
        if not self.whole:
            return {"displacement": u}, in_cells
        # VTK's order of a symmetric tensor: tt, bb, nn, tb, bn, tn
        in_cells["stress"] = stress[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
        return {"displacement": u, "velocity": self.model.nodes(state.v)[self.places]}, in_cells
