"""Files that a mesh file takes parts of its text or its numbers from."""

import re
from pathlib import Path

from meshes.errors import MeshError

__all__ = ["full_text", "included"]

# the line that takes another file, by the program; the names of the files follow
LINES = {
    "abaqus": re.compile(r"^[ \t]*\*INCLUDE[ \t]*,[ \t]*INPUT[ \t]*=[ \t]*([^,\n]+)[^\n]*$", re.I | re.M),
    "nastran": re.compile(r"^INCLUDE[ \t]+['\"]?([^'\"\n]+)['\"]?[^\n]*$", re.I | re.M),
    "radioss": re.compile(r"^#include[ \t]+([^\n]+)$", re.M),
    "lsdyna": re.compile(r"^\*INCLUDE[ \t]*\n((?:\$[^\n]*\n|[^\n*$][^\n]*\n?)+)", re.I | re.M),
}
ENDINGS = {
    "abaqus": (".inp",),
    "nastran": (".bdf", ".nas", ".fem", ".dat"),
    "radioss": (".rad",),
    "lsdyna": (".k", ".key", ".dyn"),
}
XDMF = re.compile(r">\s*([^<>:]+\.h5):")


def full_text(path: Path, program: str, within: tuple[Path, ...] = ()) -> str:
    """Return the text of a deck with that of the files it includes in their places.

    The files ``within`` which it stands are those that include it.

    Raises
    ------
    MeshError
        If one of them is not there, or they include each other.
    """
    if path.resolve() in within:
        raise MeshError(f"includes the file {path.name!r} within itself. Leave that line out.")

    def put_in(match: re.Match[str]) -> str:
        inner = (*within, path.resolve())
        return "\n".join(full_text(other, program, inner) for other in _named(match, path))

    return LINES[program].sub(put_in, path.read_text(encoding="latin-1"))


def _named(match: re.Match[str], path: Path) -> list[Path]:
    """Return the files that a line names, as seen from the file in which it stands."""
    names = [line.strip().strip("'\"") for line in match[1].splitlines() if line[:1] != "$"]
    found = [path.parent / name.replace("\\", "/") for name in names if name]
    for other in found:
        if not other.is_file():
            raise MeshError(
                f"takes a part from the file {other.name!r}, which is not beside it. Put it there, or leave "
                "the line out if it holds no nodes or cells."
            )
    return found


def included(path: Path, within: tuple[Path, ...] = ()) -> list[Path]:
    """Return the files that a mesh file takes parts from, those that are there; see `full_text`."""
    ending = path.suffix.lower()
    programs = [program for program, endings in ENDINGS.items() if ending in endings]
    if ending in (".xdmf", ".xmf"):
        names = sorted(set(XDMF.findall(path.read_text(encoding="latin-1"))))
        return [path.parent / name.strip() for name in names if (path.parent / name.strip()).is_file()]
    if not programs or path.resolve() in within:
        return []
    found: list[Path] = []
    for match in LINES[programs[0]].finditer(path.read_text(encoding="latin-1")):
        try:
            others = _named(match, path)
        except MeshError:
            continue  # told by the reader
        for other in others:
            found += [other, *included(other, (*within, path.resolve()))]
    return found
