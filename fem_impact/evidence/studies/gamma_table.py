"""The runs of the study of slenderness and its one table: a row a run, of a rod and its rigid twin."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from pandas import DataFrame

from fem_impact import Outcome, known, load, replace_all, simulate
from fem_impact.answers.refine.extrapolate import vibration_floor
from fem_impact.answers.refine.work import Levels, LevelsJob
from fem_impact.answers.verdict.vibration import solid_effect
from fem_impact.evidence.studies.rod_theory import spring_bounce, whole_ratio
from fem_impact.evidence.studies.rods import DroppedRod, length_of
from fem_impact.jobs.job import Failure, Job
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.outcome.shares import shares

CURVE, OTHERS, MEASURED, MODES = "curve", "other inputs", "measured sets", "modes"
"""Families of rods at one angle or one input away from it: by finite elements, the last by modes."""
HERTZ = "Hertz, one tip radius", "Hertz, tip in proportion"
YIELDING, SPRING = "yielding, frictionless, modes", "linear spring"
BY_MESHES = {state: f"yielding, {state}" for state in ("contaminated", "machined")}
"""Families of rods at all angles, the last by surface state and finite elements."""
ANGLED = (*HERTZ, YIELDING, SPRING, *BY_MESHES.values())
BLIND, ENDS = "over friction", "elastic, by finite elements"
"""Families of elastic rods over friction, and of those that confirm the modal fidelity."""

VIBRATION, RESTITUTION = "E_vib_over_E_0", "e_edge"
BANDED = (VIBRATION, RESTITUTION, "mu", "Omega_rad_per_s", "peak_force_N")
"""Keys that finite elements give with bands."""
SHARES = tuple(share.key.name for share in shares("figure") if share.key.name != VIBRATION)
CLOSE, LEAST = 0.05, 2e-4  # wanted band of vibration: of itself, and of E_0; the larger counts
SLACK = 1e-6  # s: a run that is cut ends so long after its first contact
FIRST = "first-"  # before the name of a run that is cut after its first contact
WORDS = ("point", "family", "way", "rod", "contact", "law", "contacts", "intervals", "reason", "doubted")
"""Columns that hold no real numbers."""

Results = Mapping[str, Outcome | Levels | Failure]


@dataclass(frozen=True, slots=True)
class RodRun:
    """One run of a dropped rod.

    Attributes
    ----------
    rod : what is dropped, or for a measured set the rod most like it
    way : "modal"; "solid", on levels as users run it, beside a twin that cannot vibrate on its own levels;
        "pair", both on the same levels; or "spring", which is solved exactly and is no job
    places : of the barrier's grid, at which each level of "solid" but the first runs
    measured_set : id of the measured set whose scene runs in place of the rod's
    """

    rod: DroppedRod
    way: str = "modal"
    places: int = 1
    measured_set: str = ""

    @property
    def point(self) -> str:
        """Name that the runs of a rod on all meshes have in common."""
        return self.measured_set or self.rod.name

    @property
    def name(self) -> str:
        """Name of the job."""
        return self.point + {"modal": "", "solid": "-levels"}.get(self.way, f"-{self.way}")

    @property
    def twin(self) -> "RodRun":
        """The same run of the rod that cannot vibrate, at one place of the grid."""
        return replace(self, rod=replace(self.rod, vibrates=False), places=1, measured_set="")

    def job(self) -> Job | LevelsJob:
        """Return the job."""
        scene = load(self.measured_set) if self.measured_set else self.rod.scene()
        if self.way == "modal":
            return Job(self.name, scene, "modal")
        if self.way == "pair":
            return LevelsJob(self.name, scene, twin=self.twin.rod.scene())
        changes = {"accuracy.offsets": self.places, "save.frames": 0}
        return Job(self.name, replace_all(scene, changes), way=simulate)

    def cut_job(self, results: Results) -> Job | None:
        """Return the job that ends after the first contact; None where no second one is known."""
        touches, job = contacts(results.get(self.name)), self.job()
        if len(touches) < 2 or not isinstance(job, Job):
            return None
        accuracy = replace(job.scene.accuracy, max_time=touches[0].end + SLACK)
        return replace(job, name=f"{FIRST}{self.point}", scene=replace(job.scene, accuracy=accuracy))


def table_of(families: Mapping[str, Iterable[RodRun]], results: Results) -> DataFrame:
    """Return one row per run of each family: its rod, and what it gave beside the rod that cannot vibrate.

    Columns are ``point``, those of `DroppedRod.inputs`, keys of the outcome and their bands, keys with
    ``_rigid`` of the twin, ``tau_s``, the duration of the twin's first contact, ``T1_over_tau``,
    ``band_of_change``, the half-width of the change of e by vibration, ``by_modes``, E_vib/E_0 of the same
    rod by modes, and ``doubted``, whether the two counts of vibration differ by more than the wanted
    band. What is not known is NaN, None in `WORDS`.
    """
    ways = {"modal": _modal, "solid": _solid, "pair": _pair, "spring": _spring}
    rows = [
        {"point": run.point, **run.rod.inputs, **ways[run.way](run, results)}
        | {"family": family, "way": run.way, "rod": run.rod}
        for family, runs in families.items()
        for run in runs
    ]
    by_modes = {row["point"]: row[VIBRATION] for row in rows if row["way"] == "modal"}
    table = DataFrame([{**row, "by_modes": by_modes.get(row["point"])} for row in rows])
    return table.astype({name: object if name in WORDS else float for name in table})


def _modal(run: RodRun, results: Results) -> dict[str, Any]:
    outcome, twin = results.get(run.name), results.get(run.twin.name)
    row = {key: value(outcome, key) for key in (VIBRATION, RESTITUTION)}
    return row | _beside_rigid(run.rod, twin) | _whole(run.rod, twin)


def _solid(run: RodRun, results: Results) -> dict[str, Any]:
    outcome, twin = results.get(run.name, Failure(run.name, "was not computed")), results.get(run.twin.name)
    vibration, band = estimate(outcome, VIBRATION)
    wanted = max(CLOSE * abs(vibration or 0.0), LEAST)
    reason = outcome.reason if isinstance(outcome, Failure) else ""
    if isinstance(outcome, Outcome) and band is None:
        reason = outcome.reasons[VIBRATION if vibration is None else "mesh_band"]
    banded: dict[str, Any] = {}
    for key in BANDED:
        banded[key], banded[f"{key}_band"] = estimate(outcome, key)
    return {
        **banded,
        **{key: estimate(outcome, key)[0] for key in SHARES},
        f"{VIBRATION}_own_mesh": value(outcome, VIBRATION),
        f"{VIBRATION}_first_contact": value(results.get(f"{FIRST}{run.point}"), VIBRATION),
        "tip_size_m": value(outcome, "tip_size_m"),
        "contacts": len(contacts(outcome)) or None,
        **_beside_rigid(run.rod, twin),
        "residual_over_E_0": value(outcome, "residual_over_E_0"),
        "as_wanted": band is not None and band <= wanted,
        "reason": reason,
        "intervals": contacts(outcome),
        "doubted": isinstance(outcome, Outcome) and vibration_floor(outcome) > wanted,
    }


def _pair(run: RodRun, results: Results) -> dict[str, Any]:
    """Return e by the finest level, and its change by all levels: a mesh's own error does not count."""
    levels = results.get(run.name)
    effect = solid_effect(levels.meshes) if isinstance(levels, Levels) else None
    if effect is None:
        return {}
    e = known(effect.free.restitution.edge.e)
    row = {RESTITUTION: e, **_beside_rigid(run.rod, effect.stiff), **_whole(run.rod, effect.stiff)}
    return row | {f"{RESTITUTION}_rigid": e - effect.value, "band_of_change": effect.band}


def _spring(run: RodRun, _: Results) -> dict[str, Any]:
    return spring_bounce(run.rod)


def _beside_rigid(rod: DroppedRod, twin: object) -> dict[str, float | None]:
    """Return e and first contact of the rod that cannot vibrate, and T1/tau."""
    period, touches = rod.first_period, contacts(twin)
    tau = touches[0].duration if touches else None
    return {
        "T1_s": period,
        "tau_s": tau,
        "T1_over_tau": period / tau if tau else None,
        "e_edge_rigid": value(twin, RESTITUTION),
        "band_of_change": None,
    }


def _whole(rod: DroppedRod, twin: object) -> dict[str, float]:
    """Return T1/tau of the rod's whole mass at 45 degrees, nothing where it has no twin."""
    return {"T1_over_tau_whole": whole_ratio(replace(rod, angle=45.0))} if twin else {}


def value(result: object, key: str) -> float | None:
    """Return a number of an outcome, None where it is not known."""
    number: float | None = or_none(KEY_TABLE[key].of(result)) if isinstance(result, Outcome) else None
    return number


def contacts(result: object) -> tuple[ContactInterval, ...]:
    """Return the contacts of an outcome, none where they are not known."""
    return (or_none(result.contact.intervals) or ()) if isinstance(result, Outcome) else ()


def estimate(result: object, key: str) -> tuple[float | None, float | None]:
    """Return limit and half-width of its band that levels give a number, None where not known."""
    number, band = result.estimate(key) if isinstance(result, Outcome) else (None, None)
    return or_none(number), band


def among(rows: DataFrame, **values: object) -> DataFrame:
    """Return the rows with the given values of their columns, by slenderness."""
    for column, wanted in values.items():
        rows = rows[rows[column] == wanted]
    return rows.sort_values("gamma", kind="stable")


def rods_of(angles: DataFrame) -> DataFrame:
    """Return one row per family and rod, over the angles.

    ``error_of_e`` is the largest change of e by vibration, with T1/tau at that angle; ``error_low`` is what
    the bands leave sure of it, ``error_high`` what they allow, ``error_of_e_band`` how much more that is.
    ``spread_of_e`` is the largest less the smallest e, the published meaning of the criterion,
    ``spread_rigid`` that of the rod that cannot vibrate.
    """
    error, band = (angles.e_edge - angles.e_edge_rigid).abs(), angles.band_of_change.fillna(0.0)
    angles = angles.assign(error_of_e=error, error_low=error - band, error_high=error + band)
    same = angles.groupby(["family", "diameter_m", "length_m"], sort=False)
    worst = same[["gamma", "T1_over_tau_whole", "error_of_e", "error_low", "error_high"]].max()
    return worst.assign(
        T1_over_tau=angles.T1_over_tau[same.error_of_e.idxmax()].to_numpy(),
        error_of_e_band=(worst.error_high - worst.error_of_e).where(same.band_of_change.max().notna()),
        spread_of_e=same.e_edge.max() - same.e_edge.min(),
        spread_rigid=same.e_edge_rigid.max() - same.e_edge_rigid.min(),
    ).reset_index()


def crossing(rods: DataFrame, level: float, measure: str = "error_of_e", x: str = "gamma") -> float | None:
    """Return where, in slenderness or T1/tau, a measure first passes a level, by linear interpolation."""
    for (low, below), (high, above) in pairwise(sorted(zip(rods[x], rods[measure], strict=True))):
        if below < level <= above:
            return float(low + (high - low) * (level - below) / (above - below))
    return None


def exponent(rods: DataFrame, level: float, measure: str = "error_of_e") -> float | None:
    """Return p of l = C d^p along which the measure stays at a level, fitted over the diameters."""
    onsets = [(d, crossing(same, level, measure)) for d, same in rods.groupby("diameter_m")]
    lengths = [(d, length_of(gamma, d)) for d, gamma in onsets if gamma is not None]
    if len(lengths) < 2:
        return None
    d, length = np.log(np.array(lengths)).T
    return float(np.polyfit(d, length, 1)[0])
