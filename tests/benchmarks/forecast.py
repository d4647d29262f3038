"""How far the forecast of a mesh by the one before it is off: of the runs that a cost study has stored.

Usage: python tests/benchmarks/forecast.py results/cost/paper
"""

import sqlite3
import sys
from dataclasses import replace
from math import exp, log
from pathlib import Path
from statistics import fmean

from fem_impact.answers.refine.budget import calibration_factor, planned_s
from fem_impact.answers.refine.levels import MESH_LEVELS, at_offsets
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import load
from fem_impact.scene.types import MEASURED_SETS


def timed(run: Outcome) -> Outcome:
    """Return an outcome whose wall time is its processor time: other programs do not count."""
    return replace(run, cost=replace(run.cost, wall=run.cost.whole_cpu, setup_wall=0.0))


def main(folder: Path) -> None:
    """Print planned, forecast and real processor time of each mesh of the measured sets."""
    ratios = []
    for name in MEASURED_SETS:
        with sqlite3.connect(folder / name / "store.sqlite") as base:
            found = base.execute("SELECT name, outcome FROM answers WHERE outcome IS NOT NULL")
            stored = {key: Outcome.from_json(text) for key, text in found}
        last = None
        for mesh in MESH_LEVELS:
            scenes = at_offsets(load(name), mesh)
            size = f"{scenes[0].id}: solid {mesh.sizes(scenes[0])[0] * 1e3:.3g} mm, grid at "
            runs = [
                timed(stored[key])
                for one in scenes
                if (key := f"{size}{one.accuracy.grid_shift:g}") in stored
            ]
            if len(runs) < len(scenes):
                continue
            planned, took = planned_s(scenes, 1), sum(run.cost.whole_cpu for run in runs)
            edge = f"{mesh.sizes(scenes[0])[0] * 1e3:.3g} mm"
            line = f"{name:16} {edge}: planned {planned:.1f} s, took {took:.1f} s"
            if last:
                ratios.append(took / (last * planned))
                line += f", forecast {last * planned:.1f} s"
            print(line)
            last = calibration_factor(scenes, runs, 1)
    spread = exp(fmean(log(ratio) ** 2 for ratio in ratios) ** 0.5)
    print(f"took over forecast: {min(ratios):.2f} to {max(ratios):.2f}, root mean square factor {spread:.2f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
