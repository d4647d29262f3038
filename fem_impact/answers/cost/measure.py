"""Measurement of the cost of one scene: its settings are run, stored and judged."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import asdict, dataclass, replace
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.answers.cost.judge import Judged, front, judge
from fem_impact.answers.cost.settings import Setting, settings_of
from fem_impact.answers.refine.extrapolate import ExtrapolatedValue, MeshRuns, target_limits
from fem_impact.answers.refine.levels import MeshLevel, family, on_mesh
from fem_impact.answers.refine.quantities import QUANTITIES
from fem_impact.case.case import Case
from fem_impact.errors import RunError, UsageError
from fem_impact.fem.kernels import compiled_before
from fem_impact.files.lock import directory_lock
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.jobs.job import Failure, Job, compute
from fem_impact.jobs.run import JobResults, run_jobs, stored_results
from fem_impact.jobs.store import STORE, Store
from fem_impact.outcome.record import Outcome, installed_versions, utc_now
from fem_impact.scene.write import to_dict
from fem_impact.tables.text import plain

if TYPE_CHECKING:
    from fem_impact.progress import ProgressMeter
    from fem_impact.scene.types import Scene


SCHEMA = "fem-impact/cost/5"
BRIEF = 5e-6  # s, end of the run that compiles the kernels: within the first contact


@dataclass(frozen=True, slots=True)
class CostStudy:
    """What accuracy costs for one scene.

    Attributes
    ----------
    scene : Scene
    limits : limit of each quantity that the finite-element runs give
    settings : judged, in order of CPU time
    failures : settings without a result, with the reason
    runs : their results by the name of the run
    """

    scene: Scene
    limits: dict[str, ExtrapolatedValue]
    settings: list[Judged]
    failures: list[dict[str, str]]
    runs: JobResults

    @property
    def quantities(self) -> dict[str, dict[str, Any]]:
        """Return unit, limit, order, uncertainty and scale of every quantity."""
        return {
            quantity.name: {
                "unit": quantity.unit,
                "limit": limit.value,
                "order": limit.order,
                "uncertainty": limit.uncertainty,
                "scatter": limit.scatter,
                "scale": limit.scale,
            }
            for quantity in QUANTITIES
            if (limit := self.limits.get(quantity.name))
        }

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        from fem_impact.case.measured import yardsticks

        return {
            "schema": SCHEMA,
            "created_utc": utc_now(),
            "versions": installed_versions(),
            "machine": yardsticks(),
            "scene": to_dict(self.scene),
            "quantities": self.quantities,
            "settings": [asdict(setting) for setting in self.settings],
            "failures": self.failures,
        }


def measure(
    scene: Scene,
    out: Path,
    progress: ProgressMeter,
    meshes: Sequence[MeshLevel] = (),
    executor: Executor | None = None,
    budget_s: float = inf,
) -> CostStudy:
    """Run what is not stored in ``out`` yet, one run at a time so that times are times.

    Settings that do not fit into a processor time of ``budget_s``, s, as `RunSize` expects it, are left out.

    Raises
    ------
    OutputPathError
        Another process writes to ``out``, or it cannot be written.
    RunError
        Fewer than two meshes gave a result, so nothing is known of the limit.
    """
    settings = affordable(settings_of(scene, meshes), budget_s)
    jobs = _jobs(settings)
    # a process of its own for every run: its peak memory is its own
    processes = LocalProcesses(1, reuse=False) if executor is None else nullcontext(executor)
    with directory_lock(out), processes as process:
        _compile(scene, process)
        results = run_jobs(jobs, out / STORE, progress, process)
    return conclude(scene, settings, results)


def affordable(settings: Sequence[Setting], budget_s: float) -> list[Setting]:
    """Return the settings that fit into a processor time, s, taken in their order."""
    taken: list[Setting] = []
    spent: dict[str, float] = {}
    for setting in settings:
        new = {job.name: _planned_s(job) for job in _jobs([setting]) if job.name not in spent}
        if sum(spent.values()) + sum(new.values()) <= budget_s:
            spent |= new
            taken.append(setting)
    if sum(setting.kind == "mesh" for setting in taken) < 2:
        meshes = [setting for setting in settings if setting.kind == "mesh"]
        need = sum(map(_planned_s, _jobs(meshes[:2])))
        raise UsageError(
            "is too short for two meshes.",
            key="--budget",
            value=f"{budget_s:.3g} s",
            remedy=f"Give some {plain(need, 2)} s or more.",
        )
    return taken


def _planned_s(job: Job) -> float:
    """Return the processor time, s, that a run is expected to take; 0 of a reduced model."""
    return Case.of(job.scene).size.time if job.fidelity == "solid" else 0.0


def judge_stored(
    scene: Scene, out: Path, progress: ProgressMeter, meshes: Sequence[MeshLevel] = ()
) -> CostStudy:
    """Judge what `measure` has stored in ``out`` so far, and run nothing.

    Raises
    ------
    RunError
        As `measure`, and where nothing is stored.
    """
    settings = settings_of(scene, meshes)
    with Store.open(out / STORE) as base:
        results = stored_results(base, _jobs(settings), progress)
    if not results:
        raise RunError(
            f"{out}: holds no run of {scene.id} by this version of the program. "
            "Leave out --stored to run its settings."
        )
    return conclude(scene, settings, results)


def _jobs(settings: Sequence[Setting]) -> list[Job]:
    """Return the runs of settings without repetition: several meshes use the runs of each."""
    jobs = (job for setting in settings for on_mesh in setting.runs for job in on_mesh)
    return list({job.name: job for job in jobs}.values())


def _compile(scene: Scene, executor: Executor) -> None:
    """Compile the kernels by a run of a few steps, so that compilation is no part of a measured time."""
    if not compiled_before():
        coarse = on_mesh(scene, family(scene)[0])
        brief = replace(coarse, accuracy=replace(coarse.accuracy, max_time=BRIEF))
        executor.submit(compute, Job("compilation", brief)).result()


def conclude(scene: Scene, settings: Sequence[Setting], results: JobResults) -> CostStudy:
    """Judge the runs of settings; those that lack one are left out.

    Settings are in order of CPU time, each with the quantities on whose Pareto front it lies.
    """
    runs = {setting.name: _runs(setting, results) for setting in settings}
    failures = [
        {"setting": name, "reason": reason}
        for name, result in results.items()
        if (reason := _failure(result)) is not None
    ]
    meshes = {s.meshes[0]: runs[s.name][0] for s in settings if s.kind == "mesh" and runs[s.name]}
    if len(meshes) < 2:
        reasons = " ".join(dict.fromkeys(failure["reason"] for failure in failures))
        raise RunError(f"{scene.id}: no two meshes gave a result. {reasons}".strip())
    on_meshes = list(meshes.values())
    limits, finest = target_limits(on_meshes), target_limits(on_meshes[-2:])
    judged = []
    for setting in settings:
        of_effect = setting.kind == "effect"  # left out at the first offset of its mesh
        whole = meshes.get(setting.meshes[0]) if of_effect else None
        if runs[setting.name] and not (of_effect and whole is None):
            first = MeshRuns(whole.size, whole.runs[:1]) if whole else None
            judged.append(judge(setting, runs[setting.name], limits, finest, first))
    fronts = {q.name: {one.name for one in front(judged, [q.name])} for q in QUANTITIES}
    marked = [
        replace(one, front=[name for name, members in fronts.items() if one.name in members])
        for one in sorted(judged, key=lambda one: one.cpu_s)
    ]
    return CostStudy(scene, limits, marked, failures, results)


def _failure(result: Outcome | Failure) -> str | None:
    """Return why a run cannot be judged."""
    if isinstance(result, Failure):
        return result.reason
    return None if result.validity.finished else result.validity.stopped_because


def _runs(setting: Setting, results: JobResults) -> list[MeshRuns]:
    """Return the outcomes of a setting on each mesh, none if one is missing."""
    good = [
        [run for job in jobs if isinstance(run := results.get(job.name), Outcome) and _failure(run) is None]
        for jobs in setting.runs
    ]
    complete = [len(runs) for runs in good] == [len(jobs) for jobs in setting.runs]
    return [MeshRuns.of(runs) for runs in good] if complete else []
