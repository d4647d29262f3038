"""The rod as a free beam: periods, modes at the contact point, and its exact motion between impulses.

Bending is Timoshenko's, stretching that of a bar. Between two impulses at the contact point the modes and the
rigid motion have closed forms, which `BeamFlight` evaluates in steps of constant length.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, inf, pi, sin, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem_impact.arrays import Array
from fem_impact.physics import stepped_beam
from fem_impact.physics.contact import (
    ContactBodies,
    contact_estimate,
    projectile,
    section_frequency,
    shear_speed,
    touch_point,
)

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


ROOTS = np.array([4.730041, 7.853205, *((2 * np.arange(3, 31) + 1) * pi / 2)])  # cos cosh = 1
SHEAR = 0.9  # shear coefficient of a round section, about 6 (1 + nu) / (7 + 6 nu) (Cowper 1966)
STRETCHING = 20  # largest number of longitudinal modes
BLOCK = 2048  # steps of a flight that are evaluated together
HORIZON = 4e-3  # s, least time that a free flight is looked ahead: the camera's window, 40 frames at 10 kHz
PERIODS = 1.5  # of the rod's bending, that a free flight is looked ahead if they are longer

AnyArray = NDArray[Any]


class Beam(NamedTuple):
    """Modes at the contact point: omega (k,) rad/s; displacements along t and n (k,) kg^-1/2."""

    omega: Array
    along_t: Array
    along_n: Array


def bending_frequencies(scene: Scene) -> Array:
    """Return circular frequencies of free-free bending, rad/s, ascending; those of a profile by `beam_modes`.

    Timoshenko's dispersion at the wave numbers of the Euler-Bernoulli modes.
    """
    if not scene.projectile.is_rod:
        return stepped_beam.beam_modes(scene.projectile).bent
    return bending_dispersion(scene, ROOTS / scene.projectile.length)


def bending_dispersion(scene: Scene, wave: Array) -> Array:
    """Return circular frequencies, rad/s, of bending waves of wave numbers b = ``wave``, 1/m.

    The lower root of Timoshenko's dispersion, r = d/4 and s = kappa G/E:
    w^4 r^2/s - w^2 c0^2 (1 + b^2 r^2 (1 + 1/s)) + b^4 r^2 c0^4 = 0.
    """
    rod, s = scene.projectile, SHEAR / (2 * (1 + scene.projectile.material.nu))
    b2, r2 = wave**2, (rod.diameter / 4) ** 2
    middle = 1 + b2 * r2 * (1 + 1 / s)
    root = 2 * b2**2 * r2 / (middle + np.sqrt(middle**2 - 4 * b2**2 * r2**2 / s))
    return np.asarray(bar_speed(scene) * np.sqrt(root))


def bending_group_speed(scene: Scene) -> float:
    """Return the largest group speed dw/db of bending waves, m/s: no packet of them runs ahead of it."""
    wave = np.linspace(0.0, 8.0, 801)[1:] / scene.projectile.diameter
    return float(np.gradient(bending_dispersion(scene, wave), wave).max())


def bending_period(scene: Scene) -> float:
    """Return the first free-free bending period, s."""
    return 2 * pi / float(bending_frequencies(scene)[0])


def stretching_period(scene: Scene) -> float:
    """Return the first longitudinal period, s: 2 l / c0 of a rod."""
    if not scene.projectile.is_rod:
        return 2 * pi / float(stepped_beam.beam_modes(scene.projectile).stretched[0])
    return 2 * scene.projectile.length / bar_speed(scene)


def beam(scene: Scene) -> Beam:
    """Return the modes of a rod at its contact point.

    The end of a bending mode, of amplitude 2 for a unit mass, rotates by w' (1 - (w/b)^2 rho/(kappa G))
    (Timoshenko); its rotatory inertia is part of the modal mass.
    """
    if not scene.projectile.is_rod:
        return _stepped(scene)
    body, alpha, r = projectile(scene), scene.impact.angle, scene.projectile.diameter / 4
    rho, z = (float(part) for part in body.contact_point(alpha))
    rho = rho if alpha > 0 else 0.0  # an upright rod strikes with its whole face
    bent, wave, shear = bending_frequencies(scene), ROOTS / body.length, shear_speed(scene)
    turn = 2 * wave * (1 - (bent / wave) ** 2 / (SHEAR * shear**2))
    height = 1 / np.sqrt(body.mass * (1 + (0.5 * r * turn) ** 2))
    count = np.arange(1, STRETCHING + 1)
    omega = np.concatenate([bent, 2 * pi * count / stretching_period(scene)])
    x = np.concatenate([height * (2 - turn * z), 0.0 * count])
    y = np.concatenate([height * turn * rho, sqrt(2 / body.mass) + 0.0 * count])
    below = omega < section_frequency(scene)
    along_t, along_n = cos(alpha) * x + sin(alpha) * y, cos(alpha) * y - sin(alpha) * x
    return Beam(omega[below], along_t[below], along_n[below])


def _stepped(scene: Scene) -> Beam:
    """Return the modes of a turned projectile at its contact point."""
    modes, alpha = stepped_beam.beam_modes(scene.projectile), scene.impact.angle
    rho, z = touch_point(scene)

    def there(shapes: Array) -> Array:
        return np.array([np.interp(z, modes.z, shape) for shape in shapes])

    omega = np.concatenate([modes.bent, modes.stretched])
    x = np.concatenate([there(modes.w), 0.0 * modes.stretched])
    y = np.concatenate([-rho * there(modes.angle), there(modes.u)])
    below = omega < section_frequency(scene)
    along_t, along_n = cos(alpha) * x + sin(alpha) * y, cos(alpha) * y - sin(alpha) * x
    return Beam(omega[below], along_t[below], along_n[below])


def bar_speed(scene: Scene) -> float:
    """Return the speed c0 = sqrt(E/rho) of stretching waves in a thin rod, m/s."""
    steel = scene.projectile.material
    return float((steel.E / steel.rho) ** 0.5)


class Rigid(NamedTuple):
    """Rigid motion: velocities, m/s; spin, rad/s; height, m, of the contact point by it."""

    V_n: float
    V_t: float
    spin: float
    height: float


@dataclass(slots=True)
class BeamFlight:
    """Exact motion between impulses in steps ``dt``, s; ``swing`` (modes,) is omega q + i dq/dt of each mode.

    Attributes
    ----------
    table : (modes, BLOCK + 1) complex factor of each mode after 0, 1, ... steps
    give : (modes,) height of the contact point per unit of ``swing``
    g : (2,) decrease of V_n and V_t by gravity in a step, m/s
    longest : 1.5 periods of the slowest mode, s: a rod that does not touch for so long has left
    """

    modes: Beam
    dt: float
    d_c: float
    g: tuple[float, float]
    table: AnyArray = field(init=False)
    give: AnyArray = field(init=False)
    longest: float = field(init=False)

    def __post_init__(self) -> None:
        omega = self.modes.omega
        self.table = np.exp(-1j * self.dt * np.outer(omega, np.arange(BLOCK + 1)))
        self.give = self.modes.along_n / omega
        self.longest = 3 * pi / float(omega.min(initial=inf)) + 2 * self.dt

    def depth(self, now: Rigid, swing: AnyArray) -> float:
        """Return the depth of the contact point, m."""
        return -now.height - float(self.give @ swing.real)

    def free(self, now: Rigid, swing: AnyArray, crater: float) -> int:
        """Return the steps, from 1 to `BLOCK`, until the contact point is below the depth of its crater."""
        n = np.arange(1, BLOCK + 1)
        below = self._height(now, n) + ((self.give * swing) @ self.table[:, 1:]).real < -crater
        return int(n[np.argmax(below)]) if below.any() else BLOCK

    def gone(self, now: Rigid, swing: AnyArray, crater: float) -> bool:
        """Return whether no vibration can bring the contact point back; a fall by gravity is not counted."""
        return self._away(now) > 0 and now.height + crater > float(np.abs(self.give) @ np.abs(swing))

    def fly(self, now: Rigid, swing: AnyArray, n: int) -> tuple[Rigid, AnyArray]:
        """Return the motion after ``n`` steps."""
        V_n, V_t = now.V_n - n * self.g[0], now.V_t - n * self.g[1]
        return Rigid(V_n, V_t, now.spin, float(self._height(now, n))), self.table[:, n] * swing

    def _height(self, now: Rigid, n: int | AnyArray) -> Any:
        """Return the height, m, that rigid motion gives the contact point after ``n`` steps, of any shape."""
        return now.height + self.dt * n * (self._away(now) - 0.5 * self.g[0] * (n + 1))

    def _away(self, now: Rigid) -> float:
        """Return the speed, m/s, of the contact point off the barrier by rigid motion."""
        return now.V_n + self.d_c * now.spin


def horizon(scene: Scene) -> float:
    """Return the time, s, that a free flight is looked ahead for a further contact by the rod's bending."""
    return max(HORIZON, PERIODS * bending_period(scene))


LATEST, SPAN = 2.5e-3, 2.8  # s, and over the bending period and the contact time, if longer


def max_time(bodies: ContactBodies) -> float:
    """Return the latest time of a run, s: stated, or such that long rods touch again and slow ones leave."""
    stated = bodies.scene.accuracy.max_time
    if stated is not None:
        return stated
    return max(LATEST, SPAN * (bending_period(bodies.scene) + float(contact_estimate(bodies).duration)))
