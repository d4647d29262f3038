"""Time of a step against the set of effects, in contact, beside the bare rod on a rigid plane.

Run ``python tests/benchmarks/effect_cost.py [SCENE]``; all rows come from one process and one thread. The
same set stands twice, first and last: an effect that is absent has no item, no array and no branch, so what
those two rows differ by is the noise, and nothing that is not named in a row can cost more.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Sequence
from dataclasses import replace

os.environ["OPENBLAS_NUM_THREADS"] = "1"

from fem_impact.effects import specify
from fem_impact.scene import Scene, load, replace_all
from fem_impact.solid.build import build
from fem_impact.solid.heatwatch import HeatWatch
from fem_impact.solid.march import Observer, advance, evaluate

STEPS, REPEATS = 60, 5
FULL = ("friction", "rod-plasticity", "barrier-elastoplastic", "radiation", "large-rotation")
SETS = (
    ("barrier-rigid",),
    ("vibration", "barrier-rigid"),
    ("vibration", "friction", "barrier-rigid"),
    ("vibration", "barrier-rigid", "gravity"),
    ("vibration", "barrier-rigid", "large-rotation"),
    ("vibration", "barrier-rigid", "material-damping"),
    ("vibration", "friction", "barrier-rigid", "contact-heating"),
    ("vibration", "rod-plasticity", "barrier-rigid"),
    ("vibration", "rod-plasticity", "barrier-rigid", "rate-hardening"),
    ("vibration", "barrier-elastic"),
    ("vibration", "barrier-elastic", "radiation"),
    ("vibration", "barrier-elastoplastic"),
    FULL,
    ("vibration", *FULL),
    ("vibration", *FULL, "rate-hardening"),
    ("vibration", *FULL, "rate-hardening", "gravity", "material-damping", "contact-heating"),
    ("barrier-rigid",),
)


def step_time(scene: Scene, effects: Sequence[str], until: float) -> float:
    """Return the smallest mean CPU time of a step, s, from the time ``until``, s, on."""
    spec = specify(replace(scene, effects=tuple(effects)))
    model = build(replace(scene, effects=tuple(effects)), spec)
    observers: list[Observer] = [HeatWatch(model)] if spec.heat else []
    state, best = model.initial_state(), float("inf")
    while state.time < until or state.step < 50:
        evaluate(model, state)
        advance(model, state)
    for _ in range(REPEATS):
        begun = time.process_time()
        for _ in range(STEPS):
            evaluate(model, state)
            for observer in observers:
                observer.observe(state)
            advance(model, state)
        best = min(best, (time.process_time() - begun) / STEPS)
    return best


def main(name: str = "quick") -> None:
    """Print the table."""
    scene = replace_all(load(name), {"accuracy.tip_size": "0.8 mm"})
    bare = None
    print(f"{'us a step':>10} {'of bare':>8}  effects")
    for effects in SETS:
        found = step_time(scene, effects, 10e-6)
        bare = bare or found
        print(f"{found * 1e6:10.1f} {found / bare:8.2f}  {', '.join(effects)}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:2])
