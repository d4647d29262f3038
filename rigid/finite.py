"""A barrier of finite mass, free to move: Brach's impact of two bodies; a massive barrier is its limit."""

from typing import NamedTuple

from .inputs import ArrayLike, Floats, floats, refuse
from .massive import JAM, approach_velocity, phi


class FreeMotion(NamedTuple):
    """Motion of rod (V_n, V_t m/s, Omega rad/s) and barrier (V_bn, V_bt m/s) after impact."""

    V_n: Floats
    V_t: Floats
    Omega: Floats
    V_bn: Floats
    V_bt: Floats


def solve_free(
    v_n: ArrayLike,
    v_t: ArrayLike,
    *,
    e: ArrayLike,
    mu: ArrayLike,
    e_m: ArrayLike = -1.0,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    mass_ratio: ArrayLike,
    v_bn: ArrayLike = 0.0,
    v_bt: ArrayLike = 0.0,
    omega: ArrayLike = 0.0,
) -> FreeMotion:
    """Motion after impact on a block that slides freely but does not turn.

    As `solve`, but the barrier takes the opposite impulse, so that momentum is conserved; restitution
    is that of the relative velocity. With `mass_ratio` = 0 the barrier is massive.

    Parameters
    ----------
    v_n, v_t, e, mu, e_m, d_c, d_d, k2, omega : array_like
        As in `solve`.
    mass_ratio : array_like
        Mass of the rod over mass of the barrier, not negative.
    v_bn, v_bt : array_like
        Velocity of the barrier before impact, m/s.

    Returns
    -------
    FreeMotion
        float64 of the broadcast shape.

    Examples
    --------
    Newton's cradle, two equal masses:

    >>> after = solve_free(-1.0, 0.0, e=1, mu=0, d_c=0, d_d=0.04, k2=5e-4, mass_ratio=1)
    >>> float(after.V_n), float(after.V_bn)
    (0.0, -1.0)
    """
    v_n, v_t, e, mu, e_m, omega = floats(v_n, v_t, e, mu, e_m, omega)
    d_c, d_d, k2, ratio, v_bn, v_bt = floats(d_c, d_d, k2, mass_ratio, v_bn, v_bt)
    refuse(~(ratio >= 0), "the mass ratio must not be negative, got {value}", ratio)
    approach = approach_velocity(v_n, d_c, omega, v_bn)
    stiffness = 1.0 + phi(mu=mu, e_m=e_m, d_c=d_c, d_d=d_d, k2=k2) + ratio
    refuse(~(stiffness > 0), JAM, stiffness)
    impulse = (e_m * d_c * omega - (v_n - v_bn) - e * approach) / stiffness
    spin = -e_m * ((d_c - mu * d_d) * impulse / k2 + omega)
    barrier = v_bn - ratio * impulse, v_bt - ratio * mu * impulse
    return FreeMotion(v_n + impulse, v_t + mu * impulse, spin, *barrier)
