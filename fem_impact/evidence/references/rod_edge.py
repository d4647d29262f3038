"""How far the rounded edge of a rod differs from a half-space on a beam: its static flexibility.

A rod that strikes obliquely touches with its rounded edge. Hertz' half-space and the beam behind it both miss
the corner itself. A short free rod with such an edge (an exact body of revolution) is loaded on an ellipse by
Hertz' pressure, along the normal n and along t, and balanced by its own inertia. Its displacements are a
Fourier series around the axis; each order is a plane problem (quadratic triangles, graded towards the
contact). The mean displacement under the load over the force is, as a matrix in n and t,

    C = diag(C_n, C_t) + B + X / (E R),

with the half-space's C_n, C_t, the flexibility B of a free beam (`beam`) whose end lies where a flat end
gives the rod its volume, and the excess X of the edge: -0.8 along n, 2 to 3 along t, which shears the corner.
"""

from dataclasses import dataclass
from functools import cache
from math import ceil, cos, pi, sin

import numpy as np
import skfem
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu
from scipy.special import j1
from skfem.helpers import dot, grad

from fem_impact.arrays import Array, Ints
from fem_impact.evidence.references.free_modes import free_bar_flexibility
from fem_impact.evidence.references.hertz import patch_compliance

LENGTH = 8.0  # radii of the rod that is computed; 5 and 12 move X by 0.02
FINEST, GRADING = 3.0, 0.5  # cells over the patch's shorter half-axis; cell size over distance from it
COARSEST = 0.5  # cells far away
ORDERS = 8.0  # last order times the patch's half-width; 20 moves X by 0.002
QUADRATURE = 16  # of the load, whose edge is a square root
R, Z, AROUND = 0, 1, 2  # components


def lost_length(edge: float) -> float:
    """Return by how much a rod with an edge of radius ``edge`` is longer than a flat one of its volume.

    Both over the rod's radius: a square ring less a quarter disc, by Pappus.

    Examples
    --------
    >>> round(lost_length(1.0), 4), round(9.5 * lost_length(3 / 9.5), 3)  # half a ball, 3 mm on 9.5 mm
    (0.3333, 0.378)
    """
    centroid = 1 - edge * (10 - 3 * pi) / (12 - 3 * pi)
    return (2 - pi / 2) * edge**2 * centroid


def _start(edge: float) -> tuple[Array, Ints]:
    """Return points (2, n) and triangles (3, m) of a rectangle whose last cell at the edge is cut inwards."""
    r = np.append(np.linspace(0.0, 1 - edge, 1 + ceil((1 - edge) / COARSEST)), 1.0)
    z = np.append(0.0, np.linspace(edge, LENGTH, 1 + ceil((LENGTH - edge) / COARSEST)))
    points = np.stack(np.meshgrid(np.unique(r), z, indexing="ij")).reshape(2, -1)
    number = np.arange(points.shape[1]).reshape(-1, len(z))
    corners = ((0, 0), (1, 0), (0, 1), (1, 1))
    inner, out, up, both = (number[i : len(number) - 1 + i, j : len(z) - 1 + j].ravel() for i, j in corners)
    return points, np.concatenate([[inner, out, up], [out, both, up]], axis=1)


def _rounded(mesh: skfem.MeshTri, edge: float) -> skfem.MeshTri:
    """Return the mesh with its outer points at the edge moved onto the arc."""
    outer = mesh.boundary_nodes()
    arm = mesh.p[:, outer] - _centre(edge)
    at = (arm[0] > -1e-12) & (arm[1] < 1e-12) & (mesh.p[0, outer] > 1e-12)
    points = mesh.p.copy()
    points[:, outer[at]] = _centre(edge) + edge * arm[:, at] / np.hypot(*arm[:, at])
    return skfem.MeshTri(points, mesh.t)


def _centre(edge: float) -> Array:
    """Return the centre (2, 1) of the arc in the plane (r, z)."""
    return np.array([[1 - edge], [edge]])


def _mesh(edge: float, angle: float, finest: float) -> skfem.MeshTri:
    """Return the meridian plane, graded towards the point of the arc where the normal leans by ``angle``."""
    mesh = _rounded(skfem.MeshTri(*_start(edge)), edge)
    touch = _centre(edge) + edge * np.array([[sin(angle)], [-cos(angle)]])
    while True:
        corners = mesh.p[:, mesh.t]
        size = np.hypot(*(corners - np.roll(corners, 1, axis=1))).max(axis=0)
        away = np.hypot(*(corners - touch[:, :, None])).min(axis=0)
        coarse = np.flatnonzero(size > np.clip(GRADING * away, finest, COARSEST * 1.5))
        if not coarse.size:
            return mesh
        mesh = _rounded(mesh.refined(coarse), edge)


@skfem.BilinearForm
def _elastic(u, v, w):  # type: ignore[no-untyped-def]
    """Give r times stress by strain of u cos(m phi), u_phi sin(m phi), of order ``w.m``, E = 1."""
    r, m = w.x[0], w.m

    def strain(y):  # type: ignore[no-untyped-def]
        g, hoop = grad(y), (y[R] + m * y[AROUND]) / r
        turn = g[AROUND, 0] - (m * y[R] + y[AROUND]) / r
        return (g[R, 0], g[Z, 1], hoop), (g[R, 1] + g[Z, 0], turn, g[AROUND, 1] - m * y[Z] / r)

    (direct, shear), (virtual, sheared) = map(strain, (u, v))
    G, lame = 1 / (2 + 2 * w.nu), w.nu / ((1 + w.nu) * (1 - 2 * w.nu))
    along = sum(a * b for a, b in zip(direct, virtual, strict=True))
    across = sum(a * b for a, b in zip(shear, sheared, strict=True))
    return r * (lame * sum(direct) * sum(virtual) + 2 * G * along + G * across)


@skfem.BilinearForm
def _inertia(u, v, w):  # type: ignore[no-untyped-def]
    return w.x[0] * dot(u, v)


@dataclass(frozen=True, slots=True)
class _Patch:
    """An ellipse on the arc: half-axes, m, along the meridian and around; rod of radius 1.

    The pressure of a unit force is 3 / (2 pi a b) sqrt(1 - (s / a)^2 - (r phi / b)^2).
    """

    edge: float
    angle: float
    along: float
    around: float

    def load(self, skin: skfem.FacetBasis, order: int) -> Array:
        """Return the loads (size, 2) of unit forces along n and t in one order."""
        n, t = (-sin(self.angle), cos(self.angle)), (cos(self.angle), sin(self.angle))
        return np.stack([self._load(skin, order, *towards) for towards in (n, t)], axis=1)

    def _load(self, skin: skfem.FacetBasis, order: int, across: float, along: float) -> Array:
        """Return the load of a force with parts away from the axis, and along it away from the tip."""

        @skfem.LinearForm
        def form(v, w):  # type: ignore[no-untyped-def]
            less, same, more = (self._spread(w.x, abs(k)) for k in (order - 1, order, order + 1))
            sideways = 0.5 * ((less + more) * v[R] - (less - more) * v[AROUND])
            return w.x[0] * (across * sideways + along * same * v[Z])

        load: Array = form.assemble(skin)
        return load

    def _spread(self, x: Array, order: int) -> Array:
        """Return the integral over phi of the pressure times cos(order phi), at points x (2, ...)."""
        arm = x - _centre(self.edge)[:, :, None]
        s = self.edge * (np.arctan2(arm[0], -arm[1]) - self.angle)
        half = self.around / x[0] * np.sqrt(np.maximum(1 - (s / self.along) ** 2, 0.0))
        bend = order * half
        mean = np.where(bend > 1e-6, j1(bend) / np.maximum(bend, 1e-6), 0.5)
        return np.asarray(1.5 / (self.along * self.around**2) * x[0] * half**2 * mean)


@dataclass(frozen=True, slots=True)
class _EdgeBody:
    """The rod's operators: stiffness by powers of the order, inertia; each unknown's component."""

    basis: skfem.CellBasis
    stiffness: tuple[csr_matrix, csr_matrix, csr_matrix]
    inertia: csr_matrix
    component: Ints

    @classmethod
    def of(cls, mesh: skfem.MeshTri, nu: float) -> "_EdgeBody":
        """Assemble; stiffness is quadratic in the order."""
        basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTriP2(), 3), intorder=5)
        none, one, two = (_elastic.assemble(basis, m=float(m), nu=nu) for m in range(3))
        square = (two - 2 * one + none) / 2
        component = np.zeros(basis.N, dtype=np.int64)
        for i in (Z, AROUND):
            component[basis.get_dofs(elements=True).all(f"u^{i + 1}")] = i
        return cls(basis, (none, one - none - square, square), _inertia.assemble(basis), component)

    def moves(self, order: int) -> Ints:
        """Return the unknowns that may move: on the axis only what is smooth there does."""
        axis, smooth = self.basis.doflocs[0] < 1e-12, {0: self.component == Z, 1: self.component != Z}
        free = ~axis | smooth.get(order, np.zeros(self.basis.N, dtype=bool))
        return np.flatnonzero(free & ((order > 0) | (self.component != AROUND)))

    def rigid(self, order: int) -> Array:
        """Return rigid motions (size, k): along the axis; across it and about it."""
        i, (_, z) = self.component, self.basis.doflocs
        if order == 0:
            return np.eye(3)[i][:, [Z]]
        sideways = np.array([1.0, 0.0, -1.0])[i]
        turning = np.where(i == Z, -self.basis.doflocs[0], z * sideways)
        return np.stack([sideways, turning], axis=1) if order == 1 else np.zeros((len(i), 0))

    def displaced(self, order: int, load: Array) -> Array:
        """Return what loads (size, k) work on the displacements by each other (k, k), balanced by inertia."""
        rigid = self.rigid(order)
        pulled = self.inertia @ rigid
        balanced = load - pulled @ np.linalg.solve(rigid.T @ pulled, rigid.T @ load)
        moving = self.moves(order)
        # nothing pulls at what holds the rigid motions: one or two unknowns far apart
        if order < 2:
            along = moving[self.component[moving] == (Z if order == 0 else R)]
            height = self.basis.doflocs[1, along]
            moving = np.setdiff1d(moving, along[[height.argmin(), height.argmax()]][: order + 1])
        K = sum(order**i * part for i, part in enumerate(self.stiffness)) * (2 * pi if order == 0 else pi)
        u = splu(K[moving][:, moving].tocsc()).solve(balanced[moving])
        return np.asarray(balanced[moving].T @ u)


@cache
def edge_excess(
    nu: float, edge: float, angle: float, patches: tuple[tuple[float, float], ...]
) -> tuple[Array, ...]:
    """Return the excess X (2, 2) in n and t for each patch; lengths over the rod's radius.

    Parameters
    ----------
    edge : radius of the arc; angle : rad, of the rod's axis to n
    patches : half-axes of ellipses, along the meridian and around the rod

    Examples
    --------
    >>> edge_excess(0.29, 0.316, 0.785, ((0.08, 0.2),))[0].round(1)
    array([[-0.8, -0.3],
           [-0.3,  2.1]])
    """
    finest = min(min(patch) for patch in patches)
    mesh = _mesh(edge, angle, finest / FINEST)
    body, touch = _EdgeBody.of(mesh, nu), _centre(edge)[:, 0] + edge * np.array([sin(angle), -cos(angle)])
    reach = 1.5 * max(along for along, _ in patches)
    near = mesh.facets_satisfying(lambda x: np.hypot(*(x.T - touch).T) < reach, boundaries_only=True)
    skin = skfem.FacetBasis(mesh, body.basis.elem, facets=near, intorder=QUADRATURE)
    total: Array = np.zeros((2 * len(patches),) * 2)
    for order in range(ceil(ORDERS / min(around for _, around in patches))):
        loads = [_Patch(edge, angle, *patch).load(skin, order) for patch in patches]
        total += body.displaced(order, np.concatenate(loads, axis=1))
    lost = lost_length(edge)
    beam = free_bar_flexibility(nu, LENGTH - lost, angle, (float(touch[0]), float(touch[1]) - lost))
    compliances = [total[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] for i in range(len(patches))]
    return tuple(
        C - beam - np.diag(patch_compliance(nu, *p)) for C, p in zip(compliances, patches, strict=True)
    )
