"""Energy losses: from velocities (Eq 20, 21, 26), from coefficients (Eq 23-25), at most by any contact."""

from typing import NamedTuple

from .inputs import ArrayLike, Floats, floats
from .massive import phi


class Losses(NamedTuple):
    """Normal and tangential loss, retained and initial kinetic energy, J."""

    E_ln: Floats
    E_lt: Floats
    E_r: Floats
    E_0: Floats

    def fractions(self) -> "Losses":
        """All four divided by E_0."""
        return Losses(*(value / self.E_0 for value in self))


class PredictedLosses(NamedTuple):
    """Normal and tangential loss, J."""

    E_ln: Floats
    E_lt: Floats


def kinetic_energy(
    v_n: ArrayLike, v_t: ArrayLike, spin: ArrayLike, *, mass: ArrayLike, k2: ArrayLike
) -> Floats:
    """Kinetic energy m (v_n^2 + v_t^2 + k^2 spin^2)/2, J (Eq 26 for the motion after impact)."""
    v_n, v_t, spin, mass, k2 = floats(v_n, v_t, spin, mass, k2)
    return 0.5 * mass * (v_n**2 + v_t**2 + k2 * spin**2)


def losses(
    v_n: ArrayLike,
    v_t: ArrayLike,
    V_n: ArrayLike,
    V_t: ArrayLike,
    Omega: ArrayLike,
    *,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    mass: ArrayLike,
    omega: ArrayLike = 0.0,
) -> Losses:
    """Work lost by the normal and tangential impulse, and energy kept (Eq 20, 21 and 26).

    Each loss is minus the impulse times the mean velocity of the contact point in its direction. The
    tangential one is neither friction heat nor, when the tip reverses, a bound on it.

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
    mass : array_like
        kg.

    Returns
    -------
    Losses
        E_ln, E_lt, E_r, E_0 in J, float64 of the broadcast shape.

    Examples
    --------
    >>> lost = losses(-2.751, -2.809, -.397, -1.887, 26.94, d_c=.083, d_d=.086, k2=4.84e-3, mass=.5)
    >>> f"{lost.E_ln:.3f} {lost.E_lt:.3f} {lost.E_r:.3f} J"
    '0.537 1.616 1.808 J'
    """
    v_n, v_t, V_n, V_t, Omega, omega = floats(v_n, v_t, V_n, V_t, Omega, omega)
    d_c, d_d, mass = floats(d_c, d_d, mass)
    spin = omega + Omega
    return Losses(
        -0.5 * mass * (V_n - v_n) * (v_n + V_n + d_c * spin),
        -0.5 * mass * (V_t - v_t) * (v_t + V_t - d_d * spin),
        kinetic_energy(V_n, V_t, Omega, mass=mass, k2=k2),
        kinetic_energy(v_n, v_t, omega, mass=mass, k2=k2),
    )


def predicted_losses(
    v_n: ArrayLike,
    v_t: ArrayLike,
    *,
    e: ArrayLike,
    mu: ArrayLike,
    e_m: ArrayLike = -1.0,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    mass: ArrayLike,
) -> PredictedLosses:
    """Losses of a rod without initial spin, from its coefficients alone (Eq 23-25).

    Parameters as in `solve` and `losses`; the result is in J and of the broadcast shape. It is the
    same as `losses` of what `solve` gives, and says nothing about how the losses split further.

    Examples
    --------
    >>> lost = predicted_losses(-1.6, -1.6, e=0.67, mu=0.32, d_c=0.083, d_d=0.086, k2=4.84e-3, mass=0.5)
    >>> f"{lost.E_ln:.4f} {lost.E_lt:.4f} J"
    '0.1807 0.4504 J'
    """
    v_n, v_t, e, mu, e_m, mass = floats(v_n, v_t, e, mu, e_m, mass)
    d_c, d_d, k2 = floats(d_c, d_d, k2)
    factor = 1.0 + phi(mu=mu, e_m=e_m, d_c=d_c, d_d=d_d, k2=k2)
    normal = 0.5 * mass * v_n**2 * (1.0 - e**2) / factor
    bracket = (
        mu * v_n * (e + 1.0) * (d_d**2 * e_m - k2)
        + 2.0 * v_t * (k2 - e_m * d_c**2)
        + d_c * d_d * e_m * (2.0 * mu * v_t - (1.0 + e) * v_n)
    )
    tangential = 0.5 * mass * v_n * mu * (1.0 + e) * bracket / (k2 * factor**2)
    return PredictedLosses(normal, tangential)


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
