"""Errors of the settings against the limit, the Pareto front, and the choice."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from math import inf
from typing import Any

from fem_impact.cost.quantities import QUANTITIES, Quantity
from fem_impact.cost.settings import Setting
from fem_impact.outcome import Outcome
from fem_impact.study.richardson import SURE, UNSURE, limit

__all__ = ["Judged", "Truth", "extrapolated", "front", "judge", "pair_limit", "truths", "worst"]

PAIR_ORDER = 1.0  # assumed where two meshes are all there is


@dataclass(frozen=True, slots=True)
class Truth:
    """What the meshes say of one quantity: limit, observed order, its own uncertainty, error scale."""

    value: float
    order: float | None
    uncertainty: float
    scale: float


@dataclass(frozen=True, slots=True)
class Judged:
    """A setting with what it gave and what it took; times in s, memory in 1e6 bytes.

    Settings are compared by CPU time: a run of the ladder has one thread, so that this is its wall time on a
    free core, and another program beside it does not lengthen it.

    ``error`` holds, for each quantity, distance from the limit plus the limit's own uncertainty over the
    scale; where an effect is left out, what that changes on the same mesh over the scale. ``band`` of a pair
    is the uncertainty of its extrapolation over the scale, without what is known of the limit.
    ``two_cores_s`` is the time with the two meshes of a pair side by side. ``meshes`` are those of a
    finite-element setting, the finer first. ``front`` names the quantities on whose Pareto front it lies.
    """

    name: str
    kind: str
    fidelity: str
    meshes: list[dict[str, Any]]
    tip_size_m: float | None
    value: dict[str, float | None]
    error: dict[str, float | None]
    band: dict[str, float]
    wall_s: float
    cpu_s: float
    two_cores_s: float
    element_steps: int | None
    peak_memory_MB: float | None
    front: list[str] = field(default_factory=list)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return asdict(self)


def extrapolated(fine: float, coarse: float, ratio: float, order: float = PAIR_ORDER) -> float:
    """Return the limit of q_0 + c h^order from two meshes; ``ratio`` is coarse over fine size.

    Examples
    --------
    >>> extrapolated(1.1, 1.2, 2.0)
    1.0
    """
    return float(fine + (fine - coarse) / (ratio**order - 1))


def pair_limit(fine: float, coarse: float, ratio: float) -> tuple[float, float]:
    """Return the first-order limit of two meshes and its half-width.

    The safety factor of a disbelieved order, 3 of the fine mesh's distance from it (Roache's for two grids),
    leaves twice that distance around the limit itself; never less than the two differ by.
    """
    value = extrapolated(fine, coarse, ratio)
    return value, max((UNSURE - 1) * abs(value - fine), abs(fine - coarse))


def truths(runs: Sequence[Outcome], others: Sequence[Outcome] = ()) -> dict[str, Truth]:
    """Return the limit of every quantity from runs on two or more meshes.

    The uncertainty of a limit is what Eca and Hoekstra's band leaves beyond the finest mesh's own
    distance from it. With two meshes the order is assumed, the safety factor is that of a disbelieved fit,
    and the uncertainty is at least the range of all meshes, ``others`` too, a mesh: two that agree by
    chance prove nothing.
    """
    sizes = [run["tip_size_m"] for run in runs]
    finest = runs[sizes.index(min(sizes))]
    found = {}
    for q in QUANTITIES:
        values = [_known(q, run) for run in runs]
        every = values + [_known(q, run) for run in others]
        spread = (max(every) - min(every)) / (len(every) - 1)
        found[q.name] = _truth(q, sizes, values, finest, spread)
    return found


def _known(quantity: Quantity, outcome: Mapping[str, Any]) -> float:
    value = quantity.value(outcome)
    assert value is not None  # a finished finite-element run knows all quantities
    return value


def _truth(
    quantity: Quantity, sizes: list[float], values: list[float], finest: Outcome, spread: float
) -> Truth:
    last = values[sizes.index(min(sizes))]
    if len(sizes) > 2:
        found = limit(sizes, values)
        value, order, band = found.value, found.order, found.band
    else:
        first = values[sizes.index(max(sizes))]
        value, half = pair_limit(last, first, max(sizes) / min(sizes))
        order, band = None, max(half, spread) + abs(value - last)
    least = (SURE - 1) * abs(value - last)
    size = max(abs(value), abs(last))  # an extrapolation towards zero must not inflate every error
    return Truth(value, order, max(band - abs(value - last), least), quantity.scale(size, finest))


def judge(
    setting: Setting,
    runs: Sequence[Outcome],
    truth: Mapping[str, Truth],
    whole: Outcome | None = None,
    every: Sequence[Outcome] = (),
) -> Judged:
    """Return a setting with its errors.

    ``runs`` is one outcome, or fine and coarse of a pair; ``whole`` the outcome with all effects on the same
    mesh if the setting leaves one out: then errors of the mesh must not hide those of the effect. ``every``
    holds the runs of all meshes, whose range bounds the band of a pair from below.
    """
    if whole is not None:
        truth = {q.name: _on_mesh(q, whole, truth[q.name]) for q in QUANTITIES}
    value = {q.name: _value(q, runs) for q in QUANTITIES}
    first = runs[0]
    return Judged(
        name=setting.name,
        kind=setting.kind,
        fidelity=setting.fidelity,
        meshes=[asdict(mesh) for mesh in (setting.mesh, setting.coarser) if mesh],
        tip_size_m=first["tip_size_m"],
        value=value,
        error={name: _error(number, truth[name]) for name, number in value.items()},
        band=_band(runs, every, truth) if len(runs) == 2 else {},
        wall_s=sum(run["wall_s"] for run in runs),
        cpu_s=sum(run["cpu_s"] for run in runs),
        two_cores_s=max(run["cpu_s"] for run in runs),
        element_steps=_total(run["element_steps"] for run in runs),
        peak_memory_MB=max((run["peak_memory_MB"] or 0.0 for run in runs), default=0.0) or None,
    )


def _band(pair: Sequence[Outcome], every: Sequence[Outcome], truth: Mapping[str, Truth]) -> dict[str, float]:
    others = [run for run in every if run not in pair]
    return {name: own.uncertainty / truth[name].scale for name, own in truths(pair, others).items()}


def _on_mesh(quantity: Quantity, whole: Outcome, truth: Truth) -> Truth:
    return Truth(_known(quantity, whole), None, 0.0, truth.scale)


def _value(quantity: Quantity, runs: Sequence[Outcome]) -> float | None:
    values = [quantity.value(run) for run in runs]
    if len(values) == 1 or values[0] is None or values[1] is None:
        return values[0]
    return extrapolated(values[0], values[1], runs[1]["tip_size_m"] / runs[0]["tip_size_m"])


def _error(value: float | None, truth: Truth) -> float | None:
    return None if value is None else (abs(value - truth.value) + truth.uncertainty) / truth.scale


def _total(counts: Iterable[int | None]) -> int | None:
    known = [count for count in counts if count is not None]
    return sum(known) if known else None


def worst(judged: Judged, names: Iterable[str]) -> float:
    """Return the largest error over some quantities; infinite if one is not known."""
    errors = [judged.error[name] for name in names]
    return max(inf if error is None else error for error in errors)


def front(judged: Sequence[Judged], names: Sequence[str]) -> list[Judged]:
    """Return the settings that no other beats in both time and worst error, from cheap to dear.

    A setting that leaves an effect out takes no part: its error is not one against the limit.
    """
    found: list[Judged] = []
    best = inf
    whole = [one for one in judged if one.kind != "effect"]
    for one in sorted(whole, key=lambda j: (j.cpu_s, worst(j, names))):
        if worst(one, names) < best:
            best = worst(one, names)
            found.append(one)
    return found
