"""The settings whose cost is measured: fidelities, meshes, some extrapolated, elements, effects left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import TYPE_CHECKING, Any, Literal

from fem_impact.answers.refine.levels import (
    FEW_OFFSETS,
    GRID_OFFSETS,
    MeshLevel,
    at_offsets,
    can_be_made,
    family,
    on_mesh,
)
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import BARRIERS, with_prerequisites
from fem_impact.jobs.job import Job
from fem_impact.scene.shipped import replace_all

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


SettingKind = Literal["rigid", "modal", "mesh", "extrapolated", "default", "full", "numerics", "effect"]
ONE_OFFSET = ("default", "full", "numerics", "effect")
"""Kinds of settings that run at one grid offset: their error may be small by chance."""
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
    runs : for each mesh, the finest first, the runs at the grid offsets; their mean counts. A reduced model
        has one run
    meshes : those of a solid setting
    places : most grid offsets that a mesh of it is run at
    """

    name: str
    kind: SettingKind
    fidelity: str
    runs: tuple[tuple[Job, ...], ...]
    meshes: tuple[MeshLevel, ...] = ()
    places: int = len(GRID_OFFSETS)


def settings_of(scene: Scene, meshes: Sequence[MeshLevel] = ()) -> list[Setting]:
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


def _job(scene: Scene, name: str, fidelity: str) -> Job:
    return Job(f"{scene.id}: {name}", scene, fidelity)


def _jobs(scene: Scene, mesh: MeshLevel, name: str, most: int = len(GRID_OFFSETS)) -> tuple[Job, ...]:
    return tuple(
        _job(meshed, f"{name}, grid at {meshed.accuracy.grid_shift:g}", "solid")
        for meshed in at_offsets(scene, mesh, most)
    )


def _name(scene: Scene, mesh: MeshLevel, label: str = "") -> str:
    return f"solid {mesh.sizes(scene)[0] * 1e3:.3g} mm {label}".strip()


def _solid(scene: Scene, mesh: MeshLevel, kind: SettingKind = "mesh", label: str = "") -> Setting:
    """Return the setting of one mesh; elements, steps and effects are changed at the first offset alone."""
    name = _name(scene, mesh, label)
    jobs = _jobs(scene, mesh, name)
    return Setting(name, kind, "solid", (jobs[:1] if kind in ONE_OFFSET else jobs,), (mesh,))


def _extrapolated(scene: Scene, meshes: Sequence[MeshLevel]) -> list[Setting]:
    """Return all groups of two meshes or more, with their runs at few grid offsets and with those at all."""
    settings = {}
    for count in range(2, len(meshes) + 1):
        for group, most in product(combinations(meshes, count), (FEW_OFFSETS, len(GRID_OFFSETS))):
            *coarser, finest = (f"{mesh.sizes(scene)[0] * 1e3:.3g}" for mesh in group)
            fine_first = group[::-1]
            runs = tuple(_jobs(scene, mesh, _name(scene, mesh), most) for mesh in fine_first)
            ran = len(runs[-1])  # of the coarsest mesh
            at = f", {ran} places" if ran > 1 else ""
            name = f"solid {', '.join(coarser)} and {finest} mm extrapolated{at}"
            settings[name] = Setting(name, "extrapolated", "solid", runs, fine_first, ran)
    return list(settings.values())


def _without(scene: Scene, mesh: MeshLevel) -> list[Setting]:
    """Return the scene with each effect left out that can be, and with a simpler barrier, on a mesh."""
    active = Case(scene).active
    optional = [name for name in active if name not in BARRIERS]
    fewer = {f"without {name}": with_prerequisites([e for e in active if e != name]) for name in optional}
    if "barrier-elastoplastic" in active:
        softer = ["barrier-elastic" if e == "barrier-elastoplastic" else e for e in active]
        fewer["with an elastic barrier"] = with_prerequisites(softer)
    scenes = {label: replace_all(scene, {"effects": names}) for label, names in fewer.items()}
    return [
        _solid(changed, mesh, "effect", label)
        for label, changed in scenes.items()
        if can_be_made(on_mesh(changed, mesh))  # its contact is of another width, and so are its cells
    ]
