"""Time of an element-step in CalculiX' explicit dynamics, beside a CSR product and this solver (optional).

    python tests/benchmarks/calculix_speed.py [ACROSS] [SLICES]

One mesh for all, half an elastic bar that stretches freely, one thread. CalculiX takes the time of a run with
the longer span less that of the shorter one, so that reading and setting up do not count, and its own step,
which follows the deformation; this solver has incompatible modes and keeps its ledger. The last columns are
what a microsecond of motion costs and how far the free end is from where this solver has it. Debian's
package calculix-ccx holds the program; nothing of this project needs it.
"""

import os
import resource
import shutil
import subprocess
import sys
from dataclasses import replace
from math import ceil
from pathlib import Path
from tempfile import mkdtemp

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from calculix import last_table, numbered
from kernel_speed import LEDGER_EVERY, cpu_ns, plain_stiffness

import meshes
from fem_impact.evidence.problems.bodies import FreeBody, body_model
from fem_impact.solid.march import advance, evaluate

LENGTH, RADIUS, E, NU, RHO = 0.24, 0.0095, 206e9, 0.29, 7850.0
SPANS = (1e-5, 4e-5)  # s of motion
STRETCH = 1.0  # m/s over half the length


def bar(across, slices):
    """Return the bar's mesh and the velocity of its nodes (n, 3), m/s."""
    flat = np.array([[0.0, 0.0], [RADIUS, 0.0]])
    rod = meshes.rod(flat, LENGTH, across, slice_length=LENGTH / slices, nose=False)
    velocity = np.zeros_like(rod.mesh.points)
    velocity[:, 2] = STRETCH * (rod.mesh.points[:, 2] / LENGTH - 0.5)
    return rod, velocity


def deck(mesh, velocity, kind, end):
    """Return the input deck of a free bar on its symmetry plane."""
    middle = np.flatnonzero(np.abs(mesh.points[:, 1]) < 1e-12) + 1
    parts = [
        ["*NODE", *numbered(mesh.points)],
        [f"*ELEMENT, TYPE={kind}, ELSET=BAR", *numbered(mesh.cells + 1)],
        ["*NSET, NSET=MIDDLE", *map(str, middle), "*NSET, NSET=TOP", str(len(mesh.points))],
        ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{E:g}, {NU}", "*DENSITY", f"{RHO:g}"],
        ["*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL", "*BOUNDARY", "MIDDLE, 2, 2"],
        ["*INITIAL CONDITIONS, TYPE=VELOCITY"],
        [f"{i + 1}, 3, {v:.9g}" for i, v in enumerate(velocity[:, 2])],
        ["*STEP, NLGEOM, INC=1000000", "*DYNAMIC, EXPLICIT", f"1e-8, {end:g}"],
        ["*NODE PRINT, NSET=TOP, FREQUENCY=1", "U", "*END STEP", ""],
    ]
    return "\n".join(line for part in parts for line in part)


def calculix(mesh, velocity, kind, end):
    """Return CPU time, s, steps, and the top node's displacement along the bar, m, of a run of CalculiX."""
    folder = Path(mkdtemp(prefix="calculix-"))
    (folder / "bar.inp").write_text(deck(mesh, velocity, kind, end))
    one_thread = os.environ | {"OMP_NUM_THREADS": "1"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = ["ccx", "-i", "bar"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL, env=one_thread)
    took = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    text = (folder / "bar.dat").read_text()
    shutil.rmtree(folder)
    return took, text.count("displacements"), last_table(text, "displacements")[0, 2]


def ours(rod, velocity, end):
    """Return CPU times, ns, of a CSR product and of a step with ledger; steps to the end; displacement, m."""
    model = body_model(FreeBody(rod, rod.mesh.points, velocity, E, NU, RHO))
    count = ceil(end / model.step)
    model = replace(model, steps={"rod": end / count})
    state, ledger, node = model.initial_state(), model.ledger(), model.layout.rod[-1]

    def steps(number=LEDGER_EVERY):
        for _ in range(number):
            evaluate(model, state)
            advance(model, state)
        ledger.sample(state)

    steps(count)
    moved = model.nodes(state.x)[node][2] - model.nodes(model.start[0])[node][2]
    K, u = plain_stiffness(model), state.x[: model.layout.rod_size].copy()
    return cpu_ns(lambda: K @ u), cpu_ns(steps, calls=2) / LEDGER_EVERY, count, moved


def main(across=8, slices=96):
    """Print the table; without CalculiX only this solver's rows."""
    rod, velocity = bar(int(across), int(slices))
    cells, end = len(rod.mesh.cells), SPANS[1]
    product, step, count, moved = ours(rod, velocity, end)
    product /= cells
    rows = [("SciPy CSR product", product, None, None), ("this solver", step / cells, end / count, moved)]
    if shutil.which("ccx"):
        for kind in ("C3D8", "C3D8R"):
            (less, few, _), (more, many, top) = (calculix(rod.mesh, velocity, kind, span) for span in SPANS)
            ns = (more - less) / (many - few) / cells * 1e9
            rows.append((f"CalculiX {kind}", ns, (SPANS[1] - SPANS[0]) / (many - few), top))
    else:
        print("ccx is not installed")
    print(f"{cells} cells")
    print(f"{'':<20}{'ns/element-step':>16}{'of CSR':>8}{'step, ns':>10}{'ms/us':>8}{'end off, %':>12}")
    for name, ns, dt, top in rows:
        tail = "" if dt is None else f"{dt * 1e9:>10.0f}{ns * cells * 1e-12 / dt:>8.2f}"
        tail += "" if top is None else f"{100 * (top / moved - 1):>12.2f}"
        print(f"{name:<20}{ns:>16.0f}{ns / product:>8.2f}{tail}")


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
