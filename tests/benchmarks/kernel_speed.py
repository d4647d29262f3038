"""Speed of the compiled kernels in ns an element-step, beside a SciPy CSR product on the same mesh.

Run ``python tests/benchmarks/kernel_speed.py [SCENE]``; all rows come from one process, so
the ratios mean something even on a busy machine. Times are the smallest of several repeats, CPU time but for
the last two rows, which need two free cores.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from scipy.sparse import csr_matrix

from fem_impact.effects import specify
from fem_impact.scene import load
from fem_impact.solid.build import build
from fem_impact.solid.elastic import ElasticBlock
from fem_impact.solid.elements import element_stiffness, isotropic_stiffness
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.model import Model
from fem_impact.solid.sparse import assemble, tie_operator
from fem_impact.solid.state import State

HELPER = ThreadPoolExecutor(1)


def cpu_ns(work: Callable[[], object], repeats: int = 7, calls: int = 40) -> float:
    """Return the smallest CPU time of one call, ns."""
    best = float("inf")
    for _ in range(repeats):
        begun = time.process_time_ns()
        for _ in range(calls):
            work()
        best = min(best, (time.process_time_ns() - begun) / calls)
    return best


def wall_ns(work: Callable[[], object], repeats: int = 200) -> float:
    """Return the smallest wall time of one call, ns: many short tries find moments with both cores free."""
    best = float("inf")
    for _ in range(repeats):
        begun = time.perf_counter_ns()
        work()
        best = min(best, time.perf_counter_ns() - begun)
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
    K = element_stiffness(mesh.points, mesh.cells, isotropic_stiffness(2e11, 0.29), "incompatible")
    return assemble(K, mesh.cells, tie_operator(mesh.tie, layout.rod, layout.rod_size))


def rows(model: Model, state: State) -> list[tuple[str, int, float]]:
    """Return (part, elements, ns an element-step) of each part of a step."""
    elastic, rod = model.forces[0], model.geometry.rod
    n, plain = len(elastic.d), plain_stiffness(model)
    d, y = model.layout.slices_of(elastic.d), model.layout.slices_of(elastic.y)
    vector = state.x[:n].copy()
    cells, slices = len(rod.mesh.cells), rod.body_cells.size
    table = [
        ("SciPy CSR product, whole rod", cells, cpu_ns(lambda: plain @ vector) / cells),
        ("slices: stencil alone", slices, cpu_ns(lambda: elastic.slices.apply(d, y)) / slices),
        ("linear rod: frame, stencil, nose, force", cells, cpu_ns(lambda: elastic.add_force(state)) / cells),
    ]
    for block in (force for force in model.forces if isinstance(force, ElasticBlock)):
        linear = len(model.geometry.barrier.cells) - model.zones[-1].count
        table.append(("linear block", linear, cpu_ns(lambda b=block: b.add_force(state)) / linear))
    for zone in model.zones:
        table.append(
            (
                f"yielding {zone.body}: B-bar, J2",
                zone.count,
                cpu_ns(lambda z=zone: z.add_force(state)) / zone.count,
            )
        )
    every = cells + (len(model.geometry.barrier.cells) if model.geometry.barrier is not None else 0)

    def step() -> None:
        evaluate(model, state)
        advance(model, state)

    table.append(("whole step, all bodies and contact", every, cpu_ns(step) / every))
    for words, helper in (("forces, one thread (wall)", None), ("forces, two threads (wall)", HELPER)):
        table.append((words, every, wall_ns(lambda h=helper: evaluate(model, state, h)) / every))
    return table


def main(name: str = "t5b") -> None:
    """Print the table."""
    scene = load(name)
    model = build(scene, specify(scene))
    state = model.initial_state()
    for _ in range(2000):  # into the contact, so that elements yield and nodes touch
        evaluate(model, state)
        advance(model, state)
    table = rows(model, state)
    yardstick = table[0][2]
    print(
        f"{name}: {len(model.geometry.rod.mesh.cells)} rod cells, triad {triad_gb_per_s():.1f} GB/s, 1 thread"
    )
    print(f"{'part':<42}{'elements':>9}{'ns/element-step':>17}{'of CSR':>8}")
    for part, count, ns in table:
        print(f"{part:<42}{count:9d}{ns:17.1f}{ns / yardstick:8.2f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
