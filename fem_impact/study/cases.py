"""One case of a study: a scene and a place for its results, computed once and never again."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.errors import FemImpactError
from fem_impact.output import make_directory, write_text

if TYPE_CHECKING:
    from fem_impact.outcome import Outcome
    from fem_impact.scene import Scene

STAMP = "computed-by.txt"
# parts of fem_impact that make numbers; reports and pictures may change without a new run
NUMERIC = ("effects", "modes", "scene", "solid", "estimates.py", "markers.py", "reduce.py")


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


@cache
def source_digest() -> str:
    """Return a digest of the sources that make numbers: another program never reads a stale result."""
    digest = hashlib.sha256()
    for path in _sources():
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _sources() -> list[Path]:
    import fem_impact
    import meshes
    import rigid

    top = Path(str(fem_impact.__file__)).parent
    packages = [
        Path(str(meshes.__file__)).parent,
        Path(str(rigid.__file__)).parent,
        *(top / n for n in NUMERIC),
    ]
    kinds = {".py", ".toml", ".csv"}
    found = [f for place in packages for f in (sorted(place.rglob("*")) if place.is_dir() else [place])]
    return [f for f in found if f.suffix in kinds]


def stamp(scene: Scene) -> str:
    """Return what a stored result must have been computed from."""
    return f"scene {scene.digest()}\nsources {source_digest()}\n"


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
