"""About what share of the run time each effect takes, before a run: from a ladder of measured steps."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files
from itertools import pairwise

__all__ = ["expected_shares"]

UNDER = {"barrier-elastoplastic": "barrier-elastic"}  # a block that yields is an elastic one first


def expected_shares(active: Iterable[str]) -> dict[str, float]:
    """Return the share of a step of each of the effects in a model that was measured.

    What each effect added to a step of t5b at its default mesh (``tests/benchmarks/effect_cost.py``) over the
    sum of what the effects of this model added, and the rigid rod's nose: so about for other meshes.
    """
    added = _added()
    took = {name: added[name] + added.get(UNDER.get(name, ""), 0.0) for name in active if name in added}
    whole = added["nose"] + sum(took.values())
    return {name: time / whole for name, time in took.items()}


@cache
def _added() -> Mapping[str, float]:
    """Return what each effect adds to a step, us; the first rung is the nose on a rigid plane."""
    text = files("fem_impact.effects").joinpath("data", "effect-cost.csv").read_text(encoding="utf-8")
    steps = [(row["added"], float(row["step_us"])) for row in csv.DictReader(text.splitlines())]
    rises = {name: max(now - before, 0.0) for (_, before), (name, now) in pairwise(steps)}
    return {"nose": steps[0][1], "barrier-rigid": 0.0, **rises}
