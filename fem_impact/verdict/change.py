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
from fem_impact.errors import SceneError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.plan.cells import ERROR, contact_edge, expected_cells, kind
from fem_impact.plan.plan import plan
from fem_impact.run.simulate import simulate
from fem_impact.verdict.reliability import known_error
from fem_impact.verdict.twins import twins

if TYPE_CHECKING:
    from fem_impact.physics.contact import ContactBodies
    from fem_impact.scene.types import Scene


FINE_TIP = Mesh(8, 0, 0)
"""Finer at the rod's tip only: enough where the rod's cells resolve the contact, and the cheapest."""
FINER = 0.9
"""A mesh counts as finer if the cells at its contact are below this share of those before."""

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

    def widened(self, other: Change) -> Change:
        """Return the change with a band that holds that of another one, too."""
        low = min(self.value - self.band, other.value - other.band)
        high = max(self.value + self.band, other.value + other.band)
        return replace(self, value=0.5 * (low + high), band=0.5 * (high - low))

    def meets(self, other: Change) -> bool:
        """Say whether both may be right: their bands have values in common."""
        return abs(self.value - other.value) <= self.band + other.band

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

    The first mesh is the coarsest of `FAMILY` that can be made; then follows, each time, the cheapest whose
    cells at the contact are finer than all before.

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

    def following(self) -> Mesh | None:
        """Return the mesh to run next, None where no finer one can be made."""
        if not self.meshes:
            return next((mesh for mesh in FAMILY if self._made(mesh)), None)
        edge = FINER * min(map(self._edge, self.meshes))
        finer = [mesh for mesh in (*FAMILY[1:], FINE_TIP) if self._made(mesh) and self._edge(mesh) < edge]
        return min(finer, key=self._expected, default=None)

    def expected_s(self, mesh: Mesh) -> float:
        """Return the wall time, s, that a mesh is expected to take, scaled by what the others took."""
        expected = self._expected(mesh)
        return expected * self.spent_s / sum(map(self._expected, self.meshes)) if self.meshes else expected

    def affords(self, mesh: Mesh) -> bool:
        """Say whether a mesh fits into what is left of the budget."""
        return self.spent_s + self.expected_s(mesh) <= self.budget_s

    def climb(self, mesh: Mesh) -> None:
        """Run the twins on a mesh."""
        begun = perf_counter()
        scenes = [on_mesh(one, mesh) for one in twins(self.scene)]
        runs, _ = side_by_side(scenes, "solid", [RunOptions()] * 2, self.workers)
        self.meshes.append(mesh)
        self.pairs.append((runs[0], runs[1]))
        self.spent_s += perf_counter() - begun

    def drop(self) -> None:
        """Forget the last mesh, which gave no answer; its time stays spent."""
        self.meshes.pop()
        self.pairs.pop()

    def change(self) -> Change:
        """Return what the meshes say: limit and band of two, or one with its known error."""
        return self._of_one() if len(self.pairs) == 1 else self._of_two()

    def _of_one(self) -> Change:
        pair, (share, error) = self.pairs[0], self._error(0)
        E_vib = known(pair[0].energy.vibration)
        told = f"Finite elements on one mesh ({_edge(pair)}), which gives e within {100 * share:.2g} %."
        return Change(self.scene.impact.angle, _difference(pair), error, E_vib, share * E_vib, *pair, told)

    def _of_two(self) -> Change:
        coarse, fine = self.pairs[0], self.pairs[-1]
        ratio = known(coarse[0].cost.tip_size) / known(fine[0].cost.tip_size)
        value, band = pair_limit(_difference(fine), _difference(coarse), ratio)
        E_vib, of_vibration = pair_limit(
            known(fine[0].energy.vibration), known(coarse[0].energy.vibration), ratio
        )
        told = f"Finite elements on meshes of {_edge(coarse)} and {_edge(fine)} at the tip; "
        apart, expected = abs(_difference(fine) - _difference(coarse)), self._error(0)[1] + self._error(-1)[1]
        if apart > expected:
            low, high = min(value - band, _difference(coarse)), max(value + band, _difference(coarse))
            value, band = 0.5 * (low + high), 0.5 * (high - low)
            told += (
                f"the change of e differs by {apart:.2g} between them, more than the {expected:.2g} that "
                "such meshes were off by on the measured sets: the band holds both, and all limits."
            )
        else:
            told += "the band holds the limits of all orders of convergence from 3/4 up."
        return Change(self.scene.impact.angle, value, band, E_vib, of_vibration, *fine, told)

    def _expected(self, mesh: Mesh) -> float:
        each = [plan(on_mesh(one, mesh)).size.time for one in twins(self.scene)]
        return max(each) if self.workers > 1 else sum(each)

    def _made(self, mesh: Mesh) -> bool:
        """Say whether the mesh can be made: the fine zone of a coarse tip may be missing."""
        try:
            self._expected(mesh)
        except SceneError:
            return False
        return True

    def _edge(self, mesh: Mesh) -> float:
        """Return the size, m, of the cells that resolve the contact."""
        return contact_edge(self._bodies(mesh))

    def _error(self, which: int) -> tuple[float, float]:
        """Return the error of e on a mesh that ran, by its cells over the contact: relative, absolute."""
        bodies = self._bodies(self.meshes[which])
        share = ERROR[kind(bodies)] / expected_cells(bodies)
        return share, share * max(abs(known(run.restitution.edge.e)) for run in self.pairs[which])

    def _bodies(self, mesh: Mesh) -> ContactBodies:
        return bodies_of(on_mesh(twins(self.scene)[0], mesh))


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
