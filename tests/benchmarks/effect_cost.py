"""Run time against the set of effects: a ladder on which each rung adds one, timed in contact.

Run ``python tests/benchmarks/effect_cost.py [FOLDER]``: it times t5b at its default mesh in one process and
one thread, prints the table, and writes it as ``effect-cost.csv`` with its chart ``effect-cost.svg`` into a
folder; without one the table goes where ``check`` reads its shares, and the chart to the documentation. The
bare rod stands first and last: an effect that is absent has no item, no array and no branch, so what those
two differ by is noise, and nothing that a row does not name can cost more.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"

from fem_impact.case.case import Case
from fem_impact.case.effects.registry import BARRIERS
from fem_impact.figures.still import PALETTE, QUIET, figure
from fem_impact.files.atomic import write_text
from fem_impact.scene.shipped import load
from fem_impact.scene.types import Scene
from fem_impact.solid.build import build
from fem_impact.solid.march import Observer, advance, evaluate
from fem_impact.solid.model import Model
from fem_impact.tables.table import Table

SCENE, UNTIL = "t5b", 10e-6  # s: in contact, both bodies yield
STEPS, ROUNDS = 20, 15
BARE = "barrier-rigid"
ADDED = (
    *("vibration", "friction", "rod-plasticity", "barrier-elastic", "barrier-elastoplastic"),
    *("rate-hardening", "radiation", "large-rotation", "gravity", "material-damping", "contact-heating"),
)
COLUMNS = ("added", "step_us", "run_s_per_ms", "run_over_bare", "effects")
ROOT = Path(__file__).parents[2]
TABLES, CHARTS = ROOT / "fem_impact" / "plan" / "data", ROOT / "docs" / "pictures"
Row = tuple[str, float, float, float, str]


def ladder() -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield what each rung adds and all its effects; the bare rod once more at the end."""
    effects: tuple[str, ...] = (BARE,)
    yield BARE, effects
    for name in ADDED:
        kept = [e for e in effects if not (name in BARRIERS and e in BARRIERS)]
        effects = (*kept, name)
        yield name, effects
    yield f"{BARE}, again", (BARE,)


class Rung:
    """A model in contact, stepped on a little in every round; the fastest round counts."""

    def __init__(self, scene: Scene, effects: Sequence[str]) -> None:
        stated = replace(scene, measured=None, effects=tuple(effects))
        planned = Case.of(stated)
        self.model = build(planned)
        self.state, self.best = self.model.initial_state(), float("inf")
        while self.state.time < UNTIL:
            evaluate(self.model, self.state)
            advance(self.model, self.state)
        self.observers = list(_heat(self.model)) if planned.slots.heat else []

    def round(self) -> None:
        """Time some steps."""
        begun = time.process_time()
        for _ in range(STEPS):
            evaluate(self.model, self.state)
            for observer in self.observers:
                observer.observe(self.state)
            advance(self.model, self.state)
        self.best = min(self.best, (time.process_time() - begun) / STEPS)


def _heat(model: Model) -> Iterator[Observer]:
    from fem_impact.solid.heatwatch import HeatWatch

    yield HeatWatch(model)


def measured() -> list[Row]:
    """Return the rows of the table and print each; a busy while of the machine hits all rungs alike."""
    scene = load(SCENE)
    rungs = [(added, effects, Rung(scene, effects)) for added, effects in ladder()]
    for _ in range(ROUNDS):
        for _, _, rung in rungs:
            rung.round()
    runs = [rung.best / rung.model.step * 1e-3 for _, _, rung in rungs]
    rows = [
        (added, rung.best * 1e6, run, run / runs[0], " ".join(effects))
        for (added, effects, rung), run in zip(rungs, runs, strict=True)
    ]
    for row in rows:
        print("{:24} {:8.1f} us a step {:8.2f} s a ms {:6.2f} of bare".format(*row[:4]))
    return rows


def draw(rows: Sequence[Row], path: Path) -> None:
    """Draw the run time of each rung."""
    labels = ["rigid rod, rigid plane", *(f"+ {row[0]}" for row in rows[1:-1]), "the first again"]
    with figure(path, 4.2) as drawn:
        axes = drawn.add_subplot()
        bars = axes.barh(range(len(rows)), [row[2] for row in rows], height=0.7, color=PALETTE["blue"])
        for i in (0, -1):
            bars[i].set_color(PALETTE["grey"])
        axes.set_yticks(range(len(rows)), labels)
        axes.bar_label(bars, [f"{row[3]:.2f} x" for row in rows], padding=4, fontsize=8.5)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.margins(x=0.1)
        axes.grid(axis="x")
        axes.set_xlabel(f"CPU time of 1 ms of motion, s ({SCENE}, default mesh, in contact)", color=QUIET)


def main(folder: Path | None = None) -> None:
    """Time, write, draw."""
    rows = measured()
    draw(rows, (folder or CHARTS) / "effect-cost.svg")
    write_text((folder or TABLES) / "effect-cost.csv", Table.of(COLUMNS, rows).csv())


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
