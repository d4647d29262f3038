"""The points of the design chart: change of e and energy of vibration of many rods, by the reduced model.

Run ``python tests/benchmarks/design_chart.py`` (about 3 min of processor time): it computes rods of three
diameters and three metals, elastic and yielding, at five inclinations and four coefficients of friction, each
beside its twin that cannot vibrate, and writes ``fem_impact/answers/verdict/data/design-chart.csv``, which
`assess` draws. Its first line says when and by which commit it was made.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from math import cos, radians, sin
from pathlib import Path

from fem_impact.answers.verdict.chart import COLUMNS, TABLE
from fem_impact.answers.verdict.screening import screening
from fem_impact.answers.verdict.vibration import modal_pair, unfinished
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.evidence.studies.rods import BODY, TIP, length_of
from fem_impact.files.atomic import write_text
from fem_impact.outcome.keys import known
from fem_impact.outcome.record import utc_now
from fem_impact.scene.impact import Impact
from fem_impact.scene.library import materials
from fem_impact.scene.material import Surface
from fem_impact.scene.shipped import load
from fem_impact.scene.types import Scene
from fem_impact.tables.table import Table

ROOT = Path(__file__).parents[2]
GAMMAS, DIAMETERS, ANGLES = (
    (10.0, 14.0, 20.0, 26.45, 36.0, 57.0),
    (0.012, BODY, 0.030),
    (10.0, 25.0, 45.0, 60.0, 75.0),
)
FRICTIONS, SPEED = (0.0, 0.2, 0.4, 0.57), 2.1
OTHER_METALS = ("aluminium-6061-t6", "tungsten-heavy-alloy")
ELASTIC = ("auto", "-rod-plasticity", "barrier-elastic", "-gravity")
YIELDING = ("auto", "-gravity")


def cases() -> Iterator[tuple[tuple[object, ...], Scene]]:
    """Yield what names a point, and its scene."""
    steel = "rod-steel"
    for effects, diameter, gamma, angle, f in product(
        (YIELDING, ELASTIC), DIAMETERS, GAMMAS, ANGLES, FRICTIONS
    ):
        yield case(effects, steel, diameter, gamma, angle, f)
    for metal, gamma, angle in product(OTHER_METALS, GAMMAS, ANGLES):
        yield case(YIELDING, metal, BODY, gamma, angle, 0.4)


def case(
    effects: tuple[str, ...], metal: str, diameter: float, gamma: float, angle: float, f: float
) -> tuple[tuple[object, ...], Scene]:
    """Return what names a point, and its scene: a rod of tip B on the plate of the measured sets."""
    base, alpha = load("t5b"), radians(angle)
    rod = replace(
        base.projectile,
        length=length_of(gamma, diameter),
        diameter=diameter,
        tip_radius=TIP * diameter / BODY,
        material=materials()[metal],
    )
    scene = replace(
        base,
        projectile=rod,
        surface=Surface("custom", f, f, f, "point of the design chart"),
        impact=Impact(alpha, -SPEED * cos(alpha), -SPEED * sin(alpha)),
        effects=effects,
        measured=None,
    )
    kind = "yielding" if effects == YIELDING else "elastic"
    return (kind, metal, diameter, gamma, angle, f), scene


def rows() -> Iterator[tuple[object, ...]]:
    """Yield the rows of the table; what the reduced model cannot compute is left out."""
    for name, scene in cases():
        try:
            pair = modal_pair(scene)
        except SceneError:
            continue
        if not unfinished(pair):
            free, stiff = pair
            change = known(free.restitution.edge.e) - known(stiff.restitution.edge.e)
            ratio = screening(Case(scene).bodies).ratio
            numbers = ratio, known(free.restitution.mu), change, known(free.energy.vibration)
            yield (*name, *(float(f"{number:.5g}") for number in numbers))


if __name__ == "__main__":
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"], capture_output=True, text=True, cwd=ROOT
    )
    made = f"# made {utc_now()} by tests/benchmarks/design_chart.py, commit {commit.stdout.strip()}\n"
    write_text(
        ROOT / "fem_impact" / "answers" / "verdict" / "data" / TABLE,
        made + Table.of(COLUMNS, list(rows())).csv(),
    )
