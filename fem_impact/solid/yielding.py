"""The zone that may yield: blocks of B-bar elements with J2 plasticity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.elements import lame_constants, lumped_mass
from fem_impact.solid.hardening import Hardening
from fem_impact.solid.hexmodes import LANES, SIGNS
from fem_impact.solid.items import Accounts
from fem_impact.solid.state import State
from fem_impact.solid.yielding_kernel import FULL_ELASTIC, FULL_PLASTIC, ROWS, update

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(slots=True)
class YieldingZone:
    """Elements of one body in blocks of ``LANES``, the last filled up with the dummy element.

    Attributes
    ----------
    body : ``rod`` or ``barrier``, names the accounts
    count : number of true elements
    dof : (blocks, 3, 8, LANES) int64
    stress : (blocks, 8, 6 * LANES) deviator, Pa; strain, flow : (blocks, 8, LANES)
    pressure, volume : (blocks, LANES), Pa (tension positive), m3
    """

    body: str
    count: int
    dof: Ints
    G: float
    K: float
    law: Array
    stress: Array
    strain: Array
    flow: Array
    pressure: Array
    volume: Array
    scratch: Array
    work: Array

    @classmethod
    def of(
        cls, body: str, dof: Ints, points: Array, E: float, nu: float, law: Hardening, dummy: Ints
    ) -> YieldingZone:
        """Build from places (m, 8, 3) and start positions (m, 8, 3) of the elements' nodes."""
        blocks = -(-len(dof) // LANES)
        filled = np.concatenate([dof, np.broadcast_to(dummy, (blocks * LANES - len(dof), 8, 3))])
        volume = np.full(blocks * LANES, 8.0e-9)
        cells = np.arange(8 * len(dof)).reshape(-1, 8)
        volume[: len(dof)] = lumped_mass(points.reshape(-1, 3), cells, 1.0).sum(axis=1)
        lame, G = lame_constants(E, nu)
        strain = np.zeros((blocks, 8, LANES))
        return cls(
            body=body,
            count=len(dof),
            dof=np.ascontiguousarray(filled.reshape(blocks, LANES, 8, 3).transpose(0, 3, 2, 1)),
            G=G,
            K=lame + 2 * G / 3,
            law=np.array([law.yield_stress, law.slope, law.exponent]),
            stress=np.zeros((blocks, 8, 6 * LANES)),
            strain=strain,
            flow=np.full_like(strain, law.yield_stress),
            pressure=np.zeros((blocks, LANES)),
            volume=volume.reshape(blocks, LANES),
            scratch=np.zeros(ROWS * LANES),
            work=np.zeros(2),
        )

    def add_force(self, state: State) -> None:
        """Advance stresses to the present positions and subtract the nodal forces."""
        update(
            state.x,
            state.v,
            state.dt,
            state.force,
            self.dof,
            self.stress,
            self.strain,
            self.flow,
            self.pressure,
            self.volume,
            self.scratch,
            self.G,
            self.K,
            self.law,
            self.work,
        )

    def accounts(self, state: State) -> Accounts:
        """Return elastic energy and plastic work."""
        return {
            f"strain_{self.body}": float(self.work[FULL_ELASTIC]),
            f"plastic_{self.body}": float(self.work[FULL_PLASTIC]),
        }

    def plastic_strain(self) -> Array:
        """Return the mean equivalent plastic strain (count,) of each element."""
        return np.asarray(self.strain.mean(axis=1).ravel()[: self.count])

    def mises(self) -> Array:
        """Return the mean von Mises stress (count,), Pa, of each element."""
        s = self.stress.reshape(len(self.dof), 8, 6, LANES)
        square = 1.5 * (s[:, :, :3] ** 2).sum(axis=2) + 3.0 * (s[:, :, 3:] ** 2).sum(axis=2)
        return np.asarray(np.sqrt(square).mean(axis=1).ravel()[: self.count])


def dummy_element() -> Array:
    """Return the positions (8, 3) of the filler: a cube that never moves, 2 mm wide."""
    return SIGNS * 1e-3
