"""What leaving vibration out changes: one pair of twins, by the reduced model or by finite elements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING, Literal

from fem_impact.answers.refine.budget import Budget
from fem_impact.answers.refine.extrapolate import ONE_RUN, pair_limit, vibration_floor
from fem_impact.answers.refine.levels import FAMILY, RUNGS, Mesh, can_be_made, on_mesh
from fem_impact.answers.verdict.reliability import known_error
from fem_impact.answers.verdict.twins import twins
from fem_impact.case.case import Case
from fem_impact.case.cells import ERROR, contact_edge, expected_cells, kind
from fem_impact.case.plates import half_space_error, is_thin
from fem_impact.errors import SceneError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import known, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import SHARES
from fem_impact.run.simulate import simulate

if TYPE_CHECKING:
    from fem_impact.case.bodies import Bodies
    from fem_impact.outcome.groups import Energy
    from fem_impact.scene.types import Scene


REDUCED, ONE_MESH, MESHES = "the reduced model", "one mesh of finite elements", "meshes of finite elements"
"""What a change of e rests on."""

OWN_CELLS = (
    " All meshes have the cells of your file behind the contact, whose error they do not show: the {:.2g} by "
    "which such a mesh was off on the measured sets is added. A file of smaller cells shows it."
)

COUNTS = (
    " The band of the vibration energy is at least {:.2g} % of E_0, by which its two independent counts (by "
    "modes and without them) or the energy balance of the finer mesh are off."
)

THIN_PLATE = (
    " The plate is thin beside the contact, and a half-space under it in this model: the {:.2g} by which e "
    "may be off is added."
)

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
    band : half-width that should hold the error of ``value``; inf where nothing is known of that error
    E_vib, E_vib_band : energy of vibration over E_0, and its half-width
    free, stiff : the outcomes, of the finest mesh where there are several
    source : where value and band come from, as a sentence
    models : what ``value`` and ``band`` rest on
    model : what ``free``, ``stiff`` and the shares of the energy rest on
    error : what the half-widths of the shares are
    errors : half-widths of shares of E_0, by their names in an outcome's energy, as far as they are known
    """

    angle: float
    value: float
    band: float
    E_vib: float
    E_vib_band: float
    free: Outcome
    stiff: Outcome
    source: str
    models: str
    model: str
    error: str
    errors: Mapping[str, float]

    def widened(self, other: Change) -> Change:
        """Return the change with bands of e and E_vib that hold those of another one, too."""
        low = min(self.value - self.band, other.value - other.band)
        high = max(self.value + self.band, other.value + other.band)
        apart = abs(self.E_vib - other.E_vib) + other.E_vib_band
        return replace(
            self,
            value=0.5 * (low + high),
            band=0.5 * (high - low),
            E_vib_band=max(self.E_vib_band, apart),
            models=f"{self.model} and {other.model} together",
            error=f"{self.model}, and {other.model} within",
        )

    def at_least(self, off: float) -> Change:
        """Return the change with a band no smaller than ``off``, an error that finite elements showed."""
        if off <= self.band:
            return self
        told = f"At the scene's own inclination it is off by {off:.2g}: so much counts at all others."
        return replace(self, band=off, source=f"{self.source} {told}")

    @property
    def told(self) -> str:
        """Value and band as text."""
        return (
            f"{self.value:+.3f} ± {self.band:.3f}" if self.band < inf else f"{self.value:+.3f}, error unknown"
        )

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
    error, bodies = known_error(_meshless(scene)), Case(scene).bodies
    thin = half_space_error(bodies) * abs(known(pair[0].restitution.edge.e)) if is_thin(bodies) else 0.0
    return Change(
        scene.impact.angle,
        _difference(pair),
        error.change_of_e + thin,
        known(pair[0].energy.vibration),
        error.shares["vibration"],
        *pair,
        error.sentence + THIN_PLATE.format(thin) * bool(thin),
        REDUCED,
        REDUCED,
        f"known error of {REDUCED}",
        error.shares,
    )


@dataclass(slots=True)
class Ladder:
    """Twins on finite-element meshes of a scene, from coarse to fine.

    They are those of `RUNGS` that can be made.

    Attributes
    ----------
    scene : Scene
    budget : of all meshes together
    meshes, pairs : what has run so far
    """

    scene: Scene
    budget: Budget
    meshes: list[Mesh]
    pairs: list[Pair]

    @classmethod
    def of(cls, scene: Scene, budget_s: float, workers: int) -> Ladder:
        """Return a ladder on which nothing has run."""
        return cls(_meshless(scene), Budget(budget_s, workers), [], [])

    def refused(self) -> SceneError | None:
        """Return why no mesh of the scene can be made, None where one can."""
        if self.following() is None:
            try:
                self.expected_s(FAMILY[-1])
            except SceneError as error:
                return error
        return None

    def following(self) -> Mesh | None:
        """Return the mesh to run next, None where no finer one can be made."""
        edge = min(map(self._edge, self.meshes), default=inf)
        return next((mesh for mesh in RUNGS if self._edge(mesh) < edge and self._made(mesh)), None)

    def expected_s(self, mesh: Mesh) -> float:
        """Return the wall time, s, that a mesh is expected to take, by what the last one took."""
        return self.budget.forecast_s(self._scenes(mesh))

    def affords(self, mesh: Mesh) -> bool:
        """Say whether a mesh fits into what is left of the budget."""
        return self.budget.affords(self._scenes(mesh))

    def climb(self, mesh: Mesh) -> str:
        """Run the twins on a mesh; return why they give no answer, and forget it then, else an empty string.

        Raises
        ------
        SceneError
            The mesh cannot be made.
        """
        runs = self.budget.run(self._scenes(mesh), [RunOptions()] * 2)
        pair = runs[0], runs[1]
        failed = unfinished(pair)
        if not failed:
            self.meshes.append(mesh)
            self.pairs.append(pair)
        return failed

    def change(self) -> Change:
        """Return what the meshes say: limit and band of two, or one with its known error."""
        return self._of_one() if len(self.pairs) == 1 else self._of_two()

    def _of_one(self) -> Change:
        pair, (share, error) = self.pairs[0], self._error(0)
        E_vib = known(pair[0].energy.vibration)
        size = f"{self._size(0)} at the contact"
        told = f"Finite elements on one mesh ({size}), which gives e within {100 * share:.2g} %."
        return Change(
            self.scene.impact.angle,
            _difference(pair),
            error,
            E_vib,
            max(share * E_vib, vibration_floor(pair[0])),
            *pair,
            told,
            ONE_MESH,
            ONE_MESH,
            f"known error of {ONE_MESH}",
            {},
        )

    def doubted(self) -> Change:
        """Return what one mesh says that nothing bears out: its error is not known."""
        told = f"Finite elements on one mesh ({self._size(0)} at the contact), whose error is not known."
        error = f"of {ONE_MESH} unknown"
        return replace(self._of_one(), band=inf, E_vib_band=inf, source=told, error=error)

    def _of_two(self) -> Change:
        coarse, fine = self.pairs[0], self.pairs[-1]
        ratio = self._edge(self.meshes[0]) / self._edge(self.meshes[-1])
        value, band = pair_limit(_difference(fine), _difference(coarse), ratio)
        E_vib, of_vibration = pair_limit(
            known(fine[0].energy.vibration), known(coarse[0].energy.vibration), ratio
        )
        floor = vibration_floor(fine[0])
        of_vibration = max(of_vibration, floor)
        told = f"Finite elements on meshes of {self._size(0)} and {self._size(-1)} at the contact; "
        apart, expected = abs(_difference(fine) - _difference(coarse)), self._error(0)[1] + self._error(-1)[1]
        if apart > expected:
            low, high = min(value - band, _difference(coarse)), max(value + band, _difference(coarse))
            value, band = 0.5 * (low + high), 0.5 * (high - low)
            told += (
                f"the change of e differs by {apart:.2g} between them, more than the {expected:.2g} that "
                "such meshes were off by on the measured sets: the band holds both, and all limits."
            )
        else:
            told += (
                f"the band is {ONE_RUN:g} times the range of the limits of all orders of convergence from "
                "3/4 up, as each mesh runs once."
            )
        told += COUNTS.format(100 * floor)
        if self.scene.projectile.own_mesh:
            share, error = self._error(-1)
            band, of_vibration = band + error, of_vibration + share * E_vib
            told += OWN_CELLS.format(error)
        bands = _bands(coarse[0].energy, fine[0].energy, ratio)
        return Change(
            self.scene.impact.angle,
            value,
            band,
            E_vib,
            of_vibration,
            *fine,
            told,
            MESHES,
            MESHES,
            f"band of the {MESHES}",
            {**bands, "vibration": max(bands["vibration"], floor)},
        )

    def _scenes(self, mesh: Mesh) -> list[Scene]:
        return [on_mesh(one, mesh) for one in twins(self.scene)]

    def _made(self, mesh: Mesh) -> bool:
        return all(map(can_be_made, self._scenes(mesh)))

    def _edge(self, mesh: Mesh) -> float:
        """Return the size, m, of the cells that resolve the contact."""
        return contact_edge(self._bodies(mesh))

    def _size(self, which: int) -> str:
        return f"{self._edge(self.meshes[which]) * 1e3:.3g} mm"

    def _error(self, which: int) -> tuple[float, float]:
        """Return the error of e on a mesh that ran, by its cells over the contact: relative, absolute."""
        bodies = self._bodies(self.meshes[which])
        share = ERROR[kind(bodies)] / expected_cells(bodies)
        return share, share * max(abs(known(run.restitution.edge.e)) for run in self.pairs[which])

    def _bodies(self, mesh: Mesh) -> Bodies:
        return Case(on_mesh(twins(self.scene)[0], mesh)).bodies


def largest(changes: Sequence[Change]) -> Change:
    """Return the largest change of e of several inclinations."""
    return max(changes, key=lambda change: abs(change.value))


def _bands(coarse: Energy, fine: Energy, ratio: float) -> dict[str, float]:
    """Return how far the limits of two meshes may lie from the shares of the finer one."""
    names = [*(share.key.path[-1] for share in SHARES), "skin"]
    pairs = {name: (or_none(getattr(fine, name)), or_none(getattr(coarse, name))) for name in names}
    limits = {
        name: (a, *pair_limit(a, b, ratio))
        for name, (a, b) in pairs.items()
        if a is not None and b is not None
    }
    return {name: abs(limit - share) + half for name, (share, limit, half) in limits.items()}


def _difference(pair: Pair) -> float:
    return known(pair[0].restitution.edge.e) - known(pair[1].restitution.edge.e)


def _meshless(scene: Scene) -> Scene:
    """Return the scene without the error that it asks for: the verdict chooses fidelity and meshes itself."""
    return replace(scene, accuracy=replace(scene.accuracy, target=None))
