"""Upper bound of the energy that an impulse at the contact point can take, for any contact law."""

from numpy.typing import ArrayLike

from .arrays import Floats, floats


def pinned_loss(
    v_n: ArrayLike, v_t: ArrayLike, *, d_c: ArrayLike, d_d: ArrayLike, k2: ArrayLike, mass: ArrayLike
) -> Floats:
    """Loss if the contact point stops dead, m (v_n^2 + v_t^2)/2 - L^2/(2 I_c), J.

    An impulse through the contact point keeps the angular momentum about it,
    L = m (d_d v_t - d_c v_n), and among all motions with this L the rotation about the contact point, with
    I_c = m (k^2 + d_c^2 + d_d^2), has the least energy. So no friction, restitution, reversal, number
    of contacts or vibration can take more from the rod's rigid motion, as long as the impulse acts at
    this point.

    Parameters
    ----------
    v_n, v_t : array_like
        Velocity of the mass centre before impact, m/s; the rod does not spin.
    d_c, d_d : array_like
        Arms of the contact point, m.
    k2 : array_like
        Squared radius of gyration, m2.
    mass : array_like
        kg.

    Returns
    -------
    float64 of the broadcast shape, J

    Examples
    --------
    >>> f"{pinned_loss(-1.5, -1.5, d_c=0.0226, d_d=0.035, k2=5.56e-4, mass=0.175):.3f} of 0.394 J"
    '0.381 of 0.394 J'
    """
    v_n, v_t, d_c, d_d, k2, mass = floats(v_n, v_t, d_c, d_d, k2, mass)
    turning = (d_d * v_t - d_c * v_n) ** 2 / (k2 + d_c**2 + d_d**2)
    return 0.5 * mass * (v_n**2 + v_t**2 - turning)
