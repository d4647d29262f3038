"""A rod that cannot vibrate: its nose deforms, the cylinder behind it moves as one rigid body.

The rigid rest is the nose's last section and two points on the axis, which have the mass, mass centre and
moment of inertia of the cylinder behind it. After every kick their velocities are replaced by the rigid
motion of equal momentum and angular momentum; then positions keep their distances to the fourth order of
the angle turned in a step.
"""

from dataclasses import dataclass
from typing import ClassVar

from fem_impact.arrays import Array, Ints
from fem_impact.fem.kernels import kernel
from fem_impact.solid.state import State


@dataclass(slots=True)
class RigidRest:
    """Constraint of nodes to the motion of one rigid body in the t-n plane.

    Attributes
    ----------
    places : (k, 3) int64, unknowns of the nodes; mass : (k,) kg
    """

    effect: ClassVar[str] = "nose"
    accounts: ClassVar[tuple[str, ...]] = ()
    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ()
    places: Ints
    mass: Array

    def resolve(self, state: State) -> None:
        """Replace the kicked velocities by the rigid motion of equal momentum."""
        hold(self.places, self.mass, state.x, state.v, state.dt_next)

    def energies(self, state: State) -> tuple[float, ...]:
        """Return nothing: the constraint does no work."""
        return ()


@kernel
def hold(places, mass, x, v, dt):  # type: ignore[no-untyped-def]
    """Project the velocities on rigid motions in the t-n plane; a step along chords keeps the radii."""
    total, c_t, c_n, V_t, V_n = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(places)):
        m, t, n = mass[i], places[i, 0], places[i, 2]
        total += m
        c_t += m * x[t]
        c_n += m * x[n]
        V_t += m * v[t]
        V_n += m * v[n]
    c_t, c_n, V_t, V_n = c_t / total, c_n / total, V_t / total, V_n / total
    inertia, spin = 0.0, 0.0
    for i in range(len(places)):
        r_t, r_n = x[places[i, 0]] - c_t, x[places[i, 2]] - c_n
        inertia += mass[i] * (r_t * r_t + r_n * r_n)
        spin += mass[i] * (r_n * (v[places[i, 0]] - V_t) - r_t * (v[places[i, 2]] - V_n))
    Omega = spin / inertia
    inwards = 0.5 * dt * Omega * Omega
    for i in range(len(places)):
        r_t, r_n = x[places[i, 0]] - c_t, x[places[i, 2]] - c_n
        v[places[i, 0]] = V_t + Omega * r_n - inwards * r_t
        v[places[i, 1]] = 0.0
        v[places[i, 2]] = V_n - Omega * r_t - inwards * r_n
