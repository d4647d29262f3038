"""What vanishing elements would give: measured sets on a family of meshes, with limits."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from statistics import fmean
from typing import TYPE_CHECKING, Any

from fem_impact.cost.limits import limit, pair_limit
from fem_impact.cost.settings import FAMILY, placed
from fem_impact.figures.lines import Panel, Series
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import Results
from fem_impact.outcome.keys import Key, known
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import shares
from fem_impact.scene.shipped import load, replace_all
from fem_impact.study.document import Picture, Request, Sheet, StudyReport, StudyResult, publish
from fem_impact.tables.table import Cell, Table

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter
    from fem_impact.scene.types import Scene


Row = dict[str, Any]

SETS = ("t3-machined", "t3-contaminated", "t5b", "t6-17")
DEFAULT = 0.019 / 8 / 2**3  # m, tip of the measured sets at their own accuracy
TOLD = ("e", "mu", "vibration/E_0")
CAPTION = "Each quantity against the size of the elements; rings: limits for vanishing elements."
QUANTITIES = {
    "e": KEY_TABLE["e_paper"],
    "mu": KEY_TABLE["mu"],
    "Omega, rad/s": KEY_TABLE["Omega_rad_per_s"],
    "E_r/E_0": KEY_TABLE["E_r_over_E_0"],
    **{share.title: share.key for share in shares("comparison") if "study" in share.shown},
    "friction and skin/E_0": KEY_TABLE["W_skin_over_E_0"],
}


def jobs_of(name: str, quick: bool) -> list[list[Job]]:
    """Return the jobs of a set: for each mesh, from coarse to fine, one a place of the barrier's grid.

    The quick study leaves out the finest mesh and all places but the first.
    """
    plain = replace_all(load(name), {"save.frames": 0})
    meshes, places = (FAMILY[:-1], 1) if quick else (FAMILY, None)
    return [[_job(scene) for scene in placed(plain, mesh)[:places]] for mesh in meshes]


def _job(scene: Scene) -> Job:
    size, place = scene.accuracy.tip_size * 1e3, scene.accuracy.grid_shift
    return Job(f"{scene.id}-{size:.3f}-{place:g}", scene)


def plan(request: Request, results: Results) -> list[Job]:
    """Return the jobs of the sets that are asked for, or of `SETS`."""
    return [job for name in request.ids or SETS for mesh in jobs_of(name, request.quick) for job in mesh]


def conclude(request: Request, results: Results, progress: ProgressMeter) -> StudyResult:
    """Extrapolate every quantity of every set; write table, data and figure."""
    rows = []
    for name in request.ids or SETS:
        runs = [[results[job.name] for job in mesh] for mesh in jobs_of(name, request.quick)]
        done = [[run for run in mesh if isinstance(run, Outcome)] for mesh in runs]
        rows += convergence_rows(name, [mesh for mesh in done if mesh])
    report = StudyReport(
        "convergence",
        "What vanishing elements would give",
        [*(_sentence(row) for row in rows if row["quantity"] in TOLD), *_pairs(rows)],
        (Picture("convergence", CAPTION, tuple(_panels(rows))),) if rows else (),
        (_sheet(rows),),
        ("Order, limit and band: Eca and Hoekstra 2014, doi:10.1016/j.jcp.2014.01.006.",),
        ("convergence",),
        [("convergence", _sentence(row)) for row in rows if row["quantity"] == "e"],
    )
    return publish(report, request, results)


def convergence_rows(name: str, meshes: Sequence[Sequence[Outcome]]) -> list[Row]:
    """Return one row a quantity; none when fewer than three meshes are there.

    ``meshes`` are, from coarse to fine, the outcomes of a mesh at its places of the barrier's grid.
    """
    if len(meshes) < 3:
        return []
    sizes = [known(runs[0].cost.tip_size) for runs in meshes]
    costs = [sum(run.cost.cpu for run in runs) for runs in meshes]
    return [
        {"set": name, "quantity": words, "tip_size_m": sizes, "cpu_s": costs}
        | _values_row(sizes, [_known(key, runs) for runs in meshes])
        for words, key in QUANTITIES.items()
    ]


def _known(key: Key, runs: Sequence[Outcome]) -> list[float]:
    """Return a number in every run of a mesh."""
    return [known(key.of(run)) for run in runs]


def _values_row(sizes: list[float], values: list[list[float]]) -> Row:
    """Return the limit of the means on each mesh, and how far the places of each are apart."""
    apart = {"apart": [max(held) - min(held) for held in values]}
    return _limit(sizes, [fmean(held) for held in values]) | apart


def _limit(sizes: list[float], values: list[float]) -> Row:
    found = limit(sizes, values)
    return {
        "values": values,
        "limit": found.value,
        "order": found.order,
        "band": found.band,
        "scatter": found.scatter,
    }


def _sentence(row: Row) -> str:
    size, value = row["tip_size_m"][-1] * 1e3, row["values"][-1]
    order = "no clear order" if row["order"] is None else f"order {row['order']:.1f}"
    return (
        f"{row['set']}, {row['quantity']}: {value:.4g} ± {row['band']:.2g} at {size:.3g} mm, "
        f"limit {row['limit']:.4g} ({order}); at {DEFAULT * 1e3:.3g} mm, the usual mesh, "
        f"{_usual(row) - row['limit']:+.2g} off the limit."
    )


def _pairs(rows: list[Row]) -> list[str]:
    """Say how often two of the meshes, extrapolated with their band, hold the limit of all."""
    held = [_holds(row, *pair) for row in rows for pair in combinations(range(len(row["values"])), 2)]
    return (
        [f"Two meshes, extrapolated: {sum(held)} of {len(held)} bands hold the limit of all."] if held else []
    )


def _holds(row: Row, coarse: int, fine: int) -> bool:
    size, value = row["tip_size_m"], row["values"]
    found, band = pair_limit(value[fine], value[coarse], size[coarse] / size[fine])
    return bool(abs(found - row["limit"]) <= band + 1e-9 * abs(found))


def _usual(row: Row) -> float:
    """Return the value on the mesh nearest to the usual one."""
    nearest = min(range(len(row["values"])), key=lambda i: abs(row["tip_size_m"][i] - DEFAULT))
    return float(row["values"][nearest])


def _sheet(rows: list[Row]) -> Sheet:
    """Return a line a set and quantity: its value on each mesh, limit, order, band and scatter."""
    sizes = sorted({size for row in rows for size in row["tip_size_m"]}, reverse=True)
    columns = (
        "set",
        "quantity",
        *(f"{size * 1e3:.3g} mm" for size in sizes),
        "limit",
        "order",
        "band",
        "scatter",
        "places apart",
    )
    return Sheet(
        "convergence",
        "Values by the element at the tip, means over places of the barrier's grid; order – is none; "
        "places apart: their largest difference on the finest mesh",
        Table.of(columns, [_line(r, sizes) for r in rows]),
    )


def _line(row: Row, sizes: list[float]) -> list[Cell]:
    values = dict(zip(row["tip_size_m"], row["values"], strict=True))
    found = (row[key] for key in ("limit", "order", "band", "scatter"))
    return [row["set"], row["quantity"], *(values.get(size) for size in sizes), *found, row["apart"][-1]]


def _panels(rows: list[Row]) -> list[Panel]:
    """Return a panel a quantity: a line a set, and its limit at element size 0."""
    return [_panel(name, [row for row in rows if row["quantity"] == name]) for name in QUANTITIES]


def _panel(name: str, rows: list[Row]) -> Panel:
    lines = [
        Series(row["set"], [1e3 * size for size in row["tip_size_m"]], row["values"], colour=at)
        for at, row in enumerate(rows)
    ]
    limits = [
        Series(f"{row['set']}, limit", [0.0], [row["limit"]], "rings", at) for at, row in enumerate(rows)
    ]
    return Panel(name, "element at the tip, mm", name, (*lines, *limits))
