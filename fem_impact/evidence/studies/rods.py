"""Dropped rods of the studies over slenderness: their scenes, their runs, and the one table of results.

Rods differ in diameter, tip, speed, angle, friction, yielding; each runs with and without vibration. Both
studies are made from that table (`run_table`).
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from math import cos, radians, sin
from typing import Any

from pandas import DataFrame

from fem_impact import Outcome, Scene, load, replace_all, simulate
from fem_impact.answers.refine.extrapolate import vibration_floor
from fem_impact.evidence.references.free_modes import bending_period
from fem_impact.jobs.job import Failure, Job, JobResults
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.outcome.shares import shares
from fem_impact.scene.fields import FlowLaw
from fem_impact.scene.impact import Impact
from fem_impact.scene.library import surfaces
from fem_impact.scene.material import Surface
from fem_impact.scene.types import Save
from fem_impact.tables.table import Table
from rigid.slenderness import EXPONENT

PAPER_RODS = {"0.24 m": 0.24, "0.12 m": 0.12, "0.08 m": 0.08}
"""Lengths, m, of the three rods of 19 mm."""

PAPER = load("t5b")
"""Scene whose steels, barrier and tip all dropped rods have: tip B, the edge of the face, rounded by 3 mm."""

READINGS: dict[FlowLaw, Scene] = {
    "tensile": PAPER,
    "hardness": replace_all(
        PAPER, {"projectile.material.law": "hardness", "barrier.material.law": "hardness"}
    ),
}
"""That scene with the flow curve of both steels from their ultimate stress, and from their hardness."""

STATES = {"frictionless": 0.0} | dict(
    sorted((name, surface.friction) for name, surface in surfaces().items())
)
"""f of no friction and of the shipped surface states, in the order of their names."""

KINDS = {False: "elastic", True: "yielding"}
"""Kind of contact by whether both bodies yield."""

PLAIN = {"yielding": "machined", "elastic": "frictionless"}
"""Surface state, by kind of contact, at which other inputs are changed and the partition is drawn."""

BODY, TIP = 0.019, 0.003  # m: diameter and edge radius of the paper's rods


def length_of(gamma: float, diameter: float = BODY) -> float:
    """Return the length, m, of a rod of slenderness gamma, m^-0.3815 (Eq 29)."""
    return float(gamma * diameter**EXPONENT)


@dataclass(frozen=True, slots=True)
class DroppedRod:
    """A rod that falls on the plate without spin: lengths in m, angle in degrees, speed in m/s.

    With ``yields`` both bodies yield, on the flow curve that ``law`` names (see `Material`); without
    ``vibrates`` the rod is rigid, on the same contact. A ``tip_radius`` of None is in proportion to the
    diameter.
    """

    length: float
    angle: float = 45.0
    friction: float = 0.0
    yields: bool = False
    diameter: float = BODY
    tip_radius: float | None = None
    speed: float = 2.1
    vibrates: bool = True
    law: FlowLaw = "tensile"

    @property
    def gamma(self) -> float:
        """Slenderness, m^-0.3815."""
        return float(self.length / self.diameter**EXPONENT)

    @property
    def name(self) -> str:
        """Identifier of rounded numbers: lengths in um, angle in 0.01 deg, f in 0.001, speed in mm/s."""
        kind = ("y" if self.yields else "e") + ("v" if self.vibrates else "r")
        kind += "" if self.law == "tensile" else self.law[0]
        lengths = (self.length * 1e6, self.diameter * 1e6, self.radius * 1e6)
        numbers = (*lengths, self.angle * 1e2, self.friction * 1e3, self.speed * 1e3)
        return "-".join([kind, *(str(round(n)) for n in numbers)])

    @property
    def inputs(self) -> dict[str, float | str]:
        """Columns of a table: slenderness and inputs, units in their names, angle in degrees."""
        return {
            "gamma": self.gamma,
            "diameter_m": self.diameter,
            "length_m": self.length,
            "speed_m_per_s": self.speed,
            "angle_deg": self.angle,
            "f": self.friction,
            "contact": KINDS[self.yields],
            "law": self.law,
        }

    @property
    def radius(self) -> float:
        """Edge radius of the tip, m."""
        return TIP * self.diameter / BODY if self.tip_radius is None else self.tip_radius

    @property
    def first_period(self) -> float:
        """First bending period of the rod, s."""
        steel = PAPER.projectile.material
        return bending_period(steel.E, steel.nu, steel.rho, self.length, self.diameter / 2)

    @property
    def effects(self) -> tuple[str, ...]:
        """Effects by their numbers but for vibration, yielding and gravity, which the study sets.

        The contact's heat does not act on the motion, so it is not watched.
        """
        vibration = "vibration" if self.vibrates else "-vibration"
        bodies = () if self.yields else ("-rod-plasticity", "barrier-elastic")
        return ("auto", vibration, *bodies, "-gravity", "-contact-heating")

    def scene(self) -> Scene:
        """Return the scene, on the mesh that it gets by itself."""
        angle, paper = radians(self.angle), READINGS[self.law]
        return replace(
            paper,
            id=self.name,
            title=f"gamma {self.gamma:.1f}, {self.angle:g} deg, {self.speed:g} m/s, f {self.friction:g}",
            projectile=replace(
                paper.projectile, length=self.length, diameter=self.diameter, tip_radius=self.radius
            ),
            surface=surface_of(self.friction),
            impact=Impact(angle, -self.speed * cos(angle), -self.speed * sin(angle)),
            effects=self.effects,
            save=Save(frames=0),
            measured=None,
        )


def surface_of(f: float) -> Surface:
    """Return the shipped surface state with a coefficient of friction, or a surface made for it."""
    shipped = (surface for surface in surfaces().values() if surface.friction == f)
    return next(shipped, Surface("custom", f, f, f, "point of a study"))


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
    def twin(self) -> "RodRun":
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
    vibration, band = estimate(result, VIBRATION)
    reason = result.reason if isinstance(result, Failure) else ""
    if band is None and not reason:
        reason = result.reasons[VIBRATION if vibration is None else "mesh_band"]
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
        "reason": reason,
        "family": row.family,
        "intervals": contacts(result),
        "doubted": isinstance(result, Outcome) and vibration_floor(result) > wanted_band(result),
    }
