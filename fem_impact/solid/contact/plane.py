"""Contact of the rod's nodes with the rigid plane n = 0."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.kernels import kernel
from fem_impact.fem.sliding import factor_at, speed_table
from fem_impact.solid.contact.book import MOVING, Booked, ContactBook, StepRecord
from fem_impact.solid.state import State


@dataclass(slots=True)
class PlaneContact(Booked):
    """Unilateral contact with Coulomb friction on a rigid plane, node by node.

    A node whose predicted position would lie below the plane gets the smallest impulse that lets it
    arrive exactly there (Fekak et al. 2017, doi:10.1007/s00466-017-1397-0, with the predicted gap).
    ``f`` (k,) are the Coulomb coefficients of the ``nodes`` (k, 3) at rest, ``over_speed`` is a
    `fem_impact.fem.sliding.speed_table`.
    """

    moving: ClassVar[tuple[str, ...]] = MOVING
    nodes: Ints
    inverse_mass: Array
    f: Array
    over_speed: Array = field(default_factory=lambda: speed_table(None))
    book: ContactBook = field(default_factory=ContactBook)

    def resolve(self, state: State) -> None:
        """Apply this step's impulses."""
        motion, span = (state.x, state.v, state.force), (state.kick, state.dt_next)
        step = touch_plane(self.nodes, *motion, self.inverse_mass, *span, self.f, self.over_speed)
        self.book.close_step(step, state.time)

    def clearance(self, x: Array) -> float:
        """Return the smallest height, m, of the nodes over the plane at positions ``x``."""
        return float(x[self.nodes[:, 2]].min())


@kernel
def touch_plane(nodes, x, v, force, inverse_mass, kick, dt, f, over_speed):  # type: ignore[no-untyped-def]
    """Resolve all nodes (k, 3): change their velocities and return the step's record; ``f`` (k,).

    Friction follows the sliding speed before the step's forces, at which it slid last.
    """
    impulse_t, impulse_n, moment, friction, closing, rubbed, active = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    for i in range(len(nodes)):
        t, b, n = nodes[i, 0], nodes[i, 1], nodes[i, 2]
        if x[n] + dt * v[n] >= 0.0:
            continue
        old_t = v[t] - kick * inverse_mass[t] * force[t]
        old_b = v[b] - kick * inverse_mass[b] * force[b]
        old_n = v[n] - kick * inverse_mass[n] * force[n]
        p = (-max(x[n], 0.0) / dt - v[n]) / inverse_mass[n]
        if p <= 0.0:
            continue
        slip = np.sqrt(v[t] * v[t] + v[b] * v[b])
        coulomb = f[i] * factor_at(np.sqrt(old_t * old_t + old_b * old_b), over_speed)
        share = min(1.0, coulomb * p * inverse_mass[t] / slip) if slip > 0.0 else 0.0
        p_t, p_b = -share * v[t] / inverse_mass[t], -share * v[b] / inverse_mass[t]
        v[t] += inverse_mass[t] * p_t
        v[b] += inverse_mass[b] * p_b
        v[n] += inverse_mass[n] * p
        impulse_t += p_t
        impulse_n += p
        moment += x[t] * p - x[n] * p_t
        friction -= 0.5 * (p_t * (old_t + v[t]) + p_b * (old_b + v[b]))
        closing -= 0.5 * p * (old_n + v[n])
        rubbed += np.sqrt(p_t * p_t + p_b * p_b)
        active += 1
    return StepRecord(impulse_t, impulse_n, moment, friction, closing, rubbed, active, 0)
