"""The one family of meshes: levels with cells half as large each, run at offsets of the barrier's grid."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import inf
from typing import TYPE_CHECKING, Any

from fem_impact.case.case import Case
from fem_impact.case.cells import body_cell, contact_edge, levels_of, rod_cell
from fem_impact.errors import SceneError
from fem_impact.scene.projectile import ACROSS
from fem_impact.scene.shipped import replace_all

if TYPE_CHECKING:
    from fem_impact.scene.fields import Element
    from fem_impact.scene.types import Scene


@dataclass(frozen=True, slots=True)
class MeshLevel:
    """A mesh relative to that which a scene gets unless it states a size.

    ``finer`` says how often more, or less often, the cells of rod and barrier are split at the contact.
    ``element`` and ``step`` are those of `Accuracy` where they are not the scene's own.

    Rod and barrier are split alike: which of two like steels flows depends on the cells of both, and a rod
    with cells twice as large hardly flows (t5b: 3 % of E_0 goes into the rod, 14 % on the finest mesh).
    """

    finer: int
    element: Element | None = None
    step: float | None = None

    def sizes(self, scene: Scene) -> tuple[float, float]:
        """Return the element sizes of rod and barrier at the contact, m."""
        return _sizes(unmeshed(scene), self.finer)


MESH_LEVELS = tuple(MeshLevel(finer) for finer in (-1, 0, 1, 2))
"""From coarse to fine, each with cells half as large as the one before."""
FAMILY = MESH_LEVELS[:3]
"""The levels of a scene of which all `MESH_LEVELS` can be made, see `family`."""
# shifts of a meshed barrier's grid along t, in cells at the contact, at which a mesh is run: at all of them,
# or at the first few, which are evenly spaced, too. The third mesh and finer ones, which scatter least and
# cost most, are run at few
GRID_OFFSETS = (0.0, 0.5, 0.25, 0.75)
FEW_OFFSETS = 2


def unmeshed(scene: Scene) -> Scene:
    """Return a scene that states no mesh and no wanted error: its meshes are chosen for it.

    It has eight cells across its projectile at least, and reports what a contact gives that a mesh does not
    resolve: such a mesh is judged by its error, as any other.
    """
    accuracy = replace(
        scene.accuracy,
        target=None,
        tip_size=None,
        barrier_size=None,
        across=max(scene.across, ACROSS),
        unresolved="report",
    )
    return replace(scene, accuracy=accuracy)


def refined(scene: Scene, finer: int, **accuracy: Any) -> Scene:
    """Return a scene with its own cells at the contact halved ``finer`` times more, or less often.

    ``accuracy`` are other keys of the scene's accuracy that change, in the units of a scene file.

    Raises
    ------
    SceneError
        No scene may state cells of that size.
    """
    tip, barrier = (f"{size * 1e3:.9g} mm" for size in _sizes(scene, finer))
    accuracy["tip_size"] = tip
    if "barrier-rigid" not in Case(scene).active:
        accuracy["barrier_size"] = barrier
    return replace_all(scene, {f"accuracy.{key}": value for key, value in accuracy.items()})


def on_mesh(scene: Scene, level: MeshLevel, offset: float = 0.0) -> Scene:
    """Return the scene on a level, the barrier's grid shifted by ``offset`` cells at the contact."""
    other = {"element": level.element, "step": level.step}
    stated = {key: value for key, value in other.items() if value}
    return refined(unmeshed(scene), level.finer, grid_shift=offset, **stated)


def at_offsets(scene: Scene, level: MeshLevel, most: int = len(GRID_OFFSETS)) -> list[Scene]:
    """Return the scene on a level at its grid offsets, at ``most`` so many; a rigid barrier has one."""
    usual = FEW_OFFSETS if level.finer >= family(scene)[-1].finer else len(GRID_OFFSETS)
    count = 1 if "barrier-rigid" in Case(scene).active else min(usual, most)
    return [on_mesh(scene, level, offset) for offset in GRID_OFFSETS[:count]]


def can_be_made(scene: Scene) -> bool:
    """Say whether the mesh that a scene states can be made for it.

    It cannot where its cells leave a wide contact without a fine zone, or where it needs too much memory.
    """
    try:
        Case.of(scene)
    except SceneError:
        return False
    return True


@lru_cache(maxsize=64)
def mesh_levels(scene: Scene) -> tuple[MeshLevel, ...]:
    """Return those of `MESH_LEVELS` that can be made for a scene, from coarse to fine.

    Each has smaller cells at the contact than the one before: those of a user's mesh may stay as they are.

    Raises
    ------
    SceneError
        None can be made: the reason of that with the scene's own cells at the tip.
    """
    levels, smallest = list[MeshLevel](), inf
    for level in MESH_LEVELS:
        try:
            meshed = on_mesh(scene, level)
        except SceneError:  # of cells so small that no scene may state them
            continue
        if can_be_made(meshed) and (size := contact_size(meshed)) < smallest:
            smallest = size
            levels.append(level)
    if not levels:
        Case.of(on_mesh(scene, FAMILY[-1]))
    return tuple(levels)


def family(scene: Scene) -> tuple[MeshLevel, ...]:
    """Return the coarsest three of `mesh_levels`."""
    return mesh_levels(scene)[: len(FAMILY)]


def contact_size(scene: Scene) -> float:
    """Return the edge, m, of the cells that resolve the contact on the mesh of a scene."""
    return contact_edge(Case(scene).bodies)


def _sizes(scene: Scene, finer: int) -> tuple[float, float]:
    """Return the cells of rod and barrier at the contact, m, ``finer`` levels below the scene's own."""
    bodies = Case(scene).bodies
    rod, barrier = levels_of(bodies)
    return rod_cell(bodies) / 2 ** (rod + finer), body_cell(bodies) / 2 ** (barrier + finer)
