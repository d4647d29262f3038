"""Whether a number stays below a limit, at a scene or anywhere in intervals of what is uncertain.

The reduced model looks at places over the intervals, and finite elements at the worst of them and the mildest
where its error leaves the answer open.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from decimal import ROUND_CEILING
from functools import partial
from itertools import product
from math import inf
from time import perf_counter
from typing import Any

import numpy as np

from fem_impact.answers.refine.forecast import budget_of
from fem_impact.answers.validate import FRICTION, Ends, Interval, at_place, interval_of, left_out
from fem_impact.answers.verdict.assess import BUDGET, LACKING, check_means
from fem_impact.answers.verdict.criteria import Bound, Criterion, criterion_of
from fem_impact.answers.verdict.levels import (
    NO_ANSWER,
    Means,
    Tell,
    by_levels,
    finite_elements,
    next_step,
    with_budget,
)
from fem_impact.answers.verdict.sentences import case_sentence, never_covered
from fem_impact.answers.verdict.vibration import Answer
from fem_impact.case.case import Case
from fem_impact.case.limits import not_reduced
from fem_impact.errors import RunError, SceneError, UsageError
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import installed_versions
from fem_impact.progress import tell_cell
from fem_impact.scene.types import Scene, digest
from fem_impact.scene.units import parse_change, parse_quantity
from fem_impact.tables.text import digits_apart, plain, plain_bound

Write = Callable[[float, int], str]
upwards = partial(plain_bound, rounding=ROUND_CEILING)
PLACES = {1: 21, 2: 7, 3: 5, 4: 3}
"""Values of each of so many intervals at which the reduced model looks."""
CONFIRMED = (
    "Finite elements ran where the reduced model has its largest number and its least; as far as their upper "
    "end lies above it at one of them, it counts as too low at all places."
)
UNCONFIRMED = (
    "a smaller error of finite elements: they stay below the limit where the reduced model has its largest "
    "number and its least, but as far as their upper end lies above it at one of them it may be too low at "
    "all places, and that passes the limit. Assess parts of the intervals, or a limit with more margin."
)
LEAST = ", where the number is least: above {} there it does not stay below the limit at all places"
SOLIDS = "finite elements"
ALONE = "finite elements where the reduced model has its least number, too: notes say why they tell none."
UNLIKE = (
    "No scene that both models computed is like this one, so that the reduced model's error is told as wide "
    "as it is where scenes differ most: finite elements, --fidelity solid, tell more."
)
Place = tuple[float, ...]
"""A place in the intervals, each from 0 to 1."""
CELSIUS = 273.15  # K, of 0 degC


@dataclass(frozen=True, slots=True, repr=False)
class LimitVerdict:
    """Whether a number stays below a limit.

    Attributes
    ----------
    scene, criterion, limit : the question; SI
    intervals : lowest to highest value by key, as stated
    answer : for all of the intervals
    worst, bound, by : values by key where the number is largest, the number there, and by which model; by
        finite elements the worse of the places that these computed
    reduced : smallest and largest number of the reduced model over the intervals, None where it has none
    places, not_known : where the reduced model looked, and why it has no answer at some
    computed : places at which finite elements tell the number
    steps, notes : what was computed one after the other, and what the reader should know
    more : arguments of `judge` with which it may decide what is undecided
    """

    scene: Scene
    criterion: Criterion
    limit: float
    intervals: Mapping[str, str]
    answer: Answer
    worst: Mapping[str, str]
    bound: Bound | None
    by: str
    reduced: tuple[float, float] | None
    places: int
    not_known: str
    computed: int
    steps: tuple[str, ...]
    notes: tuple[str, ...]
    more: Means

    def __repr__(self) -> str:
        told = "not known" if self.bound is None else f"{_told(self.criterion, self.bound)} by {self.by}"
        limit = _in_unit(self.criterion, self.limit)
        return (
            f"LimitVerdict({self.scene.id!r}: {self.criterion.called} below {limit}: {self.answer}, {told})"
        )

    @property
    def missing(self) -> str:
        """What an undecided answer lacks, empty of a decided one."""
        if self.answer != "undecided":
            return ""
        if self.hopeless and self.bound is not None:
            return f"a limit that can be judged: {self.bound.beyond}."
        if self.bound is not None and self.bound.answer(self.limit) == "undecided":
            lies = "a smaller error: the limit lies within that of the number"
            if self.bound.beyond:
                return f"{lies}."
            digits = digits_apart(self.limit, self.bound.high, 3)
            high = _in_unit(self.criterion, self.bound.high, digits, upwards)
            return f"{lies}; or a limit above {high}."
        if self.not_known:
            return f"an answer: {self.not_known}"
        if self.bound is None:
            return "a model that tells the number: the notes say what was tried."
        return ALONE if self.computed == 1 else UNCONFIRMED

    @property
    def hopeless(self) -> bool:
        """Whether the number is not known up to the limit, by any model."""
        return self.bound is not None and self.limit >= self.bound.ceiling

    @property
    def margin(self) -> float | None:
        """How far the number stays below the limit at the worst place with its error, SI; below 0: beyond.

        None where no number is known, or none beyond a ceiling.
        """
        if self.bound is None or (self.bound.beyond and self.bound.answer(self.limit) != "no"):
            return None
        return self.limit - (self.bound.low if self.bound.answer(self.limit) == "no" else self.bound.high)


def judge(
    scene: Scene,
    of: Criterion | str,
    limit: float | str,
    uncertain: Mapping[str, Ends] | None = None,
    fidelity: str = "auto",
    budget_s: float = BUDGET,
    workers: int | None = None,
    tell: Tell = tell_cell,
) -> LimitVerdict:
    """Say whether a number stays below a limit, SI, for all values in the intervals.

    Parameters
    ----------
    of : the number: "heat", "force" or "dent"; or "e", "energy" or "friction", whose change by vibration is
        judged as by `fem_impact.assess`
    limit : in SI units, or text with its unit such as "430 degC"
    uncertain : lowest and highest value by key, as of `fem_impact.answers.validate.validate`; None: friction
        over the interval of the scene, if it states one
    fidelity, budget_s, workers, tell : as of `fem_impact.answers.verdict.assess.assess`

    Raises
    ------
    SceneError, UsageError
        The scene, limit or an interval cannot be used, or the scene does not state what the number needs.
    """
    criterion, limit = _question(of, limit)
    check_means(fidelity, budget_s)
    scene = scene.first_impact
    criterion.require(scene)
    intervals = [interval_of(scene, *one) for one in {**_over_friction(scene), **(uncertain or {})}.items()]
    scenes, lacking = _places(scene, intervals), not_reduced(Case(scene).bodies)
    reduced = not lacking or fidelity == "modal"
    steps, notes = list[str](), [*left_out(scene, intervals), *([] if reduced else [LACKING.format(lacking)])]
    bounds = _scanned(scenes, criterion, tell) if reduced else {}
    known = {place: one for place, one in bounds.items() if isinstance(one, Bound)}
    why = next((one.reason for one in bounds.values() if isinstance(one, Unknown)), "")
    why = LACKING.format(lacking) if lacking and bounds else why
    worst = max(known, key=lambda at: (known[at].value, known[at].low), default=(0.5,) * len(intervals))
    mildest = min(known, key=lambda at: (known[at].value, known[at].low), default=worst)
    shown = max(known, key=lambda at: known[at].rank(limit), default=worst)
    bound, by, solids = known.get(shown), "the reduced model", dict[Place, Bound]()
    more: Means = {}
    every = [one.answer(limit) for one in known.values()]  # the told error holds no body that lacks the model
    answer = "undecided" if lacking else _together(every, bool(why) or not known)
    if bound is not None:
        where = f" at the worst of {len(known)} places" if intervals else ""
        steps.append(f"{by}: {_told(criterion, bound)}{where}: {answer}")
        tell(steps[-1])
    open_still = answer == "undecided" or not all(one.alike for one in known.values())
    if fidelity == "solid" or (fidelity == "auto" and open_still):
        apart = known[worst].value - known[mildest].value if known else 0.0
        two = {worst: (scenes[worst], limit)} | {mildest: (scenes[mildest], limit - apart)}
        solids, said, more = _by_solids(two, criterion, (budget_s, workers), tell, steps)
        notes += said
        if fidelity == "solid" and worst not in solids:  # what was asked for tells nothing
            bound, answer = None, "undecided"
        more = {"fidelity": fidelity, **more} if more and fidelity == "solid" else more
        quick = known.get(worst) if fidelity == "auto" and answer == "undecided" else None
        if worst in solids and not (quick and quick.holds_against(solids[worst], limit)):
            shown = max(solids, key=lambda at: solids[at].rank(limit))
            bound, by = solids[shown], SOLIDS
            answer = _together([one.answer(limit) for one in solids.values()], mildest not in solids)
            if answer == "yes" and intervals:
                low = [one.high - known[at].value for at, one in solids.items() if at in known]
                within = worst in known and known[worst].value + max(low) <= limit and not why
                answer, notes = ("yes", [*notes, CONFIRMED]) if within else ("undecided", notes)
    elif answer == "undecided":
        more = finite_elements(criterion.meshed(scene)[0], budget_s, criterion.needed, 1 + bool(intervals))
    return LimitVerdict(
        scene,
        criterion,
        limit,
        {key: f"{low:g} to {high:g} {unit}".rstrip() for key, low, high, unit in intervals},
        answer,
        _values(intervals, shown),
        bound,
        by,
        (known[mildest].value, known[worst].value) if known else None,
        len(bounds),
        why,
        len(solids),
        tuple(steps),
        tuple(notes),
        more if answer == "undecided" else {},
    )


def _question(of: Criterion | str, limit: float | str) -> tuple[Criterion, float]:
    """Return a criterion and its limit in SI units (SceneError: one of them is none)."""
    criterion = criterion_of(of) if isinstance(of, str) else of
    if isinstance(limit, str) and criterion.dimension:
        limit = parse_quantity(limit, criterion.dimension, "limit=")
    limit = parse_change(limit, "limit=")
    if not 0.0 < limit < inf:
        raise SceneError("must lie above 0.", key="limit=", value=_in_unit(criterion, limit))
    return criterion, limit


def _values(intervals: Sequence[Interval], place: Place) -> dict[str, str]:
    """Return the value of each uncertain key at a place."""
    return {
        key: f"{low + share * (high - low):.4g} {unit}".rstrip()
        for (key, low, high, unit), share in zip(intervals, place, strict=True)
    }


def _over_friction(scene: Scene) -> dict[str, Ends]:
    """Return the interval of friction that a scene states, by its key; none where it states none."""
    low, high = scene.surface.friction_low, scene.surface.friction_high
    return {FRICTION: (low, high)} if low < high else {}


def _places(scene: Scene, intervals: Sequence[Interval]) -> dict[Place, Scene]:
    """Return the scenes at places over the intervals, of odd numbers: their middle is one of them.

    What is stated wrongly is found here, before any run (SceneError, UsageError).
    """
    if not intervals:
        return {(): scene}
    if len(intervals) not in PLACES:
        problem, remedy = f"states {len(intervals)} intervals.", f"Give at most {max(PLACES)}."
        raise UsageError(problem, key="uncertain=", remedy=remedy)
    shares = np.linspace(0.0, 1.0, PLACES[len(intervals)]).tolist()
    return {
        place: at_place(scene, intervals, np.array(place)) for place in product(shares, repeat=len(intervals))
    }


def _scanned(scenes: Mapping[Place, Scene], criterion: Criterion, tell: Tell) -> dict[Place, Bound | Unknown]:
    """Return the number by the reduced model at places (SceneError: the only one is refused)."""
    tell(f"the reduced model at {len(scenes)} places ...")
    bounds = dict[Place, Bound | Unknown]()
    for place, scene in scenes.items():
        try:
            bounds[place] = criterion.reduced(scene)
        except (SceneError, RunError) as refused:
            if len(scenes) == 1:
                raise
            bounds[place] = Unknown(str(refused))
    return bounds


def _by_solids(
    scenes: Mapping[Place, tuple[Scene, float]],
    criterion: Criterion,
    means: tuple[float, int | None],
    tell: Tell,
    steps: list[str],
) -> tuple[dict[Place, Bound], list[str], Means]:
    """Return what finite elements say at places until one does not stay below its limit; notes; more means.

    ``means`` are the budget of all of them, s, and runs at a time.
    """
    (budget_s, workers), begun = means, perf_counter()
    solids, notes = dict[Place, Bound](), list[str]()
    more: Means = {}
    for place, (scene, limit) in scenes.items():
        least = LEAST.format(_in_unit(criterion, limit)) if solids else ""
        before = perf_counter() - begun
        left = max(budget_s - before, 1.0), workers
        try:
            pair = criterion.meshed(scene)
            as_text = partial(_told, criterion, where=least)
            told = tell, steps, before, criterion.needed
            bound, said, more = by_levels(pair, criterion.solid, as_text, limit, left, *told)
        except (SceneError, RunError) as refused:
            bound, said = None, [f"{NO_ANSWER}: {refused}"]
            more = with_budget(budget_of(refused))
        notes += said
        solids |= {} if bound is None else {place: bound}
        if bound is None or bound.answer(limit) != "yes":
            break
    return solids, notes, more


def _together(answers: Sequence[Answer], missing: bool) -> Answer:
    """Return the answer for all places: no if it is at one, yes if it is at each and none is missing."""
    if "no" in answers:
        return "no"
    return "yes" if {*answers} == {"yes"} and not missing else "undecided"


def _in_unit(criterion: Criterion, number: float, digits: int = 3, write: Write = plain) -> str:
    """Return a number in the unit of its criterion, a temperature in degC, too."""
    celsius = f" = {write(number - CELSIUS, digits)} degC" if criterion.dimension == "temperature" else ""
    return f"{_apart(criterion, number, digits, write)}{celsius}"


def _apart(criterion: Criterion, number: float, digits: int = 3, write: Write = plain) -> str:
    """Return the distance between two numbers of a criterion in its unit."""
    return f"{write(number / criterion.per_unit, digits)} {criterion.unit}".rstrip()


def _told(criterion: Criterion, bound: Bound, where: str = "") -> str:
    """Return a number between its least and most, in the unit of its criterion, and where that is."""
    value, low = _in_unit(criterion, bound.value), _in_unit(criterion, bound.low)
    if bound.low == bound.ceiling:
        return f"at least {value} ({bound.beyond}){where}"
    if bound.beyond:
        more = " or more" if bound.value == bound.ceiling else ""
        return f"{low} or more, at the best estimate {value}{more} ({bound.beyond}){where}"
    return f"{value} ({low} to {_in_unit(criterion, bound.high)}){where}"


def limit_document(v: LimitVerdict, command: str) -> dict[str, Any]:
    """Return the verdict as plain JSON, its sentences with it; ``command`` is that which gives it again."""
    of, bound = v.criterion, v.bound
    over = " and ".join(f"{key} from {ends}" for key, ends in v.intervals.items())
    where = f", {over}" if over else ""
    question = f"Does {of.called} stay below {_in_unit(of, v.limit)} in the first impact{where}?"
    box = [[question, f"{v.answer.upper()}."]]
    if bound is not None:
        at = ", ".join(f"{key} {value}" for key, value in v.worst.items())
        size = "" if v.margin is None else _apart(of, abs(v.margin))
        far = {
            "yes": f", at least {size} below the limit",
            "no": f", at least {size} above the limit",
            "undecided": f", up to {size} above the limit" if size else "",
        }
        worst = "At the worst place" if v.reduced else "Where all have their middle values"
        worst += " that finite elements computed" * bool(v.reduced and v.by == SOLIDS)
        place = f"{worst}, {at}:" if at else "Here:"
        box.append([place, f"{_told(of, bound)}{far[bound.answer(v.limit)]}, by {v.by}."])
    if bound is not None and bound.counts:
        box.append(["It counts", bound.counts])
    if v.reduced and over:
        least, most = (_in_unit(of, number) for number in v.reduced)
        box.append([f"Of {v.places} places of the reduced model", f"the least has {least}, the most {most}."])
    lacking = [f"The reduced model does not answer everywhere: {v.not_known}"] if v.not_known else []
    lacking += [UNLIKE] if v.by == "the reduced model" and bound is not None and not bound.alike else []
    return {
        "scene_digest": digest(v.scene),
        "versions": installed_versions(),
        "criterion": of.called,
        "limit": v.limit,
        "over": dict(v.intervals),
        "answer": v.answer,
        "margin": v.margin,
        "worst": dict(v.worst),
        "bound": bound and {name: None if value == inf else value for name, value in asdict(bound).items()},
        "rests_on": v.by,
        "box": box,
        "missing": v.missing or None,
        "next_step": next_step(command, {} if v.hopeless else v.more),
        "basis": [
            ["case", case_sentence(v.scene)],
            *([f"step {number}", f"{step}."] for number, step in enumerate(v.steps, 1)),
            *(["note", note] for note in [*v.notes, *lacking]),
        ],
        "not_covered": [*texts(Case(v.scene).limitations), *never_covered(v.scene)],
    }
