"""Settings with their errors and costs, the Pareto front, and the choice."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Literal

from fem_impact.answers.refine.extrapolate import MeshRuns, QuantityLimit, quantity_limits
from fem_impact.answers.refine.forecast import longest_s
from fem_impact.answers.refine.quantities import QUANTITIES, sum_of
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.tables.text import plain

SettingKind = Literal["rigid", "modal", "levels", "two places", "variant"]
Limits = Mapping[str, QuantityLimit]


@dataclass(frozen=True, slots=True)
class Judged:
    """A setting with its results and costs; times in s, memory in 1e6 bytes.

    Settings are compared by processor time: a run has one thread, so this is its wall time on a free core and
    does not depend on other programs.

    Attributes
    ----------
    name, kind : a variant is the default run with a change, and on no front
    levels : how many, 0 of a model without a mesh
    default : whether it is the default run
    tip_size_m : cells at the contact of the last level, m
    value : by quantity; of levels the limit
    error : by quantity, over its scale: of levels the band that they tell, no less than their distance from
        the limit of the finest; of a model that distance with the half-width of the limit; of a variant the
        change by it
    cpu_s : processor time of all runs with their set-up
    two_cores_s : that of the busier core where the two places run side by side
    elements : of the last level
    peak_memory_MB : of the largest run
    front : names of the quantities on whose Pareto front the setting lies
    """

    name: str
    kind: SettingKind
    levels: int
    default: bool
    tip_size_m: float | None
    value: dict[str, float | None]
    error: dict[str, float | None]
    cpu_s: float
    two_cores_s: float
    elements: int | None = None
    peak_memory_MB: float | None = None
    front: list[str] = field(default_factory=list)


def judged_model(name: Literal["rigid", "modal"], run: Outcome, limits: Limits) -> Judged:
    """Return a model without a mesh with its errors."""
    value = {quantity.name: sum_of(quantity.keys, run) for quantity in QUANTITIES}
    error = {
        of: None if value[of] is None else (abs((value[of] or 0.0) - limit.value) + limit.band) / limit.scale
        for of, limit in limits.items()
    }
    cpu_s = run.cost.whole_cpu
    return Judged(name, name, 0, False, None, value, _every(error), cpu_s, cpu_s)


def judged_levels(
    name: str, kind: SettingKind, levels: Sequence[MeshRuns], beside: Limits, default: bool = False
) -> Judged:
    """Return levels with their errors; a variant stands beside the limits of the default run."""
    limits = quantity_limits(levels)
    error = {
        of: max(
            0.0 if kind == "variant" else limit.error, abs(limit.value - beside[of].value) / beside[of].scale
        )
        for of, limit in limits.items()
        if of in beside
    }
    times = [level.times for level in levels]
    return Judged(
        name,
        kind,
        len(levels),
        default,
        levels[-1].size,
        _every({of: limit.value for of, limit in limits.items()}),
        _every(error),
        cpu_s=sum(map(sum, times)),
        two_cores_s=sum(longest_s(on_level, 2) for on_level in times),
        elements=elements_of(levels[-1]),
        peak_memory_MB=max(or_none(run.cost.peak_memory) or 0.0 for run in levels[-1].runs) or None,
    )


def elements_of(level: MeshRuns) -> int:
    """Return the number of elements of both bodies on a level."""
    cost = level.runs[0].cost
    return sum(or_none(number) or 0 for number in (cost.elements_rod, cost.elements_barrier))


def _every(known: Mapping[str, float | None]) -> dict[str, float | None]:
    """Return numbers of all quantities, None of those that are not known."""
    return {quantity.name: known.get(quantity.name) for quantity in QUANTITIES}


def worst(judged: Judged, names: Iterable[str]) -> float:
    """Return the largest error of some quantities; infinite if one is unknown."""
    errors = [judged.error[name] for name in names]
    return max(inf if error is None else error for error in errors)


def front(judged: Sequence[Judged], names: Sequence[str]) -> list[Judged]:
    """Return the settings that no other beats in both time and worst error, in order of time."""
    optimal: list[Judged] = []
    best = inf
    compared = [setting for setting in judged if setting.kind != "variant"]
    for setting in sorted(compared, key=lambda j: (j.cpu_s, worst(j, names))):
        if worst(setting, names) < best:
            best = worst(setting, names)
            optimal.append(setting)
    return optimal


def cheapest(settings: Sequence[Judged], names: Sequence[str], target: float) -> Judged | None:
    """Return the quickest setting whose worst error is at most the target, None if there is none."""
    return next((setting for setting in front(settings, names) if worst(setting, names) <= target), None)


def best_within(settings: Sequence[Judged], names: Sequence[str], budget: float) -> Judged | None:
    """Return the most accurate setting that takes at most ``budget`` s, None if there is none."""
    return next((setting for setting in reversed(front(settings, names)) if setting.cpu_s <= budget), None)


def advice(
    settings: Sequence[Judged], names: Sequence[str], target: float | None, budget: float | None
) -> list[str]:
    """Return the answer in sentences."""
    wanted, best = " and ".join(names), front(settings, names)
    if not best:
        return [f"No setting tells an error of {wanted}."]
    lines = []
    if target is not None:
        quickest = cheapest(settings, names, target)
        lines.append(
            f"Cheapest within {100 * target:.3g} % of {wanted}: {_sentence_of(quickest, names)}."
            if quickest
            else f"No setting brings {wanted} within {100 * target:.3g} %; best: "
            f"{_sentence_of(best[-1], names)}."
        )
    if budget is not None:
        within = best_within(settings, names, budget)
        lines.append(
            f"Best within {budget:.3g} s on one core: {_sentence_of(within, names)}."
            if within
            else f"No setting takes only {budget:.3g} s on one core."
        )
    return lines


def default_sentence(settings: Sequence[Judged], names: Sequence[str]) -> str:
    """Say what the default run costs and errs, where it is among the settings."""
    for setting in settings:
        if setting.default:
            errors = [(name, setting.error[name]) for name in names]
            bands = " and ".join(
                f"{plain(100 * error, 2)} % of {name}" for name, error in errors if error is not None
            )
            took = f"The default run takes {plain(setting.cpu_s, 2)} s of processor time"
            return f"{took}; its bands are {bands}." if bands else f"{took} and tells no band."
    return ""


def _sentence_of(setting: Judged, names: Sequence[str]) -> str:
    return f"{setting.name}, error {plain(100 * worst(setting, names), 2)} % in {plain(setting.cpu_s)} s"
