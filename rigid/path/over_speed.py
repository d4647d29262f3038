"""The sliding path where friction depends on the sliding speed, in small steps of the normal impulse.

Within a step friction is that of the speed in its middle, so that velocities are straight lines and works are
exact; the equations are those of `rigid.path.segments`.
"""

from collections.abc import Sequence
from math import copysign, inf, sqrt

import numpy as np

from ..inputs import ImpactError, floats
from ..massive import Motion, approach_velocity
from .resolve import End, SlidingPath

STEPS = 400  # of the impulse that would stop a smooth approach
MOST = 50 * STEPS  # until friction that presses the point into the barrier has stopped it


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
    n_n, n_t, t_t = 1.0 + d_c**2 / k2, -d_c * d_d / k2, 1.0 + d_d**2 / k2
    hold, step = -n_t / t_t, -u / n_n / STEPS
    speeds, factors = (np.asarray(row, dtype=np.float64) for row in over)

    def ratio(w: float) -> float:
        """Return tangential over normal impulse at a tangential velocity, m/s."""
        most = f * float(np.interp(abs(w), speeds, factors))
        return float(np.clip(hold, -most, most)) if w == 0 else -copysign(most, w)

    p, q, p_c, p_s = 0.0, 0.0, inf, 0.0 if w == 0 else inf
    works, stored = np.zeros((2, 2)), 0.0
    for _ in range(MOST):
        dp, s = step, ratio(w)
        if w != 0:
            middle = w + 0.5 * dp * (t_t * s + n_t)
            s = ratio(middle) if middle * w > 0 else s
        slope_n, slope_t = n_n + n_t * s, t_t * s + n_t
        slope_t = 0.0 if w == 0 and s == hold else slope_t
        stops = w * (w + slope_t * dp) < 0
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
