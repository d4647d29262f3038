"""What leaving vibration out changes: one pair of twins, by the reduced model or by finite elements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING, Literal

from fem_impact.answers.refine.extrapolate import (
    ONE_RUN,
    VIBRATION,
    MeshRuns,
    extrapolated,
    floored,
    limit_of,
    vibration_floor,
)
from fem_impact.answers.verdict.reliability import known_error
from fem_impact.answers.verdict.twins import twins
from fem_impact.case.case import Case
from fem_impact.case.cells import ERROR, expected_cells, kind
from fem_impact.case.plates import half_space_error, is_thin
from fem_impact.outcome.keys import known, or_none
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.outcome.shares import SHARES
from fem_impact.run.simulate import simulate

if TYPE_CHECKING:
    from fem_impact.answers.refine.loop import Level
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
class VibrationEffect:
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

    def widened(self, other: VibrationEffect) -> VibrationEffect:
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

    def at_least(self, off: float) -> VibrationEffect:
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

    def meets(self, other: VibrationEffect) -> bool:
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
    free, stiff = twins(untargeted(scene))
    return simulate(free, "modal"), simulate(stiff, "modal")


def modal_effect(scene: Scene, pair: Pair) -> VibrationEffect:
    """Return what the reduced model says, with its known error."""
    error, bodies = known_error(untargeted(scene)), Case(scene).bodies
    thin = half_space_error(bodies) * abs(known(pair[0].restitution.edge.e)) if is_thin(bodies) else 0.0
    return VibrationEffect(
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


def solid_effect(levels: Sequence[Level], done: Sequence[MeshRuns]) -> VibrationEffect:
    """Return what finite elements say: the limit of the finest two meshes, or one with its known error.

    Parameters
    ----------
    levels : the levels of a scene and its twin
    done : the runs on the first of them, each with vibration and without it
    """
    pair = list(zip(levels, done, strict=False))[-2:]
    return _of_two(*pair) if len(pair) == 2 else _of_one(*pair[0])


def unsupported(effect: VibrationEffect, level: Level) -> VibrationEffect:
    """Return what one mesh says that nothing bears out: its error is not known."""
    source = f"Finite elements on one mesh ({_size(level)} at the contact), whose error is not known."
    return replace(effect, band=inf, E_vib_band=inf, source=source, error=f"of {ONE_MESH} unknown")


def _of_one(level: Level, mesh: MeshRuns) -> VibrationEffect:
    (free, stiff), (share, error) = mesh.runs, _known_error(level, mesh)
    E_vib = known(free.energy.vibration)
    return VibrationEffect(
        level.scenes[0].impact.angle,
        _difference(mesh.runs),
        error,
        E_vib,
        floored(share * E_vib, [free]),
        free,
        stiff,
        f"Finite elements on one mesh ({_size(level)} at the contact), which gives e within "
        f"{100 * share:.2g} %.",
        ONE_MESH,
        ONE_MESH,
        f"known error of {ONE_MESH}",
        {},
    )


def _of_two(coarser: tuple[Level, MeshRuns], finer: tuple[Level, MeshRuns]) -> VibrationEffect:
    """Return the limits of two meshes; the band of the change of e holds both where they disagree.

    They disagree where they differ by more than meshes of such cells were off by on the measured sets.
    """
    (_, coarse), (level, fine) = coarser, finer
    (free, stiff), scene = fine.runs, level.scenes[0]
    changes = [_difference(mesh.runs) for mesh in (coarse, fine)]
    limit = limit_of([coarse.size, fine.size], [[change] for change in changes])
    value, band = limit.value, limit.uncertainty
    source = f"Finite elements on meshes of {_size(coarser[0])} and {_size(level)} at the contact; "
    apart, expected = abs(changes[1] - changes[0]), _known_error(*coarser)[1] + _known_error(*finer)[1]
    if apart > expected:
        low, high = min(value - band, changes[0]), max(value + band, changes[0])
        value, band = 0.5 * (low + high), 0.5 * (high - low)
        source += (
            f"the change of e differs by {apart:.2g} between them, more than the {expected:.2g} that "
            "such meshes were off by on the measured sets: the band holds both, and all limits."
        )
    else:
        source += (
            f"the band is {ONE_RUN:g} times the range of the limits of all orders of convergence from "
            "3/4 up, as each mesh runs once."
        )
    source += COUNTS.format(100 * vibration_floor(free))
    with_vibration = [MeshRuns(mesh.size, mesh.runs[:1]) for mesh in (coarse, fine)]
    vibration = extrapolated(with_vibration, VIBRATION)
    assert vibration is not None  # this twin vibrates
    E_vib, E_vib_band = vibration.value, vibration.uncertainty
    if scene.projectile.own_mesh:
        share, error = _known_error(*finer)
        band, E_vib_band = band + error, E_vib_band + share * E_vib
        source += OWN_CELLS.format(error)
    return VibrationEffect(
        scene.impact.angle,
        value,
        band,
        E_vib,
        E_vib_band,
        free,
        stiff,
        source,
        MESHES,
        MESHES,
        f"band of the {MESHES}",
        _share_errors(with_vibration),
    )


def _share_errors(meshes: Sequence[MeshRuns]) -> dict[str, float]:
    """Return how far shares of E_0 on the finer of two meshes may be off, by name: to the end of a band."""
    errors = {}
    for key in (*(share.key for share in SHARES), KEY_TABLE["W_skin_over_E_0"]):
        limit = extrapolated(meshes, (key,))
        if limit is not None:
            share = known(key.of(meshes[-1].runs[0]))
            errors[key.path[-1]] = abs(limit.value - share) + limit.uncertainty
    return errors


def _known_error(level: Level, mesh: MeshRuns) -> tuple[float, float]:
    """Return the error of e on a mesh by its cells over the contact: relative, and of the twins' larger e."""
    bodies = Case(level.scenes[0]).bodies
    share = ERROR[kind(bodies)] / expected_cells(bodies)
    return share, share * max(abs(known(run.restitution.edge.e)) for run in mesh.runs)


def _size(level: Level) -> str:
    return f"{level.size * 1e3:.3g} mm"


def _difference(pair: Sequence[Outcome]) -> float:
    """Return e with vibration less e without it."""
    return known(pair[0].restitution.edge.e) - known(pair[1].restitution.edge.e)


def largest(effects: Sequence[VibrationEffect]) -> VibrationEffect:
    """Return the largest change of e of several inclinations."""
    return max(effects, key=lambda effect: abs(effect.value))


def untargeted(scene: Scene) -> Scene:
    """Return the scene without the error that it asks for: the verdict chooses fidelity and meshes itself."""
    return replace(scene, accuracy=replace(scene.accuracy, target=None))
