"""One verdict on a scene or its strikes: may rigid theory be used, where does the energy go."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR
from math import degrees, inf, isclose

import numpy as np

from fem_impact.answers.refine.forecast import budget_of
from fem_impact.answers.refine.level import LevelRun
from fem_impact.answers.verdict import vibration
from fem_impact.answers.verdict.levels import NO_ANSWER, Means, Tell, by_levels, finite_elements, with_budget
from fem_impact.answers.verdict.screening import Screening, screening
from fem_impact.answers.verdict.vibration import CHANGED, inclined, twins
from fem_impact.case.case import Case
from fem_impact.case.limits import not_reduced
from fem_impact.errors import RunError, SceneError
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.outcome.strikes import StrikeRecord, Strikes
from fem_impact.progress import tell_cell
from fem_impact.run.simulate import simulate
from fem_impact.scene.impact import Following
from fem_impact.scene.types import Scene, require_scene
from fem_impact.scene.units import parse_change
from fem_impact.tables.table import Table
from fem_impact.tables.text import digits_apart, plain, plain_bound

TOLERANCE = 0.05
"""Change of e that may be neglected, unless stated."""
BUDGET = 60.0
"""Wall time, s, that the finite elements of a verdict may take, unless stated."""
FIDELITIES = ("auto", "modal", "solid")
ANGLES = tuple(np.radians(np.arange(5.0, 81.0, 5.0)))
"""Inclinations among which the worst one is looked for, rad."""
ALONE = ", but no scene like it was computed both ways: finite elements are asked, too"
WIDER = "Finite elements are less certain and do not contradict it: {}."
SURE: tuple[vibration.Answer, ...] = ("yes", "no")
LACKING = "There is no reduced model of {}: finite elements alone answer."


@dataclass(frozen=True, slots=True, repr=False)
class Verdict:
    """The verdict on a scene.

    Attributes
    ----------
    scene : Scene
    tolerance : change that may be neglected
    of : whose change is judged, of `CHANGED`
    fidelity : modal or solid, of ``here``; none
    screening : closed-form estimates
    here : the change at the scene's inclination, None where no model tells it
    elsewhere : the change of the reduced model that answers worst over other inclinations, None where none
        is known
    not_known : inclinations, rad, where the reduced model has no answer, with the reason of the first
    over_friction : smallest and largest change of e within the stated interval of f by the reduced model;
        None where f has no interval or no effect
    steps : what was computed one after the other, and what each step said
    notes : what the reader should know about how the verdict was found
    more : arguments of `assess` with which it may decide what is undecided, empty where none are known
    """

    scene: Scene
    tolerance: float
    of: str
    fidelity: str
    screening: Screening
    here: vibration.VibrationEffect | None
    elsewhere: vibration.VibrationEffect | None
    not_known: tuple[tuple[float, ...], str]
    over_friction: tuple[float, float] | None
    steps: tuple[str, ...]
    notes: tuple[str, ...]
    more: Means

    def __repr__(self) -> str:
        if self.here is None:
            return f"Verdict({self.scene.id!r}: rigid theory undecided, no model tells how {self.of} changes)"
        return (
            f"Verdict({self.scene.id!r}: rigid theory {self.answer}, {_told(self.here)}, "
            f"vibration takes {100 * self.here.E_vib:.2g} % of E_0; {self.fidelity})"
        )

    def _repr_html_(self) -> str:
        """Return the verdict, here and at the worst inclination, with its steps, as a notebook shows it."""
        told = _told(self.here) if self.here else f"no model tells how {self.of} changes"
        rows: list[tuple[str, str, str]] = [("here", self.answer, told)]
        if self.worst is not None:
            where = f"worst inclination, {degrees(self.worst.angle):.3g} deg"
            rows.append((where, self.worst_answer, _told(self.worst)))
        rows += [("missing", "", self.missing)] if self.missing else []
        rows += [(f"step {number}", "", step) for number, step in enumerate(self.steps, 1)]
        rows += [("note", "", note) for note in self.notes]
        columns = ("", "may rigid theory be used", "why")
        return Table.of(columns, rows, left=(0, 1, 2)).html(repr(self))

    @property
    def answer(self) -> vibration.GradedAnswer:
        """May rigid theory be used at the scene's inclination."""
        return "undecided" if self.here is None else self.here.graded(self.tolerance)

    @property
    def missing(self) -> str:
        """What an undecided or probable answer lacks, empty of a sure one."""
        if self.answer in SURE:
            return ""
        if self.here is None:
            return f"a model that tells how {self.of} changes: the notes say what was tried."
        if not self.here.is_known:
            return f"a change of {self.of} that is known: the half-width told holds every one there can be."
        size, band = abs(self.here.value), self.here.band
        margin, enough = abs(self.tolerance - size), size + band
        digits = digits_apart(margin, band)
        less = plain_bound(margin, digits, ROUND_FLOOR)
        missing = f"an error below {less} instead of {plain(band, digits)}"
        if self.answer != "undecided":
            missing = f"for a sure answer {missing}"
        if not self.more:
            missing += ", which no model tells here"
        if enough >= 1.0:  # no change that may be neglected
            return f"{missing}."
        wider = plain_bound(enough, digits_apart(self.tolerance, enough), ROUND_CEILING)
        return f"{missing}; or a change of {wider} that may be neglected."

    @property
    def worst(self) -> vibration.VibrationEffect | None:
        """The change that answers worst over all inclinations, None where only this one is known."""
        here = [self.here] if self.here and self.here.is_known else []
        return self.elsewhere and vibration.worst([*here, self.elsewhere], self.tolerance)

    @property
    def worst_answer(self) -> vibration.GradedAnswer:
        """May it be used at any inclination: the worst of the answers here and elsewhere."""
        both = {self.answer, self.elsewhere.graded(self.tolerance) if self.elsewhere else "undecided"}
        both |= {"undecided"} if self.not_known[0] else set()
        return min(both, key=vibration.WORST_FIRST.index)


def assess(
    scene: Scene,
    fidelity: str = "auto",
    tolerance: float | str = TOLERANCE,
    budget_s: float = BUDGET,
    workers: int | None = None,
    tell: Tell = tell_cell,
    of: str = "e",
) -> Verdict:
    """Say whether rigid theory may be used for a scene, beside its twin that cannot vibrate.

    An interrupt (Ctrl-C) ends the finite elements: the verdict rests on what ran before, and says so.

    Parameters
    ----------
    scene : Scene
        Any rod and barrier; a mesh or target error that it states is not used.
    fidelity : "auto", "modal" or "solid"
        ``auto`` takes the reduced model with its known error, and finite elements where that error leaves the
        answer open, or is that of scenes unlike this one, and the budget allows. Other inclinations than the
        scene's are computed with the reduced model.
    tolerance : change that may be neglected, such as 0.05 or "5 %"
    budget_s : wall time of the finite elements, s
    workers : runs at a time, 1 or 2; None: 2 where this process may use as many cores
    tell : called with a sentence before something that takes long, and after each step; by default these are
        printed in IPython and notebooks
    of : the change of which number: "e", or as shares of E_0 the "energy" that the body keeps or the work of
        "friction"

    Raises
    ------
    SceneError
        The scene, tolerance or budget cannot be used, or ``solid`` is asked of a scene that has no mesh.
    """
    require_scene(scene)
    check_means(fidelity, budget_s)
    if of not in CHANGED:
        remedy = f"Use one of {', '.join(CHANGED)}."
        raise SceneError("is not a number whose change is judged.", key="of=", value=of, remedy=remedy)
    tolerance = parse_change(tolerance, "tolerance=")
    if not 0.0 < tolerance < 1.0:
        remedy = "It is the change that may be neglected: give one such as 0.05."
        raise SceneError("must lie between 0 and 1.", key="tolerance=", value=tolerance, remedy=remedy)
    scene = scene.first_impact
    bodies = Case(scene).bodies
    lacking = not_reduced(bodies)
    reduced = fidelity == "modal" or not lacking
    quick, notes = _quick(scene, of, tell) if reduced else (None, [LACKING.format(lacking)])
    screened = screening(bodies)
    steps = [f"rigid theory: T1/tau = {screened.ratio:.2f}, {screened.published}"]
    # where nothing like the scene was computed both ways, the reduced model's error is not known well enough
    open_still = quick is None or not quick.alike or quick.answer(tolerance) == "undecided"
    asked = ALONE if fidelity == "auto" and quick and not quick.alike else ""
    steps += [f"the reduced model: {_told(quick)}: {quick.graded(tolerance)}{asked}"] if quick else []
    for step in steps:
        tell(step)
    effect, used = quick, "modal"
    if fidelity == "solid" or (fidelity == "auto" and open_still):

        def estimate(levels: Sequence[LevelRun]) -> vibration.VibrationEffect | None:
            return vibration.solid_effect([level.runs for level in levels], of)

        pair, means = twins(scene.untargeted), (budget_s, workers)
        try:
            solid, sentences, more = by_levels(pair, estimate, _told, tolerance, means, tell, steps)
        except (SceneError, RunError) as refused:
            if isinstance(refused, SceneError) and (fidelity == "solid" or quick is None):
                raise
            said = f"{NO_ANSWER}, where two runs are needed, with and without vibration: {refused}"
            solid, sentences = None, [said]
            more = with_budget(budget_of(refused))
        effect, used = (solid, "solid") if solid or fidelity == "solid" else (quick, "modal")
        notes += sentences
        if quick and solid and fidelity == "auto" and quick.holds_against(solid, tolerance):
            effect, used, notes = quick, "modal", [*notes, WIDER.format(_told(solid))]
        more = {"fidelity": fidelity, **more} if more and fidelity == "solid" else more
    else:
        more = finite_elements(twins(scene.untargeted)[0], budget_s) if open_still else {}
    off = 0.0 if quick is None or effect is None else abs(quick.value - effect.value)
    others, not_known = _over_angles(scene, of, tolerance, off) if reduced else (None, ((), ""))
    return Verdict(
        scene,
        tolerance,
        of,
        used if effect else "none",
        screened,
        effect,
        others,
        not_known,
        None if quick is None else _over_friction(scene, of),
        tuple(steps),
        tuple(notes),
        more if effect is None or effect.answer(tolerance) == "undecided" else {},
    )


def _told(effect: vibration.VibrationEffect) -> str:
    return f"{effect.of} changes by {effect.told}"


def _quick(scene: Scene, of: str, tell: Tell) -> tuple[vibration.VibrationEffect | None, list[str]]:
    """Return what the reduced model says, None where it has no answer; and notes."""
    tell("the reduced model, at this inclination and at others ...")
    pair = vibration.modal_pair(scene)
    if failed := vibration.unfinished(pair, of):
        return None, [f"The reduced model has no answer here: {failed}"]
    return vibration.modal_effect(scene, pair, of), []


def check_means(fidelity: str, budget_s: float) -> None:
    """Refuse another fidelity than those of a verdict, and a budget that is none (SceneError)."""
    if fidelity not in FIDELITIES:
        remedy = f"Use one of {', '.join(FIDELITIES)}."
        raise SceneError("is not a fidelity of a verdict.", key="fidelity=", value=fidelity, remedy=remedy)
    if not 0.0 < budget_s < 1e6:
        raise SceneError("must lie above 0 and below 1e6 s.", key="budget_s=", value=budget_s)


def _over_angles(
    scene: Scene, of: str, tolerance: float, off: float
) -> tuple[vibration.VibrationEffect | None, tuple[tuple[float, ...], str]]:
    """Return the worst change of the reduced model over other inclinations, and where it has no answer.

    ``off`` is its error at the scene's own inclination, as far as finite elements show it.
    """
    changes, missing, why = list[vibration.VibrationEffect](), list[float](), ""
    side = -1.0 if scene.impact.angle < 0 else 1.0  # that of the tip which comes down first
    for angle in (side * float(angle) for angle in ANGLES if not isclose(side * angle, scene.impact.angle)):
        try:
            one = inclined(scene, angle)
            pair = vibration.modal_pair(one)
            if not (failed := vibration.unfinished(pair, of)):
                change = vibration.modal_effect(one, pair, of).at_least(off)
                failed = "" if change.is_known else _told(change)
        except SceneError as error:
            failed = str(error)
        if failed:
            missing.append(angle)
            why = why or failed
        else:
            changes.append(change)
    return (vibration.worst(changes, tolerance) if changes else None), (tuple(missing), why)


def _over_friction(scene: Scene, of: str) -> tuple[float, float] | None:
    """Return the range of the change over the ends of the interval of f, by the reduced model."""
    surface = scene.surface
    if surface.friction_low == surface.friction_high:
        return None
    values = []
    for f in (surface.friction_low, surface.friction, surface.friction_high):
        one = replace(scene, surface=replace(surface, state="custom", friction=f))
        pair = vibration.modal_pair(one)
        values += [] if vibration.unfinished(pair, of) else [vibration.modal_effect(one, pair, of).value]
    return (min(values), max(values)) if values else None


def sequence_verdict(scene: Scene, tolerance: float) -> list[str]:
    """Return sentences: rigid theory beside the reduced model in the hardest strike and in all of them.

    ``tolerance`` is the share of a speed and of E_0 that may be neglected. Strikes that are not of the same
    part in all of the sequences that hold the reduced model's errors decide nothing; nor does a sequence that
    one of the models cannot follow.
    """
    plain = replace(scene, strikes=replace(scene.strikes, fidelity=Following().fidelity))
    try:
        rigid, modal = (simulate(plain, fidelity).strikes for fidelity in ("rigid", "modal"))
    except SceneError as error:
        return [f"The sequence is not known: {error}"]
    for strikes in (rigid, modal):
        if isinstance(strikes.each, Unknown):
            return [f"The sequence is not known: {strikes.each.reason}."]
    number, allowed = known(modal.hardest_energy), tolerance * known(modal.each)[0].before
    ours, theirs = (known(one.each)[:number] for one in (rigid, modal))
    certain, last = or_none(modal.certain) or 0, len(known(modal.each))
    hardest: vibration.Answer = "no"
    if [one.part for one in ours] == [one.part for one in theirs]:
        one, other = ours[-1], theirs[-1]
        speed = tolerance * other.approach
        faster = abs(one.approach - other.approach), speed, _half(modal, number, "approach_m_per_s")
        loses = abs(one.lost - other.lost), allowed, _half(modal, number, "E_after_J")
        hardest = _all_within([faster, loses])
    hardest = hardest if number <= certain else "undecided"
    lost = []
    for strikes in (rigid, modal):
        parts = strikes.friction, strikes.plastic, strikes.damping, strikes.settled, strikes.other
        lost.append((known(strikes.friction), sum(map(known, parts))))
    rubs, all_ = (abs(a - b) for a, b in zip(*lost, strict=True))
    half = _half(modal, last, "E_after_J") if last <= certain else inf
    rubbing = inf if isinstance(modal.friction_half, Unknown) else modal.friction_half
    whole = _all_within([(rubs, allowed, rubbing), (all_, allowed, half)])
    whole = min(hardest, whole, key=vibration.WORST_FIRST.index)
    rigidly, by_modes = (f"{lost_all:.3g} J, {rubbed:.3g} J of it by friction" for rubbed, lost_all in lost)
    ends = (
        "does not strike by itself"
        if isinstance(ratio, Unknown)
        else f"strikes {ratio:.3g} times as fast as the first strike came"
        for ratio in (modal.other_end, rigid.other_end)
    )
    which = f"number {number} by the reduced model"
    if number > certain:
        agree = or_none(modal.hardest_agree)
        which += f" (not certain{f', in {agree} of 64 sequences' if agree else ''})"
    return [
        f"{hardest.upper()}: rigid theory for the hardest strike, {which}: "
        f"{_struck(theirs, number)}; by rigid theory {_struck(ours, number)}.",
        f"{whole.upper()}: rigid theory for the whole sequence, which loses {by_modes} by the "
        f"reduced model and {rigidly} by rigid theory (allowed: {tolerance:g} of a speed and of E_0).",
        "The other end {} by the reduced model; by rigid theory it {}.".format(*ends),
    ]


def _half(strikes: Strikes, number: int, name: str) -> float:
    """Return the half-width of a number of a strike, infinite where it is not known."""
    half = strikes.half_width(number, name)
    return inf if isinstance(half, Unknown) else half


def _all_within(differences: Sequence[tuple[float, float, float]]) -> vibration.Answer:
    """Say whether each of some differences, with what is allowed and its half-width, lies within that."""
    if any(apart - half > allowed for apart, allowed, half in differences):
        return "no"
    return "yes" if all(apart + half <= allowed for apart, allowed, half in differences) else "undecided"


def _struck(each: tuple[StrikeRecord, ...], number: int) -> str:
    if len(each) < number:
        return "there is no such strike"
    one = each[number - 1]
    return f"the {one.part} at {one.approach:.3g} m/s, which takes {one.lost:.3g} J"
