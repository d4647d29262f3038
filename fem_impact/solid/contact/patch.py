"""Contact surfaces of quads and the search for the quad under a point, in the (t, b) plane."""

from typing import NamedTuple

import numpy as np

from fem_impact.arrays import Array, Bools, Ints
from fem_impact.fem.body import MeshedBody
from fem_impact.fem.kernels import inlined, kernel
from meshes import SKIN
from meshes.hexmesh import quad_normals

# a point this far outside the last quad (in its own units) still belongs to it: symmetry plane, round-off
SLACK = 1e-6
LONGEST_WALK = 60


@inlined
def bilinear(xi, eta):  # type: ignore[no-untyped-def]
    """Return the four bilinear weights."""
    return (
        0.25 * (1 - xi) * (1 - eta),
        0.25 * (1 + xi) * (1 - eta),
        0.25 * (1 + xi) * (1 + eta),
        0.25 * (1 - xi) * (1 + eta),
    )


@inlined
def height_from(x, surface, normals, node, t, b):  # type: ignore[no-untyped-def]
    """Return the height n, m, of the surface at the point (t, b), m, as one of its nodes alone gives it.

    That is the node's own height plus ``bend`` (0 to 1/2, see `Patch`) times the rise of the node's tangent
    plane from the node to that point. The surface of a quad is the bilinear mean of its four nodes' heights.
    ``x`` are positions, m; ``normals`` (k, 3) are unit normals at the surface's nodes.
    """
    place, bend, normal = surface.places[node], surface.bend[node], normals[node]
    if bend == 0.0:
        return x[place[2]]
    return x[place[2]] - bend * ((t - x[place[0]]) * normal[0] + (b - x[place[1]]) * normal[1]) / normal[2]


@kernel
def _invert(x, places, quad, t, b):  # type: ignore[no-untyped-def]
    """Return (xi, eta) of the point (t, b) in a quad's projection, by Newton's method."""
    t0, t1 = x[places[quad[0], 0]], x[places[quad[1], 0]]
    t2, t3 = x[places[quad[2], 0]], x[places[quad[3], 0]]
    b0, b1 = x[places[quad[0], 1]], x[places[quad[1], 1]]
    b2, b3 = x[places[quad[2], 1]], x[places[quad[3], 1]]
    xi, eta = 0.0, 0.0
    for _ in range(12):
        w0, w1, w2, w3 = bilinear(xi, eta)
        r_t = t - (w0 * t0 + w1 * t1 + w2 * t2 + w3 * t3)
        r_b = b - (w0 * b0 + w1 * b1 + w2 * b2 + w3 * b3)
        t_xi = 0.25 * ((1 - eta) * (t1 - t0) + (1 + eta) * (t2 - t3))
        b_xi = 0.25 * ((1 - eta) * (b1 - b0) + (1 + eta) * (b2 - b3))
        t_eta = 0.25 * ((1 - xi) * (t3 - t0) + (1 + xi) * (t2 - t1))
        b_eta = 0.25 * ((1 - xi) * (b3 - b0) + (1 + xi) * (b2 - b1))
        det = t_xi * b_eta - t_eta * b_xi
        if det == 0.0:
            break
        d_xi, d_eta = (r_t * b_eta - r_b * t_eta) / det, (t_xi * r_b - b_xi * r_t) / det
        xi = min(max(xi + d_xi, -3.0), 3.0)
        eta = min(max(eta + d_eta, -3.0), 3.0)
        if abs(d_xi) + abs(d_eta) < 1e-12:
            break
    return xi, eta


@kernel
def _way_out(x, places, quad, neighbours, t, b):  # type: ignore[no-untyped-def]
    """Return the edge to leave a quad by: -1 when (t, b) is inside, -2 when only borders lie between.

    Out through the open edge that the point lies farthest outside of; edges turn left around the quad.
    """
    leave, farthest, outside = -1, 0.0, False
    for edge in range(4):
        p, q = quad[edge], quad[(edge + 1) % 4]
        along_t, along_b = x[places[q, 0]] - x[places[p, 0]], x[places[q, 1]] - x[places[p, 1]]
        length = np.sqrt(along_t * along_t + along_b * along_b)
        beyond = ((t - x[places[p, 0]]) * along_b - (b - x[places[p, 1]]) * along_t) / (length * length)
        if beyond > SLACK:
            outside = True
            if neighbours[edge] >= 0 and beyond * length > farthest:
                leave, farthest = edge, beyond * length
    return leave if leave >= 0 or not outside else -2


@kernel
def locate(x, places, quads, neighbours, start, t, b):  # type: ignore[no-untyped-def]
    """Walk from quad ``start`` to the one over (t, b): (quad or -1, xi, eta)."""
    q = start
    for _ in range(LONGEST_WALK):
        edge = _way_out(x, places, quads[q], neighbours[q], t, b)
        if edge == -2:
            return -1, 0.0, 0.0
        if edge == -1:
            xi, eta = _invert(x, places, quads[q], t, b)
            return q, min(max(xi, -1.0), 1.0), min(max(eta, -1.0), 1.0)
        q = neighbours[q, edge]
    return -1, 0.0, 0.0


@kernel
def vertex_normals(x, places, quads, mirrored, normals):  # type: ignore[no-untyped-def]
    """Set unit normals (k, 3) of patch nodes, mirrored at b = 0: means over the corners of the quads around.

    The weights give the exact normal on a sphere, however uneven the quads (Max 1999, J. Graph. Tools 4(2)).
    """
    normals[:] = 0.0
    for q in range(len(quads)):
        for a in range(4):
            i, j, k = quads[q, a], quads[q, (a + 1) % 4], quads[q, (a + 3) % 4]
            ut, ub = x[places[j, 0]] - x[places[i, 0]], x[places[j, 1]] - x[places[i, 1]]
            un = x[places[j, 2]] - x[places[i, 2]]
            wt, wb = x[places[k, 0]] - x[places[i, 0]], x[places[k, 1]] - x[places[i, 1]]
            wn = x[places[k, 2]] - x[places[i, 2]]
            scale = 1.0 / ((ut * ut + ub * ub + un * un) * (wt * wt + wb * wb + wn * wn))
            normals[i, 0] += scale * (ub * wn - un * wb)
            normals[i, 1] += scale * (un * wt - ut * wn)
            normals[i, 2] += scale * (ut * wb - ub * wt)
    for i in range(len(normals)):
        if mirrored[i]:
            normals[i, 1] = 0.0
        length = np.sqrt(normals[i, 0] ** 2 + normals[i, 1] ** 2 + normals[i, 2] ** 2)
        normals[i, 0] /= length
        normals[i, 1] /= length
        normals[i, 2] /= length


@kernel
def lowest_gap(x, nodes, surface, normals, last, sign):  # type: ignore[no-untyped-def]
    """Return the smallest height of nodes (k, 3) over a surface (``sign`` 1) or under it (-1); else inf."""
    gap = np.inf
    for i in range(len(nodes)):
        t, b, n = x[nodes[i, 0]], x[nodes[i, 1]], x[nodes[i, 2]]
        q, xi, eta = locate(x, surface.places, surface.quads, surface.neighbours, max(last[i], 0), t, b)
        if q < 0:
            continue
        w, height = bilinear(xi, eta), 0.0
        for a in range(4):
            node = surface.quads[q, a]
            height += w[a] * height_from(x, surface, normals, node, t, b)
        gap = min(gap, sign * (n - height))
    return gap


# a node is on an edge, not on a rounding, where a quad leans more than this from the mean of those around
EDGE = np.cos(np.radians(30.0))
STEEP = 0.1  # a normal that rises less is that of a side: no such quad takes part, and no such node is bent


class Patch(NamedTuple):
    """Part of a skin that may touch (a named tuple, so that compiled code reads it by name).

    Attributes
    ----------
    places : (k, 3) int64, unknowns of the patch nodes
    quads : (m, 4) int64, patch node numbers, all turning the same way seen from above the barrier
    neighbours : (m, 4) int64, quad across edge i -> i + 1, or -1 at the border
    mirrored : (k,) bool, nodes on the symmetry plane
    bend : (k,) share of the slope at a node that bends the quads around it: 0 leaves them flat, with 1/2 they
        follow a round surface to third order (Boubekeur and Alexa 2008, ACM Trans. Graph. 27(5), 141)
    sag : how far bent quads may reach beyond their nodes, m
    """

    places: Ints
    quads: Ints
    neighbours: Ints
    mirrored: Bools
    bend: Array
    sag: float

    def rounded(self, x: Array) -> "Patch":
        """Return the patch with its quads bent to a round surface at positions ``x``, save at edges."""
        around = np.zeros((len(self.places), 3))
        vertex_normals(x, self.places, self.quads, self.mirrored, around)
        corners = x[self.places[self.quads]]
        flat = quad_normals(corners)
        flat /= np.linalg.norm(flat, axis=1)[:, None]
        least = np.ones(len(around))
        np.minimum.at(least, self.quads, np.einsum("qi,qai->qa", flat, around[self.quads]))
        bend = np.where((least > EDGE) & (around[:, 2] > STEEP), 0.5, 0.0)
        return self._replace(bend=bend, sag=_sag(corners, around[self.quads], bend[self.quads]))


def facing_skin(body: MeshedBody) -> Ints:
    """Return the skin quads (m, 4) of the cells that may touch, all nodes free, facing the other body."""
    quads = body.mesh.faces_with(SKIN)
    normal = quad_normals(body.points[quads])
    steep = normal[:, 2] / np.linalg.norm(normal, axis=1)
    facing = steep < -STEEP if body.name == "rod" else steep > STEEP
    touching = body.mesh.finest if body.touching is None else body.touching
    near = np.isin(quads, body.mesh.cells[touching]).all(axis=1)
    # rod quads look down: turn them so that both patches turn the same way seen from above
    chosen = quads[facing & near & ~body.mesh.is_hanging[quads].any(axis=1)]
    return np.asarray(chosen[:, ::-1] if body.name == "rod" else chosen)


def make_patch(quads: Ints, places: Ints, points: Array) -> Patch:
    """Build from skin quads (m, 4) of a mesh with node ``places`` (n, 3) and ``points`` (n, 3)."""
    used, local = np.unique(quads, return_inverse=True)
    numbers = np.ascontiguousarray(local.reshape(-1, 4), dtype=np.int64)
    mirrored, flat = np.abs(points[used, 1]) < 1e-12, np.zeros(len(used))
    return Patch(places[used], numbers, edge_neighbours(numbers), mirrored, flat, 0.0)


def edge_neighbours(quads: Ints) -> Ints:
    """Return (m, 4) the quad on the other side of each edge, -1 where there is none."""
    edges = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    key = np.sort(edges, axis=1) @ np.array([quads.max() + 1, 1])
    order = np.argsort(key, kind="stable")
    pairs = np.flatnonzero(np.diff(key[order]) == 0)
    result = np.full(len(key), -1, dtype=np.int64)
    first, second = order[pairs], order[pairs + 1]
    result[first], result[second] = second // 4, first // 4
    return result.reshape(-1, 4)


def _sag(corners: Array, normals: Array, bend: Array) -> float:
    """Bound of a rounded quad's bulge, m.

    Half of `bend` times the largest height of a corner's tangent plane over another corner.
    """
    apart = corners[:, None, :, :] - corners[:, :, None, :]
    share = np.divide(bend, normals[:, :, 2], out=np.zeros_like(bend), where=bend > 0)
    return float(0.5 * np.max(share[:, :, None] * np.abs(np.einsum("qabi,qai->qab", apart, normals))))


def nearest_quads(x: Array, patch: Patch, other: Patch) -> Ints:
    """Return for each node of ``patch`` the quad of ``other`` with the nearest centre in (t, b)."""
    centres = x[other.places[other.quads]][:, :, :2].mean(axis=1)
    nodes = x[patch.places][:, :2]
    return np.array([int(np.argmin(((centres - p) ** 2).sum(axis=1))) for p in nodes], dtype=np.int64)
