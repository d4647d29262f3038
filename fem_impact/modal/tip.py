"""What presses into a surface: a round tip with straight parts on both sides."""

from math import acos, atan, inf, pi, sin, sqrt
from typing import NamedTuple

from fem_impact.fem.kernels import inlined


class Flank(NamedTuple):
    """A side of a tip: a straight part that it goes over into.

    Its slope, how far it reaches along t, m, and the slope beyond; all are infinite where the tip is round.
    """

    slope: float
    end: float
    beyond: float


ROUND = Flank(inf, inf, inf)


class Tip(NamedTuple):
    """What presses: its radius, m, and its sides."""

    radius: float
    behind: Flank
    ahead: Flank


@inlined
def outline(tip: Tip, x: float, sinks: float) -> tuple[float, float, float]:
    """Return height, m, and slope of a tip at a distance x, m, from what is lowest of it, and a rate, m.

    Both are those over a surface that sinks beside the contact; the rate is that of the height by ``sinks``.
    """
    radius, behind, ahead = tip
    bent, past = x / radius, max(x - ahead.end, -x - behind.end)
    slope = min(max(bent, -behind.slope), ahead.slope)
    if past <= 0.0:
        rate, grows = 0.5 * slope * x, 1.0 if slope == bent else 0.5
        return slope * (x - 0.5 * radius * slope) + sinks * rate, (1.0 + grows * sinks) * slope, rate
    way, side = (1.0, ahead) if x > 0.0 else (-1.0, behind)
    rate = 0.5 * (abs(slope) * side.end + side.beyond * past)
    height = slope * (way * side.end - 0.5 * radius * slope) + side.beyond * past
    return height + sinks * rate, (1.0 + 0.5 * sinks) * way * side.beyond, rate


@inlined
def half_length(radius: float, side: Flank, depth: float) -> float:
    """Return how far, m, a tip of a radius, m, touches on a side at a depth, m."""
    slope, end, beyond = side
    if slope > 0.0 and depth <= 0.5 * radius * slope**2:
        return sqrt(2 * radius * depth)
    rise = slope * (end - 0.5 * radius * slope)
    return depth / slope + 0.5 * radius * slope if depth <= rise else end + (depth - rise) / beyond


@inlined
def lean(radius: float, side: Flank, depth: float) -> float:
    """Return the angle to the surface, rad, of a side of a tip beside its contact at a depth, m.

    Slip lines reach half as far beyond a contact as it is long (Hill 1950, The Mathematical Theory of
    Plasticity): it is the mean over so much.
    """
    slope, end, beyond = side
    flank = atan(slope)
    round_to = min(acos(max(1.0 - depth / radius, -1.0)), flank)
    reach, rest = sin(round_to), flank - round_to  # over the radius
    angle = flank - 0.5 * rest**2 / reach if rest < reach else round_to + 0.5 * reach
    if depth > max(0.5 * radius * slope**2, slope * (end - 0.5 * radius * slope)):
        angle = atan(beyond)
    return min(max(angle, 0.0), 0.5 * pi)
