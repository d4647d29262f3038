"""One case of a study: a scene and a place for its results, computed once and never again."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.errors import FemImpactError
from fem_impact.output import make_directory, write_text
from fem_impact.sources import stamp

if TYPE_CHECKING:
    from fem_impact.outcome import Outcome
    from fem_impact.scene import Scene

STAMP = "computed-by.txt"


@dataclass(frozen=True, slots=True)
class Case:
    """A scene to run into a directory."""

    scene: Scene
    out: Path


@dataclass(frozen=True, slots=True)
class Failure:
    """A case that could not be finished, and why."""

    case: Case
    reason: str


def stored(case: Case) -> Outcome | None:
    """Return the finished result of a case if it is there and belongs to this scene and program."""
    from fem_impact.outcome import Outcome

    mark, result = case.out / STAMP, case.out / "outcome.json"
    if not (mark.is_file() and result.is_file()) or mark.read_text(encoding="utf-8") != stamp(case.scene):
        return None
    try:
        return Outcome.read(result)
    except FemImpactError:
        return None


def compute(case: Case) -> Failure | None:
    """Run a case in this process with one thread and leave its result in its directory.

    A failure is a value, so that a study goes on.
    """
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    from fem_impact.simulate import simulate

    make_directory(case.out)
    (case.out / STAMP).unlink(missing_ok=True)
    mark = stamp(case.scene)  # of the program that runs, not of what lies there when it is done
    try:
        simulate(case.scene, out=case.out)
    except Exception as error:  # whatever went wrong, the other cases of the study go on
        return Failure(case, str(error) if isinstance(error, FemImpactError) else repr(error))
    # written last: a result without its stamp is computed again
    write_text(case.out / STAMP, mark)
    return None
