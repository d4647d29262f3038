"""What was found about a limit, and how it is told."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from decimal import ROUND_CEILING
from functools import partial
from math import inf
from typing import Any

from fem_impact.answers.verdict.criteria import Bound, Criterion
from fem_impact.answers.verdict.levels import Means, next_step
from fem_impact.answers.verdict.sentences import case_sentence, never_covered
from fem_impact.answers.verdict.vibration import Answer
from fem_impact.case.case import Case
from fem_impact.outcome.groups import texts
from fem_impact.outcome.record import installed_versions
from fem_impact.scene.types import Scene, digest
from fem_impact.tables.text import digits_apart, plain, plain_bound

Write = Callable[[float, int], str]
upwards = partial(plain_bound, rounding=ROUND_CEILING)
SOLIDS = "finite elements"
UNCONFIRMED = (
    "a smaller error of finite elements: they stay below the limit where the reduced model has its largest "
    "number and its least, but as far as their upper end lies above it at one of them it may be too low at "
    "all places, and that passes the limit. Assess parts of the intervals, or a limit with more margin."
)
BETWEEN = (
    "a limit with more margin, or smaller intervals: finite elements stay below the limit at the middle and "
    "at all ends, but between them the number may be higher by as much as these differ."
)
LACKING_PLACES = (
    "the number at all {} places: finite elements have it at {} so far, and steps and notes say why."
)
UNLIKE = (
    "No scene that both models computed is like this one, so that the reduced model's error is told as wide "
    "as it is where scenes differ most: finite elements, --fidelity solid, tell more."
)
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
    places, not_known : where the reduced model has a number, and why it has none at some
    planned, computed : places at which finite elements are to tell the number, and how many do
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
    planned: int
    computed: int
    steps: tuple[str, ...]
    notes: tuple[str, ...]
    more: Means

    def __repr__(self) -> str:
        told = "not known" if self.bound is None else f"{bound_text(self.criterion, self.bound)} by {self.by}"
        limit = number_text(self.criterion, self.limit)
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
            high = number_text(self.criterion, self.bound.high, digits, upwards)
            return f"{lies}; or a limit above {high}."
        if self.not_known:
            return f"an answer: {self.not_known}"
        if self.bound is None:
            return "a model that tells the number: the notes say what was tried."
        if self.computed < self.planned:
            return LACKING_PLACES.format(self.planned, self.computed)
        return UNCONFIRMED if self.reduced else BETWEEN

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


def number_text(criterion: Criterion, number: float, digits: int = 3, write: Write = plain) -> str:
    """Return a number in the unit of its criterion, a temperature in degC, too."""
    celsius = f" = {write(number - CELSIUS, digits)} degC" if criterion.dimension == "temperature" else ""
    return f"{_apart(criterion, number, digits, write)}{celsius}"


def _apart(criterion: Criterion, number: float, digits: int = 3, write: Write = plain) -> str:
    """Return the distance between two numbers of a criterion in its unit."""
    return f"{write(number / criterion.per_unit, digits)} {criterion.unit}".rstrip()


def bound_text(criterion: Criterion, bound: Bound, where: str = "") -> str:
    """Return a number between its least and most, in the unit of its criterion, and where that is."""
    value, low = number_text(criterion, bound.value), number_text(criterion, bound.low)
    if bound.low == bound.ceiling:
        return f"at least {value} ({bound.beyond}){where}"
    if bound.beyond:
        more = " or more" if bound.value == bound.ceiling else ""
        return f"{low} or more, at the best estimate {value}{more} ({bound.beyond}){where}"
    return f"{value} ({low} to {number_text(criterion, bound.high)}){where}"


def limit_document(v: LimitVerdict, command: str) -> dict[str, Any]:
    """Return the verdict as plain JSON, its sentences with it; ``command`` is that which gives it again."""
    of, bound = v.criterion, v.bound
    over = " and ".join(f"{key} from {ends}" for key, ends in v.intervals.items())
    where = f", {over}" if over else ""
    question = f"Does {of.called} stay below {number_text(of, v.limit)} in the first impact{where}?"
    box = [[question, f"{v.answer.upper()}."]]
    if bound is not None:
        at = ", ".join(f"{key} {value}" for key, value in v.worst.items())
        size = "" if v.margin is None else _apart(of, abs(v.margin))
        far = {
            "yes": f", at least {size} below the limit",
            "no": f", at least {size} above the limit",
            "undecided": f", up to {size} above the limit" if size else "",
        }
        worst = "At the worst place" + " that finite elements computed" * (v.by == SOLIDS)
        place = f"{worst}, {at}:" if at else "Here:"
        box.append([place, f"{bound_text(of, bound)}{far[bound.answer(v.limit)]}, by {v.by}."])
    if bound is not None and bound.counts:
        box.append(["It counts", bound.counts])
    if v.reduced and over:
        top = inf if bound is None else bound.ceiling
        least, most = (number_text(of, one) + (" or more" if one == top else "") for one in v.reduced)
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
