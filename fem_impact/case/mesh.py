"""Whether a projectile can be meshed and read, found before any work, on a mesh without its fine zone."""

from dataclasses import replace
from functools import lru_cache
from math import ceil, floor, isclose

import numpy as np

import meshes
from fem_impact.errors import SceneError
from fem_impact.scene.projectile import ProjectileSpec
from fem_impact.scene.types import Scene
from rigid import Turned

FINER = (8, 10, 12, 16, 20)  # cells over the diameter that are tried for a remedy
THICKEST, TRIALS = 1.5, 12  # closed ends that are tried: up to so many diameters, and how many
NO_MESH = "fidelity rigid needs no mesh; the modes of modal are those of a mesh."
SLICES = 1 / 3  # of the diameter: height over the tip at which the slices of a rod may begin
FARTHER = "Let the bore end farther from the end of the projectile, or be open there."


def require_mesh(rod: ProjectileSpec, across: int) -> None:
    """Refuse a turned projectile of which no mesh can be made (SceneError), with remedies that were tried."""
    if not rod.is_rod and rod.own_mesh is None:
        _require_mesh(rod, across)


def require_gauge(scene: Scene) -> None:
    """Refuse a strain gauge where no mesh has slices, beside the tip or beyond the end (SceneError).

    Where the slices of a mesh begin is known when it stands, see `fem_impact.solid.strain.StrainWatch`.
    """
    rod, gauge = scene.projectile, scene.save.gauge
    least = SLICES * rod.diameter if rod.is_rod else 0.0
    if gauge is not None and not least < gauge < rod.length:
        raise off_gauge(gauge, least, rod.length)


def off_gauge(gauge: float, first: float, last: float) -> SceneError:
    """Return the refusal of a strain gauge that lies beside the places, m from the tip, that are read."""
    return SceneError(
        "lies where the strain along the axis is not read.",
        key="save.gauge",
        value=f"{gauge * 1e3:.4g} mm",
        remedy=f"Give a place between {first * 1e3:.4g} and {last * 1e3:.4g} mm from the tip.",
    )


@lru_cache(maxsize=256)
def _require_mesh(rod: ProjectileSpec, across: int) -> None:
    try:
        _make_mesh(rod, across)
    except meshes.ClosedEndError as error:
        number = 0 if isclose(rod.bore[0][0], error.distance, rel_tol=1e-9) else len(rod.bore) - 1
        remedies = [*_thicker(rod, across, number, error.distance), *_finer(rod, across)]
        raise SceneError(
            f"cannot be meshed: {error}.",
            key=f"projectile.bore[{number + 1}]",
            value=f"z = {1e3 * rod.bore[number][0]:.4g} mm",
            remedy=f"Give {' or '.join(remedies)}." if remedies else FARTHER,
        ) from None
    except meshes.MeshError as error:
        raise no_mesh(error, rod, across) from None


def no_mesh(error: meshes.MeshError, rod: ProjectileSpec, across: int) -> SceneError:
    """Return the refusal of a projectile that cannot be meshed, with more cells across if that helps.

    The error itself says what to change of the shape.
    """
    remedy = " ".join([*(f"It can be with {finer}." for finer in _finer(rod, across)), NO_MESH])
    return SceneError(f"cannot be meshed: {error}.", key="projectile", remedy=remedy)


def _make_mesh(rod: ProjectileSpec, across: int) -> None:
    body = rod.body()
    assert isinstance(body, Turned), "a mesh of its own is made already"
    meshes.turned(body.outline, across, bore=body.bore, planes=[end for end, _ in body.density])


def _works(rod: ProjectileSpec, across: int) -> bool:
    try:
        _make_mesh(rod, across)
    except (meshes.MeshError, SceneError):  # no mesh, or no body
        return False
    return True


def _finer(rod: ProjectileSpec, across: int) -> list[str]:
    """Return the fewest cells over the diameter with which there is a mesh, as a remedy, if any."""
    return next(([f"accuracy.across = {n}"] for n in FINER if n > across and _works(rod, n)), [])


def _thicker(rod: ProjectileSpec, across: int, number: int, distance: float) -> list[str]:
    """Return the place of a bore's first or last point with which there is a mesh, as a remedy, if any."""
    for thickness in np.geomspace(distance, max(THICKEST * rod.diameter, 2.0 * distance), TRIALS)[1:]:
        z = ceil(1e4 * thickness) / 1e4 if number == 0 else floor(1e4 * (rod.length - thickness)) / 1e4
        points = [(z if row == number else place, r) for row, (place, r) in enumerate(rod.bore)]
        try:
            moved = replace(rod, bore=tuple(points))
        except SceneError:  # the next point lies nearer
            return []
        if _works(moved, across):
            return [f"z = {1e3 * z:.4g} mm there"]
    return []
