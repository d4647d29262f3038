"""The block of a free barrier that turns, and the dashpots around it, on a foundation with an angle.

The foundation is a rigid body with a displacement and the angle theta from n towards t. Seen from it, a point
at x stands at l = R^T (x - c), with c the foundation's mass centre, and the block with the springs around it
has the potential U = d . K d / 2, d = l - X. The forces are the full gradient of U, so linear and angular
momentum and energy are conserved for any angle: -R y on the block and R y on the foundation, y = K d, and the
torque sum(y_t l_n - y_n l_t) on its angle.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.kernels import kernel
from fem_impact.fem.sparse import NodeProduct
from fem_impact.solid.ground import Ground
from fem_impact.solid.state import State


@dataclass(slots=True)
class TurningBlock:
    """The linear part of a meshed barrier on a foundation that turns, and the springs between both.

    Attributes
    ----------
    stiffness : of block and springs, about the foundation's mass centre
    place : of the block in the flat vectors; seen : (k, 3) its nodes as the foundation sees them, m
    pulled : (k, 3) forces on them as the foundation sees them, N
    """

    body: ClassVar[str] = "barrier"
    accounts: ClassVar[tuple[str, ...]] = ("strain_barrier",)
    moving: ClassVar[tuple[str, ...]] = ()
    stiffness: NodeProduct
    place: slice
    ground: Ground
    seen: Array
    pulled: Array
    effect: str = "barrier-elastic"

    @classmethod
    def of(cls, stiffness: NodeProduct, place: slice, ground: Ground, effect: str) -> "TurningBlock":
        """Build from a stiffness whose origin is the block at the start, m."""
        stiffness.origin[:, [0, 2]] -= ground.centre
        seen, pulled = np.zeros((2, (place.stop - place.start) // 3, 3))
        return cls(stiffness, place, ground, seen, pulled, effect)

    def add(self, state: State) -> None:
        """Add the forces on the block and on its foundation."""
        (t, _, n), (turn,), x = self.ground.foundation, self.ground.turn, state.x
        c, s, (c_t, c_n) = np.cos(x[turn]), np.sin(x[turn]), self.ground.place(x)
        _seen(x[self.place].reshape(-1, 3), c_t, c_n, c, s, self.seen)
        self.stiffness.multiply(self.seen.ravel())
        self.pulled[:] = 0.0
        self.stiffness.add_to(self.pulled.ravel())
        block = state.force[self.place].reshape(-1, 3)
        pull_t, pull_n, torque = _pull(self.seen, self.pulled, c, s, block)
        state.force[t] += c * pull_t + s * pull_n
        state.force[n] += c * pull_n - s * pull_t
        state.force[turn] += torque

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the strain energy of block and springs at the last force evaluation."""
        return (self.stiffness.energy,)


@kernel
def _seen(x, c_t, c_n, c, s, seen):  # type: ignore[no-untyped-def]
    """Set ``seen`` (k, 3) to places x (k, 3) as seen from a body at c_t, c_n turned from n to t."""
    for i in range(len(x)):
        t, n = x[i, 0] - c_t, x[i, 2] - c_n
        seen[i, 0], seen[i, 1], seen[i, 2] = c * t - s * n, x[i, 1], c * n + s * t


@kernel
def _pull(seen, y, c, s, force):  # type: ignore[no-untyped-def]
    """Subtract forces y (k, 3), turned, from ``force`` (k, 3); return their sums along t, n and torque."""
    pull_t, pull_n, torque = 0.0, 0.0, 0.0
    for i in range(len(y)):
        y_t, y_n = y[i, 0], y[i, 2]
        force[i, 0] -= c * y_t + s * y_n
        force[i, 1] -= y[i, 1]
        force[i, 2] -= c * y_n - s * y_t
        pull_t += y_t
        pull_n += y_n
        torque += y_t * seen[i, 2] - y_n * seen[i, 0]
    return pull_t, pull_n, torque


def foundation_step(
    block: float, share: float, springs: Array, ground: Ground, inverse: Array, x: Array
) -> float:
    """Return the stable step, s, of a block on springs with a foundation; ``block`` is that without one.

    ``share`` is that of both steps, ``springs`` (3 k,), N/m, stand between the block's unknowns at ``x``
    (3 k,), m, and the foundation; ``inverse`` (3,) are its inverse mass along t and n, 1/kg, and inertia.
    The largest eigenvalue of the whole is at most the sum of those of its two parts.
    """
    k_t, _, k_n = springs.reshape(-1, 3).T
    t, n = (x.reshape(-1, 3)[:, [0, 2]] - ground.centre).T
    along_t = np.stack([np.ones_like(t), np.zeros_like(t), n])
    along_n = np.stack([np.zeros_like(t), np.ones_like(t), -t])
    root, K = np.sqrt(inverse), (along_t * k_t) @ along_t.T + (along_n * k_n) @ along_n.T
    largest = float(np.linalg.eigvalsh(root[:, None] * K * root)[-1])
    return float(share * 2.0 / np.sqrt((share * 2.0 / block) ** 2 + largest))


@dataclass(slots=True)
class TurningDashpots:
    """Viscous boundary between a block and a foundation that turns; implicit for both.

    Each dashpot's impulses on block and foundation act at the same place, so they keep angular momentum.

    Attributes
    ----------
    places : (k,) damped unknowns; damping : (k,), N s/m; inverse_mass : (size,), 1/kg
    ends : (k,) unknowns of the foundation in their directions
    beside, across : (k,) unknowns of block and foundation along which lie their levers about the mass centre
        of the foundation; start : (k,) its place there at the start, m
    sign : (k,) 1 along t, -1 along n, 0 along b
    radiated : energy of the half model taken so far, J
    """

    effect: ClassVar[str] = "radiation"
    accounts: ClassVar[tuple[str, ...]] = ("radiated",)
    every: ClassVar[int] = 1
    moving: ClassVar[tuple[str, ...]] = ("radiated",)
    places: Ints
    damping: Array
    inverse_mass: Array
    ground: Ground
    ends: Ints
    beside: Ints
    across: Ints
    start: Array
    sign: Array
    radiated: float = 0.0

    @classmethod
    def of(
        cls, places: Ints, damping: Array, inverse_mass: Array, ground: Ground, first: int
    ) -> "TurningDashpots":
        """Build for unknowns of a block that begins at the index ``first``."""
        along, (c_t, c_n) = (places - first) % 3, ground.centre
        beside, across = places + np.array([2, 0, -2])[along], ground.foundation[2 - along]
        start, sign = np.array([c_n, 0.0, c_t])[along], np.array([1.0, 0.0, -1.0])[along]
        return cls(
            places, damping, inverse_mass, ground, ground.foundation[along], beside, across, start, sign
        )

    def resolve(self, state: State) -> None:
        """Damp the velocities relative to the foundation, which takes the opposite impulses."""
        (turn,), inverse, v = self.ground.turn, self.inverse_mass, state.v
        lever = self.sign * (state.x[self.beside] - state.x[self.across] - self.start)

        def relative(of: Array) -> Array:
            return np.asarray(of[self.places] - of[self.ends] - lever * of[turn])

        of_block, seen = inverse[self.places], relative(v)
        old, half = seen - state.kick * relative(inverse * state.force), 0.5 * state.kick * self.damping
        given = half / (1 + half * of_block)  # N s per m/s of the foundation's motion
        alone, own = -given * (old + seen), np.array([*self.ground.foundation, turn])
        motions = np.vstack([self.ends == one for one in own[:-1]] + [lever])
        together = np.eye(len(own)) + (motions * given) @ motions.T * inverse[own]
        taken = np.linalg.solve(together, motions @ alone)  # by each unknown of the foundation
        impulse = alone - given * (inverse[own] * taken @ motions)
        v[self.places] += of_block * impulse
        np.add.at(v, self.ends, -inverse[self.ends] * impulse)
        v[turn] -= inverse[turn] * float(lever @ impulse)
        self.radiated -= 0.5 * float(impulse @ (old + relative(v)))

    def energies(self, state: State) -> tuple[float, ...]:
        """Return the energy radiated so far."""
        return (self.radiated,)
