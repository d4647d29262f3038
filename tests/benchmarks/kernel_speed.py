"""Speed of the compiled kernels in ns an element-step, beside a SciPy CSR product on the same mesh.

Run ``python tests/benchmarks/kernel_speed.py [SCENE]``; all rows come from one process and one thread, so
the ratios mean something even on a busy machine. Times are the smallest of several repeats, CPU time.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np

from fem_impact.effects import specify
from fem_impact.scene import load
from fem_impact.solid.build import build
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.model import Model
from fem_impact.solid.state import State


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


def rows(model: Model, state: State) -> list[tuple[str, int, float]]:
    """Return (part, elements, ns an element-step) of each part of a step."""
    elastic, rod = model.forces[0], model.geometry.rod
    n, shape = len(elastic.d), elastic.body_shape
    body = shape[0] * shape[1]
    d, y = elastic.d[:body].reshape(shape), elastic.y[:body].reshape(shape)
    vector = state.x[:n].copy()
    cells, slices = len(rod.mesh.cells), rod.body_cells.size
    table = [
        ("SciPy CSR product, whole rod", cells, cpu_ns(lambda: model.rod_stiffness @ vector) / cells),
        ("slices: stencil alone", slices, cpu_ns(lambda: elastic.slices.apply(d, y)) / slices),
        ("linear rod: frame, stencil, nose, force", cells, cpu_ns(lambda: elastic.add_force(state)) / cells),
    ]
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
