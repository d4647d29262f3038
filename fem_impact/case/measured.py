"""What was measured before and ships with the package: costs, shares of the effects."""

import csv
import json
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files
from itertools import pairwise
from typing import Any

CONFIDENCE = 0.9
"""Probability with which a limit from stored scenes holds the share of all scenes that it is to hold."""
UNDER = {"barrier-elastoplastic": "barrier-elastic"}  # a block that yields is an elastic one first


def expected_shares(active: Iterable[str]) -> dict[str, float]:
    """Return the share of a step of each of the effects in a model that was measured.

    What each effect added to a step of t5b at its default mesh (``tests/benchmarks/effect_cost.py``) over the
    sum of what the effects of this model added, and the rigid rod's nose: so about for other meshes. They are
    added in the order of their names: a set has another one in each process.
    """
    added = _added()
    took = {
        name: added[name] + added.get(UNDER.get(name, ""), 0.0) for name in sorted(active) if name in added
    }
    whole = added["nose"] + sum(took.values())
    return {name: time / whole for name, time in took.items()}


@cache
def _added() -> Mapping[str, float]:
    """Return what each effect adds to a step, us; the first rung is the nose on a rigid plane."""
    text = _data("effect-cost.csv")
    steps = [(row["added"], float(row["step_us"])) for row in csv.DictReader(text.splitlines())]
    rises = {name: max(now - before, 0.0) for (_, before), (name, now) in pairwise(steps)}
    return {"nose": steps[0][1], "barrier-rigid": 0.0, **rises}


@cache
def summary() -> dict[str, Any]:
    """Return the costs that ship with the package, as `fem-impact cost paper` stored them."""
    return dict(json.loads(_data("summary.json")))


@cache
def reduced_pairs() -> tuple[dict[str, float], ...]:
    """Return a row a scene that ran by the reduced model and by finite elements.

    It holds where the scene stands, and by how much numbers of the reduced model differ, over their scales
    (`fem_impact.run.modal_error`); nan where one model does not know a number. ``fem-impact study coverage``
    makes the table: its sheet ``pairs``.
    """
    return _rows("pairs.csv")


@cache
def vibration_pairs() -> tuple[dict[str, float], ...]:
    """Return a row a scene that ran by both models, with vibration and without it.

    It holds where the scene stands, and by how much changes by vibration of the reduced model differ, over
    their scales (`fem_impact.answers.verdict.vibration`); nan where one model does not know a number.
    ``fem-impact study coverage`` makes the table, of a seed and the measured sets: its sheet ``changes``.
    """
    return _rows("changes.csv")


@cache
def needed_half_widths() -> dict[str, dict[str, float]]:
    """Return what half-widths of levels need, by the key of a number, see `fem_impact.answers.refine.needed`.

    It holds the number of scenes, and ``times`` and ``share``. ``fem-impact study coverage`` makes the table:
    its sheet ``level-bands``.
    """
    rows = csv.DictReader(_data("level-bands.csv").splitlines())
    return {row.pop("key"): {name: float(text) for name, text in row.items()} for row in rows}


def tolerance_rank(count: int, share: float, confidence: float = CONFIDENCE) -> int:
    """Return which of ``count`` values, counted from 1 in ascending order, a ``share`` of all lie below.

    It is the least of which that is so with this ``confidence``, whatever the distribution (Wilks 1941,
    doi:10.1214/aoms/1177731788); the last where it is so of none.

    Examples
    --------
    >>> tolerance_rank(45, 0.95), tolerance_rank(222, 0.95), tolerance_rank(800, 0.9)
    (45, 216, 732)
    """
    beyond, exactly = 0, share**count  # chance that exactly so many of the values lie beyond the share
    chance = exactly
    while True:
        exactly *= (count - beyond) / (beyond + 1) * (1.0 - share) / share
        chance += exactly
        if beyond == count or chance > 1.0 - confidence:
            return count - beyond
        beyond += 1


def _rows(name: str) -> tuple[dict[str, float], ...]:
    rows = csv.DictReader(_data(name).splitlines())
    return tuple({key: float(text or "nan") for key, text in row.items() if key != "scene"} for row in rows)


def _data(name: str) -> str:
    return files("fem_impact.case").joinpath("data", name).read_text(encoding="utf-8")
