"""Half a ball: a bulged cube inside shells, so that the grid at the contact point is regular."""

import numpy as np
import numpy.typing as npt

from meshes.block import box_cells
from meshes.errors import MeshError
from meshes.hexmesh import SKIN, SYMMETRY, HexMesh, from_cells, outer_faces
from meshes.quality import require_positive
from meshes.refine import refine
from meshes.section import core_and_rings
from meshes.topology import FACES
from meshes.zone import Zone

__all__ = ["sphere"]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Half edge of the cube over the radius, and how far it bulges from a cube towards a ball: by a scan.
CORE = 0.45
BULGE = 0.35


def sphere(
    radius: float, across: int = 8, zone: Zone | None = None, levels: int = 0, *, buffer: int = 2
) -> HexMesh:
    """Mesh the half y >= 0 of a ball that touches the plane z = 0 at the origin.

    Parameters
    ----------
    radius : float, m
    across : int
        Cells over the diameter, even, at least 6.
    zone, levels, buffer
        See `refine`.

    Raises
    ------
    MeshError
        If the radius is not positive or `across` does not divide into a core and shells.
    """
    if not radius > 0.0:
        raise MeshError(f"sphere radius must be positive, not {radius} m")
    core, shells = core_and_rings(across)
    unit, cells = _half_ball(core, shells)
    centre = np.array([0.0, 0.0, radius])
    mesh = from_cells(radius * unit + centre, cells, _tag)

    def snap(points: FloatArray) -> FloatArray:
        arms = points - centre
        return np.asarray(centre + radius * arms / np.linalg.norm(arms, axis=1, keepdims=True))

    if zone is not None:
        mesh = refine(mesh, zone, levels, snap, buffer=buffer)
    require_positive(mesh)
    return mesh


def _half_ball(core: int, shells: int) -> tuple[FloatArray, IntArray]:
    """Points and cells of the half unit ball about the origin."""
    cube, cells = _half_cube(core)
    inside = CORE * ((1.0 - BULGE) * cube + BULGE * _ball(cube))
    owner, local = outer_faces(cells)
    quads = cells[owner[:, None], FACES[local]]
    quads = quads[~(cube[quads][:, :, 1] == 0.0).all(axis=1)]
    rim, place = np.unique(quads, return_inverse=True)
    start, far = inside[rim], _direction(cube[rim])
    weight = np.arange(1, shells + 1)[:, None, None] / shells
    layers = np.concatenate([rim[None], len(cube) + np.arange(shells * len(rim)).reshape(shells, -1)])
    sides = layers[:, place.reshape(quads.shape)]
    shell_cells = np.concatenate([sides[:-1], sides[1:]], axis=2).reshape(-1, 8)
    points = np.concatenate([inside, (start + weight * (far - start)).reshape(-1, 3)])
    return points, np.concatenate([cells, shell_cells])


def _half_cube(n: int) -> tuple[FloatArray, IntArray]:
    """Nodes of [-1, 1] x [0, 1] x [-1, 1] and its cells."""
    lines = [np.linspace(-1.0, 1.0, n + 1), np.linspace(0.0, 1.0, n // 2 + 1), np.linspace(-1.0, 1.0, n + 1)]
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    return points, box_cells(np.array([n, n // 2, n]))


def _ball(cube: FloatArray) -> FloatArray:
    """Smooth map of the cube [-1, 1]^3 onto the unit ball."""
    square = cube**2
    y, z = np.roll(square, -1, axis=1), np.roll(square, -2, axis=1)
    return np.asarray(cube * np.sqrt(1.0 - 0.5 * y - 0.5 * z + y * z / 3.0))


def _direction(cube: FloatArray) -> FloatArray:
    """Point from the centre through nodes of the cube's surface, at even angles (unit vectors)."""
    even = np.tan(0.25 * np.pi * cube)
    return np.asarray(even / np.linalg.norm(even, axis=1, keepdims=True))


def _tag(corners: FloatArray) -> IntArray:
    """SYMMETRY at y = 0, SKIN elsewhere."""
    return np.where((corners[:, :, 1] == 0.0).all(axis=1), SYMMETRY, SKIN)
