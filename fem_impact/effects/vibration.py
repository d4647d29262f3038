"""Elastic vibration of the rod: waves and bending.

Off is the limit of a rod that is rigid but for its contact: the nose, about the first half diameter with the
whole contact in it, deforms (and yields) as before, and the slices behind it become one rigid body.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING

from fem_impact.effects.spec import Effect, Harm, ModelSpec
from fem_impact.estimates import contact_estimate, effective_mass, normal_share, projectile, start_energy

if TYPE_CHECKING:
    from fem_impact.scene import Scene

BENDING, STRETCHING = 2.0, 2**0.5  # end amplitudes of the first free-free modes, mass-normalised
REBOUND = 1.5  # impulse over m* v_n, between the 1 of a dead stop and the 2 of a full rebound


def bending_period(scene: Scene) -> float:
    """Return the first free-free bending period, s.

    Euler-Bernoulli, (beta l)^2 = 22.373, times the leading correction for shear and rotary inertia,
    sqrt(1 + 4.939 (d/l)^2) (Spinner & Tefft 1961, as in ASTM E1876).
    """
    rod = scene.projectile
    slender = 2 * pi * rod.length**2 / (22.373 * _bar_speed(scene) * rod.diameter / 4)
    return float(slender * (1 + 4.939 * (rod.diameter / rod.length) ** 2) ** 0.5)


def stretching_period(scene: Scene) -> float:
    """Return the first longitudinal period, s: 2 l / c0."""
    return 2 * scene.projectile.length / _bar_speed(scene)


def _bar_speed(scene: Scene) -> float:
    rod = scene.projectile.material
    return float((rod.E / rod.rho) ** 0.5)


def number(scene: Scene) -> float:
    """Return the longest period that the blow can excite over the contact time."""
    periods = [stretching_period(scene), *([bending_period(scene)] if scene.impact.angle > 0 else [])]
    return max(periods) / contact_estimate(scene).duration


def left_by_pulse(x: float) -> float:
    """Return the largest amplitude left by a half-sine pulse over that of a blow, x = omega tau / pi."""
    if x < 1.5:
        return cos(0.5 * pi * x) / (1 - x * x) if abs(x - 1) > 1e-6 else pi / 4
    return 1 / (x * x - 1)


def vibration_share(scene: Scene) -> float:
    """Return about the largest E_vib/E_0: first bending and stretching mode, struck by a half-sine pulse.

    Friction turns the force towards the axis; at least a fifth of its side push is kept, because it turns
    back and forth during the contact.
    """
    alpha, tau = scene.impact.angle, contact_estimate(scene).duration
    f = scene.surface.friction if "friction" in scene.active else 0.0
    impulse = REBOUND * effective_mass(scene) * abs(scene.impact.v_n)
    sideways = max(sin(alpha) - f * cos(alpha), 0.2 * sin(alpha))
    bent = BENDING * impulse * sideways * left_by_pulse(2 * tau / bending_period(scene))
    stretched = STRETCHING * impulse * cos(alpha) * left_by_pulse(2 * tau / stretching_period(scene))
    energy = (bent**2 + stretched**2) / (2 * projectile(scene).mass)
    return float(min(energy / start_energy(scene), 1.0))


def harm(scene: Scene) -> Harm:
    """Return the vibration energy, and the restitution that it costs."""
    share = vibration_share(scene)
    return Harm(min(share / normal_share(scene), 1.0), share)


def fill(scene: Scene, spec: ModelSpec) -> None:
    """Let the body behind the nose deform."""
    spec.vibrating = True


EFFECT = Effect(
    "vibration",
    "The rod is elastic: longitudinal and bending waves take energy that rigid theory cannot see.",
    "The rod is rigid behind its nose, which alone deforms.",
    "T1/tau, longest period of the rod over contact time",
    0.1,
    "a half-sine pulse leaves ((2 tau/T1)^2 - 1)^-2 of the energy that a blow gives, 1e-4 at T1/tau = 0.2; "
    "a yielding contact lets go in about half its time",
    number,
    harm,
    fill,
)
