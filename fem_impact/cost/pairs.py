"""What two meshes give by extrapolation, with its band, against a target."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fem_impact.cost.judge import Judged

__all__ = ["best_pair", "pair_sentence", "verdict"]

Quantities = Mapping[str, Mapping[str, float]]  # with the scale of each


def best_pair(settings: Sequence[Judged], names: Sequence[str], target: float) -> Judged | None:
    """Return the quickest pair on two cores whose bands meet the target.

    If none does, that of meshes widest apart, the finer if there are two: scatter of the values moves its
    limit least, and a choice by the smallest band would choose agreement by chance.
    """
    pairs = [one for one in settings if one.band]
    good = [one for one in pairs if all(one.band[name] <= target for name in names)]
    if good:
        return min(good, key=lambda one: one.two_cores_s)
    return max(pairs, key=_apart, default=None)


def _apart(pair: Judged) -> tuple[float, int]:
    """Return the ratio of the meshes of a pair, and how fine the finer is."""
    fine, coarse = (mesh["across"] * 2 ** mesh["levels"] for mesh in pair.meshes)
    return fine / coarse, fine


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
    """Return value, band, how much of it is scatter, and whether the band meets the target."""
    value, band, scale = pair.value[name] or 0.0, pair.band[name], quantities[name]["scale"]
    words = "reached" if band <= target else "not reached"
    scatter = f"{pair.scatter[name] * scale:.4f} of it scatter"
    return f"{value:.4f} ± {band * scale:.4f} ({scatter}), {words}: {100 * band:.2g} %"
