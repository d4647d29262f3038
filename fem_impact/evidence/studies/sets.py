"""The measured sets as users run them, beside the experiments.

Levels run with the barrier's grid at two places half a cell apart, so that a band holds the scatter by the
place too; the run at the first place of the last level is the one that is kept with its fields.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from fem_impact import Outcome, Unknown, known, load, replace_all, simulate
from fem_impact.answers.compare import COMPARED, ComparisonRow, compare
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.jobs.job import Job, JobResults
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.shares import ADDED, EnergyShare, shares
from fem_impact.run.tests import tests_of
from fem_impact.scene.types import MEASURED_SETS
from fem_impact.tables.table import COMPARISON, DASH, Table
from fem_impact.tables.text import plain

QUICK = {"accuracy.tip_size": "0.7 mm"}  # twice the cells of a default run at the contact, as in scene quick
QUICK_SETS = ("t4", "t5b")  # two rods; one of the long ones of t2 and t3 takes longer than both
TWO_PLACES = {"accuracy.offsets": 2}


def set_job(name: str, quick: bool, out: Path | None = None) -> Job:
    """Return the run of a set, or of a scene file with own tests, as users run it.

    Each level but the first runs at two places of the barrier's grid. A quick one runs at one place, and a
    shipped scene then on coarser meshes. Without ``out`` it keeps no files.
    """
    changes = ({} if name.endswith(".toml") else QUICK) if quick else TWO_PLACES
    scene = replace_all(load(name), changes | ({} if out else {"save.frames": 0}))
    return Job(scene.id, scene, out=out / scene.id if out else None, way=simulate)


def chosen(request: Request) -> tuple[str, ...]:
    """Return the requested sets; by default all, or two of them if quick."""
    return request.ids or (QUICK_SETS if request.quick else MEASURED_SETS)


def plan(request: Request, results: JobResults) -> list[Job]:
    """Return the runs of the sets, which keep files for films and pages unless they are quick."""
    out = None if request.quick else request.out
    return [set_job(name, request.quick, out) for name in chosen(request)]


def conclude(request: Request, results: JobResults) -> StudyReport:
    """Return the study of sets and measurements, with the runs to be presented."""
    outcomes, comparison, folders = list[Outcome](), list[ComparisonRow](), list[Path]()
    for job, name in zip(plan(request, results), chosen(request), strict=True):
        if isinstance(run := results[job.name], Outcome):
            folders += [job.out] if job.out else []
            outcomes.append(run)
            comparison += compare(run, tests_of(load(name)))
    return replace(sets_report(outcomes, comparison), runs=folders)


def sets_report(outcomes: Sequence[Outcome], comparison: Sequence[ComparisonRow]) -> StudyReport:
    """Return the study: comparison, energy shares and limits of the levels."""
    sentence = inside_sentence(comparison)
    cells = {(row["set"], row["quantity"]): _cell(row) for row in comparison if row["quantity"] in COMPARED}
    names = dict.fromkeys(row["set"] for row in comparison)
    beside = Table.of(
        ("set", *COMPARED), [(name, *(cells.get((name, q)) for q in COMPARED)) for name in names]
    )
    return StudyReport(
        "sets",
        "Model beside measurement",
        [sentence],
        sheets=[
            Sheet("comparison", "Every compared quantity", Table.of(COMPARISON, comparison), shown=False),
            Sheet("beside", BESIDE.format(_banded(outcomes)), beside),
            Sheet("shares", "Energies after the last separation, % of E_0", _shares(outcomes)),
            *_limits(outcomes),
        ],
        sources=sorted({effect for outcome in outcomes for effect in outcome.provenance.effects}),
        conclusions=[("", sentence)],
        outcomes=outcomes,
        comparison=comparison,
    )


def inside_sentence(comparison: Sequence[ComparisonRow]) -> str:
    """Return the sentence on how many quantities agree with the measurement, and how many do not."""
    verdicts = [row["verdict"] for row in comparison if row["measured_mean"] is not None]
    starts = ("inside", "undecided", "outside, within the scatter")
    inside, undecided, scatter = (sum(v.startswith(start) for v in verdicts) for start in starts)
    return (
        f"{inside} of {len(verdicts)} computed quantities lie inside the 95 % interval of the measured mean; "
        f"of the others {undecided} are undecided by the mesh, {scatter} lie within the scatter of single "
        f"tests, {len(verdicts) - inside - undecided - scatter} do not agree or are not known."
    )


BESIDE = (
    "Model{} / measured mean with standard deviation; bold: inside the 95 % interval of the mean, "
    "?: undecided by the mesh"
)


def _banded(outcomes: Sequence[Outcome]) -> str:
    """Return which sets have the band of their levels."""
    without = [o.provenance.scene_id for o in outcomes if or_none(o.validity.mesh_band) is None]
    if len(without) == len(outcomes):
        return ", without a band,"
    return ", with the band of its levels" + (f" (none: {', '.join(without)})," if without else ",")


def with_spread(value: float, spread: float | None, digits: int) -> str:
    """Return a value with its band or standard deviation, where it has one."""
    return f"{value:.{digits}f}" + ("" if spread is None else f" ± {spread:.{digits}f}")


def _cell(row: ComparisonRow) -> str:
    digits = 1 if row["quantity"] == "Omega" else 3
    model, measured = (
        DASH if row[value] is None else with_spread(row[value], row[spread], digits)
        for value, spread in (("model", "band"), ("measured_mean", "measured_sd"))
    )
    if row["verdict"] == "inside":
        return f"**{model}** / {measured}"
    return f"{model} / {measured}{' ?' if row['verdict'].startswith('undecided') else ''}"


def _shares(outcomes: Sequence[Outcome]) -> Table:
    """Return one row per set with its shares of E_0, limits with bands where there are."""
    listed = (*shares("report"), ADDED)
    rows = [
        (
            o.provenance.scene_id,
            *(_percent(o, share) for share in listed),
            f"{o.energy.residual:.0e}",
            known(o.cost.steps),
            f"{o.cost.cpu:.0f}",
        )
        for o in outcomes
    ]
    return Table.of(("set", *(f"{s.label}, %" for s in listed), "residual", "steps", "CPU s"), rows)


def _percent(outcome: Outcome, share: EnergyShare) -> str | None:
    if share.key.path[-1] == "vibration" and or_none(outcome.energy.below_floor):
        return "below floor"
    value, band = outcome.estimate(share.key)
    if isinstance(value, Unknown):
        return None
    digits = 2 if abs(100 * value) < 10 else 1
    return with_spread(100 * value, None if band is None else 100 * band, digits)


def _limits(outcomes: Sequence[Outcome]) -> list[Sheet]:
    """Return one row per set with bands: limits of e and E_vib, CPU time of the last level."""
    rows = []
    for outcome in outcomes:
        cells = [outcome.provenance.scene_id]
        for key, scale in (("e_edge", 1), ("E_vib_over_E_0", 100)):
            limit, band = outcome.estimate(key)
            if band is not None:
                share = plain(100 * band / abs(known(limit)), 2)
                cells += [with_spread(scale * known(limit), scale * band, 3), share]
        rows += [[*cells, f"{outcome.cost.cpu:.0f}"]] if len(cells) > 1 else []
    head = ("set", "e, limit", "of e, %", "E_vib / E_0, %, limit", "of E_vib, %", "CPU s")
    caption = "Limits for vanishing elements, their bands, these in per cent, and time of the last level"
    return [Sheet("limits", caption, Table.of(head, rows))] if rows else []
