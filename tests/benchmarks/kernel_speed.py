"""Speed of the compiled kernels in ns an element-step, beside a SciPy CSR product on the same mesh.

Run ``python tests/benchmarks/kernel_speed.py [SCENE]``; all rows come from one process, so the ratios mean
something even on a busy machine. Parts of a scene are timed while it runs, for yielding depends on the
increment: lower deciles of CPU time over steps in the contact.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from scipy.sparse import csr_matrix

import meshes
from fem_impact.case.case import Case
from fem_impact.evidence.problems.bodies import FreeBody, body_model
from fem_impact.fem.elements import lame_constants
from fem_impact.fem.sparse import assemble, tie_operator
from fem_impact.scene.shipped import load
from fem_impact.solid.build import build
from fem_impact.solid.march import advance, evaluate
from fem_impact.solid.model import Model
from fem_impact.solid.state import State
from fem_impact.solid.yielding import YieldingZone

Row = tuple[str, int, float, float]  # part, elements, ns an element-step, over the CSR product's
ACROSS, SLICES = 12, 144  # cells across and along the bar
LEDGER_EVERY = 20  # steps, as a scene's history
IN_CONTACT = 60e-6  # s: elements yield, nodes touch
STEPS = 400


@dataclass(frozen=True, slots=True)
class Timed:
    """A force under the clock."""

    body: str
    add: Callable[[State], None]


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
    lame, T = lame_constants(2e11, 0.29), tie_operator(mesh.tie, layout.rod, layout.rod_size)
    return assemble(mesh.points, mesh.cells, lame, "incompatible", T)


def bar_rows() -> list[Row]:
    """Return the CSR product and the whole step of a linear bar of identical slices, with its ledger."""
    flat = np.array([[0.0, 0.0], [0.0095, 0.0]])
    rod = meshes.rod(flat, 0.24, ACROSS, slice_length=0.24 / SLICES, nose=False)
    still = np.zeros_like(rod.mesh.points)
    model = body_model(FreeBody(rod, rod.mesh.points, still, 206e9, 0.29, 7850.0))
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
        Timed(force.body, timed(f"{type(force).__name__} of the {force.body}", force.add))
        for force in model.forces
    ]
    watched = replace(model, forces=forces)  # type: ignore[arg-type]
    for _ in range(STEPS):
        begun = time.process_time_ns()
        evaluate(watched, state)
        advance(watched, state)
        times.setdefault("whole step", []).append(time.process_time_ns() - begun)
    return {name: float(np.quantile(found, 0.1)) for name, found in times.items()}


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
    return table


def main(name: str = "t5b") -> None:
    """Print the table."""
    scene = load(name)
    model = build(Case.of(scene))
    state = model.initial_state()
    while state.time < IN_CONTACT:
        evaluate(model, state)
        advance(model, state)
    print(f"{name}: {len(model.geometry.rod.mesh.cells)} rod cells, triad {triad_gb_per_s():.1f} GB/s")
    print(f"{'part':<42}{'elements':>9}{'ns/element-step':>17}{'of CSR':>8}")
    for part, count, ns, ratio in [*bar_rows(), *scene_rows(model, state)]:
        print(f"{part:<42}{count:9d}{ns:17.1f}{ratio:8.2f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
