"""What leaving vibration out changes: one pair of twins, by the reduced model or by finite elements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import TYPE_CHECKING, Literal

from fem_impact.cost.lanes import side_by_side
from fem_impact.cost.limits import pair_limit
from fem_impact.cost.settings import FAMILY, Mesh, on_mesh
from fem_impact.effects.slots import bodies_of
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.plan.cells import ERROR, expected_cells, kind
from fem_impact.plan.plan import plan
from fem_impact.run.simulate import simulate
from fem_impact.verdict.reliability import known_error
from fem_impact.verdict.twins import twins

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


Answer = Literal["yes", "no", "undecided"]
Pair = tuple[Outcome, Outcome]
"""With vibration and without it, on the same mesh."""


@dataclass(frozen=True, slots=True)
class Change:
    """The change of e by vibration at one inclination.

    Attributes
    ----------
    angle : rad
    value : e with vibration less e of the twin that cannot vibrate
    band : half-width that should hold the error of ``value``
    E_vib, E_vib_band : energy of vibration over E_0, and its half-width
    free, stiff : the outcomes, of the finest mesh where there are several
    source : where value and band come from, as a sentence
    """

    angle: float
    value: float
    band: float
    E_vib: float
    E_vib_band: float
    free: Outcome
    stiff: Outcome
    source: str

    def answer(self, tolerance: float) -> Answer:
        """Say whether rigid theory may be used if e may be off by ``tolerance``."""
        if abs(self.value) - self.band > tolerance:
            return "no"
        return "yes" if abs(self.value) + self.band <= tolerance else "undecided"


def unfinished(pair: Pair) -> str:
    """Return why a pair of twins says nothing, empty where it does."""
    for run, which in zip(pair, ("with", "without"), strict=True):
        if not run.validity.finished or or_none(run.restitution.edge.e) is None:
            return f"the run {which} vibration gives no e: {run.validity.stopped_because}"
    return ""


def modal_pair(scene: Scene) -> Pair:
    """Return the twins of a scene by the reduced model."""
    free, stiff = twins(_meshless(scene))
    return simulate(free, "modal"), simulate(stiff, "modal")


def modal_change(scene: Scene, pair: Pair) -> Change:
    """Return what the reduced model says, with its known error."""
    error = known_error(_meshless(scene))
    return Change(
        scene.impact.angle,
        _difference(pair),
        error.change_of_e,
        known(pair[0].energy.vibration),
        error.E_vib,
        *pair,
        error.sentence,
    )


@dataclass(slots=True)
class Ladder:
    """Twins on finite-element meshes of a scene, from coarse to fine.

    Attributes
    ----------
    scene : Scene
    budget_s : wall time, s, that all meshes together may take
    workers : runs at a time, 1 or 2
    meshes, pairs : what has run so far
    spent_s : wall time of that, s
    """

    scene: Scene
    budget_s: float
    workers: int
    meshes: list[Mesh]
    pairs: list[Pair]
    spent_s: float = 0.0

    @classmethod
    def of(cls, scene: Scene, budget_s: float, workers: int) -> Ladder:
        """Return a ladder on which nothing has run."""
        return cls(_meshless(scene), budget_s, workers, [], [])

    def next_s(self) -> float:
        """Return the wall time, s, that the next mesh is expected to take, scaled by what the last took."""
        expected = self._expected(FAMILY[len(self.meshes)])
        return expected * self.spent_s / sum(map(self._expected, self.meshes)) if self.meshes else expected

    def climb(self) -> bool:
        """Run the next mesh if there is one and it fits the budget; say whether it ran."""
        if len(self.meshes) == len(FAMILY) or self.spent_s + self.next_s() > self.budget_s:
            return False
        mesh, begun = FAMILY[len(self.meshes)], perf_counter()
        scenes = [on_mesh(one, mesh) for one in twins(self.scene)]
        runs, _ = side_by_side(scenes, "solid", [RunOptions()] * 2, self.workers)
        self.meshes.append(mesh)
        self.pairs.append((runs[0], runs[1]))
        self.spent_s += perf_counter() - begun
        return True

    def change(self) -> Change:
        """Return what the meshes say: limit and band of two, or one with its known error."""
        fine, coarse = self.pairs[-1], self.pairs[0]
        value, E_vib, angle = _difference(fine), known(fine[0].energy.vibration), self.scene.impact.angle
        if len(self.pairs) == 1:
            share = self._error_of_one()
            e = max(abs(known(run.restitution.edge.e)) for run in fine)
            told = f"Finite elements on one mesh ({_edge(fine)}), which gives e within {100 * share:.2g} %."
            return Change(angle, value, share * e, E_vib, share * E_vib, *fine, told)
        ratio = known(coarse[0].cost.tip_size) / known(fine[0].cost.tip_size)
        value, band = pair_limit(value, _difference(coarse), ratio)
        E_vib, of_vibration = pair_limit(E_vib, known(coarse[0].energy.vibration), ratio)
        told = (
            f"Finite elements on meshes of {_edge(coarse)} and {_edge(fine)} at the tip; the band holds the "
            "limits of all orders of convergence from 3/4 up."
        )
        return Change(angle, value, band, E_vib, of_vibration, *fine, told)

    def _expected(self, mesh: Mesh) -> float:
        each = [plan(on_mesh(one, mesh)).size.time for one in twins(self.scene)]
        return max(each) if self.workers > 1 else sum(each)

    def _error_of_one(self) -> float:
        """Return the relative error of e that so many cells over the contact leave."""
        bodies = bodies_of(on_mesh(twins(self.scene)[0], self.meshes[0]))
        return ERROR[kind(bodies)] / expected_cells(bodies)


def largest(changes: Sequence[Change]) -> Change:
    """Return the largest change of e of several inclinations."""
    return max(changes, key=lambda change: abs(change.value))


def _difference(pair: Pair) -> float:
    return known(pair[0].restitution.edge.e) - known(pair[1].restitution.edge.e)


def _edge(pair: Pair) -> str:
    return f"{known(pair[0].cost.tip_size) * 1e3:.3g} mm"


def _meshless(scene: Scene) -> Scene:
    """Return the scene without the error that it asks for: the verdict chooses fidelity and meshes itself."""
    return replace(scene, accuracy=replace(scene.accuracy, target=None))
