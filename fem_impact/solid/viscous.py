"""A rod of a standard linear solid: beside its springs each cell has a Maxwell element, spring and dashpot.

All cells relax alike, so the Maxwell elements' state is one field of displacements q of the nodes, and the
force follows from the elastic operator K that the rod has anyway. Of displacements d,

    f = K (c d + g c q),    q' = d' - q / theta,

where c is the share of the stiffness that stays for ever and g, theta those of `linear_solid`. The elastic
item adds K d, this one the rest, K w with w = g c q - (1 - c) d.
"""

from dataclasses import dataclass
from math import expm1
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array
from fem_impact.physics.viscous import LinearSolid
from fem_impact.solid.elastic import ElasticRod
from fem_impact.solid.state import State


@dataclass(slots=True)
class MaxwellCells:
    """The Maxwell elements of all cells of a rod; it acts right after the rod's elastic item.

    Attributes
    ----------
    rod : the elastic item, whose displacements d it takes
    solid : the material's law
    q : (n,) displacements that the springs of the Maxwell elements hold, m
    pull : (n,) forces of these springs, g c K q, N
    before : (n,) d at the last evaluation, m; time : of it, s
    w, y : (n,) work space: the displacements of which y = K w is the force, m and N
    spring, stored : energy of these springs, and with it what the whole adds to that of the elastic item, J,
        of the half model
    lost : energy that the dashpots took so far, J, of the half model
    """

    body: ClassVar[str] = "rod"
    effect: ClassVar[str] = "contact-loss"
    accounts: ClassVar[tuple[str, ...]] = ("strain_rod", "damping")
    moving: ClassVar[tuple[str, ...]] = ("q", "pull", "before", "time", "spring", "stored", "lost")
    rod: ElasticRod
    solid: LinearSolid
    q: Array
    pull: Array
    before: Array
    w: Array
    y: Array
    time: float = 0.0
    spring: float = 0.0
    stored: float = 0.0
    lost: float = 0.0

    @classmethod
    def of(cls, rod: ElasticRod, solid: LinearSolid) -> "MaxwellCells":
        """Return the elements of a rod at rest."""
        q, pull, before, w, y = np.zeros((5, len(rod.d)))
        return cls(rod, solid, q, pull, before, w, y)

    def add(self, state: State) -> None:
        """Relax the elements to the present time, add their forces and book their work."""
        d, law, shrink = self.rod.d, self.solid, (state.time - self.time) / self.solid.theta
        # exact for displacements that change evenly since the last time
        kept = -expm1(-shrink) / shrink if shrink > 0.0 else 1.0
        self.q *= 1.0 - kept * shrink
        self.q += kept * (d - self.before)
        np.multiply(self.q, law.g * law.c, out=self.w)
        self.w -= (1.0 - law.c) * d
        self.rod.apply(self.w, self.y)
        self.rod.frame.add_force(d, self.y, state.force[: len(d)])
        # the dashpots take what the elements are given and their springs do not store; the work is that of
        # the mean force along the way since the last time, as leapfrog does it
        relaxed = 1.0 - law.c
        pull = self.y + relaxed * self.rod.y
        spring = 0.5 * float(self.q @ pull)
        given = 0.5 * float((self.pull + pull) @ (d - self.before))
        self.lost += given - (spring - self.spring)
        self.pull[:], self.spring = pull, spring
        self.stored = spring - 0.5 * relaxed * float(d @ self.rod.y)
        self.before[:], self.time = d, state.time

    def energies(self, state: State) -> tuple[float, ...]:
        """Return what the elements add to the strain energy, and what their dashpots have taken."""
        return self.stored, self.lost
