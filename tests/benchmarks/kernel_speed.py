"""Speed of the compiled kernels in ns an element-step, beside a SciPy CSR product on the same mesh.

Run ``python tests/benchmarks/kernel_speed.py [SCENE]``; all rows come from one process, so the ratios mean
something even on a busy machine. Parts of a scene are timed while it runs, for yielding depends on the
increment: lower deciles of CPU time over steps in the contact. The last two rows are wall times of whole
steps, by turns with one thread and with two, and need two free cores; below them stands what two threads gain
that share nothing.
"""

from __future__ import annotations

import copy
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from threading import Thread

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from scipy.sparse import csr_matrix

import meshes
from fem_impact.effects import specify
from fem_impact.scene import load
from fem_impact.solid.build import build
from fem_impact.solid.calls import perform
from fem_impact.solid.elements import isotropic_stiffness
from fem_impact.solid.helper import Helper
from fem_impact.solid.items import add_force
from fem_impact.solid.kernels import kernel
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.model import Model
from fem_impact.solid.sparse import assemble, tie_operator
from fem_impact.solid.state import State
from fem_impact.solid.yielding import YieldingZone
from fem_impact.verify.bodies import Body, body_model

Row = tuple[str, int, float, float]  # part, elements, ns an element-step, over the CSR product's
ACROSS, SLICES = 12, 144  # cells across and along the bar
LEDGER_EVERY = 20  # steps, as a scene's history
IN_CONTACT = 60e-6  # s: elements yield, nodes touch
STEPS, TURNS, REPEATS = 400, 100, 20


@dataclass(frozen=True, slots=True)
class Timed:
    """A force under the clock."""

    body: str
    find: Callable[[State], None]

    def collect(self, state: State) -> None:
        """Do nothing: that was done under the clock too."""


def cpu_ns(work: Callable[[], object], repeats: int = 7, calls: int = 40) -> float:
    """Return the smallest CPU time of one call, ns."""
    best = float("inf")
    for _ in range(repeats):
        begun = time.process_time_ns()
        for _ in range(calls):
            work()
        best = min(best, (time.process_time_ns() - begun) / calls)
    return best


def triad_gb_per_s() -> float:
    """Return the memory bandwidth of a = b + s c on arrays beyond the caches, GB/s."""
    b, c, a = (np.ones(8_000_000) for _ in range(3))

    def triad() -> None:
        np.multiply(c, 3.0, out=a)
        np.add(a, b, out=a)

    return 5 * 8 * len(a) / cpu_ns(triad, 5, 3)


def plain_stiffness(model: Model) -> csr_matrix:
    """Return the rod's assembled stiffness over its nodes; the numbers do not matter to a product's time."""
    mesh, layout = model.geometry.rod.mesh, model.layout
    C, T = isotropic_stiffness(2e11, 0.29), tie_operator(mesh.tie, layout.rod, layout.rod_size)
    return assemble(mesh.points, mesh.cells, C, "incompatible", T)


def bar_rows() -> list[Row]:
    """Return the CSR product and the whole step of a linear bar of identical slices, with its ledger."""
    flat = np.array([[0.0, 0.0], [0.0095, 0.0]])
    rod = meshes.rod(flat, 0.24, ACROSS, slice_length=0.24 / SLICES, nose=False)
    still = np.zeros_like(rod.mesh.points)
    model = body_model(Body(rod, rod.mesh.points, still, 206e9, 0.29, 7850.0))
    state, ledger, cells = model.initial_state(), model.ledger(), len(rod.mesh.cells)
    state.v[:] = np.random.default_rng(1).normal(size=len(state.v)) * (model.inverse_mass > 0)
    plain, vector = plain_stiffness(model), state.x[: model.layout.rod_size].copy()

    def steps() -> None:
        for _ in range(LEDGER_EVERY):
            evaluate(model, state)
            advance(model, state)
        ledger.sample(state)

    product = cpu_ns(lambda: plain @ vector) / cells
    step = cpu_ns(steps, calls=2) / LEDGER_EVERY / cells
    return [
        ("bar of slices: SciPy CSR product", cells, product, 1.0),
        ("bar of slices: force, update, ledger", cells, step, step / product),
    ]


def part_times(model: Model, state: State) -> dict[str, float]:
    """Return the lower decile of the CPU time, ns, of every item over real steps."""
    times: dict[str, list[int]] = {}

    def timed(name: str, work: Callable[[State], None]) -> Callable[[State], None]:
        def clocked(state: State) -> None:
            begun = time.process_time_ns()
            work(state)
            times.setdefault(name, []).append(time.process_time_ns() - begun)

        return clocked

    forces = [
        Timed(force.body, timed(f"{type(force).__name__} of the {force.body}", partial(add_force, force)))
        for force in model.forces
    ]
    watched = replace(model, forces=forces)  # type: ignore[arg-type]
    for _ in range(STEPS):
        begun = time.process_time_ns()
        evaluate(watched, state)
        advance(watched, state)
        times.setdefault("whole step", []).append(time.process_time_ns() - begun)
    return {name: float(np.quantile(found, 0.1)) for name, found in times.items()}


def thread_times(model: Model, state: State) -> list[float]:
    """Return the lower decile of the wall time of a step, ns, with one thread and with two."""
    times: tuple[list[float], list[float]] = [], []
    with Helper(model, state) as helper:
        for turn in range(2 * TURNS):
            begun = time.perf_counter_ns()
            for step in range(10):
                evaluate(model, state, helper if turn % 2 else None)
                # the last step of a turn leaves nothing begun
                advance(model, state, helper if turn % 2 and step < 9 else None)
            times[turn % 2].append((time.perf_counter_ns() - begun) / 10)
    return [float(np.quantile(some, 0.1)) for some in times]


@kernel
def repeat(times, calls):  # type: ignore[no-untyped-def]
    """Make calls again and again, without the interpreter."""
    for _ in range(times):
        perform(calls)


def machine_gain(zone: YieldingZone, state: State) -> float:
    """Return how much more two threads do than one, each updating a zone and state of its own: the limit."""
    work = []
    for _ in range(2):
        apart, moving, nowhere = copy.deepcopy(zone), copy.deepcopy(state), np.zeros(len(state.x), dtype=bool)
        (update,), _ = apart.finding(moving, np.array([state.dt, 0.0]), nowhere)
        work.append((REPEATS, (update, apart.collecting(moving))))
    repeat(*work[0])
    alone, together = [], []
    for _ in range(TURNS):
        begun = time.perf_counter_ns()
        repeat(*work[0])
        alone.append(time.perf_counter_ns() - begun)
        thread = Thread(target=repeat, args=work[1])
        begun = time.perf_counter_ns()
        thread.start()
        repeat(*work[0])
        thread.join()
        together.append(time.perf_counter_ns() - begun)
    return 2 * min(alone) / min(together)


def scene_rows(model: Model, state: State) -> list[Row]:
    """Return the parts of a scene's step, those of the rod and of the barrier over their own elements."""
    rod, barrier = model.geometry.rod.mesh, model.geometry.barrier
    plain, vector = plain_stiffness(model), state.x[: model.layout.rod_size].copy()
    yielding = {zone.body: zone.count for zone in model.zones}
    whole = {"rod": len(rod.cells), "barrier": 0 if barrier is None else len(barrier.cells)}
    product = cpu_ns(lambda: plain @ vector) / len(rod.cells)
    table = [("rod: SciPy CSR product", len(rod.cells), product, 1.0)]
    for name, ns in part_times(model, state).items():
        body = name.split()[-1]
        count = whole[body] - yielding.get(body, 0) if body in whole else sum(whole.values())
        count = yielding[body] if name.startswith(YieldingZone.__name__) else count
        table.append((name, count, ns / count, ns / count / product))
    every, (one, two) = sum(whole.values()), thread_times(model, state)
    table.append(("whole step, one thread (wall)", every, one / every, one / every / product))
    table.append((f"two threads (wall), gain {one / two:.2f}", every, two / every, two / every / product))
    return table


def main(name: str = "t5b") -> None:
    """Print the table."""
    scene = load(name)
    model = build(scene, specify(scene))
    state = model.initial_state()
    while state.time < IN_CONTACT:
        evaluate(model, state)
        advance(model, state)
    print(f"{name}: {len(model.geometry.rod.mesh.cells)} rod cells, triad {triad_gb_per_s():.1f} GB/s")
    print(f"{'part':<42}{'elements':>9}{'ns/element-step':>17}{'of CSR':>8}")
    for part, count, ns, ratio in [*bar_rows(), *scene_rows(model, state)]:
        print(f"{part:<42}{count:9d}{ns:17.1f}{ratio:8.2f}")
    if model.zones:
        gain = machine_gain(model.zones[-1], state)
        print(f"two threads that share nothing gain {gain:.2f} on this machine at this time")


if __name__ == "__main__":
    main(*sys.argv[1:])
