"""Bodies of hexahedra that a user might bring, made with numpy alone."""

import meshio
import numpy as np

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])


def box(nx, ny, nz, low, high):
    """Return points and cells of a box of equal cells."""
    axes = [np.linspace(a, b, n + 1) for a, b, n in zip(low, high, (nx, ny, nz), strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    start = np.stack(np.meshgrid(*map(np.arange, (nx, ny, nz)), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    stride = np.array([(ny + 1) * (nz + 1), nz + 1, 1])
    return points, (start + CORNERS) @ stride


def taper(width=12e-3, length=60e-3, end=0.5, cells=(4, 2, 10), whole=False):
    """Return a square bar whose width shrinks from the tail to ``end`` of it at the tip; m."""
    nx, ny, nz = cells
    low = (-width / 2, -width / 2 if whole else 0.0, 0.0)
    points, hexes = box(nx, 2 * ny if whole else ny, nz, low, (width / 2, width / 2, length))
    points[:, :2] *= end + (1 - end) * points[:, 2:] / length
    return points, hexes


def chamfered(steps):
    """A bar of 12 x 12 x 60 mm with chamfers of 2 mm at 45 degrees, so many cells along each."""
    points, cells = taper(end=1.0, cells=(2 * steps + 2, 2, 8))
    width = np.concatenate([np.linspace(-6e-3, -4e-3, steps + 1), [0.0], np.linspace(4e-3, 6e-3, steps + 1)])
    old = np.linspace(-6e-3, 6e-3, len(width))
    points[:, 0] = np.interp(points[:, 0], old, width)
    up = np.maximum(np.abs(points[:, 0]) - 4e-3, 0.0)
    points[:, 2] += up * (1.0 - points[:, 2] / 60e-3)
    return points, cells


def write(path, points, cells, kind="hexahedron", **others):
    """Write a mesh file by meshio."""
    blocks = [(kind, cells), *others.items()]
    if path.suffix == ".msh":
        meshio.write(path, meshio.Mesh(points, blocks), file_format="gmsh")
    else:
        meshio.write(path, meshio.Mesh(points, blocks))
    return path
