"""Thin rows of cells under the rod's skin: what they change, and what they cost.

    python tests/benchmarks/thin_rows.py OUT [SCENE ...]

The levels of each scene find the contact once. Meshes from that record then run at two or four places of the
barrier's grid, without rows and with them, on two sizes of cells, which takes minutes. What lies in OUT is
not run again. Prints a table of means and draws ``thin-rows.svg`` in OUT.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path
from statistics import fmean
from time import process_time

import matplotlib.pyplot as plt

from fem_impact import Case, load, replace_all
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.case.record import ContactRecord
from fem_impact.run.solid import reduce
from fem_impact.solid.build import build
from fem_impact.solid.run import solve

SHARP = {
    "projectile.tip": "plain",
    "impact.angle": "20 deg",
    "impact.v_n": "-1.88 m/s",
    "impact.v_t": "-0.684 m/s",
}
SCENES = {name: load(name) for name in ("t5b", "ogive", "aluminium-rod", "tube")}
SCENES["sharp"] = replace_all(load("t5b"), {"measured": None, "id": "sharp", **SHARP})
FINER = {"aluminium-rod": (-1, 0), "sharp": (-1, 0)}  # levels from the last one; 0 and 1 of the other scenes
PLACES = {-1: (0.0, 0.25, 0.5, 0.75), 0: (0.0, 0.25, 0.5, 0.75), 1: (0.0, 0.5)}
ROWS = (0, 2)
SHOWN = ("e", "mu", "E_vib", "plastic rod")


def record_of(name, chain, out):
    """Return the record of the contact that the levels of a scene found, and the splits of the last one."""
    kept, splits = out / f"{name}.npz", out / f"{name}.splits"
    if not kept.exists():
        chain.run()
        chain.done[-2].record.write(kept)
        splits.write_text(str(chain.done[-1].splits))
    return ContactRecord.read(kept), int(splits.read_text())


def run(chain, record, splits, rows, place):
    """Return numbers of a run on cells that are split so often, at a place of the barrier's grid."""
    scene = chain._at(splits)
    accuracy = replace(scene.accuracy, grid_shift=place, unresolved="report")
    scene = replace(scene, accuracy=accuracy, save=replace(scene.save, frames=0))
    case, start = Case.of(scene, "solid", record), process_time()
    case.__dict__["zones"] = replace(case.zones, rod_rows=rows)
    model = build(case)
    outcome = reduce(solve(case, model=model))
    return {
        "e": outcome.restitution.edge.e,
        "mu": outcome.restitution.mu,
        "E_vib": outcome.energy.vibration,
        "plastic rod": outcome.energy.plastic_rod,
        "unknowns": int((model.inverse_mass > 0).sum()),
        "cpu": process_time() - start,
    }


def runs_of(name, out):
    """Return the runs of a scene, computing those that are missing: (finer, rows) to a list."""
    path = out / f"{name}.json"
    done = json.loads(path.read_text()) if path.exists() else {}
    chain = LevelChain(Case(SCENES[name]))
    for finer in FINER.get(name, (0, 1)):
        for rows in ROWS:
            for place in PLACES[finer]:
                key = f"{finer} {rows} {place}"
                if key not in done:
                    record, splits = record_of(name, chain, out)
                    done[key] = run(chain, record, splits + finer, rows, place)
                    path.write_text(json.dumps(done, indent=1))
    grouped = {}
    for key, numbers in done.items():
        finer, rows, _ = key.split()
        grouped.setdefault((int(finer), int(rows)), []).append(numbers)
    return grouped


def told(name, grouped):
    """Return the lines of a scene's table: means over the places of the grid, least processor time."""
    lines = []
    for (_, rows), runs in sorted(grouped.items()):
        means = [f"{fmean(run[key] for run in runs):.4g}" for key in SHOWN]
        cells = [name, runs[0]["unknowns"], rows or "none", len(runs), *means]
        cpu = min(run["cpu"] for run in runs)
        lines.append("| " + " | ".join(map(str, cells)) + f" | {cpu:.3g} |")
    return lines


def draw(scenes, path):
    """Draw each quantity of each scene against processor time, without rows and with them."""
    panels = plt.subplots(
        len(SHOWN), len(scenes), figsize=(2.3 * len(scenes), 7.5), sharex="col", layout="constrained"
    )[1]
    for column, (name, grouped) in zip(panels.T, scenes.items(), strict=True):
        for ax, key in zip(column, SHOWN, strict=True):
            for rows, mark, label in ((0, "s--", "no thin rows"), (2, "o-", "two thin rows")):
                found = [runs for (_, of), runs in sorted(grouped.items()) if of == rows]
                cpu = [min(run["cpu"] for run in runs) for runs in found]
                values = [[run[key] for run in runs] for runs in found]
                middle = [fmean(of) for of in values]
                below = [m - min(of) for m, of in zip(middle, values, strict=True)]
                above = [max(of) - m for m, of in zip(middle, values, strict=True)]
                ax.errorbar(cpu, middle, [below, above], fmt=mark, label=label, ms=4, lw=1, capsize=2)
            ax.set(xscale="log", ylabel=key if ax in panels[:, 0] else None)
        column[0].set_title(name)
        column[-1].set_xlabel("processor time, s")
    panels[0, 0].legend(fontsize="small")
    plt.savefig(path)


def main(out, *names):
    """Run what is missing, print the table, draw the figure."""
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    scenes = {name: runs_of(name, folder) for name in names or SCENES}
    print("| scene | unknowns | thin rows | places | " + " | ".join(SHOWN) + " | s |")
    print("|---|---:|---|---:" + "|---:" * (len(SHOWN) + 1) + "|")
    for name, grouped in scenes.items():
        print("\n".join(told(name, grouped)))
    draw(scenes, folder / "thin-rows.svg")


if __name__ == "__main__":
    main(*sys.argv[1:])
