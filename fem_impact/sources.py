"""Which program computes: a digest of the sources that make numbers, and the stamp of what they made."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["source_digest", "stamp"]

# parts of fem_impact that make numbers; reports and pictures may change without a new run
NUMERIC = ("effects", "modes", "scene", "solid", "estimates.py", "markers.py", "reduce.py")


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
