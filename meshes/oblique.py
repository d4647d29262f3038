"""Bodies whose axis is oblique in their file: their axis, stated or found, and their plane of symmetry."""

from dataclasses import dataclass

import numpy as np

from meshes.common import FloatArray, IntArray, MeshError
from meshes.gauss import gauss_points
from meshes.halving import across, from_images
from meshes.symmetry import NEAR

#: Where a tip points in a file: an axis of it, see `TIPS`, one of `FOUND`, or a direction.
Tip = str | tuple[float, float, float]
FOUND = ("-axis", "+axis")  # the axis of least inertia, its tip to falling or to rising z
ALIKE = 0.05  # of the larger: moments of inertia that differ by less leave a body without an axis
ON = 1e-6  # cosine up to which a direction is square to an axis
ODD = 1e-3  # of their scale: odd moments of a symmetric body may be so large, its mesh is not symmetric


@dataclass(frozen=True, slots=True)
class _Masses:
    """Weights (k,) and places (k, 3) of the Gauss points of a body, about the centre of its volume."""

    weight: FloatArray
    place: FloatArray
    centre: FloatArray

    @classmethod
    def of(cls, points: FloatArray, cells: IntArray) -> "_Masses":
        weight, place = gauss_points(points, cells)
        weight, place = np.abs(weight).ravel(), place.reshape(-1, 3)  # cells may be inside out
        centre = weight @ place / weight.sum()
        return cls(weight, place - centre, centre)

    def axis(self) -> FloatArray:
        """Return the unit vector (3,) about which the moment of inertia is least."""
        second = np.einsum("k,ki,kj->ij", self.weight, self.place, self.place)
        spread, vectors = np.linalg.eigh(second)
        inertia = spread.sum() - spread
        if inertia[1] - inertia[2] < ALIKE * inertia[1]:
            raise MeshError(
                "has no axis of its own: its two least moments of inertia differ by less than "
                f"{100 * ALIKE:g} %. State where its tip points, as a direction: mesh_tip = [0, 0, -1]."
            )
        return np.asarray(vectors[:, 2])

    def principal(self, u: FloatArray, v: FloatArray) -> float:
        """Return the angle, rad from u, at which the second moment of the sections is extreme."""
        a, b = self.place @ u, self.place @ v
        return 0.5 * float(np.arctan2(2 * (self.weight @ (a * b)), self.weight @ (a * a - b * b)))

    def odd(self, normal: FloatArray, down: FloatArray) -> float:
        """Return the largest moment that a plane of symmetry with that normal makes vanish, over its scale.

        They are those of first and third order in the distance from the plane.
        """
        other = np.cross(normal, down)
        a, b, c = (self.place @ one for one in (normal, other, down))
        pairs = ((b,), (c,), (a, a), (b, b), (c, c), (b, c))
        sums = []
        for factors in pairs:
            terms = self.weight * a * np.prod(factors, axis=0)
            sums.append(abs(terms.sum()) / np.abs(terms).sum())
        return float(max(sums))


def is_oblique(tip: Tip | None) -> bool:
    """Return whether a tip is stated by a direction or to be found, and not by an axis of the file."""
    return isinstance(tip, tuple) or tip in FOUND


def stood_up(
    points: FloatArray, cells: IntArray, tip: Tip, whole: bool
) -> tuple[FloatArray, FloatArray, str]:
    """Return the turn and the origin with which ``(points - origin) @ turn.T`` has its tip at -z.

    A whole body is turned about its axis until the plane y = 0 is one of symmetry, and its centre moved
    there. A part of one is turned about the origin of the file alone: the y axis stays what it is, as far as
    the direction of the tip allows.

    Parameters
    ----------
    points : (n, 3) float64
    cells : (m, 8) int64, hexahedra
    tip : one of `FOUND`, or a direction in the file
    whole : bool

    Returns
    -------
    turn : (3, 3) float64, rows are x, y and z of the body
    origin : (3,) float64
    told : a sentence about what was done

    Raises
    ------
    MeshError
        If the direction is none, or the body has no axis of least inertia.
    """
    masses = _Masses.of(points, cells)
    if isinstance(tip, tuple):
        down, found = np.array(tip, dtype=np.float64), ""
        length = float(np.linalg.norm(down))
        if not (np.isfinite(length) and length > 0.0):
            raise MeshError(f"cannot point along {list(tip)}: a direction is three numbers, not all zero.")
        down = down / length
    else:  # to falling z, or y or x where the axis is square to z; to rising of "+axis"
        down, found = masses.axis(), ", the axis of least inertia"
        last = [part for part in down if abs(part) > ON][-1]
        down = down * (-np.sign(last) if tip == "-axis" else np.sign(last))
    # the axis of the file that is y, or x where the tip points along y
    turn = _turn(down, np.asarray(np.eye(3)[0 if abs(down[1]) > 1.0 - ON else 1]))
    if whole:
        turn = _turn(down, _normal(points, cells, masses, turn))
    told = (
        f"its tip points along {_text(down)} of the file{found}; its plane of symmetry is square to "
        f"{_text(turn[1])}"
    )
    return turn, masses.centre if whole else np.zeros(3), told


def _turn(down: FloatArray, normal: FloatArray) -> FloatArray:
    """Return rows x, y and z of a body whose tip points along ``down``; y is about ``normal``."""
    y = normal - (normal @ down) * down
    y /= np.linalg.norm(y)
    return np.array([np.cross(y, -down), y, -down])


def _normal(points: FloatArray, cells: IntArray, masses: _Masses, turn: FloatArray) -> FloatArray:
    """Return the normal of a plane of symmetry: one of the mesh, else of the body, as near to y as can be.

    Planes through nodes on the widest ring of the mesh, or halfway between two of them, are all that can be
    planes of symmetry of its nodes; of those the one that cuts the fewest cells is taken.
    """
    used = points[np.unique(cells)] - masses.centre
    near = NEAR * float(np.ptp(used @ turn[:2].T, axis=0).max())
    own = masses.principal(turn[0], turn[1])
    few = [0.5 * np.pi, own, own + 0.5 * np.pi]  # from x to the normal; the first is y itself
    x, y, z = (used @ turn.T).T
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    outer = np.flatnonzero(radius > radius.max() - near)
    first = outer[np.argmin(z[outer])]
    ring = outer[np.abs(z[outer] - z[first]) < near]
    angles = np.array([*few, *(0.5 * (angle[ring] + angle[first]) + 0.5 * np.pi)]) % np.pi
    angles = angles[np.argsort(np.abs(angles - 0.5 * np.pi), kind="stable")]
    distinct = angles[np.append(True, np.abs(np.diff(angles)) > ON)]
    mirrored = [one for one in distinct if (from_images(used, _at(turn, one)) < 2.0 * near).all()]
    if mirrored:
        away = [(points - masses.centre) @ _at(turn, one) for one in mirrored]
        return _at(turn, mirrored[int(np.argmin([across(one, cells, near).sum() for one in away]))])
    odd = [masses.odd(_at(turn, one), -turn[2]) for one in few]
    return _at(turn, few[0] if odd[0] < ODD else few[int(np.argmin(odd))])


def _at(turn: FloatArray, angle: float) -> FloatArray:
    """Return the unit vector at an angle from x towards y of a body."""
    return np.asarray(np.cos(angle) * turn[0] + np.sin(angle) * turn[1])


def _text(direction: FloatArray) -> str:
    return "(" + ", ".join(f"{part + 0.0:.4g}" for part in direction.round(6)) + ")"
