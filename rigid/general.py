"""The general planar system: Eq 1-8, with external impulses, a moving barrier and changed inertia.

Eq 1 is restitution at the contact point, Eq 2 the impulse ratio, Eq 3 the moment restitution. Table 1 of
the paper gives their coefficients; its right-hand side is printed with the opposite sign, all three
entries of it, so A x = b holds with the b of this module and fails with the printed one.
"""

from dataclasses import KW_ONLY, dataclass

import numpy as np

from .inputs import ArrayLike, Floats, floats, refuse
from .losses import kinetic_energy
from .massive import Motion, approach_velocity


@dataclass(frozen=True, slots=True)
class General:
    """A planar impact; every entry is an array_like and all broadcast together.

    Parameters
    ----------
    v_n, v_t, omega : array_like
        Motion before impact, m/s and rad/s.
    e, mu, e_m : array_like
        Kinematic restitution, impulse ratio of the contact, moment restitution.
    d_c, d_d : array_like
        Arms before impact, m.
    mass, k2 : array_like
        kg and m2; the inertia before impact is I = mass k2.
    D_c, D_d, J : array_like, optional
        Arms (m) and inertia (kg m2) just after impact; unchanged unless given.
    v_bn : array_like
        Velocity of the barrier along n, m/s.
    P_1n, P_1t, M_1 : array_like
        Impulses (N s) and moment impulse (N m s) that act without the contact.
    """

    v_n: ArrayLike
    v_t: ArrayLike
    omega: ArrayLike = 0.0
    _: KW_ONLY
    e: ArrayLike
    mu: ArrayLike
    e_m: ArrayLike = -1.0
    d_c: ArrayLike
    d_d: ArrayLike
    mass: ArrayLike
    k2: ArrayLike
    D_c: ArrayLike | None = None
    D_d: ArrayLike | None = None
    J: ArrayLike | None = None
    v_bn: ArrayLike = 0.0
    P_1n: ArrayLike = 0.0
    P_1t: ArrayLike = 0.0
    M_1: ArrayLike = 0.0

    @property
    def is_closed(self) -> bool:
        """Whether nothing but a barrier at rest can give or take energy."""
        outside = np.any(np.asarray(self.v_bn)) or any(map(np.any, (self.P_1n, self.P_1t, self.M_1)))
        return not outside and self.J is None and self.D_c is None and self.D_d is None

    def solve(self) -> Motion:
        """Motion after impact.

        Returns
        -------
        Motion
            V_n, V_t (m/s), Omega (rad/s), float64 of the broadcast shape.

        Raises
        ------
        ImpactError
            If the contact does not close, the body has no mass or inertia, the rebound would go through
            the barrier, the system is singular, the barrier would have to pull, or energy would
            be created. A kinematic e above 1 is no error: friction can turn tangential energy
            into rebound.

        Examples
        --------
        >>> rod = dict(d_c=0.0226, d_d=0.035, mass=0.175, k2=5.56e-4)
        >>> V_n, V_t, Omega = General(-1.5, -1.48, e=0.327, mu=0.584, **rod).solve()
        >>> f"{V_n:.3f} {V_t:.3f} {Omega:.2f}"
        '0.330 -0.411 7.11'
        """
        v_n, omega, d_c, v_bn, e = floats(self.v_n, self.omega, self.d_c, self.v_bn, self.e)
        approach_velocity(v_n, d_c, omega, v_bn)
        refuse(~(e >= 0), "with e = {value} < 0 the rod would pass through the barrier", e)
        inertia = _inertia_and_arms(self)[1]
        for name, value in (("mass", self.mass), ("k2", self.k2), ("inertia J", inertia)):
            refuse(~(np.asarray(value) > 0), f"{name} must be positive, got {{value}}", value)
        A, b = system(self)
        singular = np.abs(np.linalg.det(A)) <= 1e-12 * np.abs(A).max(axis=(-1, -2))
        refuse(singular, "the equations are singular: no finite impulse gives this restitution", singular)
        after = Motion(*np.moveaxis(np.linalg.solve(A, b[..., None])[..., 0], -1, 0))
        # refuse a solution in which the barrier pulls, or a closed impact that gains energy
        v_n, v_t, omega, mass, P_1n, k2 = floats(
            self.v_n, self.v_t, self.omega, self.mass, self.P_1n, self.k2
        )
        push = mass * (after.V_n - v_n) - P_1n
        refuse(~(push > 0), "the barrier can only push, but its normal impulse would be {value} N s", push)
        if self.is_closed:
            before = kinetic_energy(v_n, v_t, omega, mass=mass, k2=k2)
            gain = kinetic_energy(*after, mass=mass, k2=k2) - before
            refuse(gain > 1e-9 * before, "these coefficients would make {value} J from nothing", gain)
        return after


def system(s: General) -> tuple[Floats, Floats]:
    """Matrix and right-hand side of Eq 8 (Table 1, with the sign of b that Eq 1-3 demand).

    Returns
    -------
    A : (..., 3, 3) float64
    b : (..., 3) float64
        Unknowns are (V_n, V_t, Omega); the paper prints -b.
    """
    v_n, v_t, omega, e, mu, e_m, v_bn = floats(s.v_n, s.v_t, s.omega, s.e, s.mu, s.e_m, s.v_bn)
    mass, d_c, d_d, P_1n, P_1t, M_1 = floats(s.mass, s.d_c, s.d_d, s.P_1n, s.P_1t, s.M_1)
    I, J, D_c, D_d = _inertia_and_arms(s)
    gamma, delta = (d_c + e * D_c) / ((1 + e) * I), (d_d + e * D_d) / ((1 + e) * I)  # Eq 4, 5
    zero, one = np.zeros(()), np.ones(())
    rows = [
        [one, zero, D_c, v_bn - e * (v_n + d_c * omega - v_bn)],
        [mu, -one, zero, mu * v_n - v_t - (P_1t - mu * P_1n) / mass],
        [
            e_m * mass * gamma,
            -e_m * mass * delta,
            1 - e_m * (J / I - 1),
            e_m * (gamma * (mass * v_n + P_1n) - delta * (mass * v_t + P_1t) - omega - M_1 / I),
        ],
    ]
    entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
    table = np.stack(entries, axis=-1).reshape(*entries[0].shape, 3, 4)
    return table[..., :3], table[..., 3]


def _inertia_and_arms(s: General) -> tuple[Floats, ...]:
    """Inertia I and J (kg m2), arms D_c and D_d (m); after impact as before unless stated."""
    I = np.asarray(s.mass, dtype=np.float64) * np.asarray(s.k2, dtype=np.float64)
    after = (s.J, I), (s.D_c, s.d_c), (s.D_d, s.d_d)
    return floats(I, *(old if new is None else new for new, old in after))
