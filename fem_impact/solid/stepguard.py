"""The stable step of a yielding zone in its deformed shape, from the forces of its kernel."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from scipy.sparse.linalg import LinearOperator

from fem_impact.arrays import Array, Ints
from fem_impact.errors import RunError
from fem_impact.fem.stable import gradient_squares, stable_step
from fem_impact.solid.model import Model
from fem_impact.solid.state import State

if TYPE_CHECKING:
    from fem_impact.solid.yielding import YieldingZone


TINY = 1e-6  # displacement of the stiffness' difference quotient, over the height of the thinnest cell


def zone_step(zone: YieldingZone, model: Model, x: Array) -> float:
    """Return the largest stable step, s, of a model's zone at ``x`` (size,), where no cell is folded.

    Notes
    -----
    Lanczos over the assembly sees what a bound of single elements does not: their neighbours, and masses
    that were raised. Steel that flows is softer, so nothing flows here; stresses are those of now. The
    cells that yield set the step: of plates and tips dragged, squeezed and crushed, the whole body's fell as
    that of its zone within 2 %. Hanging nodes are held.
    """
    # a copy that may be advanced without changing the zone, and that stays elastic
    old = zone.blocks
    own = {name: np.empty_like(getattr(old, name)) for name in ("stress", "pressure", "nodal")}
    blocks = old._replace(flow=np.full_like(old.flow, np.inf), **own)
    trial, places = replace(zone, blocks=blocks, room=np.empty_like(zone.room)), zone.places()
    moves, still = np.zeros(len(x), dtype=bool), np.zeros_like(x)
    moves[places] = True
    used = np.flatnonzero(moves & (model.inverse_mass > 0))
    reach = TINY / np.sqrt(gradient_squares(x, places).max())

    def force(motion: Array, share: float) -> Array:
        state = State(x + share * motion, motion, np.zeros_like(x), dt=share)
        trial.blocks.stress[:] = old.stress
        trial.add(state)
        return state.force[used]

    rest = force(still, 0.0)

    def product(u: Array) -> Array:
        motion = still.copy()
        motion[used] = u.ravel()
        share = reach / np.abs(motion).max()
        return np.asarray((rest - force(motion, share)) / share)

    K = LinearOperator((len(used),) * 2, matvec=product, dtype=np.float64)
    return stable_step(K, model.inverse_mass[used], share=1.0)


SMALLEST = 0.02  # of the first step: below it the elements are crushed beyond use
RENEW = 0.95  # of a zone's last computed step: below it, by the elements' bound, it is computed anew
# the same of a level with thin cells, which runs again without them: an edge may squeeze single ones until
# the step of the whole run follows these. Levels of the measured sets that slide, t5d and t6-60, keep 0.77
THIN_CRUSHED = 0.2
REMEDY = "Use a coarser accuracy.tip_size or a lower speed."


@dataclass(slots=True)
class StepGuard:
    """Sets the next step from the present shape of the yielding elements.

    The stable step of a zone is found by Lanczos (`zone_step`) where its elements have changed; until then it
    falls as if the whole zone were squeezed like the element squeezed most since. That bound alone gave
    2.5 ns where 12.3 are stable (t5b, 6 m/s down and 12 along, 0.59 mm), for thin rows that shear to ten
    times their height have heavy nodes and neighbours that hold them.

    Attributes
    ----------
    crushed : of the first step, below which a run ends
    first : (zones,) their stable steps at the start, s
    places : (m, 8, 3) unknowns of the yielding elements; starts : (zones,) where each zone's begin
    steps : (zones,) last steps found, with the body's safety factor, s; square : (m,) the elements' gradient
        numbers then
    allowed : the stable step at the last look, with that factor; smallest : smallest step so far, s
    """

    moving: ClassVar[tuple[str, ...]] = ("steps", "square", "allowed", "smallest")
    model: Model
    every: int = 50
    crushed: float = SMALLEST
    first: Array = field(init=False)
    places: Ints = field(init=False)
    starts: Ints = field(init=False)
    steps: Array = field(init=False)
    square: Array = field(init=False)
    allowed: float = field(init=False)
    smallest: float = field(init=False)
    reason: str = ""

    def __post_init__(self) -> None:
        zones, x = self.model.zones, self.model.start[0]
        self.places = np.concatenate([np.zeros((0, 8, 3), dtype=np.int64), *(z.places() for z in zones)])
        self.starts = np.cumsum([0, *(z.count for z in zones)])[:-1]
        self.square = gradient_squares(x, self.places)
        self.first = np.array([zone_step(zone, self.model, x) for zone in zones])
        self.steps = np.array([self.model.steps[zone.body] for zone in zones])
        self.allowed = self.smallest = self.model.step

    def observe(self, state: State) -> bool:
        """Set the step; stop at a folded or crushed element."""
        if not np.isfinite(state.v @ state.v):
            layout = self.model.layout
            nodes = np.concatenate([layout.rod, layout.barrier])
            first = int(np.argmax(~np.isfinite(state.v[nodes]).all(axis=1)))
            place = when_and_where(state, self.model.start[0][nodes[first]])
            not_finite = f"The motion is not finite {place} What was computed before is kept. {REMEDY}"
            raise RunError(not_finite)
        if not len(self.places):
            return False
        now = gradient_squares(state.x, self.places)
        folded = ~np.isfinite(now)
        if folded.any():
            self.reason = f"An element folded {self._where(state, int(np.argmax(folded)))} {REMEDY}"
            return True
        before, self.allowed = self.allowed, min(self.model.step, self._find(state.x, now))
        # as if it fell on until the next look as since the last, by up to 7 % in fast drops: then no step of
        # nine drops was over .94 of the limit at the end of its look (1.04 without, at 100 steps a look)
        state.dt_next = self.allowed * min(1.0, self.allowed / before)
        self.smallest = min(self.smallest, state.dt_next)
        if self.allowed < self.crushed * self.model.step:
            place = self._where(state, int(np.argmax(now)))
            self.reason = f"An element was crushed to under {self.crushed:g} of its step {place} {REMEDY}"
        return bool(self.reason)

    def _find(self, x: Array, now: Array) -> float:
        """Return the stable step, s, where the elements' gradient numbers are ``now``."""
        # lower bound: as if all elements of the zone had deformed like the worst one
        steps = self.steps * np.minimum.reduceat(np.sqrt(self.square / now), self.starts)
        due = steps < RENEW * np.minimum(self.steps, self.model.step)
        for i, zone in enumerate(self.model.zones):
            if due[i]:
                ratio = zone_step(zone, self.model, x) / self.first[i]
                self.steps[i] = steps[i] = self.model.steps[zone.body] * ratio
                own = slice(self.starts[i], self.starts[i] + zone.count)
                self.square[own] = now[own]
        return float(steps.min())

    def _where(self, state: State, element: int) -> str:
        return when_and_where(state, state.x[self.places[element]].mean(axis=0))


def when_and_where(state: State, place: Array) -> str:
    """Return a phrase that gives the present time, step and a point (t, b, n), m."""
    t, b, n = place * 1e3
    return f"at {state.time * 1e6:.2f} us, step {state.step}, near t, b, n = {t:.2f}, {b:.2f}, {n:.2f} mm."
