"""The zone that may yield: blocks of elements with J2 plasticity."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.fem.elements import lame_constants
from fem_impact.fem.hexmodes import CORNERS, DUMMY_EDGE, LANES, reference_gradients
from fem_impact.fem.kernels import Counts
from fem_impact.physics.hardening import FlowCurve, HardeningLaw, RateLaw
from fem_impact.solid.state import State
from fem_impact.solid.yielding_kernel import ROWS, Blocks, elastic_energy, subtract_nodal, update


@dataclass(slots=True)
class YieldingZone:
    """Elements of one body in blocks of ``LANES``, the last filled up with the dummy element.

    Attributes
    ----------
    body : ``rod`` or ``barrier``; cells : (count,) int64, numbers of the elements in its mesh
    count : number of true elements
    blocks : their places and state
    around : nodes (k, 3), starts and entries for `subtract_nodal`
    room : (ROWS * LANES,) work space of the kernels
    G, K : shear and bulk modulus, Pa
    law : the hardening law in the numbers that compiled code reads
    rate : law of the rate factor, or None without rate hardening
    full : plain full integration in place of the mean dilatation
    """

    moving: ClassVar[tuple[str, ...]] = ("blocks.stress", "blocks.strain", "blocks.flow", "blocks.work")
    body: str
    cells: Ints
    count: int
    blocks: Blocks
    around: tuple[Counts, Ints, Counts]
    room: Array
    G: float
    K: float
    law: FlowCurve
    rate: RateLaw | None
    full: bool = False

    @classmethod
    def of(
        cls,
        body: str,
        dof: Ints,
        points: Array,
        E: float,
        nu: float,
        law: HardeningLaw,
        dummy: Ints,
        full: bool = False,
        strength: Array | None = None,
        cells: Ints | None = None,
    ) -> "YieldingZone":
        """Build from places (m, 8, 3) and start positions (m, 8, 3) of the elements' nodes.

        ``strength`` (m, 8) is a factor of the flow stress at each Gauss point, 1 unless given; ``cells``
        (m,) are the numbers of the elements in the body's mesh, counted from 0 unless given.
        """
        blocks = -(-len(dof) // LANES)
        filled = np.concatenate([dof, np.broadcast_to(dummy, (blocks * LANES - len(dof), 8, 3))])
        volumes, (lame, G) = gauss_volumes(points), lame_constants(E, nu)
        state = Blocks(
            dof=np.ascontiguousarray(filled.reshape(blocks, LANES, 8, 3).transpose(0, 3, 2, 1), np.uint32),
            stress=np.zeros((blocks, 8, 6 * LANES)),
            strain=np.zeros((blocks, 8, LANES)),
            flow=_in_blocks(np.ones_like(volumes) if strength is None else strength, 1.0) * law.yield_stress,
            weight=_in_blocks(volumes, DUMMY_EDGE**3 / 8),
            pressure=np.zeros((blocks, LANES)),
            volume=_in_blocks(volumes.sum(axis=1, keepdims=True), DUMMY_EDGE**3)[:, 0],
            work=np.zeros((blocks, LANES)),
            nodal=np.zeros((blocks, 3, 8, LANES)),
        )
        room = np.zeros(ROWS * LANES)
        numbers, bulk = np.arange(len(dof)) if cells is None else cells, lame + 2 * G / 3
        around = _around(dof)
        return cls(body, numbers, len(dof), state, around, room, G, bulk, law.curve, law.rate, full)

    def add(self, state: State) -> None:
        """Advance the blocks and subtract their nodal forces."""
        constants = self.G, self.K, self.law, self.rate
        update(state.x, state.v, state.dt, self.blocks, *constants, self.full, self.room)
        subtract_nodal(*self.around, self.blocks.nodal.ravel(), state.force)

    def places(self) -> Ints:
        """Return the unknowns (count, 8, 3) of the elements' nodes."""
        return self.blocks.dof.transpose(0, 3, 2, 1).reshape(-1, 8, 3)[: self.count].astype(np.int64)

    @property
    def effect(self) -> str:
        """Return the effect by which the body yields."""
        return "rod-plasticity" if self.body == "rod" else "barrier-elastoplastic"

    @property
    def accounts(self) -> tuple[str, ...]:
        """Return the body's accounts."""
        return f"strain_{self.body}", f"plastic_{self.body}"

    def energies(self, state: State) -> tuple[float, ...]:
        """Return elastic energy and plastic work at the last force evaluation."""
        elastic = float(elastic_energy(state.x, self.blocks, self.G, self.K, self.full, self.room))
        return elastic, float(self.blocks.work.sum())

    def plastic_strain(self) -> Array:
        """Return the mean equivalent plastic strain (count,) of each element."""
        return np.asarray(self.blocks.strain.mean(axis=1).ravel()[: self.count])

    def spent(self) -> tuple[Array, Array]:
        """Return volume times plastic strain (count, 8), m3, at Gauss points; plastic work (count,), J."""
        strain = (self.blocks.weight * self.blocks.strain).transpose(0, 2, 1).reshape(-1, 8)
        return strain[: self.count], self.blocks.work.ravel()[: self.count]

    def mises(self) -> Array:
        """Return the mean von Mises stress (count,), Pa, of each element."""
        s = self.blocks.stress.reshape(-1, 8, 6, LANES)
        square = 1.5 * (s[:, :, :3] ** 2).sum(axis=2) + 3.0 * (s[:, :, 3:] ** 2).sum(axis=2)
        return np.asarray(np.sqrt(square).mean(axis=1).ravel()[: self.count])

    def tensor(self) -> Array:
        """Return the mean Kirchhoff stress (count, 3, 3), Pa, of each element, in the barrier frame."""
        s = self.blocks.stress.reshape(-1, 8, 6, LANES).mean(axis=1)
        s[:, :3] += self.blocks.pressure[:, None]
        flat = s.transpose(0, 2, 1).reshape(-1, 6)[: self.count]
        return np.asarray(flat[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]])


def _in_blocks(values: Array, dummy: float) -> Array:
    """Return values (m, k) of elements as (blocks, k, LANES); the dummy element that fills up has its own."""
    filled = np.full((-len(values) % LANES + len(values), values.shape[1]), dummy)
    filled[: len(values)] = values
    return np.ascontiguousarray(filled.reshape(-1, LANES, values.shape[1]).transpose(0, 2, 1))


def _around(dof: Ints) -> tuple[Counts, Ints, Counts]:
    """Return the nodes (k, 3) of elements ``dof`` (m, 8, 3), and the places in ``nodal`` around each."""
    _, first, node = np.unique(dof[:, :, 0], return_index=True, return_inverse=True)
    element, corner = np.divmod(np.arange(dof[:, :, 0].size), 8)
    place = element // LANES * 24 * LANES + corner * LANES + element % LANES
    order = np.argsort(node.ravel(), kind="stable")
    start = np.concatenate([[0], np.cumsum(np.bincount(node.ravel()))])
    return dof.reshape(-1, 3)[first].astype(np.uint32), start, place[order].astype(np.uint32)


def gauss_volumes(x: Array) -> Array:
    """Return the volumes (m, 8), m3, that the Gauss points stand for, of elements (m, 8, 3).

    The order of the points is that of the kernel (xi fastest).
    """
    return np.asarray(np.linalg.det(np.einsum("qai,maj->mqij", reference_gradients(CORNERS), x)))
