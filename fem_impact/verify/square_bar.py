"""The square bar that public codes were given: 19 x 19 x 240 mm, E 206 GPa, nu 0.29, rho 7850; and others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import meshes
from fem_impact.solid.elements import Kind
from fem_impact.verify import steel
from fem_impact.verify.problem import Parameter, Values
from fem_impact.verify.reference.bricks import Bar
from meshes import OUTER, SKIN, HexMesh

__all__ = ["KINDS", "counts", "is_printed", "parameters", "square_bar", "twin"]

PRINTED = {"side": 0.019, "length": 0.24, "E": 206e9, "nu": 0.29, "rho": 7850.0}
ALONG = 12  # times as many cells along the printed bar as across it
SLENDER = 2.5, 40.0  # length over side
KINDS: tuple[Kind, ...] = ("full", "bbar", "incompatible")


def parameters() -> tuple[Parameter, ...]:
    """Return size, material, cells across and kind of element."""
    return (
        Parameter("side", "side of the square section", PRINTED["side"], 1e-3, 0.2, "length"),
        steel.length(PRINTED["length"]),
        *steel.elastic(PRINTED["E"], PRINTED["nu"], PRINTED["rho"]),
        Parameter(
            "cells",
            "cells across the bar, even; 12 times as many along the printed one",
            12,
            4,
            24,
            multiple=2,
        ),
        Parameter("element", "0: plain 8-point, 1: mean dilatation, 2: incompatible", 2, 0, 2, multiple=1),
    )


def is_printed(p: Values) -> bool:
    """Return whether size and material are the printed ones."""
    return all(p[name] == value for name, value in PRINTED.items())


def counts(p: Values) -> tuple[int, int]:
    """Return how many cells of the printed proportion lie across and along the bar.

    Raises
    ------
    SceneError
        If the bar is too stubby or too slender.
    """
    steel.slender(p, "side", *SLENDER)
    longer = p["length"] / p["side"] * PRINTED["side"] / PRINTED["length"]
    return int(p["cells"]), round(ALONG * p["cells"] * longer)


def square_bar(p: Values) -> HexMesh:
    """Return half the bar, b >= 0, standing on n = 0."""
    across, along = counts(p)
    # the block's cells are as cubic as its size says: build it as such and scale it to the bar
    block = meshes.block([-across / 2, 0.0, -float(along)], [across / 2, across / 2, 0.0], 1.0)
    points = block.points * np.array([p["side"] / across, p["side"] / across, p["length"] / along])
    points[:, 2] += p["length"]
    points[np.abs(points[:, 2]) < 1e-9 * p["length"], 2] = 0.0
    return replace(block, points=points, face_tag=np.where(block.face_tag == OUTER, SKIN, block.face_tag))


def twin(p: Values) -> Bar:
    """Return the same bar, of the same elements, for the reference's own explicit code."""
    return Bar(p["side"], p["length"], counts(p), p["E"], p["nu"], p["rho"], KINDS[int(p["element"])])
