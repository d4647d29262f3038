"""The centre of the contact impulse: the contact point for which e_m = -1."""

from numpy.typing import ArrayLike

from .arms import Arms
from .arrays import floats
from .coefficients import normal_change


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
