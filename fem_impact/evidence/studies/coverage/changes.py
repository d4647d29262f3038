"""Changes by vibration, reduced model beside finite elements, of drawn scenes and the measured sets."""

from collections.abc import Iterator, Mapping, Sequence
from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory

from fem_impact.answers.report import Sheet
from fem_impact.answers.verdict.effect import Pair, difference, modal_pair, unfinished
from fem_impact.answers.verdict.reliability import CHANGED, scale_of_change
from fem_impact.case.case import Case
from fem_impact.case.measured import summary
from fem_impact.evidence.studies.coverage.judge import Results
from fem_impact.evidence.studies.coverage.run import TWINS
from fem_impact.evidence.studies.coverage.scenes import DrawnScene
from fem_impact.run.modal_error import Place, place_of
from fem_impact.scene.read import read_dict
from fem_impact.scene.types import Scene
from fem_impact.tables.table import Cell, Table

KNOWN = 0.06
"""Widest half-width of finite elements that tells an error of a change by vibration."""
SUMS: Mapping[str, Mapping[str, float]] = {
    "e": {"e": 1.0},
    "energy": {"E_lt": -1.0, "E_ln": -1.0},
    "friction": {"friction": 1.0},
}
"""The numbers of `CHANGED` as sums of what the costs of the measured sets store."""
Changes = Mapping[str, tuple[float, float]]
"""Change by vibration and half-width by finite elements, by the numbers of `CHANGED`."""


def changes(scenes: Sequence[DrawnScene], results: Results) -> Sheet:
    """Return where each scene stands that ran with a twin, and by how much the changes by vibration differ.

    A copy, of two seeds, stands in ``fem_impact/case/data/changes.csv``: by it the reduced model's error of a
    change is told. Changes that finite elements know within `KNOWN` count.
    """
    rows: list[tuple[Cell, ...]] = []
    with TemporaryDirectory() as folder:
        drawn = (
            (one.name, one.scene(Path(folder)), results[one.name, TWINS].changes)
            for one in scenes
            if (one.name, TWINS) in results
        )
        for name, scene, solid in (*drawn, *_of_sets()):
            pair = modal_pair(scene)
            errors = [_error(pair, of, solid) for of in CHANGED]
            if any(error is not None for error in errors):
                numbers = *place_of(Case(scene), pair[0]), *errors
                rows.append((name, *(None if one is None else round(one, 5) for one in numbers)))
    caption = "Where scenes with a twin stand, and changes by vibration: reduced model less finite elements"
    return Sheet("changes", caption, Table.of(("scene", *Place._fields, *CHANGED), rows), shown=False)


def _error(pair: Pair, of: str, solid: Changes) -> float | None:
    """Return by how much the reduced model's change is off, over its scale; None where it is not known."""
    value, half = solid.get(of, (0.0, inf))
    if half > KNOWN or unfinished(pair, of):
        return None
    change = difference(pair, of)
    return (change - value) / scale_of_change(change)


def _of_sets() -> Iterator[tuple[str, Scene, Changes]]:
    """Yield the measured sets with the changes that their stored default runs show."""
    for name, stored in summary()["scenes"].items():
        run = next(one for one in stored["settings"] if one["default"])
        stiff = next(one for one in stored["settings"] if one["name"] == "default run without vibration")
        value, error = run["value"], run["error"]
        solid = {
            of: (
                sum(sign * (value[part] - stiff["value"][part]) for part, sign in parts.items()),
                abs(sum(sign * error[part] * abs(value[part]) for part, sign in parts.items())),
            )
            for of, parts in SUMS.items()
        }
        yield name, read_dict(stored["scene"]), solid
