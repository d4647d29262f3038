"""A projectile whose shape is a mesh of the user's own, from a file."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.errors import SceneError
from fem_impact.scene.checks import check_choice
from fem_impact.scene.units import DIMENSIONS

if TYPE_CHECKING:
    from fem_impact.arrays import Array
    from meshes import HexMesh
    from rigid import Faceted

UNITS = tuple(unit.symbol for unit in DIMENSIONS["length"].units)


@dataclass(frozen=True, slots=True)
class OwnMesh:
    """A mesh file: its path, the unit of its coordinates, and the SHA-256 of its content.

    The content is part of the scene: another one under the same name makes another scene.
    """

    path: str
    unit: str
    content: str

    @classmethod
    def of(cls, path: str, unit: str = "m", content: str | None = None) -> OwnMesh:
        """Return the mesh of a file; a stated ``content`` must be the file's.

        Raises
        ------
        SceneError
            If the file is missing or has changed, or the unit is none of length.
        """
        check_choice(unit, UNITS, "mesh_unit")
        found = _content(path)
        if content not in (None, found):
            problem = f"has changed: its SHA-256 is {found[:12]}..., the scene was stated with that of"
            remedy = "Put the old file back, or leave mesh_content out to state another scene."
            raise SceneError(f"{problem} mesh_content.", key="mesh", value=path, remedy=remedy)
        return cls(path, unit, found)

    def half(self) -> HexMesh:
        """Return the half y >= 0 in the frame of the body, tip at z = 0, m; see `meshes.own_half`.

        Raises
        ------
        SceneError
            If it is no body of hexahedra that the model can hold.
        """
        return _half(self)


def _content(path: str) -> str:
    try:
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()
    except OSError as error:
        reason = "there is no such file" if isinstance(error, FileNotFoundError) else str(error.strerror)
        remedy = "Name a mesh file, from the place of the scene's file."
        raise SceneError(f"cannot be read: {reason}.", key="mesh", value=path, remedy=remedy) from None


@lru_cache(maxsize=8)
def _half(mesh: OwnMesh) -> HexMesh:
    import meshes

    unit = DIMENSIONS["length"].unit(mesh.unit)
    assert unit is not None, "the unit was checked"
    try:
        return meshes.read_own(mesh.path, unit.to_si("1"))
    except meshes.MeshError as error:
        raise SceneError(str(error), key="mesh", value=mesh.path) from None


@lru_cache(maxsize=8)
def faceted_body(mesh: OwnMesh, density: tuple[tuple[float, float], ...]) -> Faceted:
    """Return the rigid body of a mesh with densities, kg/m3, up to their ends, m from the tip.

    Raises
    ------
    SceneError
        If a cell lies on both sides of the end of a segment.
    """
    import numpy as np

    import meshes
    import rigid

    half = mesh.half()
    part = meshes.cell_moments(half)
    ends = [end for end, _ in density]
    _require_joints(part.low, part.high, ends[:-1])
    middle = 0.5 * (part.low + part.high)
    rho = np.array([value for _, value in density])[np.searchsorted(ends[:-1], middle)]
    moments = [rho * moment for moment in (part.volume, part.x, part.z, part.xx, part.zz)]
    quads = half.faces_with(meshes.SKIN)
    nodes, facets = np.unique(quads, return_inverse=True)
    parts = np.column_stack([part.low, part.high, *moments])
    return rigid.Faceted(half.points[nodes], facets.reshape(quads.shape), parts)


def _require_joints(low: Array, high: Array, joints: Sequence[float]) -> None:
    """Refuse a joint of two segments that cuts cells between their ends ``low`` and ``high`` (m,), m."""
    import numpy as np

    slack = 1e-3 * (high - low)
    rows = np.unique(low.round(9))
    for number, joint in enumerate(joints, 1):
        cut = (low + slack < joint) & (joint < high - slack)
        if cut.any():
            near = float(rows[np.argmin(np.abs(rows - joint))])
            raise SceneError(
                f"lies within {int(cut.sum())} cells of the mesh, which have one material each.",
                key=f"segments[{number}].to",
                value=f"{joint * 1e3:g} mm",
                remedy=f"The nearest nodes are at {near * 1e3:.6g} mm from the tip.",
            )
