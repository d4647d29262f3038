"""The text of mesh files: files that they include, keywords, fields, numbers."""

import re
from collections.abc import Iterable, Iterator
from itertools import accumulate, pairwise
from math import inf
from pathlib import Path

from meshes.common import MeshError

# the line that takes another file, by the program; the names of the files follow. Of Abaqus also a keyword
# whose lines of data stand in a file
LINES = {
    "abaqus": re.compile(
        r"^[ \t]*\*(?:INCLUDE|NODE|ELEMENT|ELSET|NSET)[ \t]*,[^\n*]*?\bINPUT[ \t]*=[ \t]*([^,\n]+)[^\n]*$",
        re.I | re.M,
    ),
    "nastran": re.compile(r"^[ \t]*INCLUDE[ \t]+['\"]?([^'\"\n]+)['\"]?[^\n]*$", re.I | re.M),
    "radioss": re.compile(r"^#include[ \t]+([^\n]+)$", re.M),
    "lsdyna": re.compile(r"^\*INCLUDE[ \t]*\n((?:\$[^\n]*\n|[^\n*$][^\n]*\n?)+)", re.I | re.M),
}
ENDINGS = {
    "abaqus": (".inp",),
    "nastran": (".bdf", ".nas", ".fem", ".dat"),
    "radioss": (".rad",),
    "lsdyna": (".k", ".key", ".dyn"),
}
INCLUDE = re.compile(r"\W*INCLUDE\b", re.I)
INPUT = re.compile(r",[ \t]*INPUT[ \t]*=[^,\n]*", re.I)
# files that another holds the names of, by the beginning of its ending
HOLDS = {".xdmf": re.compile(r">\s*([^<>:]+\.h5):")}
HOLDS[".xmf"] = HOLDS[".xdmf"]
HOLDS |= dict.fromkeys((".pvt", ".vtm"), re.compile(r"\b(?:Source|file)=\"([^\"]+)\""))
MOST = 10**7  # numbers in a range
# a number, of which Fortran may leave the E of the exponent out
NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:E([+-]?\d+)|(?<=[\d.])([+-]\d+))?")


def decoded(data: bytes) -> str:
    """Return text of UTF-8, or of one byte a letter, with lines that end in a line feed alone."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def lines_of(path: Path, program: str = "") -> list[str]:
    """Return the lines of a deck; those of the files that a ``program`` includes stand in their places.

    Not by `str.splitlines`, which takes letters of comments for ends of lines.

    Raises
    ------
    MeshError
        If one of these files is not there, or they include each other.
    """
    return _full_text(path, program, ()).split("\n")


def _full_text(path: Path, program: str, within: tuple[Path, ...]) -> str:
    """Return the text of a deck that stands ``within`` those that include it."""
    if path.resolve() in within:
        raise MeshError(f"includes the file {path.name!r} within itself. Leave that line out.")

    def put_in(match: re.Match[str]) -> str:
        inner = (*within, path.resolve())
        keyword = "" if INCLUDE.match(match[0]) else INPUT.sub("", match[0])
        texts = (_full_text(other, program, inner) for other in _named(match, path))
        return "\n".join(part for part in (keyword, *texts) if part)

    text = decoded(path.read_bytes())
    return LINES[program].sub(put_in, text) if program else text


def _named(match: re.Match[str], path: Path) -> list[Path]:
    """Return the files that a line names, as seen from the file in which it stands."""
    names = [line.strip().strip("'\"") for line in match[1].split("\n") if line[:1] != "$"]
    found = [path.parent / name.replace("\\", "/") for name in names if name]
    for other in found:
        if not other.is_file():
            raise MeshError(
                f"takes a part from the file {other.name!r}, which is not beside it. Put it there, or leave "
                "the line out if it holds no nodes or cells."
            )
    return found


def included(path: Path, within: tuple[Path, ...] = ()) -> list[Path]:
    """Return the files that a mesh file takes parts from, those that are there; see `lines_of`."""
    ending = path.suffix.lower()
    programs = [program for program, endings in ENDINGS.items() if ending in endings]
    if kind := next((one for one in HOLDS if ending.startswith(one)), ""):
        names = sorted(set(HOLDS[kind].findall(decoded(path.read_bytes()))))
        return [path.parent / name.strip() for name in names if (path.parent / name.strip()).is_file()]
    if not programs or path.resolve() in within:
        return []
    found: list[Path] = []
    for match in LINES[programs[0]].finditer(decoded(path.read_bytes())):
        try:
            others = _named(match, path)
        except MeshError:
            continue  # told by the reader
        for other in others:
            found += [other, *included(other, (*within, path.resolve()))]
    return found


def sections(lines: Iterable[str], mark: str, comment: str) -> Iterator[tuple[str, list[str]]]:
    """Yield each keyword in capitals, without its ``mark``, and its lines but comments.

    A blank line is "": it may be a title, or numbers that are all 0.
    """
    name, held = "", list[str]()
    for line in lines:
        if line.startswith(comment):
            continue
        if not line.startswith(mark):
            held.append(line.rstrip())
            continue
        if name:
            yield name, held
        name, held = line[len(mark) :].strip().upper(), []
    if name:
        yield name, held


def fixed_fields(line: str, widths: list[int]) -> list[str]:
    """Return the fields of a line by their widths in letters."""
    return [line[low:high].strip() for low, high in pairwise(accumulate(widths, initial=0))]


def number_of(text: str, where: str) -> float:
    """Return a number of a deck, "1.5-3", "2.D+4" and blanks, which are 0, included.

    Raises
    ------
    MeshError
        If it is none; ``where`` says what it belongs to.
    """
    bare = text.strip().upper().replace("D", "E")
    found = NUMBER.fullmatch(bare or "0")
    number = float(f"{found[1]}E{found[2] or found[3] or 0}") if found else inf
    if abs(number) == inf:
        raise MeshError(f"has {text.strip()!r} for a number of {where}.")
    return number


def place_of(texts: list[str], node: object) -> tuple[float, ...]:
    """Return the place (3,) of a node; a coordinate that is left out is 0.

    Raises
    ------
    MeshError
        As `number_of`.
    """
    return tuple(number_of(text, f"node {node}") for text in (*texts, "", "", "")[:3])


def numbers_between(low: int, high: int, step: int, where: str) -> range:
    """Return the whole numbers of a range that a deck states, both ends included.

    Raises
    ------
    MeshError
        If they are no range, or more than a mesh has; ``where`` says what they belong to.
    """
    if step < 1 or (high - low) // step > MOST:
        raise MeshError(f"has {low} to {high} in steps of {step} for a range of numbers of {where}.")
    return range(low, high + 1, step)


def whole_number(text: str, where: str) -> int:
    """Return a whole number of a deck.

    Raises
    ------
    MeshError
        If it is none; ``where`` says what it belongs to.
    """
    try:
        return int(text)
    except ValueError:
        raise MeshError(f"has {text.strip()!r} for a whole number of {where}.") from None
