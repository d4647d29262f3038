"""The measured tests that a scene repeats: a published set, or the user's own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from fem_impact.physics.contact import arms, projectile
from fem_impact.scene.camera import read_camera
from fem_impact.scene.means import Mean, holds_means, read_means
from fem_impact.scene.types import OWN
from rigid import Arms
from rigid.experiments import MeasuredSet, Statistic, measured_set, of_mean

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


class Tests(Protocol):
    """Measured tests: the arms d_c, d_d, m, of their e, and mean, scatter and interval of each quantity."""

    @property
    def arms(self) -> Arms:
        """Arms with which e was worked out, m."""

    def statistics(self) -> dict[str, Statistic]:
        """Return the statistics by quantity, SI."""


@dataclass(frozen=True, slots=True)
class MeanTests:
    """Tests of which the means with their scatter are known; ``means`` by quantity."""

    arms: Arms
    means: Mapping[str, Mean]

    def statistics(self) -> dict[str, Statistic]:
        """Return mean, standard deviation and 95 % interval of the mean for each stated quantity."""
        return {name: of_mean(stated.mean, stated.sd, stated.n) for name, stated in self.means.items()}


def tests_of(scene: Scene) -> Tests | None:
    """Return the tests that a scene repeats, None where it repeats none.

    A file holds single tests, or means with their scatter. Its arms are taken, or else those of the tip;
    single tests are worked out with the rod of the scene.

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
def _own(scene: Scene, changed: int) -> Tests:
    """Return the tests of a file; ``changed`` is when, so that one that is changed is read again."""
    file = scene.measured or ""
    if holds_means(file):
        stated = read_means(file)
        return MeanTests(_arms(scene, stated.arms), stated.means)
    camera, rod, impact = read_camera(file), scene.projectile, scene.impact
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
        arms=_arms(scene, camera.arms),
        mass=body.mass,
        k2=body.k2,
        select={},
        printed={},
        motion=camera.motion,
        reconstructed=False,
    )


def _arms(scene: Scene, stated: tuple[float, float] | None) -> Arms:
    """Return the stated arms, else those of the tip, m."""
    return Arms(*(stated or arms(scene)))  # type: ignore[arg-type]
