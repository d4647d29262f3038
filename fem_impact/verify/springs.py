"""The contact of public codes: a spring under every node, friction through a second spring that gives way."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from fem_impact.solid.state import State
from fem_impact.verify.reference.bricks import spring_force
from meshes import HexMesh

__all__ = ["NodeSprings", "node_areas"]

Array = NDArray[np.float64]


def node_areas(mesh: HexMesh, faces: NDArray[np.bool_]) -> Array:
    """Return the area (n,), m2, that each node has in some of the outer faces (k,)."""
    corners = mesh.faces[faces]
    a, b = (mesh.points[corners[:, 2 + i]] - mesh.points[corners[:, i]] for i in (0, 1))
    area = 0.5 * np.linalg.norm(np.cross(a, b), axis=1)
    return np.asarray(
        np.bincount(corners.ravel(), np.repeat(area / 4, 4), len(mesh.points)), dtype=np.float64
    )


@dataclass(slots=True)
class NodeSprings:
    """Springs between the rigid plane n = 0 and the nodes of a body.

    Attributes
    ----------
    nodes : (k, 3) unknowns; stiffness : (k,) N/m, along the normal
    stick : tangential over normal stiffness; f : Coulomb's coefficient
    anchor : (k, 2) where each node holds on to the plane, m
    """

    body: ClassVar[str] = "rod"
    effect: ClassVar[str] = "contact"
    accounts: ClassVar[tuple[str, ...]] = ()
    moving: ClassVar[tuple[str, ...]] = ("anchor",)
    nodes: NDArray[np.int64]
    stiffness: Array
    stick: float
    f: float
    anchor: Array = field(init=False)

    def __post_init__(self) -> None:
        self.anchor = np.zeros((len(self.nodes), 2))

    def add(self, state: State) -> None:
        """Add the springs' forces; where friction gives way, the anchor follows."""
        place = state.x[self.nodes]
        pull, press, self.anchor = spring_force(place, self.anchor, self.stiffness, self.stick, self.f)
        state.force[self.nodes] += np.column_stack([pull, press])

    def energies(self, state: State) -> tuple[float, ...]:
        """Return nothing: what springs hold and lose is no part of the ledger."""
        return ()
