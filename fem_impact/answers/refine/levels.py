"""The ladder of settings: fidelities, meshes, several extrapolated, elements, steps, effects left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations, product
from typing import TYPE_CHECKING, Any, Literal

from fem_impact.case.case import Case
from fem_impact.case.cells import body_cell, levels_of, rod_cell
from fem_impact.case.effects.registry import BARRIERS, with_prerequisites
from fem_impact.errors import SceneError
from fem_impact.jobs.job import Job
from fem_impact.scene.projectile import ACROSS
from fem_impact.scene.shipped import replace_all

if TYPE_CHECKING:
    from fem_impact.scene.fields import Element
    from fem_impact.scene.types import Scene


Kind = Literal["rigid", "modal", "mesh", "extrapolated", "default", "full", "numerics", "effect"]
ONE_PLACE = ("default", "full", "numerics", "effect")
"""Kinds of settings that run at one place of the barrier's grid: their error may be small by chance."""


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh relative to that which a scene gets unless it states a size, see `levels_of`.

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
        plain = replace(scene.accuracy, across=_across(scene), tip_size=None, barrier_size=None)
        bodies = Case(replace(scene, accuracy=plain)).bodies
        levels, below = levels_of(bodies)
        tip = rod_cell(bodies) / 2 ** (levels + self.finer)
        return tip, body_cell(bodies) / 2 ** (below + self.finer)


RUNGS = tuple(Mesh(finer) for finer in (-1, 0, 1, 2))  # from coarse to fine, each with cells half as large
FAMILY = RUNGS[:3]
"""The meshes of a scene of which all `RUNGS` can be made, see `family`."""
# shifts of a meshed barrier's grid along t, in cells at the contact, at which a mesh is run: at all of them,
# or at the first `FEW`, which are evenly spaced, too. The third mesh and finer ones, which scatter least and
# cost most, are run at few
PLACES = (0.0, 0.5, 0.25, 0.75)
FEW = 2
DEFAULT = "default run"  # one run as the scene states it
FULL = "default run without savings"
SAVINGS_OFF = {"accuracy.mass_scaling": 1, "accuracy.fine_zone": "even"}
NUMERICS: dict[str, dict[str, Any]] = {
    "fully integrated": {"element": "full"},
    "mean dilatation": {"element": "bbar"},
    "with half the default step": {"step": 0.45},
}
"""Changes of elements and step, made on the coarsest mesh, as those of the effects are."""


@dataclass(frozen=True, slots=True)
class Setting:
    """One way to compute a scene.

    Attributes
    ----------
    name, kind, fidelity : str
    runs : for each mesh, the finest first, the runs at the places of the barrier's grid; their mean
        counts. A reduced model has one run
    meshes : those of a solid setting
    places : most places that a mesh of it is run at
    """

    name: str
    kind: Kind
    fidelity: str
    runs: tuple[tuple[Job, ...], ...]
    meshes: tuple[Mesh, ...] = ()
    places: int = len(PLACES)


def can_be_made(scene: Scene) -> bool:
    """Say whether the mesh that a scene states can be made for it.

    It cannot where its cells leave a wide contact without a fine zone, or where it needs too much memory.
    """
    try:
        Case.of(scene)
    except SceneError:
        return False
    return True


def _makeable(scene: Scene, mesh: Mesh) -> bool:
    """Say whether a scene may state the sizes of a mesh, and it can be made."""
    try:
        return can_be_made(on_mesh(scene, mesh))
    except SceneError:
        return False


@lru_cache(maxsize=64)
def rungs(scene: Scene) -> tuple[Mesh, ...]:
    """Return those of `RUNGS` that can be made for a scene, from coarse to fine.

    Raises
    ------
    SceneError
        None can be made: the reason of that with the scene's own cells at the tip.
    """
    made = tuple(mesh for mesh in RUNGS if _makeable(scene, mesh))
    if not made:
        Case.of(on_mesh(scene, FAMILY[-1]))
    return made


def family(scene: Scene) -> tuple[Mesh, ...]:
    """Return the coarsest three of `rungs`."""
    return rungs(scene)[: len(FAMILY)]


def ladder(scene: Scene, meshes: Sequence[Mesh] = ()) -> list[Setting]:
    """Return the settings in order of cost; ``meshes``, from coarse to fine, are by default the `family`."""
    scene = replace_all(scene, {"save.frames": 0})
    scene = replace(scene, accuracy=replace(scene.accuracy, target=None))  # each setting states its own
    settings = [Setting(kind, kind, kind, ((_job(scene, kind, kind),),)) for kind in ("rigid", "modal")]
    meshes = meshes or family(scene)
    settings += [_solid(scene, mesh) for mesh in meshes]
    settings += _extrapolated(scene, meshes)
    settings.append(Setting(DEFAULT, "default", "solid", ((_job(scene, DEFAULT, "solid"),),)))
    full = _job(replace_all(scene, SAVINGS_OFF), FULL, "solid")
    settings.append(Setting(FULL, "full", "solid", ((full,),)))
    settings += [
        _solid(scene, replace(meshes[0], **changes), "numerics", label) for label, changes in NUMERICS.items()
    ]
    return settings + _without(scene, meshes[0])


def on_mesh(scene: Scene, mesh: Mesh, place: float = 0.0) -> Scene:
    """Return the scene on a mesh, the grid of the barrier at a place."""
    tip, barrier = (f"{size * 1e3:.9g} mm" for size in mesh.sizes(scene))
    changes: dict[str, Any] = {"across": _across(scene), "tip_size": tip, "grid_shift": place}
    changes |= {"barrier_size": barrier} if "barrier-rigid" not in Case(scene).active else {}
    changes |= {"unresolved": "report"}  # an unresolved contact is an error of the setting, to be judged too
    changes |= {"element": mesh.element} if mesh.element else {}
    changes |= {"step": mesh.step} if mesh.step else {}
    return replace_all(scene, {f"accuracy.{key}": value for key, value in changes.items()})


def _across(scene: Scene) -> int:
    return max(scene.across, ACROSS)


def placed(scene: Scene, mesh: Mesh, most: int = len(PLACES)) -> list[Scene]:
    """Return the scene on a mesh at its places of the barrier's grid, at ``most`` so many.

    A rigid barrier has one.
    """
    own = FEW if mesh.finer >= family(scene)[-1].finer else len(PLACES)
    count = 1 if "barrier-rigid" in Case(scene).active else min(own, most)
    return [on_mesh(scene, mesh, place) for place in PLACES[:count]]


def _job(scene: Scene, name: str, fidelity: str) -> Job:
    return Job(f"{scene.id}: {name}", scene, fidelity)


def _jobs(scene: Scene, mesh: Mesh, name: str, most: int = len(PLACES)) -> tuple[Job, ...]:
    return tuple(
        _job(one, f"{name}, grid at {one.accuracy.grid_shift:g}", "solid")
        for one in placed(scene, mesh, most)
    )


def _name(scene: Scene, mesh: Mesh, label: str = "") -> str:
    return f"solid {mesh.sizes(scene)[0] * 1e3:.3g} mm {label}".strip()


def _solid(scene: Scene, mesh: Mesh, kind: Kind = "mesh", label: str = "") -> Setting:
    """Return the setting of one mesh; elements, steps and effects are changed at the first place alone."""
    name = _name(scene, mesh, label)
    jobs = _jobs(scene, mesh, name)
    return Setting(name, kind, "solid", (jobs[:1] if kind in ONE_PLACE else jobs,), (mesh,))


def _extrapolated(scene: Scene, meshes: Sequence[Mesh]) -> list[Setting]:
    """Return all groups of two meshes or more, with their runs at few places and with those at all."""
    settings = {}
    for count in range(2, len(meshes) + 1):
        for group, most in product(combinations(meshes, count), (FEW, len(PLACES))):
            *coarser, finest = (f"{mesh.sizes(scene)[0] * 1e3:.3g}" for mesh in group)
            fine_first = group[::-1]
            runs = tuple(_jobs(scene, mesh, _name(scene, mesh), most) for mesh in fine_first)
            ran = len(runs[-1])  # of the coarsest mesh
            at = f", {ran} places" if ran > 1 else ""
            name = f"solid {', '.join(coarser)} and {finest} mm extrapolated{at}"
            settings[name] = Setting(name, "extrapolated", "solid", runs, fine_first, ran)
    return list(settings.values())


def _without(scene: Scene, mesh: Mesh) -> list[Setting]:
    """Return the scene with each effect left out that can be, and with a simpler barrier, on a mesh."""
    active = Case(scene).active
    optional = [name for name in active if name not in BARRIERS]
    fewer = {f"without {name}": with_prerequisites([e for e in active if e != name]) for name in optional}
    if "barrier-elastoplastic" in active:
        softer = ["barrier-elastic" if e == "barrier-elastoplastic" else e for e in active]
        fewer["with an elastic barrier"] = with_prerequisites(softer)
    scenes = {label: replace_all(scene, {"effects": names}) for label, names in fewer.items()}
    return [
        _solid(one, mesh, "effect", label)
        for label, one in scenes.items()
        if can_be_made(on_mesh(one, mesh))  # its contact is of another width, and so are its cells
    ]
