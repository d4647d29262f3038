"""Masses without volume that a file holds beside the cells of a body."""

from dataclasses import dataclass

import numpy as np

from meshes.common import FloatArray, IntArray
from meshes.reading.stored import PointMass


@dataclass(frozen=True, slots=True)
class LooseMass:
    """Masses of one kind that a body lacks.

    Attributes
    ----------
    what : their kind in the file
    count : how many
    mass : together, in the file's unit of mass; nan where the file does not tell it
    place : of the first that stands at a node, m, in the axes of the file; None where none does
    own : whether they may be the body's
    """

    what: str
    count: int
    mass: float
    place: tuple[float, float, float] | None
    own: bool


def loose_masses(
    masses: tuple[PointMass, ...], points: FloatArray, body: IntArray | None
) -> tuple[LooseMass, ...]:
    """Return the masses of a file by kind.

    Parameters
    ----------
    masses : tuple of PointMass
    points : (n, 3) float64, m
    body : (k,) int64
        Nodes of the cells that are named as the body: what stands at another node is not its own. None where
        none are named.
    """
    owned = [body is None or one.node < 0 or bool(np.isin(one.node, body)) for one in masses]
    found = []
    for what, own in dict.fromkeys((one.what, own) for one, own in zip(masses, owned, strict=True)):
        these = [m for m, mine in zip(masses, owned, strict=True) if (m.what, mine) == (what, own)]
        places = [points[one.node] for one in these if one.node >= 0]
        place = (float(places[0][0]), float(places[0][1]), float(places[0][2])) if places else None
        found.append(LooseMass(what, len(these), sum(one.mass for one in these), place, own))
    return tuple(found)
