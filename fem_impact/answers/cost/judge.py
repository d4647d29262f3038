"""Errors of the settings against the limit, the Pareto front, and the choice."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from math import inf
from statistics import fmean
from typing import Any

from fem_impact.answers.cost.settings import ONE_OFFSET, Setting
from fem_impact.answers.refine.budget import longest_s
from fem_impact.answers.refine.extrapolate import (
    ExtrapolatedValue,
    MeshRuns,
    standard_error,
    target_limits,
)
from fem_impact.answers.refine.quantities import QUANTITIES
from fem_impact.outcome.keys import or_none
from fem_impact.tables.text import plain

Quantities = Mapping[str, Mapping[str, float]]  # by name, each with its scale


@dataclass(frozen=True, slots=True)
class Judged:
    """A setting with its results and costs; times in s, memory in 1e6 bytes.

    Settings are compared by CPU time: a run has one thread, so this is its wall time on a free core and does
    not depend on other programs.

    Attributes
    ----------
    value : by quantity, the mean over the grid offsets; of several meshes their limit
    error : by quantity, over its scale: distance from the limit plus the uncertainty of the limit, of
        several meshes their band where that is less; where an effect is left out, the change by that on the
        same mesh
    scatter : standard error of the value over the scale, of a solid setting with all effects
    band : of several meshes, uncertainty of their extrapolation over the scale, scatter included; at least
        the distance from the limit of the finest two
    wall_s, cpu_s : wall and processor time of all runs, each with its set-up, which an outcome states apart
        from its own ``wall_s`` and ``cpu_s`` (``setup_wall_s``, ``setup_cpu_s``)
    two_cores_s : ``cpu_s`` of the core that is busy longer when every second run is done on another one
    element_steps : elements times time steps, None for a reduced model
    peak_memory_MB : of the largest run
    meshes : of a solid setting, the finest first
    places : most grid offsets that a mesh of it is run at
    front : names of the quantities on whose Pareto front the setting lies
    """

    name: str
    kind: str
    fidelity: str
    meshes: list[dict[str, Any]]
    places: int
    tip_size_m: float | None
    value: dict[str, float | None]
    error: dict[str, float | None]
    scatter: dict[str, float]
    band: dict[str, float]
    wall_s: float
    cpu_s: float
    two_cores_s: float
    element_steps: int | None
    peak_memory_MB: float | None
    front: list[str] = field(default_factory=list)


def judge(
    setting: Setting,
    runs: Sequence[MeshRuns],
    limits: Mapping[str, ExtrapolatedValue],
    finest: Mapping[str, ExtrapolatedValue],
    whole: MeshRuns | None = None,
) -> Judged:
    """Return a setting with its errors.

    ``runs`` are those on each mesh, the finest first, or one of a reduced model. The band of several meshes
    reaches at least to the limit of the ``finest`` two: that of coarse ones may be narrow by chance. If the
    setting leaves an effect out, ``whole`` are the runs with all effects on the same mesh, which are the
    reference then.
    """
    quantities = {q.name: q.keys for q in QUANTITIES}
    if whole is not None:
        limits = {
            name: replace(limit, value=fmean(whole.values(quantities[name])), uncertainty=0.0)
            for name, limit in limits.items()
        }
    outcomes = [outcome for mesh in runs for outcome in mesh.runs]
    bands = {
        name: replace(limit, uncertainty=max(limit.uncertainty, abs(limit.value - finest[name].value)))
        for name, limit in (target_limits(runs) if len(runs) > 1 else {}).items()
    }
    value = {
        name: bands[name].value if name in bands else runs[0].mean(keys) for name, keys in quantities.items()
    }
    scatter = {name: limit.scatter for name, limit in bands.items()}
    if len(runs) == 1 and setting.meshes and whole is None:
        scatter = {name: standard_error(runs[0].values(quantities[name])) for name in limits}
    return Judged(
        name=setting.name,
        kind=setting.kind,
        fidelity=setting.fidelity,
        meshes=[asdict(mesh) for mesh in setting.meshes],
        places=setting.places,
        tip_size_m=or_none(outcomes[0].cost.tip_size),
        value=value,
        error={name: _error(number, limits.get(name), bands.get(name)) for name, number in value.items()},
        scatter={name: number / limits[name].scale for name, number in scatter.items()},
        band={name: limit.uncertainty / limits[name].scale for name, limit in bands.items()},
        wall_s=sum(outcome.cost.whole_wall for outcome in outcomes),
        cpu_s=sum(outcome.cost.whole_cpu for outcome in outcomes),
        two_cores_s=longest_s([outcome.cost.whole_cpu for outcome in outcomes], 2),
        element_steps=sum(or_none(outcome.cost.element_steps) or 0 for outcome in outcomes) or None,
        peak_memory_MB=max((or_none(o.cost.peak_memory) or 0.0 for o in outcomes), default=0.0) or None,
    )


def _error(
    value: float | None, limit: ExtrapolatedValue | None, band: ExtrapolatedValue | None
) -> float | None:
    """Return a bound of the error over the scale, by the limit of all meshes or its own band if less."""
    if value is None or limit is None:
        return None
    bound = abs(value - limit.value) + limit.uncertainty
    return (min(bound, band.uncertainty) if band else bound) / limit.scale


def worst(judged: Judged, names: Iterable[str]) -> float:
    """Return the largest error of some quantities; infinite if one is unknown."""
    errors = [judged.error[name] for name in names]
    return max(inf if error is None else error for error in errors)


def front(judged: Sequence[Judged], names: Sequence[str]) -> list[Judged]:
    """Return the settings that no other beats in both time and worst error, in order of time.

    Settings that run at one grid offset are not compared (`ONE_OFFSET`): their error may be
    small by chance, and it is none against the limit where an effect is left out. Those that are compared
    cost what they were measured to cost: a choice runs their meshes at the same offsets.
    """
    optimal: list[Judged] = []
    best = inf
    whole = [one for one in judged if one.kind not in ONE_OFFSET]
    for one in sorted(whole, key=lambda j: (j.cpu_s, worst(j, names))):
        if worst(one, names) < best:
            best = worst(one, names)
            optimal.append(one)
    return optimal


def cheapest(settings: Sequence[Judged], names: Sequence[str], target: float) -> Judged | None:
    """Return the quickest setting whose worst error is at most the target, None if there is none."""
    return next((one for one in front(settings, names) if worst(one, names) <= target), None)


def best_within(settings: Sequence[Judged], names: Sequence[str], budget: float) -> Judged | None:
    """Return the most accurate setting that takes at most ``budget`` s, None if there is none."""
    return next((one for one in reversed(front(settings, names)) if one.cpu_s <= budget), None)


def advice(
    settings: Sequence[Judged], names: Sequence[str], target: float | None, budget: float | None
) -> list[str]:
    """Return the answer in sentences."""
    wanted = " and ".join(names)
    lines = []
    if target is not None:
        quickest = cheapest(settings, names, target)
        best = front(settings, names)[-1]
        lines.append(
            f"Cheapest within {100 * target:.3g} % of {wanted}: {_sentence_of(quickest, names)}."
            if quickest
            else f"No setting brings {wanted} within {100 * target:.3g} %; best: {_sentence_of(best, names)}."
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
    for one in settings:
        if one.kind == "default":
            errors = [(name, one.error[name]) for name in names]
            told = " and ".join(
                f"{plain(100 * error, 2)} % in {name}" for name, error in errors if error is not None
            )
            took = f"{plain(one.cpu_s, 2)} s of processor time"
            return (
                f"The default run takes {took}; its error is at most {told}. It ran at one place of the "
                "grid, so that may be small by chance, and it is not compared with the others."
            )
    return ""


def _sentence_of(setting: Judged, names: Sequence[str]) -> str:
    return f"{setting.name}, error {plain(100 * worst(setting, names), 2)} % in {plain(setting.cpu_s)} s"


def best_group(settings: Sequence[Judged], names: Sequence[str], target: float) -> Judged | None:
    """Return the several meshes whose bands meet the target most quickly on two cores.

    If none do, the finest two at most offsets: the smallest band may be small by chance.
    """
    groups = [one for one in settings if one.band]
    good = [one for one in groups if all(one.band[name] <= target for name in names)]
    if good:
        return min(good, key=lambda one: one.two_cores_s)
    pairs = [one for one in groups if len(one.meshes) == 2]
    return max(pairs, key=lambda one: (*(mesh["finer"] for mesh in one.meshes), one.places), default=None)


def group_sentence(
    settings: Sequence[Judged], quantities: Quantities, names: Sequence[str], target: float
) -> str:
    """Say what the best several meshes give for every quantity that is asked for."""
    group = best_group(settings, names, target)
    if group is None:
        return "No two meshes gave a result."
    verdicts = "; ".join(f"{name} {verdict(group, quantities, name, target)}" for name in names)
    took = f"{group.two_cores_s:.3g} s on two cores"
    return f"Several meshes against {100 * target:.3g} %, {group.name}: {verdicts}; {took}."


def verdict(group: Judged, quantities: Quantities, name: str, target: float) -> str:
    """Return value, band, how much of it is scatter, and whether the band meets the target."""
    value, band, scale = group.value[name] or 0.0, group.band[name], quantities[name]["scale"]
    reached = "reached" if band <= target else "not reached"
    scatter = f"{group.scatter[name] * scale:.4f} of it scatter"
    return f"{value:.4f} ± {band * scale:.4f} ({scatter}), {reached}: {plain(100 * band, 2)} %"
