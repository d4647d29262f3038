"""Binary files of Gmsh of the versions 2 and 4.1, as the lines of their text files."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from meshes.common import MeshError
from meshes.reading.text import decoded

# nodes of a cell by its type; volumes, surfaces, lines and points up to the second order
NODES = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 10: 9, 11: 10, 12: 27, 13: 18, 14: 14, 15: 1}
NODES |= {16: 8, 17: 20, 18: 15, 19: 13}


@dataclass(slots=True)
class _Stream:
    """Numbers one after the other of a binary section that ends where the next keyword begins."""

    data: bytes
    at: int = 0

    def take(self, count: int, kind: str = "i4") -> npt.NDArray[np.generic]:
        """Return the next numbers, (count,), whole ones of 4 bytes unless the kind is another.

        Raises
        ------
        MeshError
            If there are not so many.
        """
        size = count * np.dtype(kind).itemsize
        if count < 0 or self.at + size > len(self.data):
            raise MeshError("ends within a section, or states other counts than it holds. Write it again.")
        found = np.frombuffer(self.data, "<" + kind, count, self.at)
        self.at += size
        return found


def sections_of(data: bytes) -> dict[str, list[str]]:
    """Return the lines of the sections, by name, that a text file would have.

    Raises
    ------
    MeshError
        If it is of another version, or its numbers are of other sizes or another order of bytes.
    """
    version, _, size = data.split(b"\n", 2)[1].decode("latin-1").split()[:3]
    if not (version.startswith("2") or version == "4.1") or size != "8":
        raise MeshError(f"is a binary file of Gmsh {version}, which is not read. Save it as version 4.1.")
    if data.split(b"\n", 3)[2][:4] != b"\x01\0\0\0":
        raise MeshError("holds binary numbers in the other order of bytes. Save it as text.")
    found = {"MeshFormat": [f"{version} 0 8"]}
    for name in ("PhysicalNames", "Entities", "Nodes", "Elements"):
        match = re.search(rb"\$%b\r?\n" % name.encode(), data)
        if not match:
            continue
        body = data[match.end() : data.find(f"$End{name}".encode(), match.end())]
        if name == "PhysicalNames":
            lines: Iterable[str] = filter(None, decoded(body).split("\n"))
        elif version == "4.1":
            lines = {"Entities": _entities, "Nodes": _nodes, "Elements": _elements}[name](_Stream(body))
        else:
            count, _, rest = body.partition(b"\n")
            lines = {"Nodes": _nodes_2, "Elements": _elements_2}[name](_Stream(rest), int(count))
        found[name] = list(lines)
    return found


def _text(*parts: npt.NDArray[np.generic]) -> str:
    return " ".join(str(number) for part in parts for number in part.tolist())


def _entities(stream: _Stream) -> Iterator[str]:
    counts = stream.take(4, "u8")
    yield _text(counts)
    for dimension, count in enumerate(counts.tolist()):
        for _ in range(count):
            head = [stream.take(1), stream.take(6 if dimension else 3, "f8")]
            for _ in range(2 if dimension else 1):  # physical groups, and what bounds it
                head.append(stream.take(1, "u8"))
                head.append(stream.take(int(head[-1][0])))
            yield _text(*head)


def _nodes(stream: _Stream) -> Iterator[str]:
    counts = stream.take(4, "u8")
    yield _text(counts)
    for _ in range(int(counts[0])):
        head, count = stream.take(3).tolist(), int(stream.take(1, "u8")[0])
        yield f"{head[0]} {head[1]} {head[2]} {count}"
        yield from map(str, stream.take(count, "u8").tolist())
        wide = 3 + head[2] * head[0]  # with its place on a curve or a surface
        for row in stream.take(wide * count, "f8").reshape(count, wide):
            yield _text(row)


def _elements(stream: _Stream) -> Iterator[str]:
    counts = stream.take(4, "u8")
    yield _text(counts)
    for _ in range(int(counts[0])):
        head, count = stream.take(3), int(stream.take(1, "u8")[0])
        yield f"{_text(head)} {count}"
        wide = 1 + _known(int(head[2]))
        for row in stream.take(wide * count, "u8").reshape(count, wide):
            yield _text(row)


def _nodes_2(stream: _Stream, count: int) -> Iterator[str]:
    yield str(count)
    for _ in range(count):
        yield _text(stream.take(1), stream.take(3, "f8"))


def _elements_2(stream: _Stream, count: int) -> Iterator[str]:
    yield str(count)
    while count > 0:
        kind, follow, tags = stream.take(3).tolist()
        for _ in range(max(follow, 1)):
            number = stream.take(1)
            yield f"{number[0]} {kind} {tags} {_text(stream.take(tags), stream.take(_known(kind)))}"
        count -= max(follow, 1)


def _known(kind: int) -> int:
    if kind not in NODES:
        raise MeshError(f"holds cells of Gmsh's type {kind}, which are not read. Save them of order 1.")
    return NODES[kind]
