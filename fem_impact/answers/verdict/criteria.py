"""What may be asked of a scene by a limit: rigid theory's error, heat, force and dent, by both models."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, pi

import numpy as np

from fem_impact.answers.refine.extrapolate import level_limit, level_limits
from fem_impact.answers.refine.level import LevelRun
from fem_impact.answers.verdict import vibration
from fem_impact.answers.verdict.levels import LEAST_LEVELS
from fem_impact.answers.verdict.vibration import twins
from fem_impact.case.case import Case
from fem_impact.case.effects.heating import halves
from fem_impact.case.effects.registry import BARRIERS, NAMES
from fem_impact.errors import SceneError
from fem_impact.modal.impact import ModalResult
from fem_impact.modal.motion import ROW
from fem_impact.outcome.keys import Num, Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.shares import heat_ends, work_ends
from fem_impact.physics.contact_law import contact_law
from fem_impact.physics.flash import flash
from fem_impact.run.common import part_of_last
from fem_impact.run.heated import beyond_melting
from fem_impact.run.modal import closed, reduce
from fem_impact.run.modal_error import SPLIT, factor_of, farness, place_of
from fem_impact.scene.fields import LEVELS, check_choice
from fem_impact.scene.inputs import first_melting
from fem_impact.scene.types import Scene
from fem_impact.tables.text import with_band


@dataclass(frozen=True, slots=True)
class Bound:
    """A number with its least and most, SI; ``alike``: its error was found on scenes like this one.

    Beyond a ``ceiling`` it is not known, for the reason ``beyond``: value and least are at most the ceiling,
    and the most is infinite. ``counts`` says what alone the number counts, empty if all.
    """

    value: float
    low: float
    high: float
    alike: bool = True
    ceiling: float = inf
    beyond: str = ""
    counts: str = ""

    def answer(self, limit: float) -> vibration.Answer:
        """Say whether the number stays below a limit."""
        if self.low > limit:
            return "no"
        return "yes" if self.high < limit else "undecided"

    def rank(self, limit: float) -> tuple[int, float, float, float]:
        """Return how bad the answer is, 0 of a yes, 2 of a no; the end that decides; number and least."""
        bad = ("yes", "undecided", "no").index(self.answer(limit))
        return bad, self.low if bad == 2 else self.high, self.value, self.low

    def graded(self, limit: float) -> vibration.Answer:
        """Return the answer: of a limit none is probable."""
        return self.answer(limit)

    def holds_against(self, meshes: "Bound", limit: float) -> bool:
        """Say whether it stands beside finite elements that do not decide: they agree, and know less."""
        agree = self.low <= meshes.high and meshes.low <= self.high
        narrower = self.high - self.low < meshes.high - meshes.low
        return self.alike and agree and narrower and meshes.answer(limit) == "undecided"

    def over(self, limit: float) -> float:
        """Return the error towards a limit over the one with which there would be an answer."""
        margin, error = limit - self.value, self.high - self.value
        if margin < 0.0:
            margin, error = -margin, self.value - self.low
        return error / margin if margin else inf


class Criterion(ABC):
    """A number that must stay below a limit.

    Attributes
    ----------
    called : in a sentence
    dimension, unit, per_unit : of its limit, the unit that is printed, and how many of SI that is
    needed : levels of finite elements without which they tell none
    """

    needed = LEAST_LEVELS

    called: str
    dimension: str
    unit: str
    per_unit: float

    def require(self, scene: Scene) -> None:
        """Refuse a scene that does not state what the number needs (SceneError)."""
        return

    @abstractmethod
    def reduced(self, scene: Scene) -> Bound | Unknown:
        """Return the number by the reduced model (SceneError: the scene is refused)."""

    @abstractmethod
    def meshed(self, scene: Scene) -> tuple[Scene, Scene | None]:
        """Return the scene for finite elements and the twin that runs beside it, None where none does."""

    @abstractmethod
    def solid(self, levels: Sequence[LevelRun]) -> Bound | None:
        """Return the number by levels of finite elements from coarse to fine, None where they tell none."""


class Rigidity(Criterion):
    """The change of a number of `fem_impact.answers.verdict.vibration.CHANGED` by vibration."""

    dimension, unit, per_unit = "", "", 1.0

    def __init__(self, of: str) -> None:
        self.of, self.called = of, f"the change of {of} by vibration"

    def reduced(self, scene: Scene) -> Bound | Unknown:
        """Return the change with its known error."""
        pair = vibration.modal_pair(scene)
        if failed := vibration.unfinished(pair, self.of):
            return Unknown(failed)
        effect = vibration.modal_effect(scene, pair, self.of)
        return _about(abs(effect.value), effect.band, effect.alike)

    def meshed(self, scene: Scene) -> tuple[Scene, Scene | None]:
        """Return the twins."""
        return twins(scene.untargeted)

    def solid(self, levels: Sequence[LevelRun]) -> Bound | None:
        """Return the change and the band of the levels."""
        effect = vibration.solid_effect([level.runs for level in levels], self.of)
        return None if effect is None else _about(abs(effect.value), effect.band)


class Limited(Criterion):
    """A number of one run, which the reduced model tells within a factor."""

    column: str  # of the stored scenes, by which that factor is found
    unknown_flat = ""  # why the reduced model does not tell it of what lands flat, empty where it does

    @abstractmethod
    def of_reduced(self, case: Case, result: ModalResult) -> float:
        """Return the number from a run of the reduced model."""

    @abstractmethod
    def of_solid(self, outcome: Outcome) -> Num:
        """Return the number from a run of finite elements."""

    def base(self, scene: Scene) -> float:
        """Return what of the number is known beforehand: of a temperature that of the surroundings."""
        return 0.0

    def counts(self, told: Callable[[str], str], heats: str = "") -> str:
        """Return what alone the number counts, empty if all.

        ``told`` gives shares of E_0 by key; ``heats`` says between what W_skin lies if its error is unknown.
        """
        return ""

    def reduced(self, scene: Scene) -> Bound | Unknown:
        """Return the number between those over and times its factor."""
        case = Case.of(scene, "modal")
        result = closed(case, recorded=True)
        if result.laid and self.unknown_flat:
            return Unknown(self.unknown_flat)
        outcome = reduce(case, result)
        if not outcome.validity.finished:
            return Unknown(outcome.validity.stopped_because)
        if isinstance(outcome.half_widths, Unknown):
            return outcome.half_widths
        place, value, base = place_of(case, outcome), self.of_reduced(case, result), self.base(scene)
        far = farness(place, outcome)
        factor = factor_of(place, self.column, far)
        ends = base + value, base + value / factor, base + value * factor
        heats = heat_ends(outcome) or work_ends(outcome) * isinstance(outcome.energy.skin, Unknown)
        counts = self.counts(lambda name: outcome.told(name, 100.0), heats)
        return Bound(*ends, far == 0.0, counts=counts)

    def meshed(self, scene: Scene) -> tuple[Scene, Scene | None]:
        """Return the scene without a film."""
        return replace(scene.untargeted, measured=None, save=replace(scene.save, frames=0)), None

    def solid(self, levels: Sequence[LevelRun]) -> Bound | None:
        """Return the limit and the half-width of the levels."""
        known = [
            (level, value) for level in levels if isinstance(value := self.of_solid(level.outcome), float)
        ]
        used = [level.runs for level, _ in known][-3:]
        limits, bands = level_limits(used)
        if len(levels) < self.needed or isinstance(limits, Unknown) or isinstance(bands, Unknown):
            return None
        if self.column in bands:
            value, band = limits[self.column], bands[self.column]
        else:
            values = [[value] for _, value in known][-3:]
            sizes, wide = zip(*((one.size, one.wide) for one in used), strict=True)
            value, band = level_limit(sizes, values, wide)

        def told(name: str) -> str:
            if name not in bands:
                return "not known"
            return with_band(100 * limits[name], 100 * bands[name], 0.0, 100.0)

        base = self.base(known[-1][0].cases[0].scene)
        return replace(_about(value + base, band), counts=self.counts(told))


def _about(value: float, band: float, alike: bool = True) -> Bound:
    """Return a number that is not negative between its ends."""
    return Bound(value, max(value - band, 0.0), value + band, alike)


class HeatCriterion(Limited):
    """The highest mean temperature of the patch."""

    called, column = "the flash temperature of the contact", "flash_rise_K"
    dimension, unit, per_unit = "temperature", "K", 1.0
    needed = LEVELS

    def counts(self, told: Callable[[str], str], heats: str = "") -> str:
        """Return the shares of friction, which is counted, and of all that can heat the contact."""
        sure = "its error is not known"
        unsure = {"W_friction_over_E_0": sure, "W_skin_over_E_0": f"{sure}: {heats}" if heats else sure}
        friction, skin = (
            share + doubt[len(sure) :]
            if share == "not known"
            else f"{share} % of E_0" + f" ({doubt})" * (" " not in share)
            for share, doubt in ((told(name), doubt) for name, doubt in unsure.items())
        )
        return (
            f"the power of friction alone, over the mean of the patch, in the first strike; spots in it may "
            f"be hotter. Friction takes {friction}. More can heat the contact: W_skin, friction and the "
            f"plastic work down to 0.1 mm below both surfaces, {skin}."
        )

    def of_reduced(self, case: Case, result: ModalResult) -> float:
        """Return the rise, K, of the patch, see `fem_impact.physics.flash`.

        The friction of the record heats the patch of Hertz or, where that is larger, the one that carries the
        force at the pressure at which the softer body flows.
        """
        record, law = result.record, contact_law(case.contact)
        t, first = np.unique(record[:, ROW.time], return_index=True)
        force, work = np.maximum(record[first, ROW.force_n], 0.0), record[first, ROW.friction]
        force, power = 0.5 * (force[1:] + force[:-1]), np.maximum(np.diff(work) / np.diff(t), 0.0)
        patch = pi * (0.75 * force * law.R / law.E_star) ** (2 / 3)
        patch = np.maximum(patch, 0.0 if law.limit == inf else force / law.limit)
        rubs, zero = (force > 0.0) & (power > 0.0), np.zeros_like(force)
        flux = np.divide(power, patch, out=zero.copy(), where=rubs)
        speed = np.divide(power, law.friction * force, out=zero.copy(), where=rubs)
        return flash(t, flux, np.sqrt(patch / pi), speed, *halves(case.bodies)).peak

    def of_solid(self, outcome: Outcome) -> Num:
        """Return the rise, K."""
        return outcome.heat.rise

    def require(self, scene: Scene) -> None:
        """Refuse a scene without heat capacities and conductivities (SceneError)."""
        halves(Case(scene).bodies)

    def base(self, scene: Scene) -> float:
        """Return the temperature of the surroundings, K."""
        return scene.heating.ambient

    def reduced(self, scene: Scene) -> Bound | Unknown:
        """Return the temperature, which is not known beyond the lower melting point of the two bodies."""
        bound = super().reduced(scene)
        return bound if isinstance(bound, Unknown) else _solid_metal(scene, bound)

    def solid(self, levels: Sequence[LevelRun]) -> Bound | None:
        """Return the limit and the half-width of as many levels as a default run has.

        Finer cells heat more: two levels of t5b told 415 to 507 K where three gave 513 K. Where the last one
        melts a body, the least is the melting point if the one before does so too. A contact that is
        hardly wider than a cell tells none.
        """
        if len(levels) < self.needed or not levels[-1].runs.wide:
            return None
        scene = levels[-1].cases[0].scene
        rises = [level.outcome.heat.rise for level in levels[-2:]]
        before, last = map(beyond_melting, rises)
        if last:
            return _solid_metal(scene, Bound(inf, inf if before else self.base(scene), inf))
        bound = super().solid(levels)
        if bound is None:
            return None
        return _solid_metal(scene, replace(bound, low=max(bound.low, self.base(scene))))

    def meshed(self, scene: Scene) -> tuple[Scene, Scene | None]:
        """Return the scene with its heat followed."""
        plain, _ = super().meshed(scene)
        on = {*Case(plain).active, "contact-heating"}
        return replace(plain, effects=tuple(name for name in NAMES if name in on)), None


def _solid_metal(scene: Scene, bound: Bound) -> Bound:
    """Return a temperature that is not known beyond the lower melting point, K."""
    ceiling, name = first_melting(scene)
    if bound.high < ceiling:
        return bound
    beyond = (
        f"{name} begins to melt at {ceiling:.0f} K, and beyond that conduction of heat alone does not hold"
    )
    value, low = min(bound.value, ceiling), min(bound.low, ceiling)
    return replace(bound, value=value, low=low, high=inf, ceiling=ceiling, beyond=beyond)


class ForceCriterion(Limited):
    """The largest normal force."""

    called, column = "the peak force", "peak_force_N"
    unknown_flat = (
        "a part of the body lands flat: its force follows from waves through the body, which the few modes "
        "of the reduced model do not resolve"
    )
    dimension, unit, per_unit = "force", "kN", 1e3

    def of_reduced(self, case: Case, result: ModalResult) -> float:
        """Return the force, N."""
        return result.force

    def of_solid(self, outcome: Outcome) -> Num:
        """Return the force, N."""
        return outcome.contact.peak_force


RIGID = BARRIERS[0]
LATER_BARRIER = Unknown(
    "the projectile yields at a lower stress, and the barrier yields as well: the reduced model, in which "
    "the body with the lower yield stress alone yields, tells no dent"
)


def _deforming(scene: Scene) -> Scene:
    """Return the scene with a barrier that deforms, however little of the contact's compliance is its own."""
    rigid = RIGID in Case.of(scene, "modal").active
    return replace(scene, effects=(*scene.effects, BARRIERS[1])) if rigid else scene


class DentCriterion(Limited):
    """The largest indentation of the barrier."""

    called, column = "the deepest indentation of the barrier", "dent_m"
    dimension, unit, per_unit = "length", "mm", 1e-3
    needed = LEVELS  # two hold the dent of one level more in 10 of 14 random scenes, three in 17 of 18

    def reduced(self, scene: Scene) -> Bound | Unknown:
        """Return the depth, which is not known where the barrier yields as well, but after the projectile.

        Where it yields first, the least is lower by the part that the projectile takes.
        """
        deforms = _deforming(scene)
        case = Case.of(deforms, "modal")
        last = part_of_last(case)
        if last and case.contact.softer == case.contact.rod:
            return LATER_BARRIER
        bound = super().reduced(deforms)
        least = 1.0 - min((1.0 + SPLIT) * last, 1.0)
        return bound if isinstance(bound, Unknown) else replace(bound, low=least * bound.low)

    def meshed(self, scene: Scene) -> tuple[Scene, Scene | None]:
        """Return the scene with a barrier that deforms."""
        return super().meshed(_deforming(scene))

    def require(self, scene: Scene) -> None:
        """Refuse a scene that states a rigid barrier (SceneError)."""
        if RIGID in scene.effects:
            remedy = "Take it out of effects: the barrier then deforms."
            raise SceneError("leaves the barrier no dent.", key="effects", value=RIGID, remedy=remedy)

    def of_reduced(self, case: Case, result: ModalResult) -> float:
        """Return the depth, m, at the place that is pressed deepest."""
        return max(site.depth for site in result.sites)

    def of_solid(self, outcome: Outcome) -> Num:
        """Return the depth, m, at the place that is pressed deepest."""
        sites = outcome.contact.sites
        return sites if isinstance(sites, Unknown) else max(site.depth for site in sites)


LIMITED: Mapping[str, Limited] = {"heat": HeatCriterion(), "force": ForceCriterion(), "dent": DentCriterion()}
"""Criteria that need a limit, by the word that asks for them."""


def criterion_of(word: str) -> Criterion:
    """Return a criterion by its word: of `LIMITED`, or the change by vibration of one of `CHANGED`.

    Raises
    ------
    SceneError
        The word is none of them.
    """
    check_choice(word, (*LIMITED, *vibration.CHANGED), "of=")
    return LIMITED[word] if word in LIMITED else Rigidity(word)
