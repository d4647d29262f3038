"""How large a run of the solid fidelity becomes: elements, memory, steps and time, before a mesh is made.

The elements follow from the volumes of body and fine zone at each level of splitting, as the mesher splits
them (`meshes.refine`). The memory of an element was fitted to runs of the 13 measured sets on meshes about an
estimated contact. ``tests/case/test_size.py`` holds elements and memory to their default runs, which ship
with the package (``case/data/summary.json``).
"""

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, sin, sqrt
from pathlib import Path

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.bodies import Bodies
from fem_impact.case.cells import body_cell
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.case.layers import block_of, moved_rows
from fem_impact.case.zones import BUFFER, Ways, Zones, zones_of
from fem_impact.errors import SceneError
from fem_impact.physics.contact import pressure_speed
from fem_impact.physics.plate import contact_time
from fem_impact.scene.material import Material
from fem_impact.scene.own_mesh import OwnMesh
from fem_impact.scene.units import format_quantity
from meshes import cell_moments, cells_across, thin_skin_rise
from meshes.refine import reach
from meshes.section import SLIMMEST, WIDEST, bored_section, section
from rigid import Faceted, Turned

SAMPLES = 20  # points along each edge of a box whose share inside the rod is counted
FRAMES_SPAN = 3.0  # contact durations (estimated) over which the wanted number of frames is spread
SPLIT = 7  # elements that a cell adds when it is split into eight
# mean step of a run over that in which a wave crosses the finest edge: cells that flow are squeezed
SMALLEST = {"rod": 0.52, "barrier": 0.54}
UNTIL_APART = 1.43, 0.67  # contact times and bending periods, after which a second contact comes, in a run
# bytes: of the program, and of an element; of 14 default runs of drawn scenes, each a process of its own, the
# largest resident memory was .91 to 1.11 of it (median 1.00)
BASE, PER_ELEMENT = 2.2e8, 4.0e3
FILL = 1700.0  # bytes over n^4/3, for the factor of the stiffness of a rod of n elements
# the same of a user's mesh, which has no slices; its factor takes OWN_FILL sqrt(min(n, PIECE w^3)) bytes an
# element, w cells across: the largest resident memory (VmHWM) of processes that did nothing else, for half
# boxes of 7 000 to 32 000 cells, as long as wide and five times longer (tests/benchmarks/own_mesh_memory.py)
OWN_BASE, OWN_ELEMENT, OWN_FILL, PIECE = 2.4e8, 9.5e3, 330.0, 1.15
# bytes of that for an entry of the lower factor (boxes of 7 000 to 16 000 cells, 13.6 to 14), which SuperLU
# numbers by 32 bits
ENTRY, MOST_ENTRIES = 14.0, 2.0**31
# s of a step, of it for an element that cannot yield, and for one that may: least squares of logarithms, of
# 393 runs of the study of coverage (seed 20261801; two at a time on two cores), 90 % within .78 and 1.32
STEP, ELASTIC, YIELDING = 35e-6, 54e-9, 320e-9
# s of the modes for an entry of a user's factor: 0.12 to 0.26 us on half bars of 4 300 and 14 600 cells,
# a fifth for the factor, the rest for the steps of the eigenvalue solver
MODES = 1.8e-7
LARGER = 'Give a mesh of larger cells, or let it not vibrate: effects = ["auto", "-vibration"].'
SETUP = 2.7e-4  # s for an element, of these runs: mesh, assembly, modes; 90 % within .59 and 1.77


@dataclass(frozen=True, slots=True)
class RunSize:
    """About what a run of the solid fidelity takes.

    Attributes
    ----------
    rod, barrier, yielding : elements of each body, and those of both that may yield
    step : time step, s
    steps, most_steps : until the rod is expected to be apart, and until ``accuracy.max_time``
    memory : bytes
    time, most_time : processor time of as many steps and the set-up, s, where the stored runs were measured
    """

    rod: int
    barrier: int
    yielding: int
    step: float
    steps: int
    most_steps: int
    memory: float
    time: float
    most_time: float


def run_size(slots: ModelSpec, bodies: Bodies, zones: Zones) -> RunSize:
    """Return about what a run of these bodies takes with these fine zones."""
    # the elements of half the rod, without slices if it cannot vibrate
    end = bodies.rod.length
    rod = _coarse_elements(bodies, end if slots.vibrating else min(_body_start(bodies, zones), end))
    for edge, lowest, highest in _split_boxes(zones.rod_base, zones.rod_boxes):
        rod += SPLIT * _inside_rod(bodies, lowest, highest)[1] / edge**3
    barrier = _block_elements(bodies, zones) if slots.meshed_barrier else 0.0
    yielding = _yielding_rod(bodies, zones) if slots.rod_law else 0.0
    yielding += _yielding_block(zones) if any(slots.barrier_laws) else 0.0
    step, latest = _step(bodies, zones, slots), bodies.max_time
    touch, swing = UNTIL_APART
    apart = touch * contact_time(bodies.contact) + swing * bodies.bending_period
    elements = rod + barrier
    steps, most = min(apart, latest) / step, latest / step
    modes = modes_time(bodies, rod) if slots.vibrating else 0.0
    return RunSize(
        *(round(rod), round(barrier), round(yielding), step, round(steps), round(most)),
        memory=_memory(bodies, slots.vibrating, rod, barrier),
        time=run_time(elements, yielding, steps) + modes,
        most_time=run_time(elements, yielding, most) + modes,
    )


def run_time(elements: float, yielding: float, steps: float) -> float:
    """Return the processor time, s, of steps and set-up with so many elements, some of which may yield."""
    each = STEP + ELASTIC * max(elements - yielding, 0.0) + YIELDING * yielding
    return SETUP * elements + each * steps


def modes_time(bodies: Bodies, rod: float) -> float:
    """Return the processor time, s, of the modes of a user's mesh; that of others is part of `SETUP`."""
    mesh = bodies.rod.own_mesh
    return 0.0 if mesh is None else MODES * _own_factor(mesh, rod) / ENTRY


def setup_time(bodies: Bodies, vibrating: bool, rod: float, elements: float) -> float:
    """Return the processor time, s, before the first step; of a user's mesh its modes take most of it."""
    return (vibrating and modes_time(bodies, rod)) or SETUP * elements


def about(value: float) -> str:
    """Return a number of at least one with two significant digits."""
    return f"{float(f'{value:.2g}'):,.0f}".replace(",", " ")


def machine_memory() -> float:
    """Return the bytes of memory that a process may use here: the machine's, or its group's limit."""
    whole = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    try:
        return min(whole, float(Path("/sys/fs", "cgroup", "memory.max").read_text()))
    except (OSError, ValueError):  # no such file, or "max"
        return whole


def require_memory(slots: ModelSpec, bodies: Bodies, zones: Zones) -> None:
    """Refuse a mesh that needs more memory than the machine has, or too large a factor (SceneError)."""
    size, there, mesh = run_size(slots, bodies, zones), machine_memory(), bodies.rod.own_mesh
    entries = _own_factor(mesh, size.rod) / ENTRY if mesh is not None and slots.vibrating else 0.0
    if mesh is not None and entries > MOST_ENTRIES:
        problem = (
            f"makes about {about(size.rod)} elements, whose modes need a factor of some {entries:.2g} "
            f"entries; the solver numbers {MOST_ENTRIES:.2g} of them at most."
        )
        raise SceneError(problem, key="projectile.mesh", value=mesh.path, remedy=LARGER)
    if size.memory <= there:
        return
    problem = (
        f"makes about {about(size.rod + size.barrier)} elements, which take some {about(size.memory / 1e9)} "
        f"GB of memory; this machine has {about(there / 1e9)} GB."
    )
    finest = _finest_that_fits(slots, bodies, zones, there)
    if mesh is not None and not finest:
        raise SceneError(problem, key="projectile.mesh", value=mesh.path, remedy=LARGER)
    none = "No tip size fits: give a smaller rod, accuracy.across or accuracy.block_margin."
    value = format_quantity(zones.tip_size, "length")
    raise SceneError(problem, key="accuracy.tip_size", value=value, remedy=finest or none)


def _memory(bodies: Bodies, vibrates: bool, rod: float, barrier: float) -> float:
    """Return the bytes that elements of ``rod`` and ``barrier`` take, and the modes of one that vibrates."""
    if bodies.rod.own_mesh is None:
        return float(BASE + PER_ELEMENT * (rod + barrier) + FILL * rod ** (4 / 3))
    elements = OWN_ELEMENT * rod + PER_ELEMENT * barrier
    return OWN_BASE + elements + (_own_factor(bodies.rod.own_mesh, rod) if vibrates else 0.0)


def _own_factor(mesh: OwnMesh, rod: float) -> float:
    """Return the bytes of the factor for the modes of a user's mesh; split cells lie close together."""
    cells = cell_moments(mesh.half())
    section = (cells.high - cells.low).sum() / (cells.high.max() - cells.low.min())  # of the half, in cells
    count, piece = len(cells.low), PIECE * (2 * section) ** 1.5
    return float(OWN_FILL * (count * sqrt(min(count, piece)) + max(rod - count, 0.0) ** 1.5))


def require_rest(bodies: Bodies, zones: Zones) -> None:
    """Refuse a user's mesh that cannot vibrate and is all nose (SceneError)."""
    body = bodies.rod.body()
    if isinstance(body, Faceted) and not (body.parts[:, 0] >= _body_start(bodies, zones)).any():
        raise no_rest()


def no_rest() -> SceneError:
    """Return the refusal of a body whose cells are split up to its end, without vibration."""
    return SceneError(
        "deforms as a whole: the fine zone of its contact leaves no part that could move as one rigid body.",
        key="projectile",
        remedy='A body that vibrates is computed: effects = ["auto", "vibration"].',
    )


def _finest_that_fits(slots: ModelSpec, bodies: Bodies, zones: Zones, there: float) -> str:
    """Return the remedy by a larger tip size, which a barrier size grows with; nothing where none fits."""
    stated = bodies.scene.accuracy
    for levels in range(len(zones.rod) - 1, 0, -1):
        size = float(f"{zones.rod_base / 2**levels:.2g}")
        barrier = stated.barrier_size and float(f"{stated.barrier_size * size / zones.tip_size:.2g}")
        accuracy = replace(stated, tip_size=size, barrier_size=barrier)
        coarser = Bodies(replace(bodies.scene, accuracy=accuracy), bodies.effects)
        if run_size(slots, coarser, zones_of(coarser)).memory <= there:
            told, finer = f"Give at least {format_quantity(size, 'length')}", barrier and barrier < size
            of_barrier = (
                f", and {format_quantity(barrier, 'length')} as accuracy.barrier_size" if finer else ""
            )
            return f"{told}{of_barrier}."
    return ""


def _step(bodies: Bodies, zones: Zones, slots: ModelSpec) -> float:
    """Return about the stable step, s, with the scene's safety factor."""
    crossing = SMALLEST["rod"] * zones.tip_size / _wave_speed(bodies.rod.material)
    if slots.meshed_barrier:
        fastest, height = max(_wave_speed(metal) for _, metal in bodies.barrier.strata), zones.barrier_size
        if zones.edges:  # the cells of a plate that is meshed through may be flatter than wide
            before, after = moved_rows(bodies, zones)
            height *= min(1.0, float(after[-1] / before[-1]))
        crossing = min(crossing, SMALLEST["barrier"] * height / fastest)
    return bodies.scene.accuracy.step / 0.9 * sqrt(bodies.scene.accuracy.mass_scaling) * crossing


def _wave_speed(steel: Material) -> float:
    """Return the speed of pressure waves, m/s; of bar waves times 2 where the material is incompressible."""
    return min(pressure_speed(steel), 2.0 * sqrt(steel.E / steel.rho))


def _split_boxes(base: float, boxes: list[tuple[Array, Array]]) -> Iterator[tuple[float, Array, Array]]:
    """Yield for each level the edge of the cells that are split, and the box that they fill.

    ``boxes`` are the lowest and highest corners, m, of the zone of each level.
    """
    for level in range(1, len(boxes) + 1):
        edge = base / 2 ** (level - 1)
        # cells that touch stand out by half
        margins = [
            float(reach(edge, level, finest, BUFFER)) + edge / 2 for finest in range(level, len(boxes) + 1)
        ]
        pairs = list(zip(boxes[level - 1 :], margins, strict=True))
        low = np.min([corner - margin for (corner, _), margin in pairs], axis=0)
        yield edge, low, np.max([corner + margin for (_, corner), margin in pairs], axis=0)


def _coarse_elements(bodies: Bodies, end: float) -> float:
    """Return the elements of half the coarse body from its tip up to a height, m."""
    rod, across = bodies.rod, bodies.scene.across
    if rod.own_mesh is not None:
        return float((cell_moments(rod.own_mesh.half()).low < end).sum())
    z = (np.arange(SAMPLES) + 0.5) / SAMPLES * end
    body = rod.body()
    radius = rod.diameter / 2 if rod.is_rod else np.maximum(body.radius(z), 0.05 * rod.diameter)
    if isinstance(body, Turned):
        across = cells_across(body.outline, across, body.bore)
    if rod.bore:
        assert isinstance(body, Turned), "a bore is stated for a turned body"
        _, outer, inner = rod.wall()
        half = bored_section(across, float(np.clip(inner[0] / outer[0], SLIMMEST, WIDEST)))
        cells = len(half.quads) - np.where(body.inner_radius(z) > 0, half.bore_quads, 0)
    else:
        cells = np.full(SAMPLES, len(section(across).quads))
    return float(end * np.mean(cells * across / (2 * radius)))


def _body_start(bodies: Bodies, zones: Zones) -> float:
    """Return about the height, m, at which the slices begin: a cell above all that is split."""
    alpha, foot, edge = bodies.mesh_inclination, float(bodies.lowest_point[2]), body_cell(bodies)
    tops = (
        high[2] * cos(alpha)
        + max(-low[0], high[0]) * abs(sin(alpha))
        + float(reach(1.4 * edge, 1, level, BUFFER))
        for level, (low, high) in enumerate(zones.rod_boxes, 1)
    )
    return max(foot + max(tops, default=0.0) + 1.5 * edge, bodies.rod.diameter / 3)


def _grid(low: Array, high: Array) -> Array:
    """Return points (k, 3) evenly over a box."""
    ends = (np.arange(SAMPLES) + 0.5) / SAMPLES
    axes = [a + (z - a) * ends for a, z in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)


def _inside_rod(bodies: Bodies, low: Array, high: Array) -> tuple[Array, float]:
    """Return points (k, 3), m, of a box that lie in the half rod b >= 0, and the volume there, m3."""
    low = np.array([low[0], 0.0, low[2]])
    points, alpha, body = _grid(low, high), bodies.mesh_inclination, bodies.body
    t, b, n = points.T
    x, z = cos(alpha) * t - sin(alpha) * n, sin(alpha) * t + cos(alpha) * n
    rho_0, _, z_0 = bodies.lowest_point
    rho, z = np.hypot(x + rho_0, b), z + z_0
    inside = points[body.holds(rho, z)]
    return inside, float(np.prod(high - low)) * len(inside) / len(points)


def _block_elements(bodies: Bodies, zones: Zones) -> float:
    """Return the elements of the half block: boxes about the fine zone, cut off at the block's sides."""
    boxes, (bottom, top) = zones.barrier_boxes, block_of(bodies, zones)
    count = float(np.maximum(1.0, np.rint((top - bottom) / zones.base)).prod())
    for edge, lowest, highest in _split_boxes(zones.base, boxes):
        sides = np.minimum(highest, top) - np.maximum(lowest, bottom)
        count += SPLIT * float(np.prod(sides)) / edge**3
    return count


def _yielding_rod(bodies: Bodies, zones: Zones) -> float:
    """Return the split cells of half the rod that reach into the ellipsoid whose cells may yield."""
    radii = _radii(zones, zones.tip_size)
    down, up = zones.reach
    low, high = np.array([-radii[0] - down, 0.0, -radii[2]]), np.array([radii[0] + up, *radii[1:]])
    points, volume = _inside_rod(bodies, low, high)
    return _yielding(
        points, volume / max(len(points), 1), zones.reach, radii, zones.rod_base, zones.rod_boxes
    )


def _yielding_block(zones: Zones) -> float:
    """Return the split cells of half the block that reach into the ellipsoid; thin rows stand for depth."""
    radii = _radii(zones, zones.barrier_size)
    radii[2] += thin_skin_rise(zones.skin_rows) * zones.barrier_size
    down, up = zones.along
    low, high = np.array([-radii[0] - down, 0.0, -radii[2]]), np.array([radii[0] + up, radii[1], 0.0])
    points = _grid(low, high)
    each = float(np.prod(high - low)) / len(points)
    return _yielding(points, each, zones.along, radii, zones.base, zones.barrier_boxes)


def _radii(zones: Zones, edge: float) -> Array:
    """Return the radii (3,), m, of the ellipsoid whose cells may yield; cells that touch it count half."""
    return 1.1 * np.array(zones.half) + edge / 2


def _yielding(
    points: Array, each: float, along: Ways, radii: Array, base: float, boxes: list[tuple[Array, Array]]
) -> float:
    """Return the split cells at ``points`` (k, 3), each of which stands for a volume, m3, in an ellipsoid.

    The ellipsoid is drawn out by ``along``, m, down and up the slope.
    """
    place = points.copy()
    place[:, 0] -= np.clip(place[:, 0], -along[0], along[1])
    inside = points[np.sum((place / radii) ** 2, axis=1) < 1]
    edges = np.full(len(inside), np.inf)
    for edge, low, high in _split_boxes(base, boxes):
        edges[((inside >= low) & (inside <= high)).all(axis=1)] = edge / 2
    return float(np.sum(each / edges**3))
