"""Thin rows under the rod's skin and narrow columns at the ends of the contact: what they change and cost.

    python tests/benchmarks/thin_rows.py OUT [SCENE ...]

The levels of each scene find the contact once. Meshes from that record then run at four places of the
barrier's grid: with cells all alike, with thin rows, and with both; and at two places with cells half as
large, all alike, which takes up to two minutes a run. What lies in OUT is not run again. Prints a table of
means and draws ``thin-rows.svg`` in OUT.
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
    "projectile": {"shape": "flat", "length": "80 mm", "diameter": "19 mm", "material": "rod-steel"},
    "impact": {"angle": "20 deg", "speed": "2 m/s"},
}
SCENES = {name: load(name) for name in ("t5b", "ogive", "aluminium-rod", "tube")}
SCENES["sharp"] = replace_all(load("t5b"), {"measured": None, "id": "sharp", **SHARP})
COARSER = {"aluminium-rod": 1, "sharp": 1}  # levels before the last one of a run, whose cells are compared
ALIKE, ROWS, BOTH = "all alike", "thin rows", "rows and ends"
PLACES = {0: (0.0, 0.25, 0.5, 0.75), 1: (0.0, 0.5)}
STYLES = {ALIKE: "s--", ROWS: "^", BOTH: "o"}
SHOWN = ("e", "mu", "E_vib", "plastic rod")


def record_of(name, out):
    """Return the levels of a scene, the record of the contact that they found, and the last one's splits."""
    chain, kept, splits = LevelChain(Case(SCENES[name])), out / f"{name}.npz", out / f"{name}.splits"
    if not kept.exists():
        chain.run()
        chain.done[-2].record.write(kept)
        splits.write_text(str(chain.done[-1].splits))
    return chain, ContactRecord.read(kept), int(splits.read_text())


def run(chain, record, splits, kind, place):
    """Return numbers of a run on cells that are split so often, at a place of the barrier's grid."""
    scene = chain.meshes.at(splits)
    accuracy = replace(scene.accuracy, grid_shift=place, unresolved="report")
    scene = replace(scene, accuracy=accuracy, save=replace(scene.save, frames=0))
    if kind != BOTH:
        record = replace(record, sites=())  # without places of contact their ends are not known
    case, start = Case.of(scene, "solid", record), process_time()
    if kind == ALIKE:
        case.__dict__["zones"] = replace(case.zones, rod_rows=0)
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
    """Return the runs of a scene, computing those that are missing: (finer, kind) to a list."""
    path = out / f"{name}.json"
    done = json.loads(path.read_text()) if path.exists() else {}
    wanted = [(0, kind, place) for kind in STYLES for place in PLACES[0]]
    wanted += [(1, ALIKE, place) for place in PLACES[1]]
    grouped = {}
    for finer, kind, place in wanted:
        key = f"{finer} {kind} {place}"
        if key not in done:
            chain, record, splits = record_of(name, out)
            done[key] = run(chain, record, splits + finer - COARSER.get(name, 0), kind, place)
            path.write_text(json.dumps(done, indent=1))
        grouped.setdefault((finer, kind), []).append(done[key])
    return grouped


def told(name, grouped):
    """Return the lines of a scene's table: means over the places of the grid, least processor time."""
    lines = []
    for (finer, kind), runs in grouped.items():
        means = [f"{fmean(run[key] for run in runs):.3g}" for key in SHOWN]
        cells = [name, "half" * finer or "1", kind, runs[0]["unknowns"], *means]
        lines.append("| " + " | ".join(map(str, cells)) + f" | {min(run['cpu'] for run in runs):.2g} |")
    return lines


def draw(scenes, path):
    """Draw each quantity of each scene against processor time: means, with the range over the places."""
    size = 2.3 * len(scenes), 7.5
    panels = plt.subplots(len(SHOWN), len(scenes), figsize=size, sharex="col", layout="constrained")[1]
    for column, (name, grouped) in zip(panels.T, scenes.items(), strict=True):
        times = [run["cpu"] for runs in grouped.values() for run in runs]
        least, most = min(times), max(times)
        for ax, key in zip(column, SHOWN, strict=True):
            for kind, style in STYLES.items():
                found = [runs for (_, of), runs in grouped.items() if of == kind]
                cpu = [min(run["cpu"] for run in runs) for runs in found]
                values = [[run[key] for run in runs] for runs in found]
                middle = [fmean(of) for of in values]
                below = [m - min(of) for m, of in zip(middle, values, strict=True)]
                above = [max(of) - m for m, of in zip(middle, values, strict=True)]
                ax.errorbar(cpu, middle, [below, above], fmt=style, label=kind, ms=5, lw=1, capsize=2)
            ax.set(xscale="log", xticks=(2, 5, 10, 20, 50, 100), xticklabels=(2, 5, 10, 20, 50, 100))
            ax.minorticks_off()
            ax.set(xlim=(0.8 * least, 1.25 * most), ylabel=key if ax in panels[:, 0] else None)
        column[0].set_title(name)
        column[-1].set_xlabel("processor time, s")
    panels[0, 0].legend(fontsize="x-small")
    plt.savefig(path)


def main(out, *names):
    """Run what is missing, print the table, draw the figure."""
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    scenes = {name: runs_of(name, folder) for name in names or SCENES}
    print("| scene | cells | their shape | unknowns | " + " | ".join(SHOWN) + " | s |")
    print("|---|---|---|---:" + "|---:" * (len(SHOWN) + 1) + "|")
    for name, grouped in scenes.items():
        print("\n".join(told(name, grouped)))
    draw(scenes, folder / "thin-rows.svg")


if __name__ == "__main__":
    main(*sys.argv[1:])
