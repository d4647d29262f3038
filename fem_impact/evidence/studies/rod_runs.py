"""Runs of dropped rods: their jobs, with and without vibration, and the one table of their results.

Both studies over slenderness are made from that table (`run_table`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain, takewhile
from typing import TYPE_CHECKING, Any

from fem_impact.answers.refine.extrapolate import vibration_floor
from fem_impact.evidence.studies.pairs import resized, shifted, vibration_band, with_limits
from fem_impact.evidence.studies.rods import DroppedRod
from fem_impact.jobs.job import Failure, Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import shares
from fem_impact.scene.shipped import load
from fem_impact.tables.table import Table

if TYPE_CHECKING:
    from pandas import DataFrame

VIBRATION, RESTITUTION = "E_vib_over_E_0", "e_edge"
CLOSE, LEAST = 0.05, 2e-4  # wanted band of vibration: of itself, and of E_0; the larger counts
MOST = 400.0  # s of processor time that a finer mesh may be expected to take
SLACK = 1e-6  # s: a run that is cut ends so long after its first contact
FIRST = "first-"  # before the name of a run that is cut after its first contact
BANDED = (VIBRATION, RESTITUTION, "mu", "Omega_rad_per_s", "peak_force_N")
"""Keys of a point that have limits with bands."""
SHARES = tuple(share.key.name for share in shares("figure") if share.key.name != VIBRATION)
Result = Outcome | Failure
_resized = cache(resized)


@dataclass(frozen=True, slots=True)
class RodRun:
    """One run of a dropped rod.

    Attributes
    ----------
    rod : what is dropped, or for a measured set the rod most like it
    fidelity : "modal" or "solid"
    size : of the elements at the contact, over those that the scene gets by itself
    offset : of the barrier's grid, in cells at the contact
    measured_set : id of the measured set whose scene runs in place of the rod's
    """

    rod: DroppedRod
    fidelity: str = "modal"
    size: float = 1.0
    offset: float = 0.0
    measured_set: str = ""

    @property
    def point(self) -> str:
        """Name that the runs of a rod on all meshes have in common."""
        return self.measured_set or self.rod.name

    @property
    def name(self) -> str:
        """Name of the job."""
        if self.fidelity == "modal":
            return self.point
        return f"{self.point}-x{self.size:g}" + (f"-at-{self.offset:g}" if self.offset else "")

    @property
    def twin(self) -> RodRun:
        """The same run of the rod that cannot vibrate."""
        return replace(self, rod=replace(self.rod, vibrates=False), measured_set="")

    def job(self) -> Job:
        """Return the job."""
        scene = load(self.measured_set) if self.measured_set else self.rod.scene()
        if self.fidelity == "modal":
            return Job(self.name, scene, "modal")
        scene = _resized(scene, self.size)
        return Job(self.name, shifted(scene, self.offset) if self.offset else scene)


def mesh_runs(
    rod: DroppedRod, sizes: Iterable[float], offsets: Iterable[float], measured_set: str = ""
) -> list[RodRun]:
    """Return the runs of a rod by finite elements, on each mesh at each offset of the barrier's grid."""
    return [RodRun(rod, "solid", size, offset, measured_set) for size in sizes for offset in offsets]


def longest_first(runs: Iterable[RodRun], others: Iterable[Job] = ()) -> list[Job]:
    """Return the jobs of runs, and other jobs, each name once, the longest first."""
    unique = {run.name: run for run in runs}.values()
    return sorted((*(run.job() for run in unique), *others), key=lambda job: job.planned_s, reverse=True)


def run_table(families: Mapping[str, Iterable[RodRun]], results: JobResults) -> DataFrame:
    """Return one row per run of each family: its rod, mesh and result, and the same run without vibration.

    Columns are ``point``, those of `DroppedRod.inputs`, E_vib/E_0, e, ``e_edge_rigid`` of the rod that cannot
    vibrate and ``tau_s``, the duration of its first contact, s; ``family``, ``fidelity``, ``element_size``
    (over the scene's own), ``grid_offset`` (cells), ``rod_run`` and ``result``. None where not known.
    """
    from pandas import DataFrame

    rows = []
    for family, run in ((family, run) for family, runs in families.items() for run in runs):
        result = results.get(run.name, Failure(run.name, "was not computed"))
        twin = results.get(run.twin.name)
        values = {
            VIBRATION: value(result, VIBRATION),
            RESTITUTION: value(result, RESTITUTION),
            "e_edge_rigid": value(twin, RESTITUTION),
            "tau_s": next((touch.duration for touch in contacts(twin)), None),
            "family": family,
            "fidelity": run.fidelity,
            "element_size": run.size,
            "grid_offset": run.offset,
            "rod_run": run,
            "result": result,
        }
        rows.append({"point": run.point, **run.rod.inputs, **values})
    return DataFrame(rows, dtype=object)


def value(result: Result | None, key: str) -> float | None:
    """Return a number of a run, None where it is not known."""
    number: float | None = or_none(KEY_TABLE[key].of(result)) if isinstance(result, Outcome) else None
    return number


def contacts(result: Result | None) -> tuple[ContactInterval, ...]:
    """Return the contacts of a run, none where they are not known."""
    return (or_none(result.contact.intervals) or ()) if isinstance(result, Outcome) else ()


def among(rows: DataFrame, **values: object) -> DataFrame:
    """Return the rows with the given values of their columns, by slenderness."""
    for column, value in values.items():
        rows = rows[rows[column] == value]
    return rows.sort_values("gamma", kind="stable")


def as_table(rows: DataFrame) -> Table:
    """Return a frame as a table for a report."""
    return Table.of([*rows], rows.to_numpy(object).tolist())


def mesh_levels(runs: DataFrame, column: str = "result") -> list[list[Any]]:
    """Return a column of a point's runs on each mesh, the coarsest first."""
    return [level.tolist() for _, level in runs.groupby("element_size")[column]][::-1]


def limited(levels: Sequence[Sequence[Result]]) -> Result:
    """Return the run on the finest mesh that knows vibration, with the limits of it and the mesh before.

    The second mesh is the scene's own: if its first run failed, that failure is returned.
    """
    if isinstance(levels[1][0], Failure):
        return levels[1][0]
    coarse, fine = _finest_two(levels)
    return with_limits(fine, coarse)


def is_settled(levels: Sequence[Sequence[Result]]) -> bool:
    """Return whether no finer mesh is called for: the meshes alone give vibration as closely as wanted.

    The stated band also holds the distance of the two counts of vibration, which a finer mesh may not lower.
    """
    coarse, fine = _finest_two(levels)
    band = vibration_band(fine, coarse)
    return band is not None and band <= wanted_band(limited(levels))


def _finest_two(levels: Sequence[Sequence[Result]]) -> Sequence[Sequence[Result]]:
    """Return the runs on the finest mesh that knows vibration, after those on the mesh before it."""
    finer = takewhile(lambda runs: all(value(run, VIBRATION) is not None for run in runs), levels[2:])
    return (*levels[:2], *finer)[-2:]


def estimate(result: Result, key: str) -> tuple[float | None, float | None]:
    """Return limit and half-width of its band that two meshes give a number, None where not known."""
    if isinstance(result, Failure):
        return None, None
    number, band = result.estimate(KEY_TABLE[key])
    return or_none(number), band


def wanted_band(result: Result) -> float:
    """Return the half-width, of E_0, that the band of vibration should have at most."""
    return max(CLOSE * abs(estimate(result, VIBRATION)[0] or 0.0), LEAST)


def is_close(result: Result) -> bool:
    """Return whether vibration has a band as narrow as wanted."""
    band = estimate(result, VIBRATION)[1]
    return band is not None and band <= wanted_band(result)


def more_jobs(runs: DataFrame, results: JobResults) -> list[Job]:
    """Return the jobs that the results of a point call for: finer meshes, and one cut at a second contact.

    ``runs`` are its rows of `run_table`. Meshes that are refused or take more than `MOST` are left out.
    """
    levels, rod_runs = mesh_levels(runs), mesh_levels(runs, "rod_run")
    jobs: list[Job] = []
    for at in range(2, len(levels)):
        if is_settled(levels[:at]):
            break
        jobs += [run.job() for run in rod_runs[at]]
        if any(job.name not in results for job in jobs):
            break
    touches = contacts(levels[1][0])
    if len(touches) > 1:
        scene = rod_runs[1][0].job().scene
        accuracy = replace(scene.accuracy, max_time=touches[0].end + SLACK)
        jobs.append(Job(f"{FIRST}{rod_runs[1][0].point}", replace(scene, accuracy=accuracy)))
    return [job for job in jobs if job.kind[1] and job.planned_s <= MOST]


def points_of(table: DataFrame, results: JobResults) -> DataFrame:
    """Return one row per point by finite elements, a row of points.csv up to ``reason``.

    Further columns are ``family``, ``intervals`` of contact, ``doubted``, whether the run's two counts of
    vibration differ by more than the band that is wanted, and ``by_modes``, E_vib/E_0 of the same rod by the
    modal fidelity.
    """
    from pandas import DataFrame

    modal = table[table.fidelity == "modal"]
    by_modes = dict(zip(modal.point, modal[VIBRATION], strict=True))
    return DataFrame(
        [
            {**_point(runs, results), "by_modes": by_modes.get(name)}
            for name, runs in table[table.fidelity == "solid"].groupby("point", sort=False)
        ],
        dtype=object,
    )


def _point(runs: DataFrame, results: JobResults) -> dict[str, Any]:
    run, levels = runs.iloc[0].rod_run, mesh_levels(runs)
    result, period, tau = limited(levels), run.rod.first_period, mesh_levels(runs, "tau_s")[0][0]
    bands = [zip((key, f"{key}_band"), estimate(result, key), strict=True) for key in BANDED]
    return {
        "point": run.point,
        **run.rod.inputs,
        **dict(chain.from_iterable(bands)),
        **{key: estimate(result, key)[0] for key in SHARES},
        f"{VIBRATION}_own_mesh": value(levels[1][0], VIBRATION),
        f"{VIBRATION}_first_contact": value(results.get(f"{FIRST}{run.point}"), VIBRATION),
        "tip_size_m": value(result, "tip_size_m"),
        "contacts": len(contacts(result)) or None,
        "T1_s": period,
        "tau_s": tau,
        "T1_over_tau": period / tau if tau else None,
        "e_edge_rigid": mesh_levels(runs, "e_edge_rigid")[0][0],
        "residual_over_E_0": value(result, "residual_over_E_0"),
        "band_as_wanted": "yes" if is_close(result) else "no",
        "reason": _gap(result),
        "family": runs.iloc[0].family,
        "intervals": contacts(result),
        "doubted": isinstance(result, Outcome) and vibration_floor(result) > wanted_band(result),
    }


def _gap(result: Result) -> str:
    """Return why vibration has no value or no band; empty where it has both."""
    if isinstance(result, Failure):
        return result.reason
    vibration, band = estimate(result, VIBRATION)
    return "" if band is not None else result.reasons[VIBRATION if vibration is None else "mesh_band"]
