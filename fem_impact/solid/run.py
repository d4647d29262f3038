"""One run of the explicit model, from scene to the state after the last separation."""

from __future__ import annotations

import resource
import sys
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fem_impact.fem.flight import FreeVibration, RigidMotion
from fem_impact.fem.kernels import compiled_before
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.options import RunOptions
from fem_impact.plan.plan import Plan
from fem_impact.progress import compiling
from fem_impact.solid.build import build
from fem_impact.solid.checkpoint import Checkpoint
from fem_impact.solid.doubts import doubts, skin_share
from fem_impact.solid.march import Observer, advance, evaluate, march
from fem_impact.solid.model import Model
from fem_impact.solid.observers import ProgressObserver
from fem_impact.solid.rodview import RodState
from fem_impact.solid.shares import run_time_shares
from fem_impact.solid.state import State
from fem_impact.solid.watchers import Stopwatch, Watchers

if TYPE_CHECKING:
    from fem_impact.solid.heatwatch import HeatWatch


@dataclass(frozen=True, slots=True)
class LoopCost:
    """What a run took.

    ``wall`` and ``cpu`` are s in its time loop, ``setup_wall`` and ``setup_cpu`` around it, compiling apart.
    """

    wall: float
    cpu: float
    setup_wall: float
    setup_cpu: float
    memory_MB: float
    smallest_step: float


@dataclass(frozen=True, slots=True)
class SolidResult:
    """The end of a run.

    Attributes
    ----------
    plan : what was run
    time, steps : s and number at the end of the march
    accounts, E_0, worst : the ledger there, J; worst is the largest residual of the run
    motion, flight : rigid and vibrating part of the motion after the last separation
    skin_share : share of the barrier's plastic work that lies right under its surface
    peak_force : largest normal force on the whole rod, N, mean over 2 us
    peak_nodes : nodes of the half model that were pressed at once then
    vibration_check : kinetic and strain energy of the vibration without modes, see `RodState`, J, or None
    heat : the contact's patch and friction power over time, or None
    shares : share of the run time of the effects that have items of their own; None where it is not resolved
    """

    plan: Plan
    model: Model
    view: RodState
    time: float
    steps: int
    accounts: dict[str, float]
    E_0: float
    worst: float
    motion: RigidMotion
    flight: FreeVibration
    skin_share: float
    peak_force: float
    peak_nodes: int
    vibration_check: tuple[float, float] | None
    finished: bool
    reason: str
    cost: LoopCost
    warnings: tuple[str, ...]
    heat: HeatWatch | None = None
    shares: dict[str, float | None] = field(default_factory=dict)


def solve(plan: Plan, options: RunOptions = RunOptions(), model: Model | None = None) -> SolidResult:
    """Run a scene as planned; histories, fields and checkpoints go to ``options.out`` while it runs.

    Parameters
    ----------
    plan, options : what is computed, and how the run is kept
    model : a prepared model of the scene instead of a built one

    Raises
    ------
    ResultError
        If the checkpoint is missing, damaged, or of another scene or program.
    RunError
        If the motion is no longer finite.
    """
    whole = Stopwatch()
    model, out = model or build(plan), options.out
    view = RodState.of(model)
    state = model.initial_state()
    looking = Watchers.of(plan, model, view, out, options.resume)
    observers: list[Observer] = [*looking.all]
    if options.progress is not None:
        scene = plan.scene
        if not compiled_before():
            options.progress(compiling(scene.accuracy.max_time, 20))
        end = scene.accuracy.max_time
        observers.append(ProgressObserver(options.progress, looking.watch, model, end, scene.id))
    evaluate(model, model.initial_state())  # kernels compile on a throw-away state, not in the times
    clock = Stopwatch()
    if out is not None:
        holders = looking.holders(model, state, clock)
        place, every = out / CHECKPOINT, options.checkpoint_s
        saved = Checkpoint(place, options.stamp, holders, every, lambda: bool(looking.reason))
        observers.append(saved)
        if options.resume:
            saved.restore()
            advance(model, state)  # the forces of the checkpoint's step are known
    marching = Stopwatch()
    try:
        march(model, state, observers)
    finally:
        looking.flush()
    loop, here = clock.read(), marching.read()
    looking.watch.observe(state)
    free = looking.stop.finished and model.rod_stiffness is not None
    check = view.vibration(state, model) if free else None
    wall, cpu = (long - part for long, part in zip(whole.read(), here, strict=True))
    cost = LoopCost(*loop, wall, cpu, _peak_memory(), looking.guard.smallest)
    result = _result(plan, model, view, state, looking, check, cost)
    step_time = result.cost.cpu / max(result.steps, 1)
    return replace(result, shares=run_time_shares(model, state, step_time, looking.heat))


def _result(
    plan: Plan,
    model: Model,
    view: RodState,
    state: State,
    looking: Watchers,
    check: tuple[float, float] | None,
    cost: LoopCost,
) -> SolidResult:
    ledger, stop = looking.watch.ledger, looking.stop
    return SolidResult(
        plan=plan,
        model=model,
        view=view,
        time=state.time,
        steps=state.step,
        accounts=looking.watch.accounts,
        E_0=ledger.start,
        worst=ledger.worst,
        motion=view.rigid(state),
        flight=view.flight(state, model),
        skin_share=skin_share(model),
        peak_force=looking.peak.largest,
        peak_nodes=looking.peak.nodes,
        vibration_check=check,
        finished=stop.finished,
        reason=looking.reason,
        cost=cost,
        warnings=tuple(w for f in looking.frames for w in f.writer.warnings) + doubts(model, looking.skin),
        heat=looking.heat,
    )


def _peak_memory() -> float:
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1e6 if sys.platform == "darwin" else peak * 1024 / 1e6
