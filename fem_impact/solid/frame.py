"""The frame in which the elastic rod is linear: turning with the rod, or fixed.

Turning frame: with phi the mass-weighted best-fit angle (n from t) of the positions x to the reference X,
d = R^T x - X and U = d . K d / 2. The force is the full gradient of U, including that of phi,

    f = R (-y + (tau / rho) m (-X_n, X_t)),   y = K d,   tau = sum(d x y),   rho = |sum m X (R^T x)|,

so linear and angular momentum and energy are all conserved, and a free rotation makes no force.
"""

from dataclasses import dataclass, field
from math import cos, sin
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.kernels import Counts, kernel


def mass_centre(mass: Array, x: Array, places: Ints) -> Array:
    """Return the mass centre (3,), m, of the nodes in ``places``; b is 0 by symmetry."""
    m = mass[places[:, 0]]
    centre = m @ x[places] / m.sum()
    centre[1] = 0.0
    return np.asarray(centre)


def turned(rows: Array, angle: float) -> Array:
    """Return vectors along t, b, n, (m, 3) or (m, 3, k), turned from n towards t, rad."""
    (t, b, n), c, s = np.moveaxis(rows, 1, 0), cos(angle), sin(angle)
    return np.stack([c * t + s * n, b, c * n - s * t], axis=1)


def turned_at(vector: Array, places: Ints, angle: float) -> Array:
    """Return a flat vector, (n,) or (n, k), whose places (m, 3) are turned from n towards t, rad."""
    result = vector.copy()
    result[places] = turned(vector[places], angle)
    return result


@dataclass(slots=True)
class FixedFrame:
    """Frame for small rotations: displacements are differences of positions, the angle is 0."""

    reference: Array
    angle: ClassVar[float] = 0.0
    work: Array = field(default_factory=lambda: np.zeros(2))

    def localise(self, x: Array, d: Array) -> None:
        """Set ``d`` to the displacements of ``x``."""
        np.subtract(x, self.reference, out=d)

    def add_force(self, d: Array, y: Array, force: Array) -> None:
        """Subtract the elastic force ``y`` from ``force``."""
        force -= y


@dataclass(slots=True)
class TurningFrame:
    """Frame for large rotations in the t-n plane.

    Attributes
    ----------
    reference : (size,) float64, m, about the mass centre
    mass : (size,) float64, kg
    t, b, n : (nodes,) unknowns of the three components
    work : (2,) rho cos(phi) and rho sin(phi) at the last positions, kg m2
    """

    reference: Array
    mass: Array
    t: Counts
    b: Counts
    n: Counts
    work: Array = field(default_factory=lambda: np.zeros(2))

    @classmethod
    def at(cls, x: Array, mass: Array, free: Ints) -> "TurningFrame":
        """Start at positions ``x`` (size,) of free nodes with unknowns ``free`` (nodes, 3)."""
        reference = x.copy()
        reference[free] -= mass_centre(mass, x, free)
        t, b, n = np.ascontiguousarray(free.T, np.uint32)
        return cls(reference, mass.copy(), t, b, n)

    def localise(self, x: Array, d: Array) -> None:
        """Set ``d`` to the displacements of ``x`` seen in the frame, and turn the frame."""
        _localise(x, self.reference, self.mass, self.t, self.b, self.n, d, self.work)

    @property
    def angle(self) -> float:
        """Return the angle from t towards n, rad, at the last positions."""
        return float(np.arctan2(self.work[1], self.work[0]))

    def add_force(self, d: Array, y: Array, force: Array) -> None:
        """Add the force whose potential is half d . y."""
        _add_turned(d, y, self.reference, self.mass, self.t, self.b, self.n, self.work, force)


@kernel
def _localise(x, X, mass, t, b, n, d, work):  # type: ignore[no-untyped-def]
    along, across, total, centre_t, centre_n = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(t)):
        p, q = t[i], n[i]
        total += mass[p]
        centre_t += mass[p] * x[p]
        centre_n += mass[p] * x[q]
        along += mass[p] * (X[p] * x[p] + X[q] * x[q])
        across += mass[p] * (X[p] * x[q] - X[q] * x[p])
    work[0], work[1] = along, across
    rho = np.sqrt(along * along + across * across)
    c, s = along / rho, across / rho
    centre_t /= total
    centre_n /= total
    # relative to the mass centre: a common offset does no work but loses digits
    for i in range(len(t)):
        p, q = t[i], n[i]
        d[p] = c * (x[p] - centre_t) + s * (x[q] - centre_n) - X[p]
        d[q] = c * (x[q] - centre_n) - s * (x[p] - centre_t) - X[q]
        d[b[i]] = x[b[i]] - X[b[i]]


@kernel
def _add_turned(d, y, X, mass, t, b, n, work, force):  # type: ignore[no-untyped-def]
    rho = np.sqrt(work[0] * work[0] + work[1] * work[1])
    c, s = work[0] / rho, work[1] / rho
    torque = 0.0
    for i in range(len(t)):
        torque += d[t[i]] * y[n[i]] - d[n[i]] * y[t[i]]
    swirl = torque / rho
    for i in range(len(t)):
        p, q = t[i], n[i]
        f_t = -y[p] - swirl * mass[p] * X[q]
        f_n = -y[q] + swirl * mass[p] * X[p]
        force[p] += c * f_t - s * f_n
        force[q] += s * f_t + c * f_n
        force[b[i]] -= y[b[i]]
