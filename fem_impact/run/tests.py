"""The measured tests that a scene repeats: a published set, or the user's own."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.physics.contact import arms, projectile
from fem_impact.scene.camera import read_camera
from fem_impact.scene.types import OWN
from rigid import Arms
from rigid.experiments import MeasuredSet, measured_set

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


def tests_of(scene: Scene) -> MeasuredSet | None:
    """Return the tests that a scene repeats, None where it repeats none.

    Those of a file are worked out with its arms, or with the arms of the tip, and with the rod of the scene.

    Raises
    ------
    ResultError
        The file cannot be read as tests.
    """
    if scene.measured is None:
        return None
    if not scene.measured.endswith(OWN):
        return measured_set(scene.measured)
    return _own(scene, Path(scene.measured).stat().st_mtime_ns)


@lru_cache(maxsize=32)
def _own(scene: Scene, changed: int) -> MeasuredSet:
    """Return the tests of a file; ``changed`` is when, so that one that is changed is read again."""
    camera, rod, impact = read_camera(scene.measured or ""), scene.projectile, scene.impact
    d_c, d_d = camera.arms or arms(scene)
    body = projectile(scene)
    return MeasuredSet(
        id=scene.id,
        table=0,
        surface=scene.surface.state,
        alpha=impact.angle,
        length=rod.length,
        diameter=rod.diameter,
        tip=rod.tip,
        tip_radius=rod.tip_radius,
        arms=Arms(d_c, d_d),  # type: ignore[arg-type]
        mass=body.mass,
        k2=body.k2,
        select={},
        printed={},
        motion=camera.motion,
        reconstructed=False,
    )
