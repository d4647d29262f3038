"""Runs of dropped rods: their jobs, with and without vibration, and the one table of their results.

Both studies over slenderness are made from that table (`run_table`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, Any

from fem_impact import Outcome, load, replace_all, simulate
from fem_impact.answers.refine.extrapolate import vibration_floor
from fem_impact.evidence.studies.rods import DroppedRod
from fem_impact.jobs.job import Failure, Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.outcome.shares import shares
from fem_impact.tables.table import Table

if TYPE_CHECKING:
    from pandas import DataFrame

VIBRATION, RESTITUTION = "E_vib_over_E_0", "e_edge"
CLOSE, LEAST = 0.05, 2e-4  # wanted band of vibration: of itself, and of E_0; the larger counts
SLACK = 1e-6  # s: a run that is cut ends so long after its first contact
FIRST = "first-"  # before the name of a run that is cut after its first contact
BANDED = (VIBRATION, RESTITUTION, "mu", "Omega_rad_per_s", "peak_force_N")
"""Keys of a point that have limits with bands."""
SHARES = tuple(share.key.name for share in shares("figure") if share.key.name != VIBRATION)
Result = Outcome | Failure


@dataclass(frozen=True, slots=True)
class RodRun:
    """One run of a dropped rod.

    Attributes
    ----------
    rod : what is dropped, or for a measured set the rod most like it
    fidelity : "modal" or "solid", on levels as users run it
    places : of the barrier's grid, at which each level of finite elements but the first runs
    measured_set : id of the measured set whose scene runs in place of the rod's
    """

    rod: DroppedRod
    fidelity: str = "modal"
    places: int = 1
    measured_set: str = ""

    @property
    def point(self) -> str:
        """Name that the runs of a rod on all meshes have in common."""
        return self.measured_set or self.rod.name

    @property
    def name(self) -> str:
        """Name of the job."""
        return self.point if self.fidelity == "modal" else f"{self.point}-levels"

    @property
    def twin(self) -> RodRun:
        """The same run of the rod that cannot vibrate, at one place of the grid."""
        return replace(self, rod=replace(self.rod, vibrates=False), places=1, measured_set="")

    def job(self) -> Job:
        """Return the job."""
        scene = load(self.measured_set) if self.measured_set else self.rod.scene()
        if self.fidelity == "modal":
            return Job(self.name, scene, "modal")
        changes = {"accuracy.offsets": self.places, "save.frames": 0}
        return Job(self.name, replace_all(scene, changes), way=simulate)


def longest_first(runs: Iterable[RodRun], others: Iterable[Job] = ()) -> list[Job]:
    """Return the jobs of runs, and other jobs, each name once, the longest first."""
    unique = {run.name: run for run in runs}.values()
    return sorted((*(run.job() for run in unique), *others), key=lambda job: job.planned_s, reverse=True)


def run_table(families: Mapping[str, Iterable[RodRun]], results: JobResults) -> DataFrame:
    """Return one row per run of each family: its rod, mesh and result, and the same run without vibration.

    Columns are ``point``, those of `DroppedRod.inputs`, E_vib/E_0, e, ``e_edge_rigid`` of the rod that cannot
    vibrate and ``tau_s``, the duration of its first contact, s; ``family``, ``fidelity``, ``rod_run`` and
    ``result``. None where not known.
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


def estimate(result: Result, key: str) -> tuple[float | None, float | None]:
    """Return limit and half-width of its band that levels give a number, None where not known."""
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


def cut_job(run: RodRun, result: Result) -> Job | None:
    """Return the job of a point that ends after its first contact; None where there was no second one."""
    touches = contacts(result)
    if len(touches) < 2:
        return None
    job = run.job()
    accuracy = replace(job.scene.accuracy, max_time=touches[0].end + SLACK)
    return replace(job, name=f"{FIRST}{run.point}", scene=replace(job.scene, accuracy=accuracy))


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
            {**_point(row, results), "by_modes": by_modes.get(row.point)}
            for row in table[table.fidelity == "solid"].itertuples()
        ],
        dtype=object,
    )


def _point(row: Any, results: JobResults) -> dict[str, Any]:
    run, result, tau = row.rod_run, row.result, row.tau_s
    period = run.rod.first_period
    bands = [zip((key, f"{key}_band"), estimate(result, key), strict=True) for key in BANDED]
    return {
        "point": run.point,
        **run.rod.inputs,
        **dict(chain.from_iterable(bands)),
        **{key: estimate(result, key)[0] for key in SHARES},
        f"{VIBRATION}_own_mesh": value(result, VIBRATION),
        f"{VIBRATION}_first_contact": value(results.get(f"{FIRST}{run.point}"), VIBRATION),
        "tip_size_m": value(result, "tip_size_m"),
        "contacts": len(contacts(result)) or None,
        "T1_s": period,
        "tau_s": tau,
        "T1_over_tau": period / tau if tau else None,
        "e_edge_rigid": row.e_edge_rigid,
        "residual_over_E_0": value(result, "residual_over_E_0"),
        "band_as_wanted": "yes" if is_close(result) else "no",
        "reason": _gap(result),
        "family": row.family,
        "intervals": contacts(result),
        "doubted": isinstance(result, Outcome) and vibration_floor(result) > wanted_band(result),
    }


def _gap(result: Result) -> str:
    """Return why vibration has no value or no band; empty where it has both."""
    if isinstance(result, Failure):
        return result.reason
    vibration, band = estimate(result, VIBRATION)
    return "" if band is not None else result.reasons[VIBRATION if vibration is None else "mesh_band"]
