"""Nodes and cells that an Abaqus deck makes by rules from others: rows, fillings and copies."""

from collections.abc import Callable, Mapping

import numpy as np

from meshes.common import MeshError
from meshes.reading.abaqus_part import AbaqusPart, moved
from meshes.reading.stored import keep
from meshes.reading.text import number_of, numbers_between, whole_number

Lines = list[list[str]]
# parameters of each keyword that are read
KNOWN = {
    "NGEN": {"NSET"},
    "NFILL": {"NSET"},
    "NCOPY": {"CHANGE NUMBER", "OLD SET", "NEW SET", "SHIFT", "MULTIPLE"},
    "ELGEN": {"ELSET"},
    "ELCOPY": {"ELEMENT SHIFT", "OLD SET", "SHIFT NODES", "NEW SET"},
}


def make(name: str, options: Mapping[str, str], lines: Lines, part: AbaqusPart) -> None:
    """Add to a part what a keyword of `KNOWN` makes.

    Raises
    ------
    MeshError
        If it has a parameter that is not read, or names what is not there.
    """
    if other := sorted(set(options) - KNOWN[name]):
        raise MeshError(
            f"makes nodes or cells by *{name} with {other[0]}, which is not read. Write the deck with all of "
            "them, as Abaqus/CAE and PrePoMax do."
        )
    RULES[name](options, lines, part)


def _row(options: Mapping[str, str], lines: Lines, part: AbaqusPart) -> None:
    """*NGEN: nodes on a straight line between two, equally far apart."""
    for line in lines:
        first, last, step = (_whole(line, k, "*NGEN", default) for k, default in enumerate((0, 0, 1)))
        numbers = numbers_between(first, last, step, "*NGEN")
        for one in (first, last):
            if one not in part.nodes:
                raise MeshError(f"makes nodes by *NGEN from the node {one}, which is not there.")
        ends = np.array([part.nodes[first], part.nodes[last]])
        for place, number in enumerate(numbers):
            share = place / max(len(numbers) - 1, 1)
            if number not in (first, last):
                keep(part.nodes, number, tuple(((1 - share) * ends[0] + share * ends[1]).tolist()), "nodes")
        _name(part.node_sets, options.get("NSET"), list(numbers))


def _filling(options: Mapping[str, str], lines: Lines, part: AbaqusPart) -> None:
    """*NFILL: rows between the nodes of two sets, pair by pair in the order of their numbers."""
    for line in lines:
        first, last = (sorted(set(_set(part.node_sets, name, "*NFILL"))) for name in line[:2])
        count, step = _whole(line, 2, "*NFILL", 0), _whole(line, 3, "*NFILL", 1)
        if len(first) != len(last):
            raise MeshError(f"fills between sets of {len(first)} and {len(last)} nodes by *NFILL.")
        for one, other in zip(first, last, strict=True):
            ends = np.array([part.nodes[one], part.nodes[other]])
            for k in range(1, count):
                place = tuple((ends[0] + (ends[1] - ends[0]) * k / count).tolist())
                keep(part.nodes, one + k * step, place, "nodes")
            _name(part.node_sets, options.get("NSET"), [one + k * step for k in range(count)] + [other])


def _copied_nodes(options: Mapping[str, str], lines: Lines, part: AbaqusPart) -> None:
    """*NCOPY with SHIFT: nodes of a set moved and turned, once or more, each from the one before."""
    if "SHIFT" not in options:
        raise MeshError("copies nodes by *NCOPY without SHIFT, which is not read. Write the deck with them.")
    old = _set(part.node_sets, options.get("OLD SET", ""), "*NCOPY")
    shift = _whole([options["CHANGE NUMBER"]], 0, "*NCOPY", 0)
    places = np.array([part.nodes[one] for one in old])
    turned = any(number_of(text, "*NCOPY") for text in lines[1][6:7]) if len(lines) > 1 else False
    for time in range(1, _whole([options.get("MULTIPLE", "")], 0, "*NCOPY", 1) + 1):
        places = moved(places, lines[: 1 + turned], "*NCOPY")
        for one, place in zip(old, places.tolist(), strict=True):
            keep(part.nodes, one + time * shift, tuple(place), "nodes")
        _name(part.node_sets, options.get("NEW SET"), [one + time * shift for one in old])


def _rows_of_cells(options: Mapping[str, str], lines: Lines, part: AbaqusPart) -> None:
    """*ELGEN: rows, layers and blocks of cells from a first one, each row with its own steps."""
    for line in lines:
        cells = [_whole(line, 0, "*ELGEN", 0)]
        for at in (1, 4, 7):
            count = _whole(line, at, "*ELGEN", 1)
            nodes, step = (_whole(line, at + k, "*ELGEN", 1) for k in (1, 2))
            for cell in list(cells):
                for k in range(1, count):
                    cells.append(_copy(part, cell, cell + k * step, k * nodes, "*ELGEN"))
        _name(part.sets, options.get("ELSET"), cells)


def _copied_cells(options: Mapping[str, str], _: Lines, part: AbaqusPart) -> None:
    """*ELCOPY: cells of a set with other numbers and nodes."""
    shift, nodes = (
        _whole([options.get(key, "")], 0, "*ELCOPY", 0) for key in ("ELEMENT SHIFT", "SHIFT NODES")
    )
    old = _set(part.sets, options.get("OLD SET", ""), "*ELCOPY")
    _name(part.sets, options.get("NEW SET"), [_copy(part, one, one + shift, nodes, "*ELCOPY") for one in old])


RULES: dict[str, Callable[[Mapping[str, str], Lines, AbaqusPart], None]] = {
    "NGEN": _row,
    "NFILL": _filling,
    "NCOPY": _copied_nodes,
    "ELGEN": _rows_of_cells,
    "ELCOPY": _copied_cells,
}


def _copy(part: AbaqusPart, cell: int, number: int, nodes: int, what: str) -> int:
    """Add a cell like another, the numbers of its nodes raised; return its number."""
    if cell not in part.cells:
        raise MeshError(f"makes cells by {what} from the cell {cell}, which is not there.")
    kind, corners = part.cells[cell]
    keep(part.cells, number, (kind, tuple(one + nodes for one in corners)), "cells")
    return number


def _whole(line: list[str], at: int, what: str, default: int) -> int:
    return whole_number(line[at], what) if line[at : at + 1] not in ([], [""]) else default


def _set(sets: Mapping[str, list[int]], name: str, what: str) -> list[int]:
    """Return the numbers of a set, or the one number that stands in its place."""
    if name.isdigit():
        return [int(name)]
    if name.upper() not in sets:
        raise MeshError(f"names a set {name!r} by {what}, which is not there.")
    return sets[name.upper()]


def _name(sets: dict[str, list[int]], name: str | None, numbers: list[int]) -> None:
    if name:
        sets.setdefault(name.upper(), []).extend(numbers)
