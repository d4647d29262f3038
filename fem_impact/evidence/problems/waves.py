"""``modes``: natural frequencies of a free round bar, from the eigenproblem and from ringing down."""

from math import ceil, inf, pi

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import eigh

import meshes
from fem_impact.arrays import Array
from fem_impact.evidence.problems import setups
from fem_impact.evidence.problems.discretisation import BarMesh
from fem_impact.evidence.problems.problem import Check, Solved, Values
from fem_impact.evidence.references.free_modes import bending_modes, cylinder_frequencies
from fem_impact.evidence.references.rod_end import bar_speed
from fem_impact.evidence.references.waves import flexural_speed, longitudinal_speed
from fem_impact.fem.eigen import rod_modes
from fem_impact.fem.elements import element_stiffness, lame_constants, lumped_mass
from fem_impact.fem.layout import TWISTING, MassPoints, number
from fem_impact.fem.slices import SliceOperator
from fem_impact.fem.sparse import assemble, assemble_mass, tie_operator
from fem_impact.scene.barrier import Barrier
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.solid.march import march
from fem_impact.solid.model import Model
from fem_impact.solid.rodview import modes_of
from fem_impact.solid.state import State

MOST = 0.005  # relative error of a frequency that is allowed on any mesh
BENDING = (4.730, 7.853, 10.996)  # wave numbers of slender free bars times the length
PERIODS = 4  # of the first bending mode over which a bar rings
COUNT = 14  # modes that are computed
SLENDER = (2.5, 30.0)  # length over diameter; stubbier bars have oval modes among the stretching ones
SLICES = 40  # about, at least; the third bending wave, 4/7 of the bar, needs 20 of them for 0.3 %
PLUCK = 0.01  # m/s, of the ringing bar
EVERY = 5  # steps between samples


def free_bar(p: Values, across: int) -> Model:
    """Return the flat rod of a scene, upright, as it flies on after its contact."""
    metal = setups.steel(p)
    rod = ProjectileSpec(p["length"], p["diameter"], "plain", 0.0, metal)
    mesh = {"tip_size": p["diameter"] / 4, "across": across}
    return setups.falling(rod, Barrier(metal), ("barrier-rigid",), PLUCK, **mesh).coasting()


def frequencies(model: Model) -> dict[str, Array]:
    """Return bending and longitudinal frequencies, Hz, told apart by what the axis does."""
    points, places = model.geometry.rod.mesh.points, model.layout.rod
    modes = modes_of(model, COUNT)
    axis = np.hypot(points[:, 0], points[:, 1]) < 1e-9
    across, along = (abs(modes.shape[places[axis, c]]).max(axis=0) for c in (0, 2))
    return {
        "bending": modes.frequency[across > 10 * along],
        "longitudinal": modes.frequency[along > 10 * across],
    }


def _torsion(p: Values, rod: meshes.RodMesh) -> float:
    """Return the first frequency, Hz, of the motions that a scene's mirrored half leaves out.

    The bar is one of slices alone: at the flat end of a scene's rod, masses at the corners of its cells make
    the bar of the defaults 0.13 % slow, one of 80 mm 0.28 %.
    """
    layout = number(rod, None)
    points, cells, n = rod.mesh.points, rod.mesh.cells, layout.rod_size
    lame, T = lame_constants(p["E"], p["nu"]), tie_operator(rod.mesh.tie, layout.rod, n)
    masses = lumped_mass(points, cells, p["rho"])
    drawn = MassPoints.of_rod(rod, masses, p["rho"], TWISTING)
    plain = assemble(points, cells, lame, "incompatible", T)
    fixed = np.zeros(n, dtype=bool)
    fixed[layout.rod[np.abs(points[:, 1]) < 1e-12][:, [0, 2]]] = True
    modes = rod_modes(
        drawn.reduced((plain,), layout.body_shape[1]), assemble_mass(masses, cells, T), fixed, COUNT
    )
    axis = layout.rod[np.hypot(points[:, 0], points[:, 1]) < 1e-9, 1]
    turns = abs(modes.shape[axis]).max(axis=0) < 0.1 * abs(modes.shape).max(axis=0)
    return float(modes.frequency[turns][0])


def _ring(p: Values, model: Model) -> tuple[float, float, State]:
    """Return the first bending and longitudinal frequency, Hz, of a plucked bar, and its end."""
    beam = bending_modes(p["E"], p["nu"], p["rho"], p["length"], p["diameter"] / 2, 1)
    points = model.geometry.rod.mesh.points
    s = 2 * points[:, 2] / p["length"] - 1
    w = np.polynomial.legendre.legval(s, beam.deflection[0])
    theta = np.polynomial.legendre.legval(s, beam.angle[0])
    bend = np.stack([w, 0 * w, -points[:, 0] * theta], axis=1)
    stretch = np.stack([0 * w, 0 * w, -np.sin(0.5 * pi * s)], axis=1)
    state = model.initial_state()
    state.v[model.layout.rod] = PLUCK * (bend / abs(w).max() + stretch)
    model.drawn.condense(model.layout.slices_of(state.v))
    probes = [probe(model, bend, PERIODS / float(beam.frequency[0])), probe(model, stretch)]
    march(model, state, probes)
    return probes[0].frequency(), probes[1].frequency(), state


def probe(model: Model, shape: Array, end: float = inf, every: int = EVERY) -> setups.Recorder:
    """Return a recorder of the velocity along a shape (n, 3) until a time, s."""
    row, moves = np.zeros(model.layout.size), ~model.geometry.rod.mesh.is_hanging
    row[model.layout.rod[moves]] = shape[moves]
    row *= model.mass
    return setups.Recorder(lambda state: float(row @ state.v), end=end, every=every)


def solve_modes(p: Values) -> Solved:
    """Compare both ways of finding frequencies with Rayleigh-Ritz in three dimensions.

    Raises
    ------
    SceneError
        If the bar is too stubby or too slender.
    """
    setups.slender(p, "diameter", *SLENDER)
    exact = cylinder_frequencies(p["E"], p["nu"], p["rho"], p["length"], p["diameter"] / 2)
    slab = min(p["diameter"] / p["across"], p["length"] / SLICES)
    flat = np.array([[0.0, 0.0], [p["diameter"] / 2, 0.0]])
    slices = meshes.rod(flat, p["length"], int(p["across"]), slice_length=slab, nose=False)
    mesh = BarMesh(p["nu"], p["across"], p["diameter"] / 2, slices.slice_length)
    # a scene's cells are as high as they are wide: in a stubby bar more of them lie across
    model = free_bar(p, 2 * ceil(0.5 * p["diameter"] / slab - 1e-9))
    computed = frequencies(model)
    stretching = [pi * i / p["length"] for i in (1, 2)]
    wanted = {
        "bending": (exact.bending, [mesh.bending_error(k / p["length"]) for k in BENDING]),
        "longitudinal": (exact.longitudinal, [mesh.stretching_error(wave) for wave in stretching]),
    }
    checks = [
        Check(f"{kind} {i + 1}", "Hz", float(computed[kind][i]), float(values[i]), min(allowed, MOST))
        for kind, (values, errors) in wanted.items()
        for i, allowed in enumerate(errors)
    ]
    bend, stretch, state = _ring(p, model)
    torsion = min(MOST, mesh.twisting_error(p["length"]))
    checks.append(Check("torsion 1", "Hz", _torsion(p, slices), float(exact.torsion[0]), torsion))
    for rung, still in ((bend, checks[0]), (stretch, checks[len(BENDING)])):
        # leapfrog rings high by (omega dt)^2 / 24; the plucked shape leaves out the lateral motion, a
        # share of (nu pi R / L)^2 / 4 in other modes, which moves the first and last of its zero crossings
        periods = PERIODS * still.reference / checks[0].reference
        others = (p["nu"] * pi * p["diameter"] / (2 * p["length"])) ** 2 / 4 / (pi * periods)
        allowed = min(MOST, still.tolerance + (2 * pi * still.reference * state.dt) ** 2 / 24 + others)
        checks.append(Check(f"{still.name}, ringing", "Hz", rung, still.reference, allowed))
    return Solved(tuple(checks), state.step, len(model.geometry.rod.mesh.cells))


WAVES_TOLERANCE = 0.005  # of c0
JUDGED, SHORT = 0.2 + 1e-9, "waves so short are up to 1 % slow even with 24 cells across"
LONGITUDINAL, FLEXURAL = 2, 0  # components of the axis that move


class _Slice:
    """One slice of the bar: its operator, the masses of a layer, and who may move."""

    def __init__(self, p: Values) -> None:
        radius = p["diameter"] / 2
        h = p["diameter"] / p["across"] * p["aspect"]
        flat = np.array([[0.0, 0.0], [radius, 0.0]])
        bar = meshes.rod(flat, 4 * h, int(p["across"]), slice_length=h, nose=False)
        first = bar.body_cells[:, 0]
        cells, points = bar.mesh.cells[first], bar.mesh.points
        masses = lumped_mass(points, bar.mesh.cells, p["rho"])
        self.drawn = MassPoints.of_rod(bar, masses, p["rho"]).section()
        K = element_stiffness(points, cells, lame_constants(p["E"], p["nu"]), "incompatible")
        self.count, self.height, self.cells = len(bar.body_nodes), bar.slice_length, len(cells)
        section = np.full(len(points), -1)
        section[bar.body_nodes[:, :2].T] = np.arange(self.count)
        low, up = section[cells[:, :4]], section[cells[:, 4:]]
        self.operator = SliceOperator.of(K, low, up)
        nodal = masses[first]
        mass = np.bincount(low.ravel(), nodal[:, :4].ravel()) + np.bincount(up.ravel(), nodal[:, 4:].ravel())
        self.mass = np.tile(mass, 3)
        place = points[bar.body_nodes[:, 0]]
        free = np.ones((3, self.count), dtype=bool)
        free[1, np.abs(place[:, 1]) < 1e-12] = False
        self.free = np.flatnonzero(free.ravel())
        self.axis = int(np.argmin(np.hypot(place[:, 0], place[:, 1])))

    def matrix(self, k: float) -> NDArray[np.complex128]:
        """Return the dense stiffness seen by a wave number, N/m."""
        o, n = self.operator, 3 * self.count
        turn = np.exp(1j * k * self.height)
        values = o.lower + o.upper + turn * o.above + np.conj(turn) * o.below
        plain = sp.csr_matrix((values, o.columns, o.start), shape=(n, n))
        return np.asarray((self.drawn.T @ plain @ self.drawn).toarray())

    def frequency(self, k: float, component: int) -> float:
        """Return the lowest circular frequency whose axis moves mostly along a component."""
        root = 1 / np.sqrt(self.mass[self.free])
        K = self.matrix(k)[np.ix_(self.free, self.free)] * root[:, None] * root
        square, shape = eigh(K, subset_by_index=(0, 5))
        moved = np.zeros((3 * self.count, 6), dtype=np.complex128)
        moved[self.free] = root[:, None] * shape
        at = abs(moved[self.axis + self.count * np.arange(3)])
        # waves of higher order around the bar leave the axis at rest
        taken = (at.argmax(axis=0) == component) & (at.max(axis=0) > 0.1 * abs(moved).max(axis=0))
        return float(np.sqrt(square[np.flatnonzero(taken)[0]]))


def solve_waves(p: Values) -> Solved:
    """Compare both first modes at a few radii over wavelength."""
    bar, c0 = _Slice(p), bar_speed(p["E"], p["rho"])
    checks = []
    for ratio in np.linspace(p["ratio"] / 4, p["ratio"], 4):
        k = 2 * pi * ratio / (p["diameter"] / 2)
        exact = {
            LONGITUDINAL: ("longitudinal", longitudinal_speed(ratio, p["nu"])),
            FLEXURAL: ("flexural", flexural_speed(ratio, p["nu"])),
        }
        for component, (name, speed) in exact.items():
            phase_speed = bar.frequency(k, component) / k / c0
            label = f"{name} c/c0 at radius/wavelength {ratio:.3g}"
            checks.append(
                Check(label, "1", phase_speed, speed, WAVES_TOLERANCE, "absolute")
                if ratio <= JUDGED
                else Check.shown(label, "1", phase_speed, speed, SHORT)
            )
    return Solved(tuple(checks), 0, bar.cells)
