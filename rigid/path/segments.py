"""The contact point's velocities against the normal impulse: two straight pieces and a kink.

With p the normal impulse per unit mass and s the ratio of tangential to normal impulse,

    d v_cn/dp = (1 + d_c^2/k^2) - (d_c d_d/k^2) s,    d v_ct/dp = (1 + d_d^2/k^2) s - d_c d_d/k^2,

where s = f against the sliding, and s = s_0 = d_c d_d/(k^2 + d_d^2) while the point sticks, which friction
can hold if abs(s_0) <= f. Sliding ends in sticking or in reverse sliding, and neither ends again.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..inputs import Floats

T = TypeVar("T", float, Floats)
NEVER = 1e12
"""Sliding that needs more than this times the approach velocity as impulse is taken never to stop."""


@dataclass(frozen=True, slots=True)
class Segments:
    """Velocities at p = 0, and the slopes before (0) and after (1) the kink at p_s.

    Attributes
    ----------
    u, w : float64, m/s
        Normal and tangential velocity of the contact point at p = 0.
    n, t : pair of float64
        Slopes of the two velocities against p.
    s : pair of float64
        Ratio of tangential to normal impulse.
    p_s : float64, m/s
        Where the first sliding ends; infinite if it would go on for ever.
    """

    u: Floats
    w: Floats
    n: tuple[Floats, Floats]
    t: tuple[Floats, Floats]
    s: tuple[Floats, Floats]
    p_s: Floats

    def _kinked(self, start: Floats, slope: tuple[Floats, Floats], p: Floats) -> tuple[Floats, Floats]:
        """Value of a two-piece line at the kink (or at p, if that comes first), and at p."""
        first = np.minimum(p, self.p_s)
        kink = start + slope[0] * first
        return kink, kink + slope[1] * (p - first)

    def normal(self, p: Floats) -> Floats:
        """Return the normal velocity of the contact point at impulse `p`, m/s."""
        return self._kinked(self.u, self.n, p)[1]

    def tangential_impulse(self, p: Floats) -> Floats:
        """Tangential impulse per unit mass up to normal impulse `p`, m/s."""
        return self._kinked(np.zeros_like(p), self.s, p)[1]

    def normal_work(self, p: Floats) -> tuple[Floats, Floats]:
        """Work of the normal impulse up to the kink and from there to `p`, m2/s2."""
        first = np.minimum(p, self.p_s)
        kink, end = self._kinked(self.u, self.n, p)
        return 0.5 * (self.u + kink) * first, 0.5 * (kink + end) * (p - first)

    def tangential_work(self, p: Floats) -> tuple[Floats, Floats]:
        """Work of friction up to the kink and from there to `p`, m2/s2."""
        first = np.minimum(p, self.p_s)
        slid = 0.5 * self.s[0] * (self.w + self._kinked(self.w, self.t, p)[0]) * first
        return slid, 0.5 * self.s[1] * self.t[1] * (p - first) ** 2

    def reaching(self, v: Floats) -> Floats:
        """Impulse at which v_cn rises through `v` >= 0, m/s."""
        forever = np.isinf(self.p_s)
        start = np.where(forever, 0.0, self.p_s)
        kink = self.u + self.n[0] * start
        early = forever | (v <= kink)
        slope = np.where(early, self.n[0], self.n[1])
        return np.where(early, (v - self.u) / slope, start + (v - kink) / slope)

    def regaining(self, work: Floats, p_c: Floats) -> Floats:
        """Impulse, m/s, at which the work since the end of compression at `p_c` reaches `work`, m2/s2."""
        forever = np.isinf(self.p_s)
        split = np.where(forever, p_c, np.maximum(self.p_s, p_c))
        v = self.normal(split)
        rest = work - 0.5 * v * (split - p_c)
        early = forever | (rest <= 0)
        from_p_c = np.sqrt(2.0 * work / np.where(early, self.n[0], 1.0))
        from_kink = (np.sqrt(v**2 + 2.0 * self.n[1] * np.maximum(rest, 0.0)) - v) / self.n[1]
        return np.where(early, p_c + from_p_c, split + from_kink)


def compliances(d_c: T, d_d: T, k2: T) -> tuple[T, T, T]:
    """Return d v_cn/dp, d v_ct/dp = d v_cn/dq and d v_ct/dq, with q the tangential impulse per unit mass."""
    return 1.0 + d_c**2 / k2, -d_c * d_d / k2, 1.0 + d_d**2 / k2


def segments(u: Floats, w: Floats, f: Floats, *, d_c: Floats, d_d: Floats, k2: Floats) -> Segments:
    """Two pieces from the contact point's velocities u, w (m/s) and the friction f."""
    n_n, n_t, t_t = compliances(d_c, d_d, k2)
    slide, hold = -f * np.sign(w), np.clip(-n_t / t_t, -f, f)
    t_slide = t_t * slide + n_t
    t_after = np.where(np.abs(n_t / t_t) <= f, 0.0, t_t * hold + n_t)
    stops = -t_slide * np.sign(w) * NEVER * np.abs(u) > np.abs(w)
    p_s = np.where(stops, -w / np.where(stops, t_slide, 1.0), np.where(w == 0, 0.0, np.inf))
    return Segments(
        u, w, n=(n_n + n_t * slide, n_n + n_t * hold), t=(t_slide, t_after), s=(slide, hold), p_s=p_s
    )
