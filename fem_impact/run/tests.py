"""The measured tests that a scene repeats: a published set, or the user's own."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import hypot
from pathlib import Path
from typing import Protocol

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.case.bodies import Bodies
from fem_impact.outcome.keys import Num, Unknown
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.scene.own_tests import Camera, Mean, holds_means, read_camera, read_means
from fem_impact.scene.types import OWN, Scene
from rigid import Arms, experiments, kinetic_energy

COVERAGE = 2.0  # standard uncertainties from the mean of one test to the ends of its interval


class MeasuredTests(Protocol):
    """Measured tests: the arms d_c, d_d, m, of their e, and mean, scatter and interval of each quantity."""

    @property
    def arms(self) -> Arms:
        """Arms with which e was worked out, m."""

    def statistics(self) -> dict[str, experiments.Statistic]:
        """Return the statistics by quantity, SI."""

    def covariance(self, names: Sequence[str]) -> Array:
        """Return the covariance (k, k) of the means of named quantities, SI."""


Estimate = tuple[Num, float | None]
"""A number and its half-width, None where that is not known."""


def _contact_time(outcome: Outcome) -> Estimate:
    intervals = outcome.contact.intervals
    if isinstance(intervals, Unknown):
        return intervals, None
    return sum(one.end - one.start for one in intervals), None


def _depth(outcome: Outcome) -> Estimate:
    sites = outcome.contact.sites
    return sites if isinstance(sites, Unknown) else max((one.depth for one in sites), default=0.0), None


def _tangential_ratio(outcome: Outcome) -> Estimate:
    """Return e_t = V_t / v_t of the mass centre, as Kharaz, Gorham and Salman 2001 give it of spheres."""
    before, (after, half) = outcome.motion.v_t, outcome.estimate("V_t_m_per_s")
    if before == 0:
        return Unknown("the scene strikes straight: e_t = V_t / v_t, and v_t is 0."), None
    if isinstance(after, Unknown):
        return after, None
    return after / before, None if half is None else half / abs(before)


OTHERS: dict[str, tuple[str, Callable[[Outcome], Estimate]]] = {
    "contact_time_s": ("s", _contact_time),
    "depth_m": ("m", _depth),
    "e_t": ("-", _tangential_ratio),
}
"""Numbers of tests that are no key of an outcome, with their units: time of all contacts, indentation of the
barrier, tangential restitution."""
NUMBERS = frozenset({key.name for key in KEY_TABLE.values() if key.kind == "number"} | set(OTHERS))
"""What a file of means may state beside the quantities of a camera."""


@dataclass(frozen=True, slots=True)
class MeanTests:
    """Tests of which the means with their scatter are known; ``means`` by quantity."""

    arms: Arms
    means: Mapping[str, Mean]

    def statistics(self) -> dict[str, experiments.Statistic]:
        """Return mean, standard deviation and 95 % interval of the mean for each stated quantity."""
        return {name: _statistic(mean) for name, mean in self.means.items()}

    def covariance(self, names: Sequence[str]) -> Array:
        """Return the covariance (k, k) of means; those whose correlation is not stated have none."""
        statistics = [self.means[name] for name in names]
        r = np.array([[statistic.correlation.get(name, 0.0) for name in names] for statistic in statistics])
        r = np.where(r == 0, r.T, r)  # stated in one of the two rows
        np.fill_diagonal(r, 1.0)
        u = np.sqrt([statistic.sd**2 / statistic.n + statistic.systematic**2 for statistic in statistics])
        return np.asarray(r * np.outer(u, u))


def _statistic(mean: Mean) -> experiments.Statistic:
    if mean.n == 1:
        half = COVERAGE * mean.systematic
        return experiments.Statistic(mean.mean, 0.0, mean.mean - half, mean.mean + half, 1, mean.systematic)
    return replace(experiments.of_mean(mean.mean, mean.sd, mean.n), systematic=mean.systematic)


@dataclass(frozen=True, slots=True)
class SingleTests:
    """Tests known one by one: velocities by name, ``(n,)``, and k2, m2, and mass, kg, of their rod."""

    arms: Arms
    motion: Mapping[str, Array]
    k2: float
    mass: float

    def statistics(self) -> dict[str, experiments.Statistic]:
        """Return mean, standard deviation and 95 % interval of the mean, of what follows from them too."""
        return {name: experiments.statistic(values) for name, values in self._columns().items()}

    @property
    def count(self) -> int:
        """How many tests there are."""
        return len(self.motion["v_n"])

    def covariance(self, names: Sequence[str]) -> Array:
        """Return the covariance (k, k) of means, from how they vary together between tests."""
        return experiments.covariance_of_means(self._columns(), names)

    def _columns(self) -> dict[str, Array]:
        """Return each quantity of all tests, those that follow from the velocities too."""
        derived = experiments.derived_columns(self.motion, **self.arms._asdict(), k2=self.k2, mass=self.mass)
        return {**self.motion, **derived}


def tests_of(scene: Scene) -> MeasuredTests | None:
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
        return experiments.measured_set(scene.measured)
    return _own(scene, Path(scene.measured).stat().st_mtime_ns)


def count(tests: MeasuredTests) -> int:
    """Return the number of tests, the largest of all quantities."""
    return max(one.n for one in tests.statistics().values())


def unused_columns(scene: Scene) -> list[str]:
    """Return a sentence on the columns of a file of tests that were not used; none where all were."""
    file = scene.measured or ""
    if not file.endswith(OWN):
        return []
    ignored = (read_means(file, NUMBERS) if holds_means(file) else read_camera(file)).ignored
    return [f"columns not used: {', '.join(ignored)}"] if ignored else []


FAR = 0.2
"""Difference from the scene's velocity, over its speed, above which a test is told to be another impact."""


def doubtful_tests(scene: Scene) -> list[str]:
    """Return a sentence on single tests of another impact than the scene's, and on those that gained energy.

    The first such test is named, with both its values. A barrier that moves may give energy.
    """
    file = scene.measured or ""
    if not file.endswith(OWN) or holds_means(file):
        return []
    camera, body = read_camera(file), scene.projectile.rigid_body
    motion, warnings = camera.motion, other_impacts(scene, camera)
    means = {"mass": body.mass, "k2": body.k2}
    before = kinetic_energy(motion["v_n"], motion["v_t"], scene.impact.omega, **means)
    after = kinetic_energy(motion["V_n"], motion["V_t"], motion["Omega"], **means)
    gained = np.flatnonzero(after > before)
    if gained.size and not (scene.barrier.v_n or scene.barrier.v_t):
        both = " after ".join(f"{name} = {motion[name][gained[0]]:.4g} m/s" for name in ("V_n", "v_n"))
        warnings.append(
            f"{_named(camera, gained)} has more kinetic energy after than before the impact: {both}."
        )
    return warnings


def other_impacts(scene: Scene, camera: Camera) -> list[str]:
    """Return a sentence on single tests that are not of the scene's impact, by v_n and by v_t."""
    fall, told = scene.relative, []
    for name, component in (("v_n", fall.v_n), ("v_t", fall.v_t)):
        far = np.flatnonzero(abs(camera.motion[name] - component) > FAR * hypot(fall.v_n, fall.v_t))
        if far.size:
            values = f"has {name} = {camera.motion[name][far[0]]:.4g} m/s, the scene {component:.4g} m/s"
            told.append(f"{_named(camera, far)} {values}: it is not the scene's impact.")
    return told


def _named(camera: Camera, rows: Ints) -> str:
    """Return the first of several tests by its name, and how many more there are."""
    more = f", the first of {len(rows)} like it," if len(rows) > 1 else ""
    return f"Test {camera.tests[rows[0]]} of {len(camera.tests)}{more}"


@lru_cache(maxsize=32)
def _own(scene: Scene, changed: int) -> MeasuredTests:
    """Return the tests of a file; ``changed`` is when, so that one that is changed is read again."""
    file = scene.measured or ""
    if holds_means(file):
        means = read_means(file, NUMBERS)
        return MeanTests(_arms(scene, means.arms), means.means)
    camera, body = read_camera(file), scene.projectile.rigid_body
    return SingleTests(_arms(scene, camera.arms), camera.motion, body.k2, body.mass)


def _arms(scene: Scene, of_file: tuple[float, float] | None) -> Arms:
    """Return the arms of the file, else those of the tip, m."""
    return Arms(*(of_file or Bodies(scene, ()).contact.arms))  # type: ignore[arg-type]
