"""The measured tests that a scene repeats: a published set, or the user's own."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import hypot, inf, sqrt
from pathlib import Path
from typing import Protocol

import numpy as np

from fem_impact.arrays import Array, Ints
from fem_impact.case.bodies import Bodies
from fem_impact.errors import ResultError
from fem_impact.outcome.keys import Num, Unknown
from fem_impact.outcome.record import KEY_TABLE, Outcome
from fem_impact.run.seen_tests import TURNING, SeenTests
from fem_impact.scene import library
from fem_impact.scene.measured import FAR
from fem_impact.scene.own_tests import Camera, Mean, holds_means, read_camera, read_means
from fem_impact.scene.types import OWN, Scene
from rigid import Arms, RigidError, experiments

COVERAGE = 2.0  # standard uncertainties that all tests share, from their mean to the ends of its interval


class MeasuredTests(Protocol):
    """Measured tests: the arms d_c, d_d, m, of their e, and mean, scatter and interval of each quantity."""

    @property
    def arms(self) -> Arms:
        """Arms with which e was worked out, m."""

    def statistics(self) -> dict[str, experiments.Statistic]:
        """Return the statistics by quantity, SI."""

    def covariance(self, names: Sequence[str]) -> Array:
        """Return the covariance (k, k) of the means of named quantities, SI."""

    def scatter(self, names: Sequence[str]) -> Array:
        """Return the part (k, k) of it by which single tests differ: what is left is known from outside."""


Estimate = tuple[Num, float | None]
"""A number and its half-width, None where that is not known."""


def _contact_time(outcome: Outcome) -> Estimate:
    intervals = outcome.contact.intervals
    if isinstance(intervals, Unknown):
        return intervals, None
    return sum(one.duration for one in intervals), None


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
        means = [self.means[name] for name in names]
        return self._correlated(names, [hypot(one.sd / sqrt(one.n), one.systematic) for one in means])

    def scatter(self, names: Sequence[str]) -> Array:
        """Return the part (k, k) of it by which single tests differ."""
        return self._correlated(names, [self.means[name].sd / sqrt(self.means[name].n) for name in names])

    def _correlated(self, names: Sequence[str], u: Sequence[float]) -> Array:
        """Return the covariance (k, k) of standard uncertainties (k,) with the stated correlations."""
        statistics = [self.means[name] for name in names]
        r = np.array([[statistic.correlation.get(name, 0.0) for name in names] for statistic in statistics])
        r = np.where(r == 0, r.T, r)  # stated in one of the two rows
        np.fill_diagonal(r, 1.0)
        return np.asarray(r * np.outer(u, u))


def _statistic(mean: Mean) -> experiments.Statistic:
    scatter = 0.0 if mean.n == 1 else experiments.of_mean(mean.mean, mean.sd, mean.n).high - mean.mean
    half = hypot(scatter, COVERAGE * mean.systematic)
    ends = mean.mean - half, mean.mean + half
    return experiments.Statistic(mean.mean, mean.sd, *ends, mean.n, mean.systematic)


@dataclass(frozen=True, slots=True)
class SingleTests:
    """Tests known one by one: velocities over the ground by name, ``(n,)``, and as seen from the barrier."""

    arms: Arms
    motion: Mapping[str, Array]
    seen: SeenTests

    def statistics(self) -> dict[str, experiments.Statistic]:
        """Return mean, standard deviation and 95 % interval of the mean, of what follows from them too."""
        return {name: experiments.statistic(values) for name, values in self._columns().items()}

    def covariance(self, names: Sequence[str]) -> Array:
        """Return the covariance (k, k) of means, from how they vary together between tests."""
        return self.scatter(names)

    def scatter(self, names: Sequence[str]) -> Array:
        """Return that covariance (k, k): all of it is scatter."""
        return experiments.covariance_of_means(self._columns(), names)

    def _columns(self) -> dict[str, Array]:
        """Return each quantity of all tests, those that follow from the velocities too."""
        return {**self.motion, **self.seen.columns(self.arms)}


def tests_of(scene: Scene) -> MeasuredTests | None:
    """Return the tests that a scene repeats, None where it repeats none.

    A file holds single tests, or means with their scatter. Its arms are taken, or else those of the tip;
    single tests are worked out with the rod of the scene, its spin before the impact where the file has no
    column omega, and the motion of its barrier.

    Raises
    ------
    ResultError
        The file cannot be read as tests, or one of them is no impact on the barrier of the scene.
    """
    if scene.measured is None:
        return None
    if not scene.measured.endswith(OWN):
        return experiments.measured_set(scene.measured)
    return _own(scene, Path(scene.measured).stat().st_mtime_ns)


def count(tests: MeasuredTests) -> int:
    """Return the number of tests, the largest of all quantities."""
    return max(one.n for one in tests.statistics().values())


def tests_freedom(tests: MeasuredTests, names: Sequence[str]) -> float:
    """Return the degrees of freedom of the scatter of numbers: tests less one, infinite without scatter."""
    statistics = tests.statistics()
    return min((statistics[name].n for name in names if statistics[name].sd > 0), default=inf) - 1


def unused_columns(scene: Scene) -> list[str]:
    """Return a sentence on the columns of a file of tests that were not used; none where all were."""
    file = scene.measured or ""
    if not file.endswith(OWN):
        return []
    ignored = (read_means(file, NUMBERS) if holds_means(file) else read_camera(file)).ignored
    return [f"columns not used: {', '.join(ignored)}"] if ignored else []


def doubtful_tests(scene: Scene) -> list[str]:
    """Return a sentence on single tests of another impact than the scene's, and on those that gained energy.

    Of a published set it is on metals of other names than the tested ones.

    The first such test is named, with both its values. Energy is that seen from the barrier.
    """
    file = scene.measured or ""
    if file and not file.endswith(OWN):
        published = library.stated(file)
        tested = {body: published[body]["material"] for body in scene.materials}
        return [
            f"{body}.material is {metal.name}, but {file} was measured with {tested[body]}."
            for body, metal in scene.materials.items()
            if metal.name.removesuffix(library.CHANGED) != tested[body]
        ]
    if not file or holds_means(file):
        return []
    camera = read_camera(file)
    seen, warnings = seen_tests(scene, camera), other_impacts(scene, camera)
    if seen.turns:
        warnings.append(TURNING)
    gained = np.flatnonzero(seen.E_r > seen.E_0)
    if gained.size:
        both = " after ".join(f"{name} = {seen.motion[name][gained[0]]:.4g} m/s" for name in ("V_n", "v_n"))
        warnings.append(
            f"{_named(camera, gained)} has more kinetic energy after than before the impact: {both}."
        )
    return warnings


def other_impacts(scene: Scene, camera: Camera) -> list[str]:
    """Return a sentence on single tests that are not of the scene's impact, by v_n and by v_t."""
    stated, fall, told = scene.impact, scene.relative, []
    for name, component in (("v_n", stated.v_n), ("v_t", stated.v_t)):
        far = np.flatnonzero(abs(camera.motion[name] - component) > FAR * hypot(fall.v_n, fall.v_t))
        if far.size:
            values = f"has {name} = {camera.motion[name][far[0]]:.4g} m/s, the scene {component:.4g} m/s"
            told.append(f"{_named(camera, far)} {values}: it is not the scene's impact.")
    return told


def seen_tests(scene: Scene, camera: Camera) -> SeenTests:
    """Return single tests of a scene's projectile and barrier as seen from that barrier."""
    body = scene.projectile.rigid_body
    return SeenTests.of(camera.motion, body.mass, body.k2, scene.impact.omega, scene.barrier)


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
    camera = read_camera(file)
    tests = SingleTests(_arms(scene, camera.arms), camera.motion, seen_tests(scene, camera))
    try:
        tests.statistics()
    except RigidError as error:
        raise ResultError(f"{file}: {error}. The scene's spin and the motion of its barrier count.") from None
    return tests


def _arms(scene: Scene, of_file: tuple[float, float] | None) -> Arms:
    """Return the arms of the file, else those of the tip, m."""
    return Arms(*(of_file or Bodies(scene, ()).contact.arms))  # type: ignore[arg-type]
