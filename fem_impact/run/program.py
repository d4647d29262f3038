"""Identity of the program: the digest of its sources and libraries, and the stamp of stored results."""

import hashlib
from collections.abc import Iterator
from functools import cache
from importlib import metadata
from importlib.resources import files
from importlib.resources.abc import Traversable

from fem_impact.plugins import providers
from fem_impact.scene.types import Scene, digest

ROOMS = (
    *("fem_impact/scene", "fem_impact/physics", "fem_impact/case", "fem_impact/fem", "fem_impact/solid"),
    *("fem_impact/modal", "fem_impact/run", "fem_impact/outcome", "meshes", "rigid"),
    *("fem_impact/answers/refine", "fem_impact/answers/simulate.py"),
)
"""Packages and modules whose code determines the numbers of an outcome."""
DATA = (
    *("fem_impact/scene/data", "fem_impact/case/data/effects.toml", "fem_impact/case/data/summary.json"),
    "rigid/experiments/data",
)
"""Files, and folders of files, that this code reads (expected times of effects are no result)."""
KINDS = (".toml", ".csv", ".json")
LIBRARIES = ("numpy", "scipy", "scikit-fem", "numba", "llvmlite")


@cache
def source_digest() -> str:
    """Return the SHA-256 of sources and library versions, to which stored results are bound."""
    digest = hashlib.sha256()
    for name, file in _sources().items():
        digest.update(name.encode())
        digest.update(file.read_bytes())
    for library in LIBRARIES:
        digest.update(f"{library} {metadata.version(library)}\n".encode())
    for package, version in providers().items():
        digest.update(f"{package} {version}\n".encode())
    return digest.hexdigest()


def _sources() -> dict[str, Traversable]:
    """Return every source and data file that can change a number, by its path from the packages."""
    code = {name: file for room in ROOMS for name, file in _files(room) if name.endswith(".py")}
    data = {name: file for place in DATA for name, file in _files(place) if name.endswith(KINDS)}
    return code | data


def _files(place: str) -> Iterator[tuple[str, Traversable]]:
    """Yield the file at a path such as ``rigid/massive.py``, or all files below it, sorted by name."""
    package, *rest = place.split("/")
    entry = files(package).joinpath(*rest)
    if entry.is_file():
        yield place, entry
        return
    for name in sorted(child.name for child in entry.iterdir()):
        yield from _files(f"{place}/{name}")


def stamp(scene: Scene) -> str:
    """Return the stamp of a stored result: digests of its scene and of the program."""
    return f"scene {digest(scene)}\nsources {source_digest()}\n"
