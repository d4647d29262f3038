"""Half a ball: a bulged cube inside shells, with a regular grid at the contact point."""

from collections.abc import Sequence

import numpy as np

from meshes.block import box_cells
from meshes.common import FloatArray, IntArray, MeshError
from meshes.hexmesh import HexMesh, from_cells, half_body_tags, outer_quads
from meshes.quality import require_positive
from meshes.refine import refine
from meshes.section import core_and_rings
from meshes.zone import Cloud, Zone

# Half edge of the cube over the radius, and the weight of the ball in the bulged cube, from a scan.
CORE = 0.45
BULGE = 0.35


def sphere(radius: float, across: int = 8, zones: Sequence[Zone | Cloud] = (), *, buffer: int = 2) -> HexMesh:
    """Mesh the half y >= 0 of a ball that touches the plane z = 0 at the origin.

    Parameters
    ----------
    radius : float, m
    across : int
        Cells over the diameter, even, at least 6.
    zones, buffer
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
    mesh = from_cells(radius * unit + centre, cells, half_body_tags)

    def snap(points: FloatArray, _: FloatArray) -> FloatArray:
        arms = points - centre
        return np.asarray(centre + radius * arms / np.linalg.norm(arms, axis=1, keepdims=True))

    mesh = refine(mesh, zones, snap, buffer=buffer)
    require_positive(mesh)
    return mesh


def pole_edge(radius: float, across: int) -> float:
    """Return the edge of the cells at the contact point before they are split, m.

    The cube's cells take even angles on the ball, a quarter turn together. With 8 cells over the diameter
    that is pi / 2 of the radius over 4.

    Examples
    --------
    >>> round(pole_edge(1.0, 8), 4)
    0.3927
    """
    core, _ = core_and_rings(across)
    return float(0.5 * np.pi * radius / core)


def _half_ball(core: int, shells: int) -> tuple[FloatArray, IntArray]:
    """Points and cells of the half unit ball about the origin."""
    half = np.linspace(-1.0, 1.0, core + 1), np.linspace(0.0, 1.0, core // 2 + 1)
    cube = np.stack(np.meshgrid(half[0], half[1], half[0], indexing="ij"), axis=-1).reshape(-1, 3)
    cells = box_cells(np.array([core, core // 2, core]))
    inside = CORE * ((1.0 - BULGE) * cube + BULGE * _ball(cube))
    quads = outer_quads(cells)
    quads = quads[~(cube[quads][:, :, 1] == 0.0).all(axis=1)]
    rim, place = np.unique(quads, return_inverse=True)
    even = np.tan(0.25 * np.pi * cube[rim])  # nodes of the cube's surface at even angles from the centre
    start, far = inside[rim], even / np.linalg.norm(even, axis=1, keepdims=True)
    weight = np.arange(1, shells + 1)[:, None, None] / shells
    layers = np.concatenate([rim[None], len(cube) + np.arange(shells * len(rim)).reshape(shells, -1)])
    sides = layers[:, place.reshape(quads.shape)]
    shell_cells = np.concatenate([sides[:-1], sides[1:]], axis=2).reshape(-1, 8)
    points = np.concatenate([inside, (start + weight * (far - start)).reshape(-1, 3)])
    return points, np.concatenate([cells, shell_cells])


def _ball(cube: FloatArray) -> FloatArray:
    """(k, 3) images of points of the cube [-1, 1]^3 in the unit ball, by a smooth map."""
    square = cube**2
    y, z = np.roll(square, -1, axis=1), np.roll(square, -2, axis=1)
    return np.asarray(cube * np.sqrt(1.0 - 0.5 * y - 0.5 * z + y * z / 3.0))
