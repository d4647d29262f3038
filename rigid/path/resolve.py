"""Motion after impact from the sliding path, for three laws of restitution.

A point contact (e_m = -1) on a massive barrier, everything in closed form. References: Stronge, Impact
Mechanics, Cambridge (energetic restitution); Wang and Mason, J. Appl. Mech. 59 (1992), 635 (sticking and
reversal in the impulse plane). Above the Painleve threshold sliding presses the point further into the
barrier, yet it stops, sticks and rebounds: the equations in impulses have a solution where those in forces
have none.

Where friction depends on the sliding speed (`path_over_speed`), the path goes in small steps of the normal
impulse. Within a step friction is that of the speed in its middle, so that velocities are straight lines and
works are exact; the equations are those of `rigid.path.segments`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from math import copysign, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from ..inputs import ArrayLike, Floats, ImpactError, floats, refuse
from ..massive import Motion, approach_velocity
from .segments import Segments, compliances, segments


class End(IntEnum):
    """How the contact point moves at separation."""

    SLIP = 0
    STICK = 1
    REVERSE = 2


@dataclass(frozen=True, slots=True)
class SlidingPath:
    """A resolved impact; all arrays have the broadcast shape, impulses and works are per unit mass.

    Attributes
    ----------
    motion : Motion
        V_n, V_t (m/s) and Omega (rad/s) after impact.
    end : int array
        `End` of each impact.
    p_c, p_f, p_s : float64, m/s
        Normal impulse at greatest compression, at separation, and where the first sliding ends (infinite
        if it never would; beyond p_f if separation comes first).
    mu : float64
        Impulse ratio of the whole impact.
    e, e_kinetic, e_energetic : float64
        The three restitutions of the outcome, whichever was given: ratio of normal velocities of the
        contact point, of impulses, root of the ratio of works. Kinematic e may exceed 1.
    normal_work, tangential_work : pair of float64, m2/s2
        Work on the rod during the first sliding and after it. Friction's is never positive.
    """

    motion: Motion
    end: NDArray[np.int_]
    p_c: Floats
    p_f: Floats
    p_s: Floats
    mu: Floats
    e: Floats
    e_kinetic: Floats
    e_energetic: Floats
    normal_work: tuple[Floats, Floats]
    tangential_work: tuple[Floats, Floats]

    @property
    def loss(self) -> Floats:
        """Kinetic energy lost per unit mass, m2/s2."""
        return -(sum(self.normal_work) + sum(self.tangential_work))  # type: ignore[return-value]


LAWS: dict[str, Callable[[Segments, Floats, Floats], Floats]] = {
    "kinematic": lambda path, e, p_c: path.reaching(-e * path.u),
    "kinetic": lambda path, e, p_c: (1.0 + e) * p_c,
    "energetic": lambda path, e, p_c: path.regaining(-(e**2) * sum(path.normal_work(p_c)), p_c),
}
"""Impulse at separation by Newton's, Poisson's and Stronge's definition of restitution.

From the path, e and the impulse p_c at greatest compression (m/s, per unit mass).
"""


def sliding_path(
    v_n: ArrayLike,
    v_t: ArrayLike,
    *,
    e: ArrayLike,
    f: ArrayLike,
    d_c: ArrayLike,
    d_d: ArrayLike,
    k2: ArrayLike,
    omega: ArrayLike = 0.0,
    law: str = "energetic",
) -> SlidingPath:
    """Resolve compression and restitution, sliding, sticking and reverse sliding.

    Parameters
    ----------
    v_n, v_t : array_like
        Velocity of the mass centre before impact, m/s.
    e : array_like
        Restitution in the sense of `law`, not negative.
    f : array_like
        Coefficient of Coulomb friction, not negative (an input; `mu` of the result is the outcome).
    d_c, d_d : array_like
        Arms of the contact point, m.
    k2 : array_like
        Squared radius of gyration, m2.
    omega : array_like
        Spin before impact, rad/s.
    law : "kinematic", "kinetic" or "energetic"
        Definition of e.

    Returns
    -------
    SlidingPath

    Raises
    ------
    ImpactError
        If the contact does not close, e or f is negative, or the kinematic or kinetic e given would
        make energy.

    Examples
    --------
    At 17 degrees the tip sticks, and the impulse ratio falls short of friction:

    >>> rod = dict(d_c=0.0046, d_d=0.0403, k2=5.56e-4)
    >>> path = sliding_path(-2.13, -0.63, e=0.527, f=0.57, **rod)
    >>> End(path.end).name, f"{path.mu:.3f}"
    ('STICK', '0.134')
    """
    v_n, v_t, e, f, omega = np.broadcast_arrays(*floats(v_n, v_t, e, f, omega))
    d_c, d_d, k2 = floats(d_c, d_d, k2)
    if law not in LAWS:
        raise ImpactError(f"law must be one of {', '.join(LAWS)}, got {law!r}")
    u, w = approach_velocity(v_n, d_c, omega), v_t - d_d * omega
    refuse(~(e >= 0), "restitution must not be negative, got {value}", e)
    refuse(~(f >= 0), "friction must not be negative, got {value}", f)
    path = segments(u, w, f, d_c=d_c, d_d=d_d, k2=k2)
    p_c = path.reaching(np.zeros_like(path.p_s))
    p_f = LAWS[law](path, e, p_c)
    q = path.tangential_impulse(p_f)
    motion = Motion(v_n + p_f, v_t + q, omega + (d_c * p_f - d_d * q) / k2)
    # collect the result; refuse a rebound that needs more work than the compression stored
    works = path.normal_work(p_f)
    stored = -sum(path.normal_work(p_c))
    returned = np.maximum(sum(works) + stored, 0.0)  # round-off can leave it below zero
    e_energetic = np.sqrt(returned / stored)
    gain = (
        "this restitution needs an energetic one of {value} > 1, energy from nothing: state it as energetic"
    )
    refuse(e_energetic > 1.0 + 1e-9, gain, e_energetic)
    after = np.where(path.t[1] == 0, End.STICK, np.where(path.w == 0, End.SLIP, End.REVERSE))
    return SlidingPath(
        motion=motion,
        end=np.where(p_f <= path.p_s, End.SLIP, after),
        p_c=p_c,
        p_f=p_f,
        p_s=path.p_s,
        mu=q / p_f,
        e=-path.normal(p_f) / path.u,
        e_kinetic=p_f / p_c - 1.0,
        e_energetic=e_energetic,
        normal_work=works,
        tangential_work=path.tangential_work(p_f),
    )


STEPS = 400  # a step changes either velocity by at most this part of its largest size so far
MOST = 50 * STEPS  # enough for a slide that drives the contact in, where steps grow with the speed


def path_over_speed(
    v_n: float,
    v_t: float,
    *,
    e: float,
    f: float,
    over: tuple[Sequence[float], Sequence[float]],
    d_c: float,
    d_d: float,
    k2: float,
    omega: float = 0.0,
) -> SlidingPath:
    """Resolve one impact as `rigid.sliding_path` does, with an energetic e and friction over speed.

    Parameters
    ----------
    over : sliding speeds, m/s, from 0 on, and the factor of `f` at each; the last one holds beyond

    Raises
    ------
    ImpactError
        If the contact does not close, or sliding drives it in without end.

    Examples
    --------
    Friction that falls with the speed takes less from a fast slide:

    >>> rod = dict(e=0.4, f=0.5, d_c=0.02, d_d=0.035, k2=5.6e-4)
    >>> path = path_over_speed(-1.5, -3.0, over=((0.0, 4.0), (1.0, 0.5)), **rod)
    >>> f"{path.mu:.2f}"
    '0.30'
    """
    u, w = start = float(approach_velocity(*floats(v_n, d_c, omega))), v_t - d_d * omega
    n_n, n_t, t_t = compliances(d_c, d_d, k2)
    hold = -n_t / t_t
    speeds, factors = (np.asarray(row, dtype=np.float64) for row in over)

    def ratio(w: float) -> float:
        """Return tangential over normal impulse at a tangential velocity, m/s."""
        most = f * float(np.interp(abs(w), speeds, factors))
        return float(np.clip(hold, -most, most)) if w == 0 else -copysign(most, w)

    p, q, p_c, p_s = 0.0, 0.0, inf, 0.0 if w == 0 else inf
    works, stored = np.zeros((2, 2)), 0.0
    for _ in range(MOST):
        s = ratio(w)
        slopes = abs(n_n + n_t * s), abs(t_t * s + n_t)
        sizes = max(abs(u), -start[0]), max(abs(w), abs(start[1]), -start[0])
        dp = min(size / max(slope, 1e-9) for size, slope in zip(sizes, slopes, strict=True)) / STEPS
        if w != 0:
            middle = w + 0.5 * dp * (t_t * s + n_t)
            s = ratio(middle) if middle * w > 0 else s
        slope_n, slope_t = n_n + n_t * s, t_t * s + n_t
        if w == 0 and s == hold:  # it holds on: nothing changes until compression ends, or the impact
            dp, slope_t = inf, 0.0
        stops = w != 0 and w * (w + slope_t * dp) < 0
        dp = -w / slope_t if stops else dp
        if p_c == inf and u + slope_n * dp >= 0:
            dp, stops = -u / slope_n, False
        rest = e**2 * stored - (works[0].sum() + stored)  # work that is still given back, m2/s2
        last = p_c < inf and (u + 0.5 * slope_n * dp) * dp >= rest
        if last:
            dp, stops = (sqrt(u**2 + 2 * slope_n * rest) - u) / slope_n, False
        after = int(p >= p_s)
        works[0, after] += (u + 0.5 * slope_n * dp) * dp
        works[1, after] += s * (w + 0.5 * slope_t * dp) * dp
        u, w, p, q = u + slope_n * dp, 0.0 if stops else w + slope_t * dp, p + dp, q + s * dp
        p_s = p if stops and p_s == inf else p_s
        if last:
            end = End.STICK if w == 0 else End.SLIP if w * start[1] >= 0 else End.REVERSE
            (n_slid, n_rest), (t_slid, t_rest) = (floats(*row) for row in works)
            given = floats(p_c, p, p_s, q / p, -u / start[0], p / p_c - 1.0, e)
            names = "p_c", "p_f", "p_s", "mu", "e", "e_kinetic", "e_energetic"
            return SlidingPath(
                motion=Motion(*floats(v_n + p, v_t + q, omega + (d_c * p - d_d * q) / k2)),
                end=np.array(end),
                normal_work=(n_slid, n_rest),
                tangential_work=(t_slid, t_rest),
                **dict(zip(names, given, strict=True)),
            )
        if p_c == inf and abs(u) < 1e-12 * abs(start[0]):
            p_c, stored = p, -float(works[0].sum())
    raise ImpactError("friction drives the contact into the barrier without end")
