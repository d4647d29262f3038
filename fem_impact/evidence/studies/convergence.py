"""Convergence with the mesh: measured sets on a family of meshes, extrapolated to vanishing elements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from itertools import combinations
from statistics import fmean
from typing import Any

from fem_impact.answers.refine.extrapolate import limit, pair_limit
from fem_impact.answers.refine.levels import FAMILY, MeshLevel, at_offsets, family
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.jobs.job import Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import shares
from fem_impact.scene.shipped import load, replace_all
from fem_impact.tables.table import Cell, Table

Row = dict[str, Any]

QUICK = (MeshLevel(-2), *FAMILY[:-1])
"""Meshes of the quick study: a coarser one for the finest, since a limit takes three."""

SETS = ("t3-machined", "t3-contaminated", "t5b", "t6-17")
USUAL_TIP_SIZE = 0.019 / 8 / 2**3  # m, of the measured sets' own scenes
STATED = ("e", "mu", "vibration/E_0")  # quantities with a sentence in the findings
CAPTION = (
    "Each quantity against the size of the elements, with the range over places of the barrier's grid; "
    "rings: limits for vanishing elements with their bands."
)
QUANTITIES = {
    "e": KEY_TABLE["e_paper"],
    "mu": KEY_TABLE["mu"],
    "Omega, rad/s": KEY_TABLE["Omega_rad_per_s"],
    "E_r/E_0": KEY_TABLE["E_r_over_E_0"],
    **{share.title: share.key for share in shares("comparison") if "study" in share.shown},
    "friction and skin/E_0": KEY_TABLE["W_skin_over_E_0"],
}


def jobs_of(name: str, quick: bool) -> list[list[Job]]:
    """Return the jobs of a set: per mesh, from coarse to fine, one per position of the barrier's grid.

    The quick study takes the meshes of `QUICK` at the first position.
    """
    plain = replace_all(load(name), {"save.frames": 0})
    meshes, positions = (QUICK, 1) if quick else (family(plain), None)
    return [
        [
            Job(f"{name}-{1e3 * mesh.sizes(plain)[0]:.3f}-{scene.accuracy.grid_shift:g}", scene)
            for scene in at_offsets(plain, mesh)[:positions]
        ]
        for mesh in meshes
    ]


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the jobs of the requested sets, by default of `SETS`."""
    return [job for name in request.ids or SETS for mesh in jobs_of(name, request.quick) for job in mesh]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Extrapolate every quantity of every set; write table, data and figure."""
    rows = []
    for name in request.ids or SETS:
        runs = [[results[job.name] for job in mesh] for mesh in jobs_of(name, request.quick)]
        done = [[run for run in mesh if isinstance(run, Outcome)] for mesh in runs]
        rows += convergence_rows(name, [mesh for mesh in done if mesh])
    panels = tuple(_panel(name, rows) for name in QUANTITIES)
    return StudyReport(
        "convergence",
        "What vanishing elements would give",
        [*_answer(rows), *(_sentence(row) for row in rows if row["quantity"] in STATED), *_pairs(rows)],
        (Picture("convergence", CAPTION, panels),) if rows else (),
        (_sheet(rows),),
        ("Order, limit and band: Eca and Hoekstra 2014, doi:10.1016/j.jcp.2014.01.006.",),
        ("convergence",),
        [("convergence", _sentence(row)) for row in rows if row["quantity"] == "e"],
    )


def convergence_rows(name: str, meshes: Sequence[Sequence[Outcome]]) -> list[Row]:
    """Return one row per quantity; none with fewer than three meshes.

    ``meshes`` holds, from coarse to fine, the outcomes of each mesh at its positions of the barrier's grid.
    """
    if len(meshes) < 3:
        return []
    sizes, rows = [known(runs[0].cost.tip_size) for runs in meshes], []
    for quantity, key in QUANTITIES.items():
        values = [[known(key.of(run)) for run in runs] for runs in meshes]
        means = [fmean(on_mesh) for on_mesh in values]
        row = {"set": name, "quantity": quantity, "tip_size_m": sizes, "values": means}
        apart = [max(on_mesh) - min(on_mesh) for on_mesh in values]
        places = min(map(len, values))
        rows.append({**row, "fit": limit(sizes, means), "apart": apart, "places": places})
    return rows


def _answer(rows: Sequence[Row]) -> list[str]:
    """Return how far e on the finest mesh lies from its limit at most, and how wide the bands of that are."""
    of_e = [row for row in rows if row["quantity"] == "e"]
    if not of_e:
        return []
    away = max(abs(row["values"][-1] - row["fit"].value) for row in of_e)
    size, band = 1e3 * of_e[0]["tip_size_m"][-1], max(row["fit"].band for row in of_e)
    return [
        f"On the finest mesh, {size:.3g} mm at the tip, e (paper's arms) of {len(of_e)} sets lies at most "
        f"{away:.2g} from its limit for vanishing elements; the bands of the limits reach ± {band:.2g}."
    ]


def _sentence(row: Row) -> str:
    """Return the sentence of a row: value on the finest mesh, limit, distance of the usual mesh from it."""
    size, value, fit = row["tip_size_m"][-1] * 1e3, row["values"][-1], row["fit"]
    nearest = min(range(len(row["values"])), key=lambda i: abs(row["tip_size_m"][i] - USUAL_TIP_SIZE))
    order = "no clear order" if fit.order is None else f"order {fit.order:.1f}"
    return (
        f"{row['set']}, {row['quantity']}: {value:.4g} ± {fit.band:.2g} at {size:.3g} mm, "
        f"limit {fit.value:.4g} ({order}); at {USUAL_TIP_SIZE * 1e3:.3g} mm, the usual mesh, "
        f"{row['values'][nearest] - fit.value:+.2g} off the limit."
    )


def _pairs(rows: list[Row]) -> list[str]:
    """Return the sentence on how many pairs of meshes have the limit of all meshes in their band."""
    inside = []
    for row in rows:
        meshes = zip(row["tip_size_m"], row["values"], strict=True)
        for (coarse_size, coarse), (fine_size, fine) in combinations(meshes, 2):
            extrapolated, band = pair_limit(fine, coarse, coarse_size / fine_size, row["places"])
            inside.append(abs(extrapolated - row["fit"].value) <= band + 1e-9 * abs(extrapolated))
    if not inside:
        return []
    return [f"Two meshes, extrapolated: {sum(inside)} of {len(inside)} bands hold the limit of all."]


def _sheet(rows: list[Row]) -> Sheet:
    """Return one row per set and quantity: value on each mesh, limit, order, band and scatter."""
    sizes = sorted({size for row in rows for size in row["tip_size_m"]}, reverse=True)
    head = ("set", "quantity", *(f"{size * 1e3:.3g} mm" for size in sizes))
    lines: list[list[Cell]] = []
    for row in rows:
        values = dict(zip(row["tip_size_m"], row["values"], strict=True))
        by_size, fit = map(values.get, sizes), astuple(row["fit"])
        lines.append([row["set"], row["quantity"], *by_size, *fit, row["apart"][-1]])
    return Sheet(
        "convergence",
        "Values by the element at the tip, means over places of the barrier's grid; order – is none; "
        "places apart: their largest difference on the finest mesh",
        Table.of((*head, "limit", "order", "band", "scatter", "places apart"), lines),
    )


def _panel(name: str, rows: list[Row]) -> Panel:
    """Return the panel of a quantity: one line per set, and its limit at element size 0."""
    lines, limits = [], []
    for at, row in enumerate(row for row in rows if row["quantity"] == name):
        sizes = [1e3 * size for size in row["tip_size_m"]]
        halves = [apart / 2 for apart in row["apart"]]
        lines.append(Series(row["set"], sizes, row["values"], "joined", at, halves if any(halves) else None))
        fit = row["fit"]
        limits.append(Series(f"{row['set']}, limit", [0.0], [fit.value], "rings", at, [fit.band]))
    return Panel(name, "element at the tip, mm", name, (*lines, *limits))
