"""One scene on several meshes, and the limits with their bands that two of them give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import log2
from typing import TYPE_CHECKING

from fem_impact.answers.refine.extrapolate import (
    VIBRATION,
    MeshNumbers,
    MeshRuns,
    limit_of,
    mesh_limits,
)
from fem_impact.answers.refine.levels import FEW_OFFSETS, GRID_OFFSETS, can_be_made, refined
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.scene.shipped import replace_all

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


COARSER = 2.0  # element sizes of the second mesh over those of the first
PLACES = GRID_OFFSETS[:FEW_OFFSETS]  # at which measured sets run
COARSE = {"accuracy.unresolved": "report", "save.frames": 0}
"""What larger elements do not resolve is reported all the same: it counts for the band alone."""


def resized(scene: Scene, factor: float) -> Scene:
    """Return a scene with elements at the contact ``factor``, a power of 2, times as large as its own."""
    changed = refined(scene, -round(log2(factor)))
    return replace_all(changed, COARSE if factor > 1 else {"save.frames": 0})


def finer_and_coarser(scene: Scene) -> tuple[Scene, Scene]:
    """Return a scene on two meshes, the second with elements at the contact `COARSER` times as large.

    The first is the scene itself; where no mesh so much coarser can be made for it, the second is. A film is
    made of the first alone: storing frames takes a tenth of a quick run.
    """
    coarser = resized(scene, COARSER)
    if can_be_made(coarser):
        return scene, coarser
    finer = replace(resized(scene, 1 / COARSER), save=scene.save)
    return finer, replace_all(scene, COARSE)


def shifted(scene: Scene, offset: float) -> Scene:
    """Return the scene with the grid of the barrier ``offset`` cells at the contact further along t."""
    return replace_all(scene, {"accuracy.grid_shift": offset, "save.frames": 0})


def with_limits(fine: Sequence[Outcome | Failure], coarse: Sequence[Outcome | Failure]) -> Outcome:
    """Return the first outcome of the finer mesh with the limits of two meshes and their bands.

    ``fine`` and ``coarse`` are the runs of a mesh at its grid offsets.
    """
    limits, bands = _limits_of(fine, coarse)
    first = next(run for run in fine if isinstance(run, Outcome))
    return replace(first, validity=replace(first.validity, mesh_limit=limits, mesh_band=bands))


def vibration_band(fine: Sequence[Outcome | Failure], coarse: Sequence[Outcome | Failure]) -> float | None:
    """Return the half-width, of E_0, that two meshes alone give the vibration energy; None where they do not.

    A finer mesh narrows it, while the distance of the two counts of that energy, which the stated band
    holds, may stay.
    """
    runs = [[run for run in mesh if isinstance(run, Outcome)] for mesh in (fine, coarse)]
    if [len(mesh) for mesh in runs] != [len(fine), len(coarse)]:
        return None
    meshes = [MeshRuns.of(mesh) for mesh in runs]
    if any(mesh.mean(VIBRATION) is None for mesh in meshes):
        return None
    return limit_of([mesh.size for mesh in meshes], [mesh.values(VIBRATION) for mesh in meshes]).uncertainty


def _limits_of(*meshes: Sequence[Outcome | Failure]) -> tuple[MeshNumbers, MeshNumbers]:
    """Return limits and half-widths of a finer and a coarser mesh, or why there are none."""
    failed = [run for runs in meshes for run in runs if isinstance(run, Failure)]
    if failed:
        reason = Unknown(f"run {failed[0].name} failed: {failed[0].reason}")
        return reason, reason
    finer, coarser = (MeshRuns.of(run for run in runs if isinstance(run, Outcome)) for runs in meshes)
    if coarser.size <= finer.size:
        reason = Unknown("the second mesh is not coarser: give a smaller accuracy.tip_size")
        return reason, reason
    return mesh_limits((finer, coarser))
