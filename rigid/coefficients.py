"""Impact coefficients from velocities (Eq 16-18), and the contact point for which e_m = -1."""

from typing import NamedTuple

import numpy as np

from .arms import Arms
from .inputs import ArrayLike, Floats, floats, refuse
from .massive import approach_velocity


class Coefficients(NamedTuple):
    """Kinematic restitution, impulse ratio and moment restitution, dimensionless."""

    e: Floats
    mu: Floats
    e_m: Floats


def restitution(
    v_n: ArrayLike, V_n: ArrayLike, Omega: ArrayLike, d_c: ArrayLike, omega: ArrayLike = 0.0
) -> Floats:
    """Kinematic restitution at the contact point, e = -(V_n + d_c Omega)/(v_n + d_c omega) (Eq 16)."""
    v_n, V_n, Omega, d_c, omega = floats(v_n, V_n, Omega, d_c, omega)
    return -(V_n + d_c * Omega) / approach_velocity(v_n, d_c, omega)


def impulse_ratio(v_n: ArrayLike, v_t: ArrayLike, V_n: ArrayLike, V_t: ArrayLike) -> Floats:
    """Tangential over normal impulse, mu = (V_t - v_t)/(V_n - v_n) (Eq 17)."""
    v_n, v_t, V_n, V_t = floats(v_n, v_t, V_n, V_t)
    return (V_t - v_t) / normal_change(v_n, V_n)


def normal_change(v_n: Floats, V_n: Floats) -> Floats:
    """Return V_n - v_n, the normal impulse over the mass, m/s. Raises ImpactError where it pulls."""
    normal: Floats = V_n - v_n
    refuse(~(normal > 0), "the barrier can only push: V_n - v_n must be positive, got {value} m/s", normal)
    return normal


def coefficients(
    v_n: ArrayLike,
    v_t: ArrayLike,
    V_n: ArrayLike,
    V_t: ArrayLike,
    Omega: ArrayLike,
    *,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    omega: ArrayLike = 0.0,
) -> Coefficients:
    """e, mu and e_m of measured or computed velocities (Eq 16-18).

    Parameters
    ----------
    v_n, v_t, V_n, V_t : array_like
        Velocities of the mass centre before and after, m/s.
    Omega, omega : array_like
        Spin after and before, rad/s.
    d_c, d_d : array_like
        Arms of the contact point, m.
    k2 : array_like
        Squared radius of gyration, m2.

    Returns
    -------
    Coefficients
        float64 of the broadcast shape. e_m is infinite where the impulse passes through the mass
        centre (and undefined, nan, if the spin does not change either).

    Raises
    ------
    ImpactError
        If the contact point does not approach, or the normal impulse is not positive.

    Examples
    --------
    >>> e, mu, e_m = coefficients(-2.751, -2.809, -.397, -1.887, 26.94, d_c=.084, d_d=.086, k2=4.84e-3)
    >>> f"{e:.3f} {mu:.3f} {e_m:.2f}"
    '0.678 0.392 -1.10'
    """
    v_n, v_t, V_n, V_t, Omega, omega = floats(v_n, v_t, V_n, V_t, Omega, omega)
    d_c, d_d, k2 = floats(d_c, d_d, k2)
    e, mu = restitution(v_n, V_n, Omega, d_c, omega), impulse_ratio(v_n, v_t, V_n, V_t)
    moment = d_c * (V_n - v_n) - d_d * (V_t - v_t) + k2 * omega
    with np.errstate(divide="ignore", invalid="ignore"):
        return Coefficients(e, mu, -k2 * Omega / moment)


def impulse_centre(
    v_n: ArrayLike,
    v_t: ArrayLike,
    V_n: ArrayLike,
    V_t: ArrayLike,
    Omega: ArrayLike,
    *,
    d_d: ArrayLike,
    k2: ArrayLike,
    omega: ArrayLike = 0.0,
) -> Arms:
    """Arms of the point of the barrier's surface through which the contact impulse acted.

    Eq 18 with e_m = -1 solved for d_c = (k^2 (Omega - omega) + d_d (V_t - v_t))/(V_n - v_n). Unlike e_m it is
    well conditioned at every angle: a distance of a millimetre or two to the geometric contact point shows
    that errors of the arms alone explain why e_m differs from -1.

    Parameters
    ----------
    v_n, v_t, V_n, V_t : array_like
        Velocities of the mass centre before and after, m/s.
    Omega, omega : array_like
        Spin after and before, rad/s.
    d_d : array_like
        Height of the mass centre above the surface, m.
    k2 : array_like
        Squared radius of gyration, m2.

    Returns
    -------
    Arms
        d_c worked out and d_d as given, m, of the broadcast shape.

    Raises
    ------
    ImpactError
        If the normal impulse is not positive.

    Examples
    --------
    >>> centre = impulse_centre(-1.5, -1.48, 0.33, -0.411, 7.11, d_d=0.035, k2=5.56e-4)
    >>> f"{1e3 * centre.d_c:.1f} mm"
    '22.6 mm'
    """
    v_n, v_t, V_n, V_t, Omega, omega = floats(v_n, v_t, V_n, V_t, Omega, omega)
    d_d, k2 = floats(d_d, k2)
    return Arms((k2 * (Omega - omega) + d_d * (V_t - v_t)) / normal_change(v_n, V_n), d_d)
