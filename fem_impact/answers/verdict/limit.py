"""Whether a number stays below a limit, at a scene or anywhere in intervals of what is uncertain.

The reduced model looks at places over the intervals, and finite elements at the worst of them and the mildest
where its error leaves the answer open.
"""

from collections.abc import Mapping, Sequence
from functools import partial
from itertools import product
from math import ceil, inf
from time import perf_counter

import numpy as np

from fem_impact.answers.refine.forecast import budget_of
from fem_impact.answers.validate import Ends, Interval, at_place, friction_of, interval_of, left_out
from fem_impact.answers.verdict.assess import BUDGET, LACKING, check_means
from fem_impact.answers.verdict.criteria import Bound, Criterion, criterion_of
from fem_impact.answers.verdict.levels import (
    NO_ANSWER,
    Means,
    Tell,
    by_levels,
    finite_elements,
    with_budget,
)
from fem_impact.answers.verdict.limit_verdict import SOLIDS, LimitVerdict, bound_text, number_text
from fem_impact.answers.verdict.vibration import Answer
from fem_impact.case.case import Case
from fem_impact.case.limits import not_reduced
from fem_impact.errors import RunError, SceneError, UsageError
from fem_impact.outcome.keys import Unknown
from fem_impact.progress import tell_cell
from fem_impact.scene.types import Scene
from fem_impact.scene.units import parse_change, parse_quantity

PLACES = {1: 21, 2: 7, 3: 5, 4: 3}
"""Values of each of so many intervals at which the reduced model looks."""
CONFIRMED = (
    "Finite elements ran where the reduced model has its largest number and its least; as far as their upper "
    "end lies above it at one of them, it counts as too low at all places."
)
ENDS = (
    "No reduced model tells the number here: finite elements ran at the middle of the intervals and at all "
    "their ends. Between them the number counts as being higher by as much as these differ."
)
LEFT_OUT = "{}: the scene has {}, the answer holds for its interval alone."
LEAST = ", where the number is least: above {} there it does not stay below the limit at all places"
Place = tuple[float, ...]
"""A place in the intervals, each from 0 to 1."""


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
    intervals = [interval_of(scene, *one) for one in {**friction_of(scene), **(uncertain or {})}.items()]
    scenes, lacking = _places(scene, intervals), not_reduced(Case(scene).bodies)
    reduced = not lacking or fidelity == "modal"
    steps = list[str]()
    notes = [LEFT_OUT.format(*one) for one in left_out(scene, intervals).items()]
    notes += [] if reduced else [LACKING.format(lacking)]
    bounds = _scanned(scenes, criterion, tell) if reduced else {}
    known = {place: one for place, one in bounds.items() if isinstance(one, Bound)}
    why = next((one.reason for one in bounds.values() if isinstance(one, Unknown)), "")
    why = LACKING.format(lacking) if lacking and bounds else why
    worst, limits = _planned(scenes, known, bool(why), limit)
    shown = max(known, key=lambda at: known[at].rank(limit), default=worst)
    bound, by, solids = known.get(shown), "the reduced model", dict[Place, Bound]()
    more: Means = {}
    every = [one.answer(limit) for one in known.values()]  # the told error holds no body that lacks the model
    answer = "undecided" if lacking else _together(every, bool(why) or not known)
    if bound is not None:
        where = f" at the worst of {len(known)} places" if intervals else ""
        steps.append(f"{by}: {bound_text(criterion, bound)}{where}: {answer}")
        tell(steps[-1])
    open_still = answer == "undecided" or not all(one.alike for one in known.values())
    if fidelity == "solid" or (fidelity == "auto" and open_still):
        solids, said, more = _by_solids(scenes, limits, criterion, (budget_s, workers), tell, steps)
        notes += said
        if fidelity == "solid" and worst not in solids:  # what was asked for tells nothing
            bound, answer = None, "undecided"
        more = {"fidelity": fidelity, **more} if more and fidelity == "solid" else more
        quick = known.get(worst) if fidelity == "auto" and answer == "undecided" else None
        if worst in solids and not (quick and quick.holds_against(solids[worst], limit)):
            shown = max(solids, key=lambda at: solids[at].rank(limit))
            bound, by = solids[shown], SOLIDS
            answer = _together([one.answer(limit) for one in solids.values()], limits.keys() > solids.keys())
            if answer == "yes" and intervals:
                most, rests = _most(solids, {} if why else known)
                answer, notes = ("yes", [*notes, rests]) if most <= limit else ("undecided", notes)
    elif answer == "undecided":
        more = finite_elements(criterion.meshed(scene)[0], budget_s, criterion.needed, len(limits))
    return LimitVerdict(
        scene,
        criterion,
        limit,
        {key: f"{low:g} to {high:g} {unit}".rstrip() for key, low, high, unit in intervals},
        answer,
        _values(intervals, shown),
        bound,
        by,
        (min(one.value for one in known.values()), known[worst].value) if known else None,
        len(known),
        why,
        len(limits),
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
        raise SceneError("must lie above 0.", key="limit=", value=number_text(criterion, limit))
    return criterion, limit


def _values(intervals: Sequence[Interval], place: Place) -> dict[str, str]:
    """Return the value of each uncertain key at a place."""
    return {
        key: f"{low + share * (high - low):.4g} {unit}".rstrip()
        for (key, low, high, unit), share in zip(intervals, place, strict=True)
    }


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
    scenes: Mapping[Place, Scene],
    limits: Mapping[Place, float],
    criterion: Criterion,
    means: tuple[float, int | None],
    tell: Tell,
    steps: list[str],
) -> tuple[dict[Place, Bound], list[str], Means]:
    """Return what finite elements say at places until one does not stay below its limit; notes; more means.

    ``limits`` are those of the places to compute, the first one's that of the question; ``means`` are the
    budget of all of them, s, and runs at a time.
    """
    (budget_s, workers), begun = means, perf_counter()
    solids, notes = dict[Place, Bound](), list[str]()
    more: Means = {}
    alike, whole = len({*limits.values()}) == 1, next(iter(limits.values()))
    for place, limit in limits.items():
        where = f" at place {len(solids) + 1} of {len(limits)}" if alike and len(limits) > 1 else ""
        where = LEAST.format(number_text(criterion, limit)) if limit != whole else where
        before = perf_counter() - begun
        left = max(budget_s - before, 1.0), workers
        try:
            pair = criterion.meshed(scenes[place])
            as_text = partial(bound_text, criterion, where=where)
            told = tell, steps, before, criterion.needed
            bound, said, more = by_levels(pair, criterion.solid, as_text, limit, left, *told)
        except (SceneError, RunError) as refused:
            bound, said = None, [f"{NO_ANSWER}: {refused}"]
            wanted = budget_of(refused)
            more = with_budget(None if wanted is None else ceil(before) + wanted)
        notes += said
        solids |= {} if bound is None else {place: bound}
        if bound is None or bound.answer(limit) != "yes":
            break
    return solids, notes, more


def _planned(
    scenes: Mapping[Place, Scene], known: Mapping[Place, Bound], incomplete: bool, limit: float
) -> tuple[Place, dict[Place, float]]:
    """Return where a number counts as largest, and the places for finite elements with a limit for each.

    They are where the reduced model has its largest number and its least; the middle and all ends, too, where
    that is ``incomplete`` or tells none at all.
    """
    middle = (0.5,) * len(next(iter(scenes)))
    worst = max(known, key=lambda at: (known[at].value, known[at].low), default=middle)
    if incomplete or not known:
        return worst, dict.fromkeys([worst, middle, *(at for at in scenes if {*at} <= {0.0, 1.0})], limit)
    mildest = min(known, key=lambda at: (known[at].value, known[at].low))
    limits = {worst: limit}
    limits.setdefault(mildest, limit - known[worst].value + known[mildest].value)
    return worst, limits


def _most(solids: Mapping[Place, Bound], known: Mapping[Place, Bound]) -> tuple[float, str]:
    """Return the most that a number may be over intervals, and what that rests on.

    ``solids`` are the places that finite elements computed: where the reduced model has its largest number
    and its least if that is ``known`` everywhere, or the middle and all ends.
    """
    if not known:
        values = [one.value for one in solids.values()]
        return max(one.high for one in solids.values()) + max(values) - min(values), ENDS
    too_low = max(one.high - known[at].value for at, one in solids.items())
    return max(one.value for one in known.values()) + too_low, CONFIRMED


def _together(answers: Sequence[Answer], missing: bool) -> Answer:
    """Return the answer for all places: no if it is at one, yes if it is at each and none is missing."""
    if "no" in answers:
        return "no"
    return "yes" if {*answers} == {"yes"} and not missing else "undecided"
