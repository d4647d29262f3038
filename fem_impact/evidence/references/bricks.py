"""A straight bar of equal bricks by central differences: an explicit code of its own.

All elements are the same box, so a single 24 x 24 stiffness is assembled. Strains are small; a bar that
bounces turns, and its stiffness with it. The contact is that of public codes: a normal spring under each
node, and a tangential one that slips at Coulomb's limit.
"""

from dataclasses import dataclass, field
from itertools import product
from math import atan2, cos, sin, sqrt

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import eigsh

from fem_impact.arrays import Array, Ints

CORNERS = np.array(list(product((-1.0, 1.0), repeat=3)))
GAUSS = CORNERS / sqrt(3)


def _strains(slopes: Array) -> Array:
    """Return the strains (6, 3 k) of k functions of given slopes (k, 3), displacement by displacement."""
    B = np.zeros((6, len(slopes), 3))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        B[i, :, i] = slopes[:, i]
        B[3 + i, :, i], B[3 + i, :, j] = slopes[:, j], slopes[:, i]
    return B.reshape(6, -1)


def brick_stiffness(kind: str, edges: Array, E: float, nu: float) -> Array:
    """Return the stiffness (24, 24), N/m, of a box with ``edges`` (3,), m; corners as in ``product``.

    ``full`` is the 8-point hexahedron; ``bbar`` has the mean dilatation (Hughes 1980), ``incompatible``
    adds 1 - xi^2 in each direction (Wilson 1973), condensed.
    """
    G, lame, weight = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu)), float(np.prod(edges)) / 8
    D = np.diag([2 * G] * 3 + [G] * 3)  # for strains xx, yy, zz, xy, yz, zx
    D[:3, :3] += lame
    factors = 1 + CORNERS * GAUSS[:, None]  # (points, corners, 3)
    slopes = CORNERS * np.roll(factors, -1, axis=2) * np.roll(factors, -2, axis=2) / (4 * edges)
    B = np.stack([_strains(at) for at in slopes])
    if kind == "bbar":
        swell = B[:, :3].sum(axis=1) / 3
        B[:, :3] += (swell.mean(axis=0) - swell)[:, None]
    K = weight * np.einsum("gia,ij,gjb->ab", B, D, B)
    if kind == "incompatible":
        H = np.stack([_strains(np.diag(-4 * at / edges)) for at in GAUSS])
        mixed = weight * np.einsum("gia,ij,gjb->ab", B, D, H)
        K -= mixed @ np.linalg.solve(weight * np.einsum("gia,ij,gjb->ab", H, D, H), mixed.T)
    return np.asarray(K)


@dataclass(frozen=True, slots=True)
class Bar:
    """A bar from z = 0 to its length, its section -side/2 to side/2 in x and 0 to side/2 in y.

    Attributes
    ----------
    side, length : m; cells : across, even, and along
    E, nu, rho : material; kind : of the element
    """

    side: float
    length: float
    cells: tuple[int, int]
    E: float
    nu: float
    rho: float
    kind: str = "full"
    counts: tuple[int, int, int] = field(init=False)
    edges: Array = field(init=False)
    points: Array = field(init=False)

    def __post_init__(self) -> None:
        counts = (self.cells[0], self.cells[0] // 2, self.cells[1])
        size = np.array([self.side, self.side / 2, self.length])
        points = np.stack(np.meshgrid(*(np.arange(n + 1.0) for n in counts), indexing="ij"), axis=-1)
        points = points.reshape(-1, 3) * size / counts - [self.side / 2, 0.0, 0.0]
        for name, value in (("counts", counts), ("edges", size / counts), ("points", points)):
            object.__setattr__(self, name, value)

    def corners(self) -> Ints:
        """Return the nodes (m, 8) of all bricks."""
        number = np.arange(len(self.points)).reshape([n + 1 for n in self.counts])
        x, y, z = (np.arange(n) for n in self.counts)
        rows = [number[np.ix_(x + i, y + j, z + k)].ravel() for i, j, k in product((0, 1), repeat=3)]
        return np.stack(rows, axis=1)

    def operators(self) -> tuple[csr_matrix, Array]:
        """Return stiffness (3 n, 3 n), N/m, and lumped mass (n,), kg."""
        cells = self.corners()
        K = brick_stiffness(self.kind, self.edges, self.E, self.nu)
        rows = (3 * cells[:, :, None] + np.arange(3)).reshape(len(cells), -1)
        place = np.repeat(rows, 24, axis=1).ravel(), np.tile(rows, (1, 24)).ravel()
        size = 3 * len(self.points)
        mass = np.bincount(cells.ravel()) * self.rho * float(np.prod(self.edges)) / 8
        return csr_matrix((np.tile(K.ravel(), len(cells)), place), shape=(size, size)), mass

    def end_areas(self) -> Array:
        """Return the area (n,), m2, that each node has in the end z = 0."""
        share = np.ones(len(self.points))
        for i, (low, high) in enumerate(((-0.5, 0.5), (0.0, 0.5))):
            share[np.isclose(self.points[:, i], low * self.side)] *= 0.5
            share[np.isclose(self.points[:, i], high * self.side)] *= 0.5
        return np.asarray(np.where(self.points[:, 2] == 0.0, share * self.edges[0] * self.edges[1], 0.0))


def wall_stress(bar: Bar, speed: float, step: float, start: float, end: float) -> float:
    """Return the mean stress, Pa, of the end z = 0 that stops dead, sampled every step of a window of time.

    Examples
    --------
    >>> bar = Bar(0.019, 0.24, (4, 48), 206e9, 0.29, 7850.0)
    >>> round(wall_stress(bar, 3.0, 2e-7, 14e-6, 80e-6) / 1e6)  # rho c0 v = 120.6 MPa
    121
    """
    K, mass = bar.operators()
    free = np.ones((len(mass), 3))
    free[bar.points[:, 1] == 0.0, 1] = 0.0
    at_wall = bar.points[:, 2] == 0.0
    free[at_wall, 2] = 0.0
    inverse = (free / mass[:, None]).ravel()
    v = (free * [0.0, 0.0, -speed]).ravel()
    u, sums, count, wall = np.zeros_like(v), 0.0, 0, 3 * np.flatnonzero(at_wall) + 2
    for k in range(int(end / step) + 1):
        force = K @ u
        if k * step >= start:
            sums, count = sums + float(force[wall].sum()), count + 1
        v -= step * inverse * force
        u += step * v
    return 2 * sums / count / bar.side**2


def spring_force(
    place: Array, anchor: Array, stiffness: Array, stick: float, f: float
) -> tuple[Array, Array, Array]:
    """Return pull (k, 2) and press (k,), N, of springs under nodes at ``place`` (k, 3), and new anchors.

    ``stiffness`` (k,), N/m, is that along the normal, ``stick`` the ratio of the tangential one to it. Where
    friction f is exceeded, the anchor (k, 2), m, moves with the node.
    """
    press = stiffness * np.maximum(-place[:, 2], 0.0)
    stiff = (stick * stiffness)[:, None]
    pull = stiff * (anchor - place[:, :2])
    pull *= np.minimum(1.0, f * press / np.maximum(np.linalg.norm(pull, axis=1), 1e-30))[:, None]
    return pull, press, place[:, :2] + pull / stiff


def rebound(
    bar: Bar, angle: float, speed: float, f: float, springs: tuple[float, float], time: float
) -> float:
    """Return the normal rebound, m/s, of a bar that flies along its axis onto a plate tilted by ``angle``.

    ``springs`` are their stiffness, N/m3, and the tangential over it; the bar is followed for ``time`` s.

    Examples
    --------
    >>> bar = Bar(0.019, 0.24, (4, 48), 206e9, 0.29, 7850.0)
    >>> [round(rebound(bar, 0.34907, 3.0, f, (2.6e13, 0.1), 2e-4), 1) for f in (0.0, 0.2)]
    [1.4, 1.9]
    """
    K, mass = bar.operators()
    area = bar.end_areas()
    end = np.flatnonzero(area)
    shape = bar.points - mass @ bar.points / mass.sum()
    x = shape @ _turned(angle).T
    x[:, 2] -= x[:, 2].min()
    free = np.ones((len(mass), 3))
    free[bar.points[:, 1] == 0.0, 1] = 0.0
    inverse = free / mass[:, None]
    stiffness = springs[0] * area[end]
    fastest = float(max(stiffness / mass[end]))
    root = np.sqrt(inverse).ravel()
    scaled = csr_matrix(K.multiply(root[:, None]).multiply(root))
    start = np.random.default_rng(0).random(len(root))  # the same step in every run
    fastest += float(eigsh(scaled, 1, v0=start, return_eigenvectors=False, tol=1e-3)[0])
    step = 1 / sqrt(fastest)  # half the largest stable one: springs open and close
    v, anchor = np.tile([-speed * sin(angle), 0.0, -speed * cos(angle)], (len(mass), 1)), x[end][:, :2].copy()
    for _ in range(int(time / step)):
        centre = mass @ x / mass.sum()
        turn = _turned(_attitude(shape, x - centre, mass))
        force = -(K @ ((x - centre) @ turn - shape).ravel()).reshape(-1, 3) @ turn.T
        pull, press, anchor = spring_force(x[end], anchor, stiffness, springs[1], f)
        force[end] += np.column_stack([pull, press])
        v += step * inverse * force
        x += step * v
    return float(mass @ v[:, 2] / mass.sum())


def _turned(angle: float) -> Array:
    """Return the rotation (3, 3) about y by ``angle``, z towards x."""
    return np.array([[cos(angle), 0, sin(angle)], [0, 1, 0], [-sin(angle), 0, cos(angle)]])


def _attitude(shape: Array, x: Array, mass: Array) -> float:
    """Return the angle by which points x (n, 3) are turned from ``shape``, both about the mass centre."""
    along = mass @ (x[:, 0] * shape[:, 0] + x[:, 2] * shape[:, 2])
    return atan2(float(mass @ (x[:, 0] * shape[:, 2] - x[:, 2] * shape[:, 0])), float(along))
