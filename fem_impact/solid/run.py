"""One run of the explicit model, from scene to the state after the last separation."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.effects import specify
from fem_impact.estimates import contact_estimate
from fem_impact.modes import Flight, RigidMotion
from fem_impact.output import FieldWriter, HistoryWriter
from fem_impact.progress import Progress
from fem_impact.solid.build import build
from fem_impact.solid.doubts import SkinWatch, doubts
from fem_impact.solid.fields import Fields
from fem_impact.solid.heatwatch import HeatWatch
from fem_impact.solid.kernels import compiled_before
from fem_impact.solid.march import Observer, evaluate, march
from fem_impact.solid.model import Model
from fem_impact.solid.observers import Frames, History, Meter, Watch
from fem_impact.solid.peak import PeakForce
from fem_impact.solid.rodview import RodView
from fem_impact.solid.separation import Separation
from fem_impact.solid.shares import run_time_shares
from fem_impact.solid.state import State
from fem_impact.solid.stepguard import StepGuard

if TYPE_CHECKING:
    from fem_impact.scene import Scene

FRAMES_SPAN = 3.0  # contact durations (estimated) over which the wanted number of frames is spread


@dataclass(frozen=True, slots=True)
class Cost:
    """What a run took."""

    wall: float
    cpu: float
    memory_MB: float
    smallest_step: float


@dataclass(frozen=True, slots=True)
class SolidResult:
    """The end of a run.

    Attributes
    ----------
    scene : what was run
    time, steps : s and number at the end of the march
    accounts, E_0, worst : the ledger there, J; worst is the largest residual of the run
    motion, flight : rigid and vibrating part of the motion after the last separation
    peak_force : largest normal force on the whole rod, N, mean over 2 us
    vibration_check : twice the mean vibrational kinetic energy over a half-period, J, or None
    heat : the contact's patch and friction power over time, or None
    shares : share of the run time of the effects that have items of their own
    """

    scene: Scene
    model: Model
    view: RodView
    time: float
    steps: int
    accounts: dict[str, float]
    E_0: float
    worst: float
    motion: RigidMotion
    flight: Flight
    peak_force: float
    vibration_check: float | None
    finished: bool
    reason: str
    cost: Cost
    warnings: tuple[str, ...]
    heat: HeatWatch | None = None
    shares: dict[str, float] = field(default_factory=dict)


def solve(
    scene: Scene, out: Path | None = None, progress: Callable[[Progress], None] | None = None
) -> SolidResult:
    """Run a scene; histories and fields go to ``out`` while it runs."""
    spec = specify(scene)
    model = build(scene, spec)
    view = RodView.of(model)
    state, watch = model.initial_state(), Watch(model.ledger(), scene.save.history_every)
    guard, stop = StepGuard(model), Separation(model, view, scene.accuracy.max_time)
    frames = _frames(scene, model, view, out)
    history = _history(scene, model, view, watch, out)
    skin, peak = SkinWatch(model), PeakForce(model.book)
    heat = HeatWatch(model) if spec.heat else None
    observers: list[Observer] = [guard, watch, *history, *frames, skin, peak, *([heat] if heat else []), stop]
    if progress is not None:
        observers.append(Meter(progress, watch, model, scene.accuracy.max_time, scene.id))
    if progress is not None and not compiled_before():
        progress(Progress(0.0, scene.accuracy.max_time, 0, 0.0, "compiling the kernels, once, about 20 s"))
    _warm_up(model)
    wall, cpu = time.perf_counter(), time.process_time()
    try:
        march(model, state, observers)
    finally:
        for h in history:
            h.writer.flush()
    watch.observe(state)
    cost = Cost(time.perf_counter() - wall, time.process_time() - cpu, _peak_memory(), guard.smallest)
    # the coasting below moves the state on: everything else is taken now
    result = SolidResult(
        scene=scene,
        model=model,
        view=view,
        time=state.time,
        steps=state.step,
        accounts=watch.accounts,
        E_0=watch.ledger.start,
        worst=watch.ledger.worst,
        motion=view.rigid(state),
        flight=view.flight(state, model),
        peak_force=peak.largest,
        vibration_check=None,
        finished=stop.finished,
        reason=stop.reason,
        cost=cost,
        warnings=tuple(w for f in frames for w in f.writer.warnings) + doubts(model, skin),
        heat=heat,
    )
    if stop.finished and model.rod_stiffness is not None:
        result = replace(result, vibration_check=coast(model, view, state))
    return replace(result, shares=run_time_shares(scene, model, state, cost.wall / max(state.step, 1)))


def _warm_up(model: Model) -> None:
    """Let the force kernels compile on a throw-away state, so that times are times of the run."""
    evaluate(model, model.initial_state())


def coast(model: Model, view: RodView, state: State) -> float:
    """Fly the rod on for half a period of its first bending mode; return 2 <vibrational kinetic energy>, J.

    Steps the rod alone, with its yielding zone, so this checks the modal projection independently. The
    state is moved on.
    """
    probe = VibrationProbe(view, state.time + np.pi / float(view.modes.omega[0]))
    state.v[model.layout.barrier_slice] = 0.0
    march(model.coasting(), state, [probe])
    return 2 * float(np.mean(probe.energies))


class VibrationProbe:
    """Samples the kinetic energy beyond the rigid motion until a time."""

    every = 10

    def __init__(self, view: RodView, end: float) -> None:
        self.view, self.end = view, end
        self.energies: list[float] = []

    def observe(self, state: State) -> bool:
        """Sample; stop at the end."""
        v = state.v[self.view.places]
        self.energies.append(float(self.view.mass @ (v**2).sum(axis=1)) - self.view.rigid(state).kinetic)
        return state.time >= self.end


def _frames(scene: Scene, model: Model, view: RodView, out: Path | None) -> list[Frames]:
    if out is None or scene.save.frames == 0:
        return []
    bodies = [scene.projectile.material, scene.barrier.material]
    fields = Fields.of(model, view, [(m.E, m.nu) for m in bodies])
    writer = FieldWriter(out / "fields.vtkhdf", fields.points, fields.cells, {"body": fields.body})
    return [Frames(fields, writer, FRAMES_SPAN * contact_estimate(scene).duration / scene.save.frames)]


def _history(scene: Scene, model: Model, view: RodView, watch: Watch, out: Path | None) -> list[History]:
    if out is None:
        return []
    writer = HistoryWriter(out / "history.csv")
    return [History(model, view, watch, writer, scene.save.history_every)]


def _peak_memory() -> float:
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1e6 if sys.platform == "darwin" else peak * 1024 / 1e6
