"""What was measured before and ships with the package: costs, shares of the effects; this machine's pace."""

import csv
import json
import time
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from importlib.resources import files
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as sp

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
    their scales (`fem_impact.answers.verdict.reliability`); nan where one model does not know a number.
    ``fem-impact study coverage`` makes the table, of a seed and the measured sets: its sheet ``changes``.
    """
    return _rows("changes.csv")


def _rows(name: str) -> tuple[dict[str, float], ...]:
    rows = csv.DictReader(_data(name).splitlines())
    return tuple({key: float(text or "nan") for key, text in row.items() if key != "scene"} for row in rows)


def _data(name: str) -> str:
    return files("fem_impact.case").joinpath("data", name).read_text(encoding="utf-8")


NODES = (21, 21, 41)  # of the box whose stiffness pattern is multiplied: about 54 000 unknowns


@cache
def yardsticks() -> dict[str, float]:
    """Return triad bandwidth, GB/s, and a CSR product, ns an element-step, on one core."""
    return {"triad_GB_per_s": round(_triad(), 2), "csr_ns_per_element_step": round(_csr(), 1)}


def _least(work: Callable[[], object], repeats: int) -> float:
    """Return the smallest wall time of one call, s: the others were disturbed."""
    times = []
    for _ in range(repeats):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return min(times)


def _triad() -> float:
    b, c, a = (np.ones(4_000_000) for _ in range(3))

    def triad() -> None:
        np.multiply(c, 3.0, out=a)
        np.add(a, b, out=a)

    return 5 * 8 * len(a) / _least(triad, 7) / 1e9


def _csr() -> float:
    """Time K x for the pattern of trilinear elements on a box, three unknowns a node."""
    pattern = sp.identity(1, format="csr")
    for n in NODES:
        pattern = sp.kron(pattern, sp.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(n, n)), format="csr")
    K = sp.kron(pattern, np.ones((3, 3)), format="csr")
    x, elements = np.ones(K.shape[0]), np.prod([n - 1 for n in NODES])
    return float(_least(lambda: K @ x, 9) / elements * 1e9)
