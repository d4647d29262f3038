"""Points of the gamma study: a drop by finite elements on two or three meshes, and without vibration."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache

from fem_impact.answers.refine.extrapolate import vibration_floor
from fem_impact.evidence.studies.pairs import resized, shifted, with_limits
from fem_impact.evidence.studies.rods import Drop
from fem_impact.jobs.job import Failure, Job
from fem_impact.jobs.run import JobResults
from fem_impact.outcome.groups import ContactInterval
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.scene.types import Scene

VIBRATION, RESTITUTION, FORCE = "E_vib_over_E_0", "e_edge", "peak_force_N"
CLOSE, LEAST = 0.05, 2e-4  # wanted band of vibration: of itself, and of E_0; the larger counts
Result = Outcome | Failure
SLACK = 1e-6  # s: a run that is cut ends so long after its first contact
FIRST = "first-"  # before the name of a run that is cut after its first contact


@dataclass(frozen=True, slots=True)
class Meshes:
    """Sizes of the elements at the contact, over those that a scene gets by itself.

    Every point has ``own`` and ``second``, the coarser one of its band and the one of the rod that cannot
    vibrate. Each of ``finer``, the largest first, is for points whose band of vibration is wider than wanted
    on the meshes before it.
    """

    own: float
    second: float
    finer: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Point:
    """A drop and what became of it.

    Attributes
    ----------
    name : the drop's, or the id of the measured set whose scene it is
    drop : the drop, or the one most like that scene
    run : with the limits and bands of its two finest meshes; a failure where its own mesh has no result
    own : E_vib/E_0 on its own mesh, None where that is not known
    first : E_vib/E_0 after the first contact on its own mesh, None where that is not known
    tau : contact time of the rod that cannot vibrate, s; e_rigid : its restitution; None where not known
    """

    name: str
    drop: Drop
    run: Result
    own: float | None
    first: float | None
    tau: float | None
    e_rigid: float | None

    def value(self, key: str) -> float | None:
        """Return the limit that two meshes give a key, else its value; None where it is not known."""
        return or_none(self.run.estimate(KEY_TABLE[key])[0]) if isinstance(self.run, Outcome) else None

    def band(self, key: str) -> float | None:
        """Return the half-width about the limit, None where two meshes give none."""
        return self.run.estimate(KEY_TABLE[key])[1] if isinstance(self.run, Outcome) else None

    @property
    def contacts(self) -> tuple[ContactInterval, ...]:
        """The contacts, none where they are not known."""
        return (or_none(self.run.contact.intervals) or ()) if isinstance(self.run, Outcome) else ()

    @property
    def ratio(self) -> float | None:
        """T1/tau: first bending period over the contact time of the rod that cannot vibrate."""
        return self.drop.first_period / self.tau if self.tau else None

    @property
    def gap(self) -> str:
        """Why vibration has no value or no band; empty where it has both."""
        if isinstance(self.run, Failure):
            return self.run.reason
        if self.value(VIBRATION) is None:
            return self.run.reasons[VIBRATION]
        return "" if self.band(VIBRATION) is not None else self.run.reasons["mesh_band"]

    @property
    def wanted(self) -> float:
        """Half-width of the band of vibration that is wanted, of E_0."""
        return max(CLOSE * abs(self.value(VIBRATION) or 0.0), LEAST)

    @property
    def close(self) -> bool:
        """Whether vibration has a band as narrow as wanted."""
        band = self.band(VIBRATION)
        return band is not None and band <= self.wanted

    @property
    def doubted(self) -> bool:
        """Whether the run's two counts of vibration differ by more than the band that is wanted."""
        return isinstance(self.run, Outcome) and vibration_floor(self.run) > self.wanted


@dataclass(frozen=True, slots=True)
class Member:
    """A point to compute.

    Attributes
    ----------
    name, scene : its name and its scene
    drop : its drop, or the one most like that scene
    places : of the barrier's grid, in cells at the contact, at which each of its meshes runs
    """

    name: str
    scene: Scene
    drop: Drop
    places: tuple[float, ...] = (0.0,)

    def jobs(self, factor: float) -> list[Job]:
        """Return the jobs, one a place, on a mesh with elements ``factor`` times the scene's own."""
        scene, name = _resized(self.scene, factor), f"{self.name}-x{factor:g}"
        return [
            Job(f"{name}-at-{place:g}", shifted(scene, place)) if place else Job(name, scene)
            for place in self.places
        ]

    def twin(self, factor: float) -> Job:
        """Return the job of the rod that cannot vibrate."""
        stiff = replace(self.drop, vibrates=False)
        return Job(f"{stiff.name}-x{factor:g}", _resized(stiff.scene(), factor))

    def first(self, factor: float, end: float) -> Job:
        """Return the job on a mesh that is cut after a first contact, which ends at ``end``, s."""
        scene = _resized(self.scene, factor)
        return Job(
            f"{FIRST}{self.name}", replace(scene, accuracy=replace(scene.accuracy, max_time=end + SLACK))
        )


def first_jobs(one: Member, meshes: Meshes) -> list[Job]:
    """Return the jobs of a point on its own and the second mesh, and of the rod that cannot vibrate."""
    return [*one.jobs(meshes.own), *one.jobs(meshes.second), one.twin(meshes.second)]


def more_jobs(one: Member, meshes: Meshes, results: JobResults) -> list[Job]:
    """Return the jobs that the results of a point call for: finer meshes, and one cut at a second contact."""
    jobs = []
    for level, factor in enumerate(meshes.finer):
        if point_of(one, replace(meshes, finer=meshes.finer[:level]), results).close:
            break
        jobs += one.jobs(factor)
        if any(job.name not in results for job in jobs):
            break
    contacts = point_of(one, replace(meshes, finer=()), results).contacts
    cut = [one.first(meshes.own, contacts[0].end)] if len(contacts) > 1 else []
    return [*jobs, *cut]


def point_of(one: Member, meshes: Meshes, results: JobResults) -> Point:
    """Return a point from the results of its jobs."""
    second, own, *finer = (
        _runs(one.jobs(factor), results) for factor in (meshes.second, meshes.own, *meshes.finer)
    )
    twin = results.get(one.twin(meshes.second).name)
    touches = (or_none(twin.contact.intervals) or ()) if isinstance(twin, Outcome) else ()
    return Point(
        one.name,
        one.drop,
        _limited(own, second, finer),
        _vibration(own[0]),
        _vibration(results.get(f"{FIRST}{one.name}")),
        touches[0].duration if touches else None,
        or_none(twin.restitution.edge.e) if isinstance(twin, Outcome) else None,
    )


def _limited(own: Sequence[Result], second: Sequence[Result], finer: Iterable[Sequence[Result]]) -> Result:
    """Return the run on the finest mesh that knows vibration, with limits; none without the own mesh."""
    if isinstance(own[0], Failure):
        return own[0]
    fine, coarse = own, second
    for runs in finer:
        if any(_vibration(run) is None for run in runs):
            break
        fine, coarse = runs, fine
    return with_limits(fine, coarse)


def _runs(jobs: Sequence[Job], results: JobResults) -> list[Result]:
    return [results.get(job.name, Failure(job.name, "was not computed")) for job in jobs]


@cache
def _resized(scene: Scene, factor: float) -> Scene:
    return resized(scene, factor)


def _vibration(run: Result | None) -> float | None:
    return or_none(run.energy.vibration) if isinstance(run, Outcome) else None


def among(points: Iterable[Point], **values: object) -> list[Point]:
    """Return the points whose drops have the given values, by slenderness."""
    same = (p for p in points if all(getattr(p.drop, name) == value for name, value in values.items()))
    return sorted(same, key=lambda point: point.drop.gamma)
