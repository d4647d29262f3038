"""One run of the explicit model, from its case to the state after the last separation."""

from __future__ import annotations

import resource
import sys
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.case.record import ContactRecord
from fem_impact.case.size import modes_time, run_time, setup_time
from fem_impact.fem.flight import FreeVibration, RigidMotion
from fem_impact.fem.geometry import Geometry
from fem_impact.fem.kernels import compiled_before
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.options import RunOptions
from fem_impact.outcome.groups import Limitation, limitations
from fem_impact.progress import compiling, setting_up, standing
from fem_impact.solid.build import build
from fem_impact.solid.checkpoint import Checkpoint
from fem_impact.solid.fine_zone import left_zones, outside_zones, skin_shares
from fem_impact.solid.frame import mass_centre
from fem_impact.solid.march import Observer, advance, evaluate, march
from fem_impact.solid.model import Model
from fem_impact.solid.observers import ProgressObserver
from fem_impact.solid.rodview import RodState, modes_of
from fem_impact.solid.shares import run_time_shares
from fem_impact.solid.state import State
from fem_impact.solid.watchers import Stopwatch, Watchers

if TYPE_CHECKING:
    from fem_impact.solid.heatwatch import HeatWatch


@dataclass(frozen=True, slots=True)
class LoopCost:
    """Run time, memory and smallest step, s, of a run.

    ``wall`` and ``cpu`` are the times, s, of the time loop, ``setup_wall`` and ``setup_cpu`` those before and
    after it, all without compilation.
    """

    wall: float
    cpu: float
    setup_wall: float
    setup_cpu: float
    memory_MB: float
    smallest_step: float


class BarrierTurn(NamedTuple):
    """How a free barrier turns.

    ``spin`` is its angular momentum over its inertia, rad/s; ``start`` and ``end`` are the rod's mass centre
    from its own (n, t), m, then.
    """

    spin: float
    start: tuple[float, float]
    end: tuple[float, float]


@dataclass(frozen=True, slots=True)
class SolidResult:
    """The end of a run.

    Attributes
    ----------
    case : what was run
    state : all that moves, at the end
    time, steps : s and number at the end of the march
    accounts, E_0, worst : the ledger there, J; worst is the largest residual of the run
    motion, flight : rigid and vibrating part of the motion after the last separation
    base : velocity (n, t), m/s, that a free barrier gained as a whole, that of its mass centre; else 0
    turned : how it turns, None of one that does not
    skin_shares : share of each body's plastic work done right under its surface, by ``rod`` and ``barrier``
    peak_force : largest normal force on the whole rod, N, mean over a short window, see `PeakForce`
    peak_nodes : nodes of the half model that were pressed at once then
    added_energy : largest kinetic energy of the mass that mass scaling added, J
    vibration_check : kinetic and strain energy of the vibration without modes, see `RodState`, J, or None
    record : where the bodies touched and flowed
    heat : the contact's patch and friction power over time, or None
    strain : what a strain gauge shows over time, (k,), or None without one
    shares : share of the run time of the effects that have items of their own; None where it is not resolved
    """

    case: Case
    model: Model
    view: RodState
    state: State
    time: float
    steps: int
    accounts: dict[str, float]
    E_0: float
    worst: float
    motion: RigidMotion
    flight: FreeVibration
    base: tuple[float, float]
    turned: BarrierTurn | None
    skin_shares: dict[str, float]
    peak_force: float
    peak_nodes: int
    added_energy: float
    vibration_check: tuple[float, float] | None
    finished: bool
    reason: str
    other_end: float
    cost: LoopCost
    limitations: tuple[Limitation, ...]
    record: ContactRecord
    heat: HeatWatch | None = None
    strain: Array | None = None
    shares: dict[str, float | None] = field(default_factory=dict)


def solve(
    case: Case,
    options: RunOptions = RunOptions(),
    model: Model | None = None,
    view: RodState | None = None,
) -> SolidResult:
    """Run a case; histories, fields and checkpoints go to ``options.out`` while it runs.

    Parameters
    ----------
    case : of the scene
    options : output directory, progress, checkpoints
    model, view : a prepared model of the case, and what reads its rod (default: built here)

    Raises
    ------
    ResultError
        If the checkpoint is missing, damaged, or of another scene or program.
    RunError
        If the motion is not finite.
    """
    whole, out, show = Stopwatch(), options.out, options.progress
    if show is not None:
        end, time = case.size.steps * case.size.step, case.size.time
        # a level's own mesh says more, as soon as it stands
        show(setting_up(end, case.scene.id, None if options.resume or case.record is not None else time))

    def tell(geometry: Geometry) -> None:
        # the set-up of a large mesh takes longer than all steps: what shows may end it between its stages
        if show is not None:
            show(setting_up(end, case.scene.id, setup_s=_setup_s(case, geometry)))

    model = model or build(case, stage=tell)
    if show is None:
        view = view or RodState.of(model)
    else:
        remaining = None if options.resume else _remaining_s(case, model, end)
        show(standing(end, case.scene.id, remaining, _setup_s(case, model.geometry)))
        going_on = partial(show, setting_up(end, case.scene.id))
        view = view or RodState.of(model, modes_of(model, step=going_on))
    state = model.initial_state()
    watchers = Watchers.of(case, model, view, out, options.resume)
    observers: list[Observer] = [*watchers.all]
    if show is not None:
        if not compiled_before():  # told at once
            show(compiling(end, 20))
        stopping = case.contact.effective_mass * case.contact.approach
        observers.append(ProgressObserver(show, watchers.watch, model, end, stopping, case.scene.id))
    evaluate(model, model.initial_state())  # compiles the kernels before the time loop
    clock = Stopwatch()
    if out is not None:
        holders, over = watchers.holders(model, state, clock), lambda: bool(watchers.reason)
        checkpoint = Checkpoint(out / CHECKPOINT, options.stamp, holders, options.checkpoint_s, over)
        observers.append(checkpoint)
        if options.resume:
            checkpoint.restore()
            advance(model, state)  # the checkpoint's forces are up to date
    marching = Stopwatch()
    try:
        march(model, state, observers)
    finally:
        watchers.flush()
    for one in watchers.frames:
        one.writer.pack()
    loop, marched = clock.read(), marching.read()
    watchers.watch.observe(state)
    free = watchers.stop.finished and model.rod_stiffness is not None
    check = view.vibration(state, model) if free else None
    wall, cpu = (long - part for long, part in zip(whole.read(), marched, strict=True))
    cost = LoopCost(*loop, wall, cpu, _peak_memory(), watchers.guard.smallest)
    result = _result(case, model, view, state, watchers, check, cost)
    for strain in watchers.strain if free else []:
        strain.write(strain.ringing(view, state, result.flight))
    return replace(result, shares=run_time_shares(model, state, cost.cpu / max(state.step, 1), watchers.heat))


def _remaining_s(case: Case, model: Model, end: float) -> float:
    """Return about the time, s, of the modes of a model and of its steps up to ``end``, s."""
    g = model.geometry
    time = run_time(g.count, sum(zone.count for zone in model.zones), end / model.step)
    return time + (modes_time(case.bodies, len(g.rod.mesh.cells)) if model.rod_stiffness is not None else 0.0)


def _setup_s(case: Case, geometry: Geometry) -> float:
    """Return about the time, s, of the set-up with these meshes."""
    return setup_time(case.bodies, case.slots.vibrating, len(geometry.rod.mesh.cells), geometry.count)


def _result(
    case: Case,
    model: Model,
    view: RodState,
    state: State,
    watchers: Watchers,
    check: tuple[float, float] | None,
    cost: LoopCost,
) -> SolidResult:
    """Return the result at ``state``, without the shares of the run time."""
    ledger, stop, save, gauge = watchers.watch.ledger, watchers.stop, case.scene.save, None
    if save.gauge is not None and watchers.strain:
        across = 1.0 if save.gauge_across is None else save.gauge_across
        gauge = watchers.strain[0].waves().gauge(save.gauge, across)
    return SolidResult(
        case=case,
        model=model,
        view=view,
        state=state,
        time=state.time,
        steps=state.step,
        accounts=watchers.watch.accounts,
        E_0=ledger.start,
        worst=ledger.worst,
        motion=view.rigid(state),
        flight=view.flight(state, model),
        base=_base(case, model, state),
        turned=_turned(case, model, state) if model.ground.turns else None,
        skin_shares=skin_shares(model),
        peak_force=watchers.peak.largest,
        peak_nodes=watchers.peak.nodes,
        added_energy=watchers.added.largest,
        vibration_check=check,
        finished=stop.finished,
        reason=watchers.reason,
        other_end=stop.other_end,
        cost=cost,
        limitations=(
            *limitations("run", *(w for f in watchers.frames for w in f.writer.warnings)),
            *limitations("resolution", model.uneven, *outside_zones(model, watchers.skin)),
        ),
        record=replace(
            watchers.skin.with_landed(watchers.contact.record(), model, state.x),
            left=left_zones(model, watchers.skin),
            crushed=bool(watchers.guard.reason),
        ),
        heat=watchers.heat,
        strain=gauge,
    )


def _base(case: Case, model: Model, state: State) -> tuple[float, float]:
    """Return the velocity of a free barrier's mass centre along n and t, m/s; 0 for any other barrier."""
    whole, block = case.scene.barrier.mass, model.layout.barrier_slice
    if whole is None:
        return 0.0, 0.0
    momentum = (model.mass[block] * state.v[block]).reshape(-1, 3).sum(axis=0)
    momentum += model.mass[model.layout.foundation] * state.v[model.layout.foundation]
    return 2 * float(momentum[2]) / whole, 2 * float(momentum[0]) / whole


def _turned(case: Case, model: Model, state: State) -> BarrierTurn:
    """Return how a free barrier turns at ``state``; block and foundation have its angular momentum."""
    start, whole, inertia = model.start, case.scene.barrier.mass or 1.0, case.scene.barrier.inertia or 1.0
    block = np.arange(model.layout.barrier_slice.start, model.layout.barrier_slice.stop).reshape(-1, 3)
    rod = model.layout.rod[~model.geometry.rod.mesh.is_hanging]

    def centre(x: Array) -> Array:
        moment = model.mass[model.layout.foundation[0]] * model.ground.place(x)
        return np.asarray(2 * (model.mass[block[:, 0]] @ x[block][:, [0, 2]] + moment) / whole)

    def apart(x: Array) -> tuple[float, float]:
        away = mass_centre(model.mass, x, rod)[[0, 2]] - centre(x)
        return float(away[1]), float(away[0])

    middle = centre(state.x)
    nodes = [(model.mass[block[:, 0]], state.x[block] - [middle[0], 0.0, middle[1]], state.v[block])]
    t, n = model.ground.place(state.x) - middle
    at, v = np.array([[t, 0.0, n]]), state.v[model.layout.foundation][None]
    nodes.append((model.mass[model.layout.foundation[:1]], at, v))
    spun = sum(float(m @ (r[:, 2] * v[:, 0] - r[:, 0] * v[:, 2])) for m, r, v in nodes)
    spun += float(model.mass[model.layout.turn[0]]) * model.ground.spin(state.v)
    return BarrierTurn(2 * spun / inertia, apart(start[0]), apart(state.x))


def _peak_memory() -> float:
    """Return the process's largest resident memory so far, MB."""
    try:  # on Linux getrusage also counts the process that started this one
        status = Path("/proc/self/status").read_text()
        return float(status.partition("VmHWM:")[2].split()[0]) * 1024 / 1e6
    except (OSError, IndexError):
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return peak / 1e6 if sys.platform == "darwin" else peak * 1024 / 1e6
