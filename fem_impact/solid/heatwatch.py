"""Observer of the friction power and the loaded contact area of a run."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.solid.contact.moving_plane import MovingPlane
from fem_impact.solid.contact.plane import PlaneContact
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from meshes import SKIN
from meshes.hexmesh import quad_normals

HEAT_WINDOW = 0.5e-6  # s, of the means of power and patch: single nodes open and close from step to step


def tributary_areas(x: Array, places: Ints, quads: Ints) -> Array:
    """Return the areas (k,), m2, of nodes with unknowns (k, 3): a quarter of each adjacent quad (m, 4)."""
    area = 0.5 * quad_normals(x[places[quads]])
    share = np.repeat(0.25 * np.linalg.norm(area, axis=1), 4)
    return np.asarray(np.bincount(quads.ravel(), weights=share, minlength=len(places)), dtype=np.float64)


def loaded_area(p: Array, area: Array) -> float:
    """Return (sum p)^2 / sum(p^2 / area), m2: that of a uniform pressure, 8/9 of Hertz' ellipse."""
    squares = float((p * p / area).sum())
    return float(p.sum()) ** 2 / squares if squares > 0 else 0.0


@dataclass(slots=True)
class HeatWatch:
    """Means over time windows, for the whole contact, of friction power, patch and sliding speed.

    Attributes
    ----------
    t : start of the first window and ends of all windows, s
    power, patch, speed : friction power, W, loaded area, m2, and sliding speed, m/s, of each window
    taken : friction heat of the half model at the end of the last window, J
    pushed : sum of the sizes of tangential impulses of the half model in the open window, N s
    window : length of a window, s
    """

    moving: ClassVar[tuple[str, ...]] = ("table", "taken", "pushed", "surface.window")
    model: Model
    every: int = 1
    t: list[float] = field(default_factory=lambda: [0.0])
    power: list[float] = field(default_factory=list)
    patch: list[float] = field(default_factory=list)
    speed: list[float] = field(default_factory=list)
    surface: "PlaneSurface | PairSurface" = field(init=False)
    taken: float = 0.0
    pushed: float = 0.0
    window: float = HEAT_WINDOW

    def __post_init__(self) -> None:
        contact = self.model.contact
        if isinstance(contact, SurfaceContact):
            self.surface = PairSurface(contact, self.model)
        elif isinstance(contact, PlaneContact | MovingPlane):
            self.surface = PlaneSurface(contact, self.model)

    @property
    def table(self) -> Array:
        """Return the windows as rows (k, 4): end, power, patch, speed."""
        return np.array([self.t[1:], self.power, self.patch, self.speed]).T

    @table.setter
    def table(self, rows: Array) -> None:
        end, self.power, self.patch, self.speed = ([float(a) for a in column] for column in rows.T)
        self.t = [0.0, *end]

    def observe(self, state: State) -> bool:
        """Add the last step; close the window when it is full."""
        book = self.model.book
        self.pushed += book.step.rubbed
        self.surface.add(state)
        span = state.time - self.t[-1]
        if span >= self.window:
            heat, self.taken = book.friction - self.taken, book.friction
            self.power.append(2 * heat / span)
            # without friction the heat is round-off and may be negative
            self.speed.append(max(heat, 0.0) / self.pushed if self.pushed > 0 else 0.0)
            self.patch.append(2 * self.surface.close())
            self.t.append(state.time)
            self.pushed = 0.0
        return False


class PlaneSurface:
    """The patch on a rigid plane: area of the skin nodes on it, mean over a window's steps."""

    def __init__(self, contact: PlaneContact | MovingPlane, model: Model) -> None:
        g = model.geometry
        quads = g.rod.mesh.faces_with(SKIN)
        areas = tributary_areas(model.start[0], model.layout.rod, quads)
        node = np.full(model.layout.size, -1)
        node[model.layout.rod[:, 2]] = np.arange(len(areas))
        self.nodes, self.ground = contact.nodes, model.ground
        self.area = areas[node[self.nodes[:, 2]]]
        self.sum, self.steps = 0.0, 0

    @property
    def window(self) -> Array:
        """Return the sums of the open window."""
        return np.array([self.sum, self.steps])

    @window.setter
    def window(self, sums: Array) -> None:
        self.sum, self.steps = float(sums[0]), int(sums[1])

    def add(self, state: State) -> None:
        """Add the skin at the height of the plane."""
        x, ground = state.x, self.ground
        heights = ground.levelled(x[self.nodes[:, 0]], x[self.nodes[:, 2]], x)
        self.sum += float(self.area[heights < ground.risen(x) + 1e-9].sum())
        self.steps += 1

    def close(self) -> float:
        """Return the mean of the window, m2, and begin the next."""
        mean, self.sum, self.steps = self.sum / self.steps, 0.0, 0
        return mean


class PairSurface:
    """The patch between rod and block: loaded areas of both slave surfaces, weighted by their loads."""

    def __init__(self, contact: SurfaceContact, model: Model) -> None:
        self.memory = contact.points.memory
        x = model.start[0]
        patches = (contact.rod, contact.barrier)
        self.areas = [np.maximum(tributary_areas(x, p.places, p.quads), 1e-18) for p in patches]
        self.load = np.zeros(len(self.memory))

    @property
    def window(self) -> Array:
        """Return the sums of the open window."""
        return self.load

    @window.setter
    def window(self, sums: Array) -> None:
        self.load[:] = sums

    def add(self, state: State) -> None:
        """Add the normal impulses of the last step."""
        self.load += self.memory[:, 2]

    def close(self) -> float:
        """Return the patch of the window, m2, and begin the next."""
        parts = np.split(np.maximum(self.load, 0.0), [len(self.areas[0])])
        loads = [float(p.sum()) for p in parts]
        patches = [loaded_area(p, a) for p, a in zip(parts, self.areas, strict=True)]
        self.load[:] = 0.0
        total = sum(loads)
        return sum(w * a for w, a in zip(loads, patches, strict=True)) / total if total > 0 else 0.0
