"""The square bar that public codes were given: 19 x 19 x 240 mm, E 206 GPa, nu 0.29, rho 7850."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import meshes
from fem_impact.solid.elements import Kind
from fem_impact.verify.problem import Parameter
from meshes import OUTER, SKIN, HexMesh

__all__ = ["KINDS", "LENGTH", "NU", "RHO", "SIDE", "E", "element", "square_bar"]

SIDE, LENGTH, E, NU, RHO = 0.019, 0.24, 206e9, 0.29, 7850.0
KINDS: tuple[Kind, ...] = ("full", "bbar", "incompatible")


def square_bar(across: int, along: int) -> HexMesh:
    """Return half the bar, b >= 0, standing on n = 0, with so many cells across and along it."""
    # the block's cells are as cubic as its size says: build it as such and scale it to the bar
    block = meshes.block([-across / 2, 0.0, -float(along)], [across / 2, across / 2, 0.0], 1.0)
    points = block.points * np.array([SIDE / across, SIDE / across, LENGTH / along])
    points[:, 2] += LENGTH
    points[np.abs(points[:, 2]) < 1e-12, 2] = 0.0
    return replace(block, points=points, face_tag=np.where(block.face_tag == OUTER, SKIN, block.face_tag))


def element(default: int) -> Parameter:
    """Return the choice of element."""
    words = "0: plain 8-point, 1: mean dilatation, 2: incompatible"
    return Parameter("element", words, default, 0, 2, multiple=1)
