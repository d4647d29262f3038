"""What two meshes give by extrapolation, with its band, against a target."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fem_impact.cost.judge import Judged

__all__ = ["best_pair", "pair_sentence", "verdict"]

Quantities = Mapping[str, Mapping[str, float]]  # with the scale of each


def best_pair(settings: Sequence[Judged], names: Sequence[str], target: float) -> Judged | None:
    """Return the quickest pair on two cores whose bands meet the target, else that with the least band."""
    pairs = [one for one in settings if one.band]
    open_by = {one.name: max(one.band[name] for name in names) for one in pairs}
    good = [one for one in pairs if open_by[one.name] <= target]
    if good:
        return min(good, key=lambda one: one.two_cores_s)
    return min(pairs, key=lambda one: open_by[one.name], default=None)


def pair_sentence(
    settings: Sequence[Judged], quantities: Quantities, names: Sequence[str], target: float
) -> str:
    """Say what the best pair gives for every quantity that is asked for."""
    pair = best_pair(settings, names, target)
    if pair is None:
        return "No two meshes gave a result."
    found = "; ".join(f"{name} {verdict(pair, quantities, name, target)}" for name in names)
    took = f"{pair.two_cores_s:.3g} s on two cores"
    return f"Two meshes against {100 * target:.3g} %, {pair.name}: {found}; {took}."


def verdict(pair: Judged, quantities: Quantities, name: str, target: float) -> str:
    """Return value, band, and whether the band meets the target."""
    value, band = pair.value[name] or 0.0, pair.band[name]
    words = "reached" if band <= target else "not reached"
    return f"{value:.4f} ± {band * quantities[name]['scale']:.4f}, {words}: {100 * band:.2g} %"
