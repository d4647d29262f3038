"""How large a run of the solid fidelity becomes: elements, memory, steps and time, before a mesh is made.

The elements follow from the volumes of body and fine zone at each level of splitting, as the mesher splits
them (`meshes.refine`). What an element costs was fitted to the 51 sizes of runs of the 13 measured sets that
ship with the package (``plan/data/summary.json``; ``tests/plan/test_size.py`` repeats the comparison):
elements within a quarter, memory within a third, steps and time within a factor of two.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, pi, sin, sqrt
from pathlib import Path

import numpy as np

from fem_impact.arrays import Array
from fem_impact.effects.slots import ModelSpec
from fem_impact.errors import SceneError
from fem_impact.physics.beam import bending_period, max_time
from fem_impact.physics.contact import ContactBodies, contact_estimate, projectile
from fem_impact.plan.zones import Zones, lowest_point, zones_of
from fem_impact.scene.types import Material, Scene
from fem_impact.scene.units import format_quantity
from meshes import thin_skin_rise
from meshes.refine import reach
from meshes.section import section

SAMPLES = 20  # points along each edge of a box whose share inside the rod is counted
SPLIT = 7  # elements that a cell adds when it is split into eight
SMALLEST = {"rod": 0.62, "barrier": 0.65}  # stable step over that in which a wave crosses the finest edge
UNTIL_APART = 1.43, 0.67  # contact times and bending periods, after which a second contact comes, in a run
BASE, PER_ELEMENT = 2.1e8, 5.5e3  # bytes: of the program, and of an element
FILL = 1500.0  # bytes over n^4/3, for the factor of the stiffness of a rod of n elements
ELASTIC, YIELDING = 84e-9, 365e-9  # s of a step for an element that cannot yield, and for one that may
SETUP = 5.6e-4  # s for an element: mesh, assembly, modes


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


def run_size(slots: ModelSpec, bodies: ContactBodies, zones: Zones) -> RunSize:
    """Return about what a run of these bodies takes with these fine zones."""
    scene = bodies.scene
    rod = _rod_elements(scene, zones, slots.vibrating)
    barrier = _block_elements(scene, zones) if slots.meshed_barrier else 0.0
    yielding = _yielding_rod(scene, zones) if slots.rod_law else 0.0
    yielding += _yielding_block(zones) if slots.barrier_law else 0.0
    step, latest = _step(scene, zones, slots), max_time(bodies)
    touch, swing = UNTIL_APART
    apart = touch * contact_estimate(bodies).duration + swing * bending_period(scene)
    elements = rod + barrier
    each = ELASTIC * max(elements - yielding, 0.0) + YIELDING * yielding
    steps, most = min(apart, latest) / step, latest / step
    return RunSize(
        *(round(rod), round(barrier), round(yielding), step, round(steps), round(most)),
        memory=BASE + PER_ELEMENT * elements + FILL * rod ** (4 / 3),
        time=SETUP * elements + each * steps,
        most_time=SETUP * elements + each * most,
    )


def about(value: float) -> str:
    """Return a number of at least one with two significant digits."""
    return f"{float(f'{value:.2g}'):,.0f}".replace(",", " ")


def machine_memory() -> float:
    """Return the bytes of memory that a process may use here: the machine's, or its group's limit."""
    whole = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    try:
        return min(whole, float(Path("/sys/fs/cgroup/memory.max").read_text()))
    except (OSError, ValueError):  # no such file, or "max"
        return whole


def require_memory(slots: ModelSpec, bodies: ContactBodies, zones: Zones) -> None:
    """Refuse a mesh that needs more memory than the machine has (SceneError)."""
    size, there = run_size(slots, bodies, zones), machine_memory()
    if size.memory <= there:
        return
    raise SceneError(
        f"makes about {about(size.rod + size.barrier)} elements, which take some {about(size.memory / 1e9)} "
        f"GB of memory; this machine has {about(there / 1e9)} GB.",
        key="accuracy.tip_size",
        value=format_quantity(bodies.scene.accuracy.tip_size, "length"),
        remedy=_finest_that_fits(slots, bodies, zones, there),
    )


def _finest_that_fits(slots: ModelSpec, bodies: ContactBodies, zones: Zones, there: float) -> str:
    for levels in range(zones.levels - 1, 0, -1):
        size = float(f"{zones.base / 2**levels:.2g}")
        accuracy = replace(bodies.scene.accuracy, tip_size=size)
        coarser = replace(bodies, scene=replace(bodies.scene, accuracy=accuracy))
        if run_size(slots, coarser, zones_of(coarser)).memory <= there:
            return f"Give at least {format_quantity(size, 'length')}."
    return "No tip size fits: give a smaller rod, accuracy.across or accuracy.block_margin."


def _step(scene: Scene, zones: Zones, slots: ModelSpec) -> float:
    """Return about the stable step, s, with the scene's safety factor."""
    shares = {"rod": scene.projectile.material}
    if slots.meshed_barrier:
        shares["barrier"] = scene.barrier.material
    crossing = (SMALLEST[body] * zones.tip_size / _wave_speed(steel) for body, steel in shares.items())
    return scene.accuracy.step / 0.9 * min(crossing)


def _wave_speed(steel: Material) -> float:
    """Return the speed of pressure waves, m/s; of bar waves times 2 where the material is incompressible."""
    stiff = (1 - steel.nu) / ((1 + steel.nu) * (1 - 2 * steel.nu))
    return sqrt(steel.E / steel.rho * min(stiff, 4.0))


def _split_boxes(zones: Zones, low: Array, high: Array) -> Iterator[tuple[float, Array, Array]]:
    """Yield for each level the edge of the cells that are split and the box about the zone that they fill."""
    for level in range(1, zones.levels + 1):
        edge = zones.base / 2 ** (level - 1)
        margin = float(reach(edge, level, zones.levels)) + edge / 2  # cells that touch stand out by half
        yield edge, low - margin, high + margin


def _rod_elements(scene: Scene, zones: Zones, vibrating: bool) -> float:
    """Return the elements of half the rod, without slices if it cannot vibrate."""
    (t, b, n), length = zones.half, scene.projectile.length
    low, high = np.array([-t - zones.reach, 0.0, -zones.tip_size]), np.array([t, b, n])
    layer = len(section(scene.accuracy.across).quads) / zones.base  # elements of a metre of the coarse rod
    count = layer * (length if vibrating else min(_body_start(scene, zones, low, high), length))
    for edge, lowest, highest in _split_boxes(zones, low, high):
        count += SPLIT * _inside_rod(scene, lowest, highest)[1] / edge**3
    return count


def _body_start(scene: Scene, zones: Zones, low: Array, high: Array) -> float:
    """Return about the height, m, at which the slices begin: a cell above all that is split."""
    alpha, foot = scene.impact.angle, float(lowest_point(scene)[2])
    top = foot + high[2] * cos(alpha) + max(-low[0], high[0]) * sin(alpha)
    above = float(reach(1.4 * zones.base, 1, zones.levels)) if zones.levels else 0.0
    return max(float(top) + above + 1.5 * zones.base, scene.projectile.diameter / 3)


def _inside_rod(scene: Scene, low: Array, high: Array) -> tuple[Array, float]:
    """Return points (k, 3), m, of a box that lie in the half rod b >= 0, and the volume there, m3."""
    low = np.array([low[0], 0.0, low[2]])
    ends = (np.arange(SAMPLES) + 0.5) / SAMPLES
    grid = np.stack(np.meshgrid(*[a + (z - a) * ends for a, z in zip(low, high, strict=True)]), axis=-1)
    points, alpha, body = grid.reshape(-1, 3), scene.impact.angle, projectile(scene)
    t, b, n = points.T
    x, z = cos(alpha) * t - sin(alpha) * n, sin(alpha) * t + cos(alpha) * n
    rho_0, _, z_0 = lowest_point(scene)
    rho, z = np.hypot(x + rho_0, b), z + z_0
    outline = body.meridian()
    surface = np.interp(rho, outline[:, 0], outline[:, 1], right=np.inf)
    inside = points[(z >= surface) & (z <= body.length)]
    return inside, float(np.prod(high - low)) * len(inside) / len(points)


def _block_elements(scene: Scene, zones: Zones) -> float:
    """Return the elements of the half block: boxes about the fine zone, cut off at the block's sides."""
    (t, b, n), margin = zones.half, scene.accuracy.block_margin
    depth = n + thin_skin_rise(zones.skin_rows) * zones.tip_size
    low, high = np.array([-t - zones.along, 0.0, -depth]), np.array([t, b, 0.0])
    bottom, top = low - np.array([margin, 0.0, margin]), high + np.array([margin, margin, 0.0])
    count = float(np.maximum(1.0, np.rint((top - bottom) / zones.base)).prod())
    for edge, lowest, highest in _split_boxes(zones, low, high):
        sides = np.minimum(highest, top) - np.maximum(lowest, bottom)
        count += SPLIT * float(np.prod(sides)) / edge**3
    return count


def _radii(zones: Zones) -> Array:
    """Return the radii (3,), m, of the ellipsoid whose cells may yield; cells that touch it count half."""
    return 1.1 * np.array(zones.half) + zones.tip_size / 2


def _yielding_rod(scene: Scene, zones: Zones) -> float:
    radii = _radii(zones)
    low, high = np.array([-radii[0] - zones.reach, 0.0, -radii[2]]), radii
    points, volume = _inside_rod(scene, low, high)
    points[:, 0] += np.clip(-points[:, 0], 0.0, zones.reach)  # the ellipsoid is drawn out along -t
    share = float(np.mean(np.sum((points / radii) ** 2, axis=1) < 1)) if len(points) else 0.0
    return share * volume / zones.tip_size**3


def _yielding_block(zones: Zones) -> float:
    """Return the cells of a quarter of the ellipsoid, drawn out along -t; thin rows stand for more depth."""
    t, b, n = _radii(zones)
    depth = n + thin_skin_rise(zones.skin_rows) * zones.tip_size
    return float(pi * b * depth * (t / 3 + zones.along / 4) / zones.tip_size**3)
