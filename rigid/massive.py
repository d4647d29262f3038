"""A projectile on a massive barrier: Eq 9, 10 and 12 solved, and the critical impulse ratio of Eq 11.

Written per unit mass, with P = V_n - v_n the normal impulse. An initial spin omega, which the paper
sets to zero, is kept: its terms are those of the general system (Eq 1-3).
"""

from typing import NamedTuple

from .inputs import ArrayLike, Floats, floats, refuse

APPROACH = "the contact point must approach the barrier, but its normal velocity is {value} m/s"
JAM = (
    "1 + Phi = {value} must be positive: at this impulse ratio friction drives the rod into the barrier "
    "(mu reaches (k^2 + d_c^2)/(d_c d_d) when e_m = -1); use the sliding path instead"
)


def approach_velocity(v_n: Floats, d_c: Floats, omega: Floats, v_bn: Floats | float = 0.0) -> Floats:
    """Return the normal velocity of the contact point against a barrier of velocity v_bn, m/s.

    Raises ImpactError where it does not approach.
    """
    approach: Floats = v_n + d_c * omega - v_bn
    refuse(~(approach < 0), APPROACH, approach)
    return approach


class Motion(NamedTuple):
    """Velocities of the mass centre (m/s) and spin (rad/s) just after the impact."""

    V_n: Floats
    V_t: Floats
    Omega: Floats


def phi(*, mu: ArrayLike, e_m: ArrayLike, d_c: ArrayLike, d_d: ArrayLike, k2: ArrayLike) -> Floats:
    """Phi = e_m d_c (mu d_d - d_c)/k^2, dimensionless (Eq 25)."""
    mu, e_m, d_c, d_d, k2 = floats(mu, e_m, d_c, d_d, k2)
    return e_m * d_c * (mu * d_d - d_c) / k2


def solve(
    v_n: ArrayLike,
    v_t: ArrayLike,
    *,
    e: ArrayLike,
    mu: ArrayLike,
    e_m: ArrayLike = -1.0,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    omega: ArrayLike = 0.0,
) -> Motion:
    """Motion after impact from the three coefficients (Eq 9, 10 and 12).

    Parameters
    ----------
    v_n, v_t : array_like
        Velocity of the mass centre before impact, m/s.
    e, mu, e_m : array_like
        Kinematic restitution at the contact point, impulse ratio, moment restitution.
    d_c, d_d : array_like
        Arms of the contact point, m.
    k2 : array_like
        Squared radius of gyration, m2.
    omega : array_like
        Spin before impact, rad/s.

    Returns
    -------
    Motion
        V_n, V_t (m/s) and Omega (rad/s), float64 of the broadcast shape.

    Raises
    ------
    ImpactError
        If the contact point does not approach, or 1 + Phi <= 0.

    Notes
    -----
    The three equations do not conserve energy by themselves: coefficients can be stated (mu beyond mu_c,
    e_m far from -1) that create some. They are solved all the same, since measured coefficients with
    their errors must invert; `kinetic_energy` shows the gain, and `General` refuses it.

    Examples
    --------
    >>> after = solve(-1.6, -1.6, e=0.67, mu=0.32, d_c=0.083, d_d=0.086, k2=4.84e-3)
    >>> f"{after.V_n:.4f} {after.V_t:.4f} {after.Omega:.3f}"
    '-0.2307 -1.1618 15.696'
    """
    v_n, v_t, e, mu, e_m, omega = floats(v_n, v_t, e, mu, e_m, omega)
    d_c, d_d, k2 = floats(d_c, d_d, k2)
    approach_velocity(v_n, d_c, omega)
    stiffness = 1.0 + phi(mu=mu, e_m=e_m, d_c=d_c, d_d=d_d, k2=k2)
    refuse(~(stiffness > 0), JAM, stiffness)
    impulse = ((e_m - e) * d_c * omega - (1.0 + e) * v_n) / stiffness
    spin = -e_m * ((d_c - mu * d_d) * impulse / k2 + omega)
    return Motion(v_n + impulse, v_t + mu * impulse, spin)


def critical_ratio(
    v_n: ArrayLike,
    v_t: ArrayLike,
    *,
    e: ArrayLike,
    e_m: ArrayLike = -1.0,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    omega: ArrayLike = 0.0,
) -> Floats:
    """Impulse ratio mu_c at which sliding ends exactly at separation (Eq 9, 11 and 12, then 17).

    It is the value without reversal, not an upper bound: a tip that stops and slides back before it
    leaves has used a larger ratio.

    Parameters
    ----------
    v_n, v_t, e, e_m, d_c, d_d, k2 : array_like
        As in `solve`.
    omega : array_like
        Spin before impact, rad/s (the paper has none).

    Returns
    -------
    float64 of the broadcast shape, dimensionless

    Raises
    ------
    ImpactError
        If the contact point does not approach, or no finite ratio stops it.

    Examples
    --------
    >>> f"{critical_ratio(-1.502, -1.482, e=0.327, d_c=0.0216, d_d=0.0338, k2=5.56e-4):.3f}"
    '0.665'
    """
    v_n, v_t, e, e_m, omega = floats(v_n, v_t, e, e_m, omega)
    d_c, d_d, k2 = floats(d_c, d_d, k2)
    approach = approach_velocity(v_n, d_c, omega)
    # velocities of the contact point to be changed; the spin -e_m omega left after impact moves it too
    normal = v_n - e_m * d_c * omega + e * approach
    tangential, coupling = v_t + e_m * d_d * omega, e_m * d_c * d_d
    above = tangential * (k2 - e_m * d_c**2) - normal * coupling
    below = normal * (k2 - e_m * d_d**2) - tangential * coupling
    refuse(below == 0, "no finite impulse ratio stops the contact point here (denominator {value})", below)
    return above / below
