"""``waves``: phase speeds in an endless bar of the solver's slices, beside Pochhammer and Chree.

A wave exp(i k z) on identical slices of height h turns the stencil into a small matrix:
P^T (A11 + A22 + A12 exp(i k h) + A21 exp(-i k h)) P w = omega^2 M w, with the nodes at P w.
"""

from __future__ import annotations

from math import pi

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import eigh

import meshes
from fem_impact.solid.elements import element_stiffness, isotropic_stiffness, lumped_mass
from fem_impact.solid.masspoints import MassPoints
from fem_impact.solid.slices import SliceOperator
from fem_impact.verify import steel
from fem_impact.verify.problem import Check, Parameter, Problem, Solved, Values
from fem_impact.verify.reference.bar import bar_speed
from fem_impact.verify.reference.waves import flexural_speed, longitudinal_speed

__all__ = ["PROBLEM"]

Array = NDArray[np.float64]

TOLERANCE = 0.005  # of c0
JUDGED, SHORT = 0.2 + 1e-9, "waves so short are up to 1 % slow even with 24 cells across"
LONGITUDINAL, FLEXURAL = 2, 0  # components of the axis that move


class _Slice:
    """One slice of the bar: its operator, the masses of a layer, and who may move."""

    def __init__(self, p: Values) -> None:
        radius = p["diameter"] / 2
        h = p["diameter"] / p["across"] * p["aspect"]
        flat = np.array([[0.0, 0.0], [radius, 0.0]])
        bar = meshes.rod(flat, 4 * h, int(p["across"]), slice_length=h, nose=False)
        first = bar.body_cells[:, 0]
        cells, points = bar.mesh.cells[first], bar.mesh.points
        masses = lumped_mass(points, bar.mesh.cells, p["rho"])
        self.drawn = MassPoints.of_rod(bar, masses, p["rho"]).section()
        K = element_stiffness(points, cells, isotropic_stiffness(p["E"], p["nu"]), "incompatible")
        self.count, self.height, self.cells = len(bar.body_nodes), bar.slice_length, len(cells)
        section = np.full(len(points), -1)
        section[bar.body_nodes[:, :2].T] = np.arange(self.count)
        low, up = section[cells[:, :4]], section[cells[:, 4:]]
        self.operator = SliceOperator.of(K, low, up)
        nodal = masses[first]
        mass = np.bincount(low.ravel(), nodal[:, :4].ravel()) + np.bincount(up.ravel(), nodal[:, 4:].ravel())
        self.mass = np.tile(mass, 3)
        place = points[bar.body_nodes[:, 0]]
        free = np.ones((3, self.count), dtype=bool)
        free[1, np.abs(place[:, 1]) < 1e-12] = False
        self.free = np.flatnonzero(free.ravel())
        self.axis = int(np.argmin(np.hypot(place[:, 0], place[:, 1])))

    def matrix(self, k: float) -> NDArray[np.complex128]:
        """Return the dense stiffness seen by a wave number, N/m."""
        o, n = self.operator, 3 * self.count
        turn = np.exp(1j * k * self.height)
        values = o.lower + o.upper + turn * o.above + np.conj(turn) * o.below
        plain = sp.csr_matrix((values, o.columns, o.start), shape=(n, n))
        return np.asarray((self.drawn.T @ plain @ self.drawn).toarray())

    def frequency(self, k: float, component: int) -> float:
        """Return the lowest circular frequency whose axis moves mostly along a component."""
        root = 1 / np.sqrt(self.mass[self.free])
        K = self.matrix(k)[np.ix_(self.free, self.free)] * root[:, None] * root
        square, shape = eigh(K, subset_by_index=(0, 5))
        moved = np.zeros((3 * self.count, 6), dtype=np.complex128)
        moved[self.free] = root[:, None] * shape
        at = abs(moved[self.axis + self.count * np.arange(3)])
        # waves of higher order around the bar leave the axis at rest
        taken = (at.argmax(axis=0) == component) & (at.max(axis=0) > 0.1 * abs(moved).max(axis=0))
        return float(np.sqrt(square[np.flatnonzero(taken)[0]]))


def solve(p: Values) -> Solved:
    """Compare both first modes at a few radii over wavelength."""
    bar, c0 = _Slice(p), bar_speed(p["E"], p["rho"])
    checks = []
    for ratio in np.linspace(p["ratio"] / 4, p["ratio"], 4):
        k = 2 * pi * ratio / (p["diameter"] / 2)
        exact = {
            LONGITUDINAL: ("longitudinal", longitudinal_speed(ratio, p["nu"])),
            FLEXURAL: ("flexural", flexural_speed(ratio, p["nu"])),
        }
        for component, (name, speed) in exact.items():
            found = bar.frequency(k, component) / k / c0
            label = f"{name} c/c0 at radius/wavelength {ratio:.3g}"
            checks.append(
                Check(label, "1", found, speed, TOLERANCE, "absolute")
                if ratio <= JUDGED
                else Check.shown(label, "1", found, speed, SHORT)
            )
    return Solved(tuple(checks), 0, bar.cells)


PROBLEM = Problem(
    "waves",
    "phase speeds of the first longitudinal and flexural waves in an endless bar of slices",
    (
        steel.diameter(),
        *steel.elastic(),
        Parameter("ratio", "largest radius over wavelength, judged up to 0.2", 0.2, 0.01, 0.5),
        steel.across(low=8),
        Parameter("aspect", "height of a slice over diameter / across (runs take 1)", 1.0, 0.1, 4.0),
    ),
    solve,
)
