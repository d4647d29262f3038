"""One scene on several meshes, and the limits with their bands that two of them give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from fem_impact.answers.refine.extrapolate import mesh_limits
from fem_impact.answers.refine.levels import can_be_made
from fem_impact.case.case import Case
from fem_impact.case.zones import zones_of
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import replace_all

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


COARSER = 2.0  # element sizes of the second mesh over those of the first
COARSE = {"accuracy.unresolved": "report"}
PLACES = (0.0, 0.5)  # of the barrier's grid, in cells at the contact, at which measured sets run


def resized(scene: Scene, factor: float) -> Scene:
    """Return the scene with elements at the contact ``factor`` times as large as its own.

    A contact that larger elements do not resolve is reported all the same: it counts for the band alone.
    """
    zones = zones_of(Case(scene).bodies)
    sizes = {"tip_size": zones.tip_size, "barrier_size": zones.barrier_size}
    changes = {f"accuracy.{key}": f"{factor * size * 1e3:g} mm" for key, size in sizes.items()}
    return replace_all(scene, {**changes, **(COARSE if factor > 1 else {}), "save.frames": 0})


def finer_and_coarser(scene: Scene) -> tuple[Scene, Scene]:
    """Return a scene on two meshes, the second with elements at the contact `COARSER` times as large.

    The first is the scene itself; where no mesh so much coarser can be made for it, the second is. A film is
    made of the first alone: storing frames takes a tenth of a quick run.
    """
    coarser = resized(scene, COARSER)
    if can_be_made(coarser):
        return scene, coarser
    finer = replace(resized(scene, 1 / COARSER), save=scene.save)
    return finer, replace_all(scene, {**COARSE, "save.frames": 0})


def shifted(scene: Scene, place: float) -> Scene:
    """Return the scene with the grid of the barrier ``place`` cells at the contact further along t."""
    return replace_all(scene, {"accuracy.grid_shift": place, "save.frames": 0})


def with_limits(fine: Sequence[Outcome | Failure], coarse: Sequence[Outcome | Failure]) -> Outcome:
    """Return the first outcome of the finer mesh with the limits of two meshes and their bands.

    ``fine`` and ``coarse`` are the runs of a mesh at its places of the barrier's grid.
    """
    limits: Mapping[str, float] | Unknown
    bands: Mapping[str, float] | Unknown
    finer, coarser = ([run for run in runs if isinstance(run, Outcome)] for runs in (fine, coarse))
    failed = [run for run in (*fine, *coarse) if isinstance(run, Failure)]
    if failed:
        limits = bands = Unknown(f"run {failed[0].name} failed: {failed[0].reason}")
    elif known(coarser[0].cost.tip_size) <= known(finer[0].cost.tip_size):
        limits = bands = Unknown("the second mesh is not coarser: give a smaller accuracy.tip_size")
    else:
        limits, bands = mesh_limits((finer, coarser))
    return replace(finer[0], validity=replace(finer[0].validity, mesh_limit=limits, mesh_band=bands))
