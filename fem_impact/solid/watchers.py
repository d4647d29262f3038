"""The observers of one run, their output files, and its stopwatch."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.cells import body_cell
from fem_impact.case.size import FRAMES_SPAN
from fem_impact.fem.geometry import tail_corners
from fem_impact.fem.kernels import COMPILING
from fem_impact.files.fields_write import FieldWriter
from fem_impact.physics.contact_law import MERGE_GAP, MERGED
from fem_impact.scene.impact import FIRST
from fem_impact.solid.checkpoint import Moving
from fem_impact.solid.contact.surface import SurfaceContact
from fem_impact.solid.contact_watch import ContactWatch, nodes_of
from fem_impact.solid.fine_zone import SkinWatch
from fem_impact.solid.march import Observer
from fem_impact.solid.model import Model
from fem_impact.solid.observers import (
    FORCE_WINDOW,
    OF_CONTACT,
    AddedMass,
    Frames,
    History,
    PeakForce,
    Watch,
    history_column,
)
from fem_impact.solid.rodview import FieldSampler, RodState
from fem_impact.solid.separation import Separation
from fem_impact.solid.state import State
from fem_impact.solid.stepguard import SMALLEST, THIN_CRUSHED, StepGuard
from fem_impact.solid.strain import StrainWatch
from fem_impact.tables.history import HISTORY, HistoryWriter

if TYPE_CHECKING:
    from fem_impact.case.case import Case
    from fem_impact.solid.heatwatch import HeatWatch


TRANSITS, EARLY = 2.0, 0.4  # lengths run by a stretching wave, in which this share of the frames is written


class Saved(Observer, Moving, Protocol):
    """An observer whose moving part a checkpoint keeps."""


def _wall() -> float:
    return time.perf_counter() - COMPILING.wall


def _cpu() -> float:
    return time.process_time() - COMPILING.cpu


@dataclass(slots=True)
class Stopwatch:
    """Wall and processor time of a part of a run, s, without compilation; a checkpoint's times are added."""

    moving: ClassVar[tuple[str, ...]] = ("wall", "cpu")
    begun_wall: float = field(default_factory=_wall)
    begun_cpu: float = field(default_factory=_cpu)

    @property
    def wall(self) -> float:
        """Time on the clock so far."""
        return _wall() - self.begun_wall

    @wall.setter
    def wall(self, before: float) -> None:
        self.begun_wall -= float(before)

    @property
    def cpu(self) -> float:
        """Processor time so far."""
        return _cpu() - self.begun_cpu

    @cpu.setter
    def cpu(self, before: float) -> None:
        self.begun_cpu -= float(before)

    def read(self) -> tuple[float, float]:
        """Return wall and processor time so far."""
        return self.wall, self.cpu


@dataclass(frozen=True, slots=True)
class Watchers:
    """All observers of a run whose state its checkpoints store."""

    guard: StepGuard
    watch: Watch
    history: list[History]
    frames: list[Frames]
    strain: list[StrainWatch]
    skin: SkinWatch
    contact: ContactWatch
    peak: PeakForce
    added: AddedMass
    heat: HeatWatch | None
    stop: Separation

    @classmethod
    def of(cls, case: Case, model: Model, view: RodState, out: Path | None, go_on: bool) -> Watchers:
        """Make the observers; with ``go_on`` they append to the files of the run that is resumed."""
        scene = case.scene
        watch = Watch(model.ledger(), scene.save.history_every)
        history, frames, strain = [], [], []
        if out is not None:
            others = [c for c in map(history_column, watch.ledger.names) if c not in HISTORY]
            writer = HistoryWriter(out / "history.csv", (*HISTORY, *others), go_on=go_on)
            history = [History(model, view, watch, writer, scene.save.history_every)]
            if scene.save.frames:
                fields = FieldSampler.of(model, view, case.bodies)
                body = {"body": fields.body}
                to = FieldWriter(out / "fields.vtkhdf", fields.points, fields.cells, body, go_on)
                frames = [Frames(fields, to, *_schedule(case))]
        sliced = model.rod_stiffness is not None and model.layout.body_shape[1] > 2
        kept = out is not None and scene.save.strain_samples > 0
        if sliced and (kept or scene.save.gauge is not None):
            strain = [StrainWatch.of(case, model, out / "waves.h5" if out and kept else None)]
        model.book.gap = min(MERGE_GAP, MERGED * case.one_impact)
        skin = SkinWatch(model, case.slots.bending is not None)
        short = OF_CONTACT * case.estimate.duration
        peak = PeakForce(model.book, min(FORCE_WINDOW, short))
        added = AddedMass(model.added_mass)
        heat = None
        if case.slots.heat:
            from fem_impact.solid.heatwatch import HEAT_WINDOW, HeatWatch

            heat = HeatWatch(model, window=min(HEAT_WINDOW, short))
        # a flat end that lands flat leaves when the wave is back from the other end, and no contact before
        moves = scene.barrier.mass is not None or scene.barrier.bends
        contact = ContactWatch(model, case.bodies.stretching_period, moves)
        stop = Separation(model, view, case.max_time, case.one_impact)
        if isinstance(model.contact, SurfaceContact) or model.rod_stiffness is None:
            stop.tail = _far_tail(case, model)
        if len(stop.tail) < 2 and scene.impact.until == FIRST:  # it may touch; a followed body goes on
            z, middle = model.geometry.rod.mesh.points[:, 2], 0.5 * case.bodies.body.length
            other = (z > middle) != (case.bodies.lowest_point[2] > middle)
            stop.behind = other[nodes_of(model.layout.rod, view.rim)]
            stop.touched = lambda: bool(other[contact.rod[contact.last >= 0.0]].any())
        # a level is run again without thin cells, a strike of a body that is followed is not
        again = case.record is not None and not case.record.crushed and scene.impact.until == FIRST
        rows = case.zones.skin_rows + case.zones.rod_rows
        guard = StepGuard(model, crushed=THIN_CRUSHED if again and rows else SMALLEST)
        return cls(guard, watch, history, frames, strain, skin, contact, peak, added, heat, stop)

    @property
    def all(self) -> list[Saved]:
        """Observers in calling order, step guard to stop rule."""
        heat = [self.heat] if self.heat else []
        first: list[Saved] = [self.guard, self.watch, *self.history, *self.frames, *self.strain]
        return [*first, self.skin, self.contact, self.peak, self.added, *heat, self.stop]

    @property
    def reason(self) -> str:
        """Return why the run ended."""
        return self.guard.reason or self.watch.reason or self.skin.reason or self.stop.reason

    def flush(self) -> None:
        """Write the rows of the history and the samples of the strain that wait."""
        for h in self.history:
            h.writer.flush()
        for s in self.strain:
            s.write()

    def holders(self, model: Model, state: State, clock: Stopwatch) -> dict[str, Moving]:
        """Return all objects with state, by names that depend on the scene only."""
        parts: list[Moving] = [state, clock, *model.forces, *model.impulses, *self.all]
        return {f"{i}-{type(part).__name__}": part for i, part in enumerate(parts)}


def _far_tail(case: Case, model: Model) -> Array:
    """Return the corners (k, 3), m, of the rod's tail at the start that no skin of the contact reaches."""
    tail, contact = tail_corners(case.bodies), model.contact
    if not isinstance(contact, SurfaceContact):
        return tail
    touching = model.start[0][contact.rod.places]
    gap = np.linalg.norm(tail[:, None] - touching[None], axis=2).min(axis=1)
    return np.asarray(tail[gap > body_cell(case.bodies)])


def _schedule(case: Case) -> tuple[float, float, float]:
    """Return the intervals, s, between early and later frames, and the time, s, that parts them.

    A stretching wave runs along the rod and back in the first part.
    """
    frames, contact = case.scene.save.frames, float(case.estimate.duration)
    early = TRANSITS / 2 * case.bodies.stretching_period
    later = FRAMES_SPAN * contact - early
    if later * EARLY < early * (1 - EARLY):
        return (early + max(later, 0.0)) / frames, np.inf, np.inf
    return early / (EARLY * frames), later / ((1 - EARLY) * frames), early
