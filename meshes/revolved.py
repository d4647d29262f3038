"""A body of revolution as it is meshed: its half plane, the rims of a disc, its section, cells across it."""

from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from meshes.common import BoolArray, FloatArray, MeshError
from meshes.section import WIDEST, Section, bored_section, section
from meshes.shoulders import eased
from meshes.surface import CORNER, TurnedSurface

AXIAL = np.deg2rad(89.99)  # steeper than this from the radial direction, a rounding has come to the side
LARGE = 1.5  # cells across a rounding from which on two chamfers follow it


def without_roundings(line: FloatArray, pitch: float) -> FloatArray:
    """Return the outline (k, 2) (rho, z), m, of a body with two flat faces, its rims without roundings.

    It is ``line`` itself where no rim is round. A rounding that is larger than a cell, ``pitch`` m wide,
    becomes a chamfer, or two, whose ends lie on it; a smaller one an edge, as a chamfer would be a row of
    slivers.
    """
    new = line
    for _ in range(2):  # the rim of the face at the tip, then that of the tail, both as it were a tip
        new = upside_down(_sharp(new, pitch))
    return line if len(new) == len(line) else new


def upside_down(line: FloatArray) -> FloatArray:
    """Return an outline (k, 2) (rho, z), m, from its tail on."""
    return np.stack([line[::-1, 0], line[-1, 1] - line[::-1, 1]], axis=1)


def without_shoulders(
    line: FloatArray, bore: FloatArray, across: int
) -> tuple[FloatArray, FloatArray, list[float]]:
    """Return both surfaces, (k, 2) and (j, 2) (rho, z), m, with cones for shoulders, and their heights."""
    beside = np.interp(bore[:, 1], line[:, 1], line[:, 0])
    outer, of_outline = eased(line, 2.0 * line[:, 0] / across)
    inner, of_bore = eased(bore, 2.0 * beside / across)
    return outer, inner, [*of_outline, *of_bore]


def _sharp(line: FloatArray, pitch: float) -> FloatArray:
    """Return the outline without the rounding at the edge of the face at z = 0, if there is one."""
    first = int(np.flatnonzero(line[:, 1] <= 0.0)[-1])
    rho, z = np.diff(line[first:], axis=0).T
    angle = np.concatenate([[0.0], np.arctan2(z, rho)])  # of the face, then of all steps behind it
    smooth = (np.abs(np.diff(angle)) < CORNER) & (angle[1:] < AXIAL)
    count = int(np.argmin(np.append(smooth, False)))
    if count < 2:
        return line
    rounding = line[first : first + count + 1]
    size = float(np.linalg.norm(rounding[-1] - rounding[0]))
    middle = int(np.searchsorted(angle[1 : count + 1], 0.5 * angle[count]))
    kept = rounding[[0, -1] if size < LARGE * pitch else [0, middle, -1]]
    if size < pitch:
        kept = np.array([[rounding[-1, 0], 0.0]])
    return np.concatenate([line[:first], kept, line[first + count + 1 :]])


SAME = 1e-9  # relative difference of radii and heights of slices that count as equal
# Of a stack: most cells over the diameter that its thickness asks for; by how much the surface may stand out
# over the chords of its cells, over the least edge of a cell, so that split cells do not fold
MOST = 40
SAGITTA = 0.25


@dataclass(frozen=True, slots=True)
class Revolved:
    """A body of revolution in its half plane.

    Attributes
    ----------
    line, bore : (k, 2) outer and inner surface, (rho, z), m; a body without a bore has no rows
    exact : (j, 2) outer surface, m, where the rims of ``line`` stand for roundings; else ``line``
    half : section; across : cells over the diameter, of a stack no fewer than asked for, see `revolved`
    """

    line: FloatArray
    bore: FloatArray
    exact: FloatArray
    half: Section
    across: int

    @property
    def length(self) -> float:
        """Length, m."""
        return float(self.line[-1, 1])

    @property
    def hollow(self) -> FloatArray:
        """(j, 2) inner surface with the flat faces that close it, (rho, z), m."""
        first, last = self.bored_from_to
        front = [[0.0, first]] if first > 0.0 else []
        rear = [[0.0, last]] if last < self.length else []
        return np.array([*front, *self.bore, *rear])

    @property
    def bored_from_to(self) -> tuple[float, float]:
        """Heights at which a bore begins and ends, m; without one, infinitely far from both ends."""
        return (float(self.bore[0, 1]), float(self.bore[-1, 1])) if len(self.bore) else (np.inf, -np.inf)

    @property
    def is_stack(self) -> bool:
        """Whether sections alone fill it: it is no longer than wide and flat at both ends, up to edges."""
        face = self.line[1] - self.line[0], self.line[2:3] - self.line[1]
        if self.line[-1, 0] <= 0.0 or face[0][1] > 0.0 or self.length > 2.0 * self.line[:, 0].max():
            return False
        sides = np.diff(self.line[1:], axis=0)
        leans = np.arctan2(sides[[0, -1], 1], np.abs(sides[[0, -1], 0]))
        return bool((leans > CORNER).all())

    @property
    def plates(self) -> list[tuple[float, float]]:
        """Heights (from, to), m, between which it bends as a plate: it, or the faces that close its bore."""
        first, last = self.bored_from_to
        if (first <= 0.0 and last >= self.length) or not len(self.bore):
            return [(0.0, self.length)]
        return [(low, high) for low, high in ((0.0, first), (last, self.length)) if low < high]

    @property
    def wall(self) -> float:
        """Least thickness of the wall along a bore, m; without one, infinite."""
        if not len(self.bore):
            return np.inf
        inner, z = self._along_bore().T
        return float((self.radius(z) - inner).min())

    def require_wall(self) -> None:
        """Refuse a wall along the bore that is thinner than a section can hold (MeshError)."""
        inner, z = self._along_bore().T
        # beside the flat faces at both ends
        outer = self.radius(np.clip(z, 1e-9 * self.length, (1.0 - 1e-9) * self.length))
        at = int(np.argmax(inner / outer))
        if inner[at] > (WIDEST + SAME) * outer[at]:
            raise MeshError(
                f"a wall of {1.0 - inner[at] / outer[at]:.3g} of the outer radius, {outer[at]:.4g} m, at z = "
                f"{z[at]:.4g} m is too thin for cells: give {1.0 - WIDEST:.2g} of it or more"
            )

    def _along_bore(self) -> FloatArray:
        """Return (k, 2) radius of the bore and height, m, wherever one of both surfaces has a point."""
        first, last = self.bored_from_to
        between = self.line[(self.line[:, 1] > first) & (self.line[:, 1] < last), 1]
        inner = np.interp(between, self.bore[:, 1], self.bore[:, 0])
        return np.concatenate([self.bore, np.stack([inner, between], axis=1)])

    def radius(self, z: FloatArray) -> FloatArray:
        """(n,) outer radius at heights z (n,), m."""
        return np.asarray(np.interp(np.maximum(z, 0.0), self.line[:, 1], self.line[:, 0]))

    def pitch(self, z: FloatArray) -> FloatArray:
        """(n,) wanted height of the cells, m."""
        radius = np.maximum(self.radius(z), 1e-3 * self.line[:, 0].max())
        return np.asarray(2.0 * radius / self.across)

    def split_radius(self, z: FloatArray) -> FloatArray:
        """(n,) radius of the circle along which a bore runs; beyond its ends, of as large a share."""
        outer = self.radius(z)
        if not len(self.bore):
            return self.half.plug * outer
        first, last = self.bore[0], self.bore[-1]
        share = np.array([first[0], last[0]]) / self.radius(np.array([first[1], last[1]]))
        inside = np.interp(z, self.bore[:, 1], self.bore[:, 0])
        return np.where(z < first[1], share[0] * outer, np.where(z > last[1], share[1] * outer, inside))

    def bored(self, low: FloatArray, high: FloatArray) -> BoolArray:
        """(n,) whether cells between these heights lie along the bore."""
        if not len(self.bore):
            return np.zeros(len(low), dtype=bool)
        first, last = self.bored_from_to
        middle = 0.5 * (low + high)
        return np.asarray((middle > first) & (middle < last))

    @property
    def surface(self) -> TurnedSurface:
        """All of the surface, the flat face at the tail included."""
        first, last = self.bored_from_to
        start = self.bore[:1] if first <= 0.0 else self.line[:1]  # a face begins beside the hole
        end = self.bore[-1:] if last >= self.length else np.array([[0.0, self.length]])
        line = self.exact[1:] if self.line[-1, 0] > 0.0 else self.exact[1:-1]
        outer = np.concatenate([start, line, end])
        return TurnedSurface((outer, self.hollow) if len(self.bore) else (outer,))


def revolved(line: FloatArray, bore: FloatArray | None, across: int) -> Revolved:
    """Return the body with the section that fits its bore.

    Parameters
    ----------
    line, bore : (k, 2) float64, m
        Outer and inner surface; their shoulders become cones, see `meshes.shoulders.eased`.
    across : int
        Cells over the diameter, at least: a stack, see `is_stack`, has as many as make cells about as wide as
        half its thickness, and as make it round beside its layers and its wall.

    Raises
    ------
    MeshError
        If the outline bounds no body, or the bore leaves too thin a wall or too small a core.
    """
    if line.ndim != 2 or line.shape[1] != 2 or not line[-1, 1] > 0.0 or np.any(np.diff(line[:, 1]) < 0.0):
        raise MeshError("an outline needs rows (rho, z) with z growing from 0 at the tip to the tail")
    same = SAME * line[:, 0].max()  # heights, m
    if np.any(np.diff(line[line[:, 1] <= same, 0]) <= 0.0):
        raise MeshError(
            "the radius of the flat face at the tip shrinks at z = 0: give its points from the axis out"
        )
    if np.any(np.diff(line[line[:, 1] >= line[-1, 1] - same, 0]) >= 0.0):
        raise MeshError(
            f"the radius of the flat face at the tail grows at z = {line[-1, 1]:.6g} m: give its points from "
            "the edge in, without a rim of no thickness"
        )
    face, tail = line[:, 1] <= 0.0, line[:, 1] >= line[-1, 1]
    line = np.concatenate([line[:1], line[face][1:][-1:], line[~face & ~tail], line[tail][:1]])
    inner = np.zeros((0, 2)) if bore is None else np.array(bore, np.float64)
    line, inner, _ = without_shoulders(line, inner, across)
    exact, radius = line, float(line[:, 0].max())
    if line[-1, 0] > 0.0 and line[-1, 1] < (2.0 / 3.0 + 0.6 / across) * radius:  # no nose fits in
        line = without_roundings(line, 2.0 * radius / across)
    plain = Revolved(line, inner, exact, section(across), across)
    if plain.is_stack:
        # the cells over the diameter of a stack, no fewer than the body has
        thinnest = min(high - low for low, high in plain.plates)
        least = 0.5 * min(thinnest, plain.wall)
        cubes = min(2.0 * radius / (0.5 * thinnest), MOST)
        # cells between two circles, n over the diameter, stand out by R pi^2 / (8 n^2) over their chords
        even = np.sqrt(np.pi**2 / 8.0 * radius / (SAGITTA * least))
        across = max(plain.across, 2 * ceil(0.5 * max(cubes, float(even)) - 1e-9))
    if bore is None:
        return replace(plain, half=section(across), across=across)
    front = np.interp(max(inner[0, 1], 1e-9 * line[-1, 1]), line[:, 1], line[:, 0])
    made = replace(plain, half=bored_section(across, float(inner[0, 0] / front)), across=across)
    made.require_wall()
    return made
