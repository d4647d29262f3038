"""One verdict on a scene: may rigid theory be used, what does vibration take, where does the rest go."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import isclose
from typing import TYPE_CHECKING

import numpy as np

from fem_impact.answers.refine.budget import LONGER, Budget, about_s
from fem_impact.answers.refine.extrapolate import MeshRuns
from fem_impact.answers.refine.loop import Level, RefinementLoop, Stop, levels_of_twins
from fem_impact.answers.verdict.effect import (
    Answer,
    VibrationEffect,
    largest,
    modal_effect,
    modal_pair,
    solid_effect,
    unfinished,
    unsupported,
    untargeted,
)
from fem_impact.answers.verdict.reliability import known_error
from fem_impact.answers.verdict.screening import Screening, screening
from fem_impact.answers.verdict.twins import inclined, twins
from fem_impact.case.case import Case
from fem_impact.case.limits import flat_part, not_reduced
from fem_impact.errors import RunError, SceneError
from fem_impact.tables.text import plain

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


TOLERANCE = 0.05
"""VibrationEffect of e that may be neglected, unless stated."""
BUDGET = 60.0
"""Wall time, s, that the finite elements of a verdict may take, unless stated."""
FIDELITIES = ("auto", "modal", "solid")
ANGLES = tuple(np.radians(np.arange(5.0, 81.0, 5.0)))
"""Inclinations among which the worst one is looked for, rad."""
LEAST_MESHES = 2
"""Meshes that ``solid`` runs whatever the budget: one alone cannot estimate its own error."""

LACKING = "There is no reduced model of {}: finite elements alone answer."
COUNT = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")

Tell = Callable[[str], object]


@dataclass(frozen=True, slots=True, repr=False)
class Verdict:
    """The verdict on a scene.

    Attributes
    ----------
    scene : Scene
    tolerance : change of e that may be neglected
    fidelity : modal or solid, of ``here``
    screening : closed-form estimates
    here : the change of e at the scene's inclination
    elsewhere : the largest change of the reduced model over other inclinations, None where none is known
    not_known : inclinations, rad, where the reduced model has no answer, with the reason of the first
    over_friction : smallest and largest change of e within the stated interval of f by the reduced model;
        None where f has no interval or no effect
    notes : what the reader should know about how the verdict was found
    more : options of ``fem-impact assess`` that may decide what is undecided, empty where none are known
    """

    scene: Scene
    tolerance: float
    fidelity: str
    screening: Screening
    here: VibrationEffect
    elsewhere: VibrationEffect | None
    not_known: tuple[tuple[float, ...], str]
    over_friction: tuple[float, float] | None
    notes: tuple[str, ...]
    more: str

    def __repr__(self) -> str:
        return (
            f"Verdict({self.scene.id!r}: rigid theory {self.answer}, e changes by {self.here.told}, "
            f"vibration takes {100 * self.here.E_vib:.2g} % of E_0; {self.fidelity})"
        )

    @property
    def answer(self) -> Answer:
        """May rigid theory be used at the scene's inclination."""
        return self.here.answer(self.tolerance)

    @property
    def worst(self) -> VibrationEffect | None:
        """The largest change over all inclinations, None where only this one is known."""
        return None if self.elsewhere is None else largest([self.here, self.elsewhere])

    @property
    def worst_answer(self) -> Answer:
        """May it be used at any inclination: no where it may not at this one."""
        both = {self.answer, self.elsewhere.answer(self.tolerance) if self.elsewhere else "undecided"}
        if "no" in both:
            return "no"
        return "yes" if both == {"yes"} and not self.not_known[0] else "undecided"


def assess(
    scene: Scene,
    fidelity: str = "auto",
    tolerance: float = TOLERANCE,
    budget_s: float = BUDGET,
    workers: int = 1,
    tell: Tell = lambda sentence: None,
) -> Verdict:
    """Say whether rigid theory may be used for a scene, beside its twin that cannot vibrate.

    Parameters
    ----------
    scene : Scene
        Any rod and barrier; a mesh or target error that it states is not used.
    fidelity : "auto", "modal" or "solid"
        ``auto`` takes the reduced model with its known error, and finite elements where that error leaves the
        answer open, or is that of scenes unlike this one, and the budget allows. Other inclinations than the
        scene's are computed with the reduced model.
    tolerance : change of e that may be neglected
    budget_s : wall time of the finite elements, s
    workers : runs at a time, 1 or 2
    tell : called with a sentence before something that takes long

    Raises
    ------
    SceneError
        The scene, tolerance or budget cannot be used, or ``solid`` is asked of a scene that has no mesh.
    RunError
        No model gives a restitution at the scene's inclination.
    """
    _check(fidelity, tolerance, budget_s)
    bodies = Case(scene).bodies
    lacking = not_reduced(bodies)
    reduced = fidelity == "modal" or not lacking
    elsewhere = reduced or lacking == flat_part(bodies)  # what lands flat does so at this angle alone
    quick, notes = _quick(scene, tell) if reduced else (None, [LACKING.format(lacking)])
    here, used, more = quick, "modal", "--fidelity solid"
    # where nothing like the scene was computed both ways, the reduced model's error is not known well enough
    unlike = quick is not None and not known_error(scene).alike
    open_still = quick is None or unlike or quick.answer(tolerance) == "undecided"
    if fidelity == "solid" or (fidelity == "auto" and open_still):
        least = LEAST_MESHES if fidelity == "solid" else int(not elsewhere)
        solid, told, more = _solid(scene, least, tolerance, Budget(budget_s, workers), quick, tell)
        here, used = (solid, "solid") if solid else (quick, "modal")
        notes += told
        more = f"--fidelity solid {more}" if more and fidelity == "solid" else more
    if here is None:
        raise RunError(" ".join(notes))
    off = 0.0 if quick is None else abs(quick.value - here.value)
    others, not_known = _over_angles(scene, off) if elsewhere else (None, ((), ""))
    return Verdict(
        scene,
        tolerance,
        used,
        screening(bodies),
        here,
        others,
        not_known,
        None if quick is None else _over_friction(scene),
        tuple(notes),
        more if here.answer(tolerance) == "undecided" else "",
    )


def _quick(scene: Scene, tell: Tell) -> tuple[VibrationEffect | None, list[str]]:
    """Return what the reduced model says, None where it has no answer; and notes."""
    tell("the reduced model, at this inclination and at others ...")
    pair = modal_pair(scene)
    if failed := unfinished(pair):
        return None, [f"The reduced model has no answer here: {failed}"]
    return modal_effect(scene, pair), []


def _check(fidelity: str, tolerance: float, budget_s: float) -> None:
    if fidelity not in FIDELITIES:
        remedy = f"Use one of {', '.join(FIDELITIES)}."
        raise SceneError("is not a fidelity of a verdict.", key="fidelity", value=fidelity, remedy=remedy)
    if not 0.0 < tolerance < 1.0:
        remedy = "It is the change of e that may be neglected: give one such as 0.05."
        raise SceneError("must lie between 0 and 1.", key="tolerance", value=tolerance, remedy=remedy)
    if not 0.0 < budget_s < 1e6:
        raise SceneError("must lie above 0 and below 1e6 s.", key="budget", value=f"{budget_s:g} s")


@dataclass(frozen=True, slots=True)
class VerdictJudge:
    """Decides where the change of e by vibration is known well enough, beside what may be neglected.

    Attributes
    ----------
    levels : of a scene and its twin
    quick : what the reduced model says, None where there is none
    tolerance : change of e that may be neglected
    """

    levels: Sequence[Level]
    quick: VibrationEffect | None
    tolerance: float

    def failure(self, done: MeshRuns) -> str:
        """Return why the twins on a mesh say nothing, empty where they do."""
        return unfinished((done.runs[0], done.runs[1]))

    def decided(self, done: Sequence[MeshRuns], scatter: float = 1.0) -> bool:
        """Say whether meshes answer; one alone does where the reduced model bears it out."""
        effect = solid_effect(self.levels, done)
        return self.supported(done, effect) and effect.answer(self.tolerance) != "undecided"

    def supported(self, done: Sequence[MeshRuns], effect: VibrationEffect) -> bool:
        """Say whether two meshes ran, or the reduced model, known well enough, agrees with one."""
        quick = self.quick
        borne_out = quick is not None and quick.band <= self.tolerance and quick.meets(effect)
        return len(done) >= LEAST_MESHES or borne_out

    def effect(self, done: Sequence[MeshRuns]) -> tuple[VibrationEffect, list[str]]:
        """Return the change of e that finished meshes show, with notes on what its band holds.

        Where the reduced model contradicts one mesh, the band holds what both say; where there is no reduced
        model, the error of one mesh is not known.
        """
        effect, quick = solid_effect(self.levels, done), self.quick
        if self.supported(done, effect):
            return effect, []
        if quick is None:
            note = "One mesh alone does not tell its error, and no reduced model bears it out."
            return unsupported(effect, self.levels[0]), [note]
        note = (
            f"One mesh of finite elements says {effect.value:+.3f} ± {effect.band:.3f}, the reduced model "
            f"{quick.value:+.3f} ± {quick.band:.3f}: the band holds both."
        )
        return effect.widened(quick), [note]


def _solid(
    scene: Scene,
    least: int,
    tolerance: float,
    budget: Budget,
    quick: VibrationEffect | None,
    tell: Tell,
) -> tuple[VibrationEffect | None, list[str], str]:
    """Return what finite elements say, None where the budget allows no mesh or no run gives an e.

    Notes on it follow, and the options with which another mesh would run. ``least`` meshes run whatever the
    budget. One mesh alone counts where the reduced model, ``quick``, bears it out.
    """
    try:
        levels = levels_of_twins(*twins(untargeted(scene)))
    except SceneError as refused:
        if quick is None or least:
            raise
        return None, [f"Finite elements have no answer here: {refused}"], ""

    def announce(level: int, seconds: float) -> None:
        tell(f"finite elements, {COUNT[level]} mesh, about {about_s(seconds)} ...")

    judge, both = VerdictJudge(levels, quick, tolerance), len(levels[0].scenes)
    loop = RefinementLoop(levels, budget, least=least, first=both, announce=announce)
    stop = loop.run(judge)
    if isinstance(stop.error, SceneError) and quick is None and not loop.done:
        raise stop.error
    note, more = _stopped(loop, stop)
    effect, notes = judge.effect(loop.done) if loop.done else (None, [])
    return effect, [*note, *notes], more


def _stopped(loop: RefinementLoop, stop: Stop) -> tuple[list[str], str]:
    """Return a note on why no other mesh runs, and the options with which one would."""
    if stop.because == "decided":
        return [], ""
    if stop.because == "finest":
        return ["No finer mesh is tried: none of the family has finer cells at the contact."], ""
    which = COUNT[len(loop.done)]
    if stop.because == "failed":
        return [f"Finite elements give no result on the {which} mesh: {stop.error}"], ""
    limit_s, spent_s = loop.budget.limit_s, loop.budget.spent_s
    more = loop.budget.forecast_s(loop.finer[0].scenes)
    left, enough = max(limit_s - spent_s, 0.0), about_s(spent_s + LONGER * more)
    note = (
        f"A {which} mesh{', finer,' if loop.done else ''} would take about "
        f"{about_s(more)} more, and {plain(left, 2)} s are left of the budget of {limit_s:g} s. "
        f'For it give --budget "{enough}".'
    )
    return [note], f'--budget "{enough}"'


def _over_angles(scene: Scene, off: float) -> tuple[VibrationEffect | None, tuple[tuple[float, ...], str]]:
    """Return the largest change of the reduced model over other inclinations, and where it has no answer.

    ``off`` is its error at the scene's own inclination, as far as finite elements show it.
    """
    changes, missing, why = list[VibrationEffect](), list[float](), ""
    side = -1.0 if scene.impact.angle < 0 else 1.0  # that of the tip which comes down first
    for angle in (side * float(angle) for angle in ANGLES if not isclose(side * angle, scene.impact.angle)):
        try:
            one = inclined(scene, angle)
            pair = modal_pair(one)
            failed = unfinished(pair)
        except SceneError as error:
            failed = str(error)
        if failed:
            missing.append(angle)
            why = why or failed
        else:
            changes.append(modal_effect(one, pair).at_least(off))
    return (largest(changes) if changes else None), (tuple(missing), why)


def _over_friction(scene: Scene) -> tuple[float, float] | None:
    """Return the range of the change of e over the ends of the interval of f, by the reduced model."""
    surface = scene.surface
    if surface.friction_low == surface.friction_high:
        return None
    values = []
    for f in (surface.friction_low, surface.friction, surface.friction_high):
        one = replace(scene, surface=replace(surface, state="custom", friction=f))
        pair = modal_pair(one)
        values += [] if unfinished(pair) else [modal_effect(one, pair).value]
    return (min(values), max(values)) if values else None
