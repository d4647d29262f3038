"""Hertz' contact of viscous bodies: F = k (1 + theta d/dt) d^1.5, of a Kelvin-Voigt solid.

theta follows from the loss factor eta = E''/E' at the circular frequency of a half wave as long as the
elastic contact, theta = eta tau / pi. Willert 2020, doi:10.3389/fmech.2020.00003, finds that e is mainly a
function of that ratio, whatever the form of the tip and the rheology. The bodies part where the force
vanishes, before the dent is gone; what it still holds is lost.
"""

from functools import lru_cache
from math import pi, sqrt
from typing import NamedTuple

HERTZ = 2.94  # elastic contact time over largest depth and speed of approach
UNITS = HERTZ * 1.25**0.4  # the same in units of (m / (k sqrt v))^0.4, in which s'' = -s^1.5 has s'(0) = 1
PACE = 0.2  # circular frequency of the contact times the relaxation time of a linear solid
STEPS = 400  # of the integration, over an elastic contact


class LinearSolid(NamedTuple):
    """Zener's standard linear solid: a spring beside a Maxwell element, a spring and a dashpot in a row.

    Attributes
    ----------
    g : stiffness of the Maxwell element's spring over that of the other
    c : stiffness of the other spring, which stays for ever, over the storage modulus at the pace
    theta : time in which the Maxwell element relaxes, s
    """

    g: float
    c: float
    theta: float

    @property
    def stiffest(self) -> float:
        """Stiffness under a sudden strain over the storage modulus at the pace."""
        return self.c * (1.0 + self.g)


def linear_solid(loss_factor: float, duration: float) -> LinearSolid:
    """Return the solid of a loss factor, below 5, and the storage modulus at the pace of half waves, s.

    E'/E_c = c (1 + g x^2 / (1 + x^2)) and E''/E_c = c g x / (1 + x^2) with x = omega theta, here `PACE`: so
    short a memory that one blow loses what it does in the Kelvin-Voigt solid of the closed forms.

    Examples
    --------
    >>> law = linear_solid(0.1, 1e-3)
    >>> x = pi / 1e-3 * law.theta
    >>> storage, loss = (law.c * (1 + law.g * x**2 / (1 + x**2)), law.c * law.g * x / (1 + x**2))
    >>> f"{storage:.6f} {loss:.6f}"
    '1.000000 0.100000'
    """
    x2 = PACE**2
    g = loss_factor * (1.0 + x2) / (PACE - loss_factor * x2)
    return LinearSolid(g, 1.0 / (1.0 + g * x2 / (1.0 + x2)), PACE * duration / pi)


def relaxation(loss_factor: float, duration: float) -> float:
    """Return theta, s, of a loss factor and the duration, s, of the elastic contact."""
    return loss_factor * duration / pi


@lru_cache(maxsize=64)
def viscous_restitution(loss_factor: float) -> float:
    """Return e of a viscous contact, 1 without loss, by Runge and Kutta's method.

    Examples
    --------
    >>> viscous_restitution(0.0)
    1.0
    >>> round(viscous_restitution(0.1), 3)
    0.842
    """
    if loss_factor == 0.0:
        return 1.0
    lag, dt = relaxation(loss_factor, UNITS), UNITS / STEPS

    def pull(s: float, v: float) -> float:
        return -sqrt(max(s, 0.0)) * (s + 1.5 * lag * v)

    s, v = 0.0, 1.0
    while True:
        a1 = pull(s, v)
        v2 = v + 0.5 * dt * a1
        a2 = pull(s + 0.5 * dt * v, v2)
        v3 = v + 0.5 * dt * a2
        a3 = pull(s + 0.5 * dt * v2, v3)
        v4 = v + dt * a3
        a4 = pull(s + dt * v3, v4)
        s_next = s + dt / 6 * (v + 2 * v2 + 2 * v3 + v4)
        v_next = v + dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        if v_next < 0 and s_next + 1.5 * lag * v_next <= 0:
            return float(min(1.0, -v_next))
        s, v = s_next, v_next
