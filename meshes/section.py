"""The half O-grid of a round section: a bulged square core, inner rings, and one outer ring."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from meshes.common import FloatArray, IntArray, MeshError

# Proportions with the longest stable step of nose and body together at 8 cells across, from a scan.
CORE = 0.43
BULGE = 0.25
PLUG = 0.75
# Radius of a bore over that of the body: a smaller one leaves slivers around it, a larger one in the wall
SLIMMEST, WIDEST = 0.2, 0.95


@dataclass(frozen=True, slots=True)
class Section:
    """Half a unit disc, y >= 0; the outer circle's nodes come last.

    Attributes
    ----------
    unit : (n, 2) float64
        Positions of the nodes.
    quads : (k, 4) int64
        Cells, counter-clockwise; those inside the circle of radius `plug` first.
    plug : float
        Radius of the circle inside the outer ring.
    inner : float
        Inner radius, on the symmetry plane, of the ring inside that circle, over the circle's radius.
    plug_nodes, plug_quads : int
        Numbers of nodes in or on that circle and of cells inside it.
    bore : float
        Radius of the circle inside which cells are left out along a bore, 0 for a section without one.
    bore_quads : int
        Number of cells inside that circle; they come first.
    """

    unit: FloatArray
    quads: IntArray
    plug: float
    inner: float
    plug_nodes: int
    plug_quads: int
    bore: float = 0.0
    bore_quads: int = 0

    @property
    def swell(self) -> float:
        """Factor that gives the section, a polygon inside the unit circle, the circle's area."""
        corners = self.unit[self.quads]
        across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
        area = 0.5 * (across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0]).sum()
        return float(np.sqrt(0.5 * np.pi / area))

    @property
    def slab(self) -> IntArray:
        """(k, 8) cells between the nodes of the section, numbered from 0, and those of the next layer."""
        return np.concatenate([self.quads, self.quads + len(self.unit)], axis=1)

    @property
    def flush_swell(self) -> float:
        """Factor of outer nodes beside y = 0 that does so where those in y = 0 stay on the circle."""
        count = len(self.unit) - self.plug_nodes - 1  # of chords
        return float(np.sqrt(1.0 + count * (count - 2) * self.swell**2) - 1.0) / (count - 2)

    @property
    def radius(self) -> FloatArray:
        """(n,) distance from the axis; exact on the two circles."""
        return np.asarray(np.hypot(self.unit[:, 0], self.unit[:, 1]))

    @property
    def direction(self) -> FloatArray:
        """(n, 2) unit vectors from the axis; (1, 0) at the axis itself."""
        s = self.radius[:, None]
        return np.where(s > 0.0, self.unit / np.where(s > 0.0, s, 1.0), np.array([1.0, 0.0]))


def core_and_rings(across: int) -> tuple[int, int]:
    """Cells over the core (even) and rings around it, at least two, for `across` cells over the diameter.

    Raises
    ------
    MeshError
        If `across` is odd or below 6: an inner and an outer ring around a core need that many.
    """
    if across < 6 or across % 2:
        raise MeshError(f"across = {across} cells over the diameter: give an even number of at least 6")
    rings = max(2, round(across / 4))
    return across - 2 * rings, rings


def section(across: int) -> Section:
    """Make the half section with `across` cells over the diameter.

    Raises
    ------
    MeshError
        If `across` is odd or below 6: an inner and an outer ring around a core need that many.
    """
    core, rings = core_and_rings(across)
    plug = max(PLUG, 1.0 - 2.0 / across)  # in fine sections the outer ring is one cell deep
    start, circle = _core(core), _circle(core)
    rim = start[_rim(core)]
    weight = np.arange(1, rings)[:, None, None] / (rings - 1)
    rows = [*(rim + weight * (plug * circle - rim)), circle]  # the last two are circles
    unit = np.concatenate([start, *rows])
    quads = _quads(core, rings)
    outer = 2 * core
    inner = 1.0 - (1.0 - CORE / plug) / (rings - 1)
    return Section(unit, quads, plug, inner, len(unit) - outer - 1, len(quads) - outer)


def bored_section(across: int, bore: float) -> Section:
    """Make the half section with a circle of radius `bore`, over the outer radius, along which cells meet.

    At least two rings of cells lie in the wall, so that its bending is followed; the outermost is that which
    wraps a nose.

    Raises
    ------
    MeshError
        If `across` is odd or below 6, or the bore leaves too thin a wall or too small a core.
    """
    if not SLIMMEST <= round(bore, 9) <= WIDEST:  # a quotient of stated radii is off by round-off
        raise MeshError(
            f"a bore of {bore:.3g} of the outer radius cannot be meshed: give {SLIMMEST} to {WIDEST} of it"
        )
    core, _ = core_and_rings(across)
    wall = max(2, round(0.5 * across * (1.0 - bore)))
    inner = max(1, round(0.5 * across * bore) - core // 2)
    plug = 1.0 - (1.0 - bore) / wall
    shrunk = CORE * min(1.0, bore / PLUG)
    start = shrunk / CORE * _core(core)
    circles = np.linspace(bore, 1.0, wall + 1)[:, None, None] * _circle(core)
    weight = np.arange(1, inner)[:, None, None] / inner
    rim = start[_rim(core)]
    rings = [*(rim + weight * (circles[0] - rim)), *circles]
    unit = np.concatenate([start, *rings])
    quads = _quads(core, inner + wall)
    outer = 2 * core
    return Section(
        unit,
        quads,
        plug,
        1.0 - (plug - bore) / (wall - 1) / plug,
        len(unit) - outer - 1,
        len(quads) - outer,
        bore,
        core * (core // 2) + inner * outer,
    )


def _circle(n: int) -> FloatArray:
    """(2 n + 1, 2) points of the half unit circle from +x to -x."""
    angle = np.linspace(0.0, np.pi, 2 * n + 1)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    circle[[0, -1], 1] = 0.0
    return circle


def _core(n: int) -> FloatArray:
    """((n + 1) (n / 2 + 1), 2) nodes of the core, x fastest: a mean of a square and a disc."""
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, n + 1), np.linspace(0.0, 1.0, n // 2 + 1))
    square = np.stack([x, y], axis=-1)
    disc = np.stack([x * np.sqrt(1.0 - 0.5 * y**2), y * np.sqrt(1.0 - 0.5 * x**2)], axis=-1)
    return np.asarray(CORE * ((1.0 - BULGE) * square + BULGE * disc).reshape(-1, 2))


def _rim(n: int) -> IntArray:
    """(2 n + 1,) core nodes along its outer edge, from +x over the top to -x."""
    half, row = n // 2, n + 1
    right = np.arange(half) * row + n
    top = half * row + np.arange(n, -1, -1)
    left = np.arange(half - 1, -1, -1) * row
    return np.concatenate([right, top, left])


def _quads(n: int, rings: int) -> IntArray:
    """(k, 4) cells: core, then rings outwards."""
    row, width = n + 1, 2 * n + 1
    i, j = np.meshgrid(np.arange(n), np.arange(n // 2))
    first = (j * row + i).ravel()
    core = np.stack([first, first + 1, first + 1 + row, first + row], axis=1)
    loops = [_rim(n), *(row * (n // 2 + 1) + np.arange(rings * width).reshape(rings, width))]
    ring = [np.stack([a[:-1], b[:-1], b[1:], a[1:]], axis=1) for a, b in pairwise(loops)]
    return np.concatenate([core, *ring])
