"""What vanishing elements would give: measured sets on a self-similar family of meshes, with limits."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.figures.convergence import convergence_figure
from fem_impact.outcome import Outcome
from fem_impact.output import write_text
from fem_impact.scale import Job, Results
from fem_impact.scene import load, replace_all
from fem_impact.study.markdown import table
from fem_impact.study.request import Request, StudyResult, failures_of
from fem_impact.study.richardson import limit

if TYPE_CHECKING:
    from fem_impact.progress import Meter
    from fem_impact.scene import Scene

Row = dict[str, Any]

SCHEMA = "fem-impact/convergence/1"
SETS = ("t3-machined", "t3-contaminated", "t5b", "t6-17")
# cells over the diameter of the body; every one is split as often, so all meshes of a set are alike
ACROSS, LEVELS = (6, 8, 10, 12), 3
QUICK_ACROSS, QUICK_LEVELS = (6, 8, 10), 2
QUANTITIES = {
    "e": "e_paper",
    "mu": "mu",
    "Omega, rad/s": "Omega_rad_per_s",
    "E_r/E_0": "E_r_over_E_0",
    "vibration/E_0": "E_vib_over_E_0",
    "friction/E_0": "W_friction_over_E_0",
    "plastic rod/E_0": "E_plastic_rod_over_E_0",
    "plastic barrier/E_0": "E_plastic_barrier_over_E_0",
}


def family(scene: Scene, across: Iterable[int], levels: int) -> list[Scene]:
    """Return the scene on meshes that differ in the size of all cells and in nothing else."""
    d = scene.projectile.diameter
    return [
        replace_all(
            scene,
            {
                "accuracy.across": cells,
                "accuracy.tip_size": f"{d / cells / 2**levels * 1e3:.9g} mm",
                "save.frames": 0,
            },
        )
        for cells in across
    ]


def jobs_of(name: str, quick: bool) -> list[Job]:
    """Return the jobs of a set, one a mesh, from coarse to fine."""
    scenes = family(load(name), *((QUICK_ACROSS, QUICK_LEVELS) if quick else (ACROSS, LEVELS)))
    return [Job(f"{name}-{scene.accuracy.across}", scene) for scene in scenes]


def plan(request: Request, results: Results) -> list[Job]:
    """Return the jobs of the sets that are asked for, or of `SETS`."""
    return [job for name in request.ids or SETS for job in jobs_of(name, request.quick)]


def conclude(request: Request, results: Results, progress: Meter) -> StudyResult:
    """Extrapolate every quantity of every set; write table, data and figure."""
    rows = []
    for name in request.ids or SETS:
        runs = [results[job.name] for job in jobs_of(name, request.quick)]
        rows += convergence_rows(name, [run for run in runs if isinstance(run, Outcome)])
    return _write(rows, failures_of(results), request.out)


def convergence_rows(name: str, runs: Sequence[Outcome]) -> list[Row]:
    """Return one row a quantity; none when fewer than three meshes are there."""
    if len(runs) < 3:
        return []
    sizes = [run["tip_size_m"] for run in runs]
    return [
        {"set": name, "quantity": words, "tip_size_m": sizes, "cpu_s": [run["cpu_s"] for run in runs]}
        | _limit(sizes, [run[key] for run in runs])
        for words, key in QUANTITIES.items()
    ]


def _limit(sizes: list[float], values: list[float]) -> Row:
    found = limit(sizes, values)
    return {
        "values": values,
        "limit": found.value,
        "order": found.order,
        "band": found.band,
        "scatter": found.scatter,
    }


def _write(rows: list[Row], failures: list[dict[str, str]], out: Path) -> StudyResult:
    text = convergence_table(rows)
    document = {"schema": SCHEMA, "rows": rows, "failures": failures}
    write_text(out / "convergence.json", json.dumps(document, indent=1, allow_nan=False))
    write_text(out / "summary.md", text)
    convergence_figure(rows, out / "convergence.svg")
    return StudyResult(document, text)


def convergence_table(rows: list[Row]) -> str:
    """Return Markdown: a line a set and quantity, its value on each mesh, limit, order and band."""
    sizes = sorted({size for row in rows for size in row["tip_size_m"]}, reverse=True)
    head = ["set", "quantity", *(f"{size * 1e3:.3g} mm" for size in sizes), "limit", "order", "band"]
    return table(head, [_line(row, sizes) for row in rows]) + "\n"


def _line(row: Row, sizes: list[float]) -> list[str]:
    values = dict(zip(row["tip_size_m"], row["values"], strict=True))
    cells = [f"{values[size]:.4g}" if size in values else "" for size in sizes]
    order = "-" if row["order"] is None else f"{row['order']:.1f}"
    return [row["set"], row["quantity"], *cells, f"{row['limit']:.4g}", order, f"{row['band']:.2g}"]
