"""The defect of the sum of losses and retained energy: an identity, not a check of the losses."""

from numpy.typing import ArrayLike

from .arrays import Floats, floats


def closure_defect(
    Omega: ArrayLike, e_m: ArrayLike, *, mass: ArrayLike, k2: ArrayLike, omega: ArrayLike = 0.0
) -> Floats:
    """E_ln + E_lt + E_r - E_0 = (I Omega/2)(Omega + omega)(1 + 1/e_m), J, for any impact.

    It is an identity of Eq 18, 20, 21 and 26, true for any six velocities: at e_m = -1 the losses and the
    retained energy add up to E_0 in every case. So a table that closes tests its mass, its moment of
    inertia and e_m = -1, and nothing else: rigid-body velocities do not contain the share of vibration,
    or the division of the loss between friction and plastic work.

    Parameters
    ----------
    Omega, omega : array_like
        Spin after and before impact, rad/s.
    e_m : array_like
        Moment restitution, not 0.
    mass, k2 : array_like
        kg, m2.

    Returns
    -------
    float64 of the broadcast shape, J

    Examples
    --------
    >>> f"{closure_defect(27.0, -1.05, mass=0.5, k2=4.84e-3):.4f} J"
    '0.0420 J'
    """
    Omega, e_m, mass, k2, omega = floats(Omega, e_m, mass, k2, omega)
    return 0.5 * mass * k2 * Omega * (Omega + omega) * (1.0 + 1.0 / e_m)
