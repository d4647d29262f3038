"""The plain full model beside the present one: errors of e and E_vib, CPU time, and its ratio at equal error.

    git worktree add PLAIN c48d227
    python tests/benchmarks/plain_model.py PLAIN OUT [SET ...]

PLAIN holds the last revision before element-steps were saved: the step of the single elements' bound, the
return to the yield surface in every element, runs that wait for the rod to rise above its crater. Both run
with its effects on the same meshes, one process after the other; what lies in OUT is not run again. An error
is the distance from the limit of the present model's meshes, each at two places of the barrier's grid, over
the scale of the cost ladder.
At equal error: CPU time of the plain model where the line through its two meshes, in logarithms, has the
error of the present finer mesh, or what its meshes bound; a dash where its error does not fall.
"""

import json
import os
import subprocess
import sys
from math import exp, log
from pathlib import Path

from fem_impact.answers.refine.chain import GRID_OFFSETS
from fem_impact.answers.refine.extrapolate import MeshRuns, quantity_limits
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.answers.refine.quantities import QUANTITIES, TARGETED
from fem_impact.case.case import Case
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load

PRESENT = Path(__file__).parents[2]
SETS = ("t5b", "t3-machined", "t6-17")
# what the plain model has: its block always radiates, and nothing hardens with the rate
EFFECTS = "vibration, friction, rod-plasticity, barrier-elastoplastic, gravity, large-rotation, radiation"
FINER = (-1, 0, 1)  # splits of the meshes beyond those that resolve the estimated contact
COMPARED = FINER[:2]
NAMED = {quantity.name: quantity for quantity in QUANTITIES}


def outcome(model, name, finer, out, place=0.0):
    """Return the file of a set's outcome, made by one model in its own process unless it lies in ``out``."""
    kind = "present" if model == PRESENT else "plain"
    folder = out / f"{kind}-{name}-{finer}{f'-at-{place:g}' if place else ''}"
    if not (folder / "outcome.json").exists():
        meshes = LevelMeshes(Case(load(name)))
        stated = meshes.at(meshes.usual + finer).accuracy
        tip, barrier = (f"{size * 1e3:.9g} mm" for size in (stated.tip_size, stated.barrier_size))
        changes = [f"accuracy.across={stated.across}", f"accuracy.tip_size={tip}", "save.frames=0"]
        if model == PRESENT:
            changes += [
                f"effects={EFFECTS}",
                "accuracy.levels=1",
                f"accuracy.grid_shift={place}",
                f"accuracy.barrier_size={barrier}",
            ]
        words = [word for change in changes for word in ("--set", change)]
        command = [sys.executable, "-m", "fem_impact", "run", name, *words, "--quiet", "--out", str(folder)]
        alone = {"PYTHONPATH": str(model), "OPENBLAS_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
        subprocess.run(command, cwd=model, env=os.environ | alone, check=True, stdout=subprocess.DEVNULL)
    return folder / "outcome.json"


def at_equal_error(plain, present):
    """Return the plain model's time over the present one's, both as (error, time), or what bounds it."""
    (coarse, short), (fine, long) = plain
    error, time = present[1]
    if not 0 < fine < coarse:
        return "-"
    if error < fine:
        return f"> {long / time:.3g}"
    if error > coarse:
        return f"< {short / time:.3g}"
    share = log(error / fine) / log(coarse / fine)
    return f"{exp((1 - share) * log(long) + share * log(short)) / time:.3g}"


def off(run, quantity, limit):
    """Return the distance from the limit over the scale; ``run`` are flat keys, of an older version too."""
    return abs(sum(run[key.name] for key in NAMED[quantity].keys) - limit.value) / limit.scale


def told(name, plain, out):
    """Return the lines of one set."""
    paths = [[outcome(PRESENT, name, finer, out, at) for at in GRID_OFFSETS] for finer in FINER]
    runs = [[Outcome.read(path) for path in of_mesh] for of_mesh in paths]
    limits = quantity_limits([MeshRuns(of_mesh[0].cost.tip_size, of_mesh) for of_mesh in runs])
    files = {model: [outcome(model, name, finer, out) for finer in COMPARED] for model in (plain, PRESENT)}
    runs = {model: [json.loads(path.read_text("utf-8")) for path in paths] for model, paths in files.items()}
    lines = []
    for quantity in TARGETED:
        limit = limits[quantity]
        points = {model: [(off(run, quantity, limit), run["cpu_s"]) for run in runs[model]] for model in runs}
        pairs = list(zip(points[plain], points[PRESENT], strict=True))
        cells = [f"{100 * found:.1f} %, {cpu:.1f} s" for pair in pairs for found, cpu in pair]
        same = " / ".join(f"{theirs[1] / ours[1]:.2g}" for theirs, ours in pairs)
        equal = at_equal_error(points[plain], points[PRESENT])
        known = f"{limit.value:.4f} ± {limit.band:.1g}"
        lines.append(f"| {name} | {quantity} | {known} | {' | '.join(cells)} | {same} | {equal} |")
    return lines


def main(plain, out, *names):
    """Print the table."""
    sizes = ["0.59 mm plain", "program", "0.30 mm plain", "program"]
    titles = ["set", "of", "extrapolated", *sizes, "CPU ratio, same mesh", "at equal error"]
    print("|", " | ".join(titles), "|")
    print("|", " | ".join(["---"] * 9), "|")
    for name in names or SETS:
        print(*told(name, Path(plain).resolve(), Path(out).resolve()), sep="\n", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
