"""Fields for pictures: displacements, velocities, stress and plastic strain of both bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.elements import isotropic_stiffness
from fem_impact.solid.hexmodes import reference_gradients
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import RodView
from fem_impact.solid.state import State

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


def centre_gradients(points: Array, cells: Ints) -> Array:
    """Return shape gradients (m, 8, 3), 1/m, at the cell centres."""
    (centre,) = reference_gradients(np.zeros((1, 3)))
    J = np.einsum("ai,maj->mij", centre, points[cells])
    return np.asarray(np.einsum("ai,mji->maj", centre, np.linalg.inv(J)))


def mises(gradient: Array, u: Array, E: float, nu: float) -> Array:
    """Return von Mises stress (m,), Pa, of element displacements u (m, 8, 3) at the centres."""
    H = np.einsum("mai,maj->mij", u, gradient)
    strain = [H[:, i, i] for i in range(3)] + [H[:, i, j] + H[:, j, i] for i, j in ((0, 1), (1, 2), (2, 0))]
    s = isotropic_stiffness(E, nu) @ np.array(strain)
    s[:3] -= s[:3].mean(axis=0)
    return np.asarray(np.sqrt(1.5 * (s[:3] ** 2).sum(axis=0) + 3.0 * (s[3:] ** 2).sum(axis=0)))


@dataclass(slots=True)
class Fields:
    """Node and cell data of rod and barrier, one after the other, in the barrier frame.

    Attributes
    ----------
    points : (n, 3) reference positions, m; cells : (m, 8); body : (m,) 0 rod, 1 barrier
    """

    model: Model
    view: RodView
    elastic: list[tuple[float, float]]
    points: Array
    cells: Ints
    body: NDArray[np.int8]
    places: Ints
    gradient: Array

    @classmethod
    def of(cls, model: Model, view: RodView, elastic: list[tuple[float, float]]) -> Fields:
        """Prepare; ``elastic`` holds (E, nu) of rod and barrier."""
        g = model.geometry
        points, cells, places = g.rod_points, g.rod.mesh.cells, model.layout.rod
        if g.barrier is not None:
            cells = np.concatenate([cells, g.barrier.cells + len(points)])
            points = np.concatenate([points, g.barrier.points])
            places = np.concatenate([places, model.layout.barrier])
        body = (np.arange(len(cells)) >= len(g.rod.mesh.cells)).astype(np.int8)
        return cls(model, view, elastic, points, cells, body, places, centre_gradients(points, cells))

    def sample(self, state: State) -> tuple[dict[str, Array], dict[str, Array]]:
        """Return point data and cell data of the present state."""
        u = self.model.nodes(state.x - self.model.start[0])[self.places]
        v = self.model.nodes(state.v)[self.places]
        return {"displacement": u, "velocity": v}, self._cells(state, self.points + u)

    def _cells(self, state: State, x: Array) -> dict[str, Array]:
        n = len(self.model.geometry.rod_points)
        local = x - self.points
        local[:n] = self._turned_back(state, x[:n]) - self.points[:n]
        stress, strain = np.zeros(len(self.cells)), np.zeros(len(self.cells))
        for number, (E, nu) in enumerate(self.elastic):
            rows = self.body == number
            stress[rows] = mises(self.gradient[rows], local[self.cells[rows]], E, nu)
        for zone in self.model.zones:
            rows = self._yielding(zone.body)
            stress[rows], strain[rows] = zone.mises(), zone.plastic_strain()
        return {"mises": stress, "plastic_strain": strain}

    def _turned_back(self, state: State, x: Array) -> Array:
        angle = self.view.angle(state, self.model)
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([c * x[:, 0] + s * x[:, 2], x[:, 1], c * x[:, 2] - s * x[:, 0]], axis=1)

    def _yielding(self, body: str) -> Ints:
        g = self.model.geometry
        first = 0 if body == "rod" else len(g.rod.mesh.cells)
        return first + np.flatnonzero(g.may_yield[body])
