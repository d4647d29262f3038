"""What vanishing elements would give: measured sets on a self-similar family of meshes, with limits."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.figures.convergence import convergence_figure
from fem_impact.outcome import Outcome
from fem_impact.output import make_directory, write_text
from fem_impact.scene import load, replace_all
from fem_impact.study.cases import Case, Failure
from fem_impact.study.markdown import table
from fem_impact.study.richardson import limit
from fem_impact.study.sets import run_cases

if TYPE_CHECKING:
    from fem_impact.progress import Meter
    from fem_impact.scene import Scene

Row = dict[str, Any]

SCHEMA = "fem-impact/convergence/1"
SETS = ("t3-machined", "t3-contaminated", "t5b", "t6-17")
# cells over the diameter of the body; every one is split as often, so all meshes of a set are alike
ACROSS, QUICK_ACROSS, LEVELS = (6, 8, 10, 12), (4, 6, 8), 3
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


@dataclass(frozen=True, slots=True)
class Convergence:
    """One row a set and quantity (sizes, values, limit, order, band, scatter), its text, what failed."""

    rows: list[Row]
    table: str
    failures: list[dict[str, str]]


def family(scene: Scene, across: Iterable[int]) -> list[Scene]:
    """Return the scene on meshes that differ in the size of all cells and in nothing else."""
    d = scene.projectile.diameter
    return [
        replace_all(
            scene,
            {
                "accuracy.across": cells,
                "accuracy.tip_size": f"{d / cells / 2**LEVELS * 1e3:.9g} mm",
                "save.frames": 0,
            },
        )
        for cells in across
    ]


def run_convergence(
    ids: Iterable[str],
    across: Sequence[int],
    out: Path,
    progress: Meter,
    workers: int,
    executor: Executor | None = None,
) -> Convergence:
    """Compute sets on a family of meshes and extrapolate every quantity.

    Parameters
    ----------
    ids : set ids; `SETS` when empty
    across : cells over the diameter, three or more
    out : study directory; finished cases in it are not computed again
    """
    names = list(ids) or list(SETS)
    cases = {
        name: [Case(s, out / f"{name}-{s.accuracy.across}") for s in family(load(name), sorted(set(across)))]
        for name in names
    }
    make_directory(out)
    done = run_cases([case for group in cases.values() for case in group], progress, workers, executor)
    failures = [
        {"scene_id": f.case.out.name, "error": f.reason} for f in done.values() if isinstance(f, Failure)
    ]
    rows = []
    for name in names:
        runs = [done[case.out.name] for case in cases[name]]
        rows += convergence_rows(name, [run for run in runs if isinstance(run, Outcome)])
    return _write(rows, failures, out)


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


def _write(rows: list[Row], failures: list[dict[str, str]], out: Path) -> Convergence:
    text = convergence_table(rows)
    document = {"schema": SCHEMA, "rows": rows, "failures": failures}
    write_text(out / "convergence.json", json.dumps(document, indent=1, allow_nan=False))
    write_text(out / "summary.md", text)
    convergence_figure(rows, out / "convergence.svg")
    return Convergence(rows, text, failures)


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
