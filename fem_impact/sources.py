"""Which program computes: a digest of its sources and libraries, and the stamp of what they made."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["source_digest", "stamp"]

# parts of fem_impact that make no numbers: they may change without a new run
TELLING = frozenset({"cost", "figures", "paper", "render", "report", "scale", "stress", "study", "verify"})
TELLING_FILES = ("cli", "progress", "__main__")
LIBRARIES = ("numpy", "scipy", "scikit-fem", "numba", "llvmlite")
KINDS = {".py", ".toml", ".csv", ".json"}


@cache
def source_digest() -> str:
    """Return a digest of sources and library versions: another program never reads a stale result."""
    digest = hashlib.sha256()
    for name, path in _sources().items():
        digest.update(name.encode())
        digest.update(path.read_bytes())
    for library in LIBRARIES:
        digest.update(f"{library} {metadata.version(library)}\n".encode())
    return digest.hexdigest()


def _sources() -> dict[str, Path]:
    """Return every source and data file that can change a number, by its name within the packages."""
    import fem_impact
    import meshes
    import rigid

    found: dict[str, Path] = {}
    for package in (fem_impact, meshes, rigid):
        top = Path(str(package.__file__)).parent
        files = sorted(path for path in top.rglob("*") if path.suffix in KINDS)
        found |= {f"{top.name}/{path.relative_to(top).as_posix()}": path for path in files}
    return {name: path for name, path in found.items() if _computes(name)}


def _computes(name: str) -> bool:
    package, first, *_ = name.split("/")
    return package != "fem_impact" or not (first in TELLING or first.startswith(TELLING_FILES))


def stamp(scene: Scene) -> str:
    """Return what a stored result must have been computed from."""
    return f"scene {scene.digest()}\nsources {source_digest()}\n"
