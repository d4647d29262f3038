"""Convergence with the mesh: levels of measured sets and a finer one, extrapolated to vanishing elements.

Limit and order of a quantity come from three meshes or more by least squares (`limit`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass
from operator import itemgetter
from statistics import fmean
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fem_impact import known, load, replace_all
from fem_impact.answers.refine.extrapolate import level_limits
from fem_impact.answers.refine.work import Levels, LevelsJob
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.arrays import Array
from fem_impact.errors import RunError
from fem_impact.evidence.studies.report_parts import rests_on
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.outcome.shares import shares
from fem_impact.tables.table import Cell, Table

LOWEST_FITTED, HIGHEST_FITTED = 0.5, 2.0  # orders of an accepted fit; the method is of second order
SURE, UNSURE = 1.25, 3.0  # safety factors of an accepted fit and of one with fixed orders


@dataclass(frozen=True, slots=True)
class Limit:
    """A fit over three meshes or more.

    Attributes
    ----------
    value : the fit at element size 0
    band : half-width about the finest mesh's value that should hold the limit in 95 of 100 cases
    order : fitted order, None where it lies outside the accepted range and fixed orders are used
    scatter : standard deviation of the values about the fit
    """

    value: float
    order: float | None
    band: float
    scatter: float


def limit(sizes: ArrayLike, values: ArrayLike) -> Limit:
    """Return limit, order and band of q(h) by least squares over at least three meshes.

    Parameters
    ----------
    sizes : (n,) float64, m, element size of each mesh of one self-similar family, in any order
    values : (n,) float64, the quantity on each mesh

    Raises
    ------
    RunError
        Fewer than three different sizes.

    Notes
    -----
    L. Eca and M. Hoekstra, J. Comput. Phys. 262 (2014) 104-130, doi:10.1016/j.jcp.2014.01.006: q_0 + a h^p
    where .5 <= p <= 2, else fixed orders with a larger safety factor; the scatter of noisy data widens
    the band. Their fit of two terms is left out: with four meshes it follows the scatter. With three meshes
    nothing is left over to tell scatter from trend, so it reads 0.

    Examples
    --------
    >>> fitted = limit([4.0, 2.0, 1.0], [1.16, 1.04, 1.01])
    >>> round(fitted.value, 6), round(fitted.order, 3), round(fitted.band, 6)
    (1.0, 2.0, 0.0125)
    """
    from scipy.optimize import minimize_scalar  # .4 s, for which no page of a run should wait

    h, q = np.asarray(sizes, float), np.asarray(values, float)
    if len(np.unique(h)) < 3:
        raise RunError(f"A limit needs three meshes or more; there are {len(np.unique(h))}.")
    h = h / h.min()
    p = minimize_scalar(
        lambda p: _least_squares(h, q, p, len(h) - 1)[2], bounds=(0.1, 4.0), method="bounded"
    ).x
    accepted = LOWEST_FITTED <= p <= HIGHEST_FITTED + 0.1
    fits = (
        [_least_squares(h, q, float(p), 3)] if accepted else [_least_squares(h, q, p, 2) for p in (1.0, 2.0)]
    )
    value, terms, scatter = min(fits, key=itemgetter(2))
    finest, spread = int(h.argmin()), (q.max() - q.min()) / (len(q) - 1)
    error, off = abs(terms[finest]), abs(q[finest] - value - terms[finest])
    if scatter < spread:
        band = (SURE if accepted else UNSURE) * error + scatter + off
    else:
        band = 3 * scatter / spread * (error + scatter + off) if spread else 0.0
    return Limit(value, float(p) if accepted else None, float(band), scatter)


def _least_squares(h: Array, q: Array, order: float, unknowns: int) -> tuple[float, Array, float]:
    """Fit q_0 + a h^order with weights 1/h, as finer meshes count for more.

    Returns q_0, the terms a h^order (n,), and the standard deviation of q about the fit.
    """
    weights = (1 / h) / (1 / h).mean()
    columns, root = np.stack([np.ones_like(h), h**order], axis=1), np.sqrt(weights)
    value, slope = np.linalg.lstsq(columns * root[:, None], q * root, rcond=None)[0]
    terms = columns[:, 1] * slope
    rest = np.sqrt(weights @ (q - value - terms) ** 2 / max(len(h) - unknowns, 1))
    return float(value), terms, float(rest) if len(h) > unknowns else 0.0


Row = dict[str, Any]
Results = Mapping[str, Levels | Failure]

SETS = ("t3-machined", "t3-contaminated", "t5b", "t6-17")
FINER = 1  # levels beyond those of the default run
LEAST = 3  # levels that a fit takes
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


def plan(request: Request, results: Results) -> list[LevelsJob]:
    """Return the levels of the requested sets, by default of `SETS`, each but the first at two places.

    If quick they are those of the default run.
    """
    finer, places = (0, {}) if request.quick else (FINER, {"accuracy.offsets": 2})
    changes = {"save.frames": 0, **places}
    return [LevelsJob(name, replace_all(load(name), changes), finer) for name in request.ids or SETS]


def conclude(request: Request, results: Results) -> StudyReport:
    """Extrapolate every quantity of every set; write table, data and figure."""
    done = {name: results[name] for name in request.ids or SETS}
    rows = [
        row
        for name, levels in done.items()
        if isinstance(levels, Levels)
        for row in convergence_rows(name, levels)
    ]
    panels = tuple(_panel(name, rows) for name in QUANTITIES)
    return StudyReport(
        "convergence",
        "What vanishing elements would give",
        [*_answer(rows), *(_sentence(row) for row in rows if row["quantity"] in STATED), *_held(rows)],
        (Picture("convergence", CAPTION, panels),) if rows else (),
        (_sheet(rows),),
        rests_on("convergence"),
        ("convergence",),
        [("convergence", _sentence(row)) for row in rows if row["quantity"] == "e"],
    )


def convergence_rows(name: str, levels: Levels) -> list[Row]:
    """Return one row per quantity; none with fewer than `LEAST` levels.

    Levels that do not resolve their contact are left out where as many others remain.
    ``numbers`` are limit and half-width that the levels of the default run tell, None where they tell none.
    """
    resolved = [mesh for mesh in levels.meshes if mesh.resolved]
    meshes = resolved if len(resolved) >= LEAST else levels.meshes
    if len(meshes) < LEAST:
        return []
    sizes, rows = [mesh.size for mesh in meshes], []
    limits, bands = (or_none(numbers) or {} for numbers in level_limits(levels.meshes[: levels.default]))
    for quantity, key in QUANTITIES.items():
        values = [[known(key.of(run)) for run in mesh.runs] for mesh in meshes]
        means = [fmean(on_mesh) for on_mesh in values]
        row = {
            "set": name,
            "quantity": quantity,
            "tip_size_m": sizes,
            "values": means,
            "default": levels.default - 1 - len(levels.meshes),
            "apart": [max(on_mesh) - min(on_mesh) for on_mesh in values],
            "fit": limit(sizes, means),
            "default_band": (limits[key.name], bands[key.name]) if key.name in bands else None,
        }
        rows.append(row)
    return rows


def _answer(rows: Sequence[Row]) -> list[str]:
    """Return how far a default run and the finest level lie from the limits, and the bands of these."""
    worst: dict[str, list[str]] = {"default": [], "finest": [], "band": []}
    for name in STATED:
        of = [row for row in rows if row["quantity"] == name]
        if of:
            for way in ("default", "finest"):
                off = (row["values"][row.get(way, -1)] - row["fit"].value for row in of)
                worst[way].append(f"{max(map(abs, off)):.2g} of {name}")
            worst["band"].append(f"{max(row['fit'].band for row in of):.2g} of {name}")
    if not worst["band"]:
        return []
    default, finest, band = (", ".join(parts) for parts in worst.values())
    return [
        f"The last level of a default run lies at most {default} from what vanishing elements would give "
        f"({len({row['set'] for row in rows})} sets, e by the paper's arms); the finest level here {finest}. "
        f"The bands of these limits are at most {band} wide to either side."
    ]


def _sentence(row: Row) -> str:
    """Return the sentence of a row: value on the finest level, limit, distance of the default run from it."""
    size, value, fit = row["tip_size_m"][-1] * 1e3, row["values"][-1], row["fit"]
    at = row["default"]
    order = "no clear order" if fit.order is None else f"order {fit.order:.1f}"
    return (
        f"{row['set']}, {row['quantity']}: {value:.4g} ± {fit.band:.2g} at {size:.3g} mm, "
        f"limit {fit.value:.4g} ({order}); the last level of a default run, at "
        f"{row['tip_size_m'][at] * 1e3:.3g} mm, is {row['values'][at] - fit.value:+.2g} off the limit."
    )


def _held(rows: Sequence[Row]) -> list[str]:
    """Return the sentence on how many bands of the default levels hold the limit of all, or overlap it."""
    banded = [(*row["default_band"], row["fit"]) for row in rows if row["default_band"]]
    if not banded:
        return []
    off = [abs(value - fit.value) - 1e-9 * abs(value) for value, _, fit in banded]
    inside = sum(away <= half for away, (_, half, _) in zip(off, banded, strict=True))
    near = sum(away <= half + fit.band for away, (_, half, fit) in zip(off, banded, strict=True))
    return [
        f"{inside} of {len(banded)} bands that the levels of a default run tell at two places of the grid "
        f"hold the limit of all levels; {near} overlap its band."
    ]


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
        "Values by the element at the contact, means over places of the barrier's grid; order – is none; "
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
    return Panel(name, "element at the contact, mm", name, (*lines, *limits))
