"""Where the rod may touch: the rounds of its outline, turned to the attitude of its first contact."""

from math import pi

import numpy as np

from fem_impact.arrays import Array
from fem_impact.modal.motion import Sites
from rigid.rounds import Round

ALIKE = 0.2  # share by which radii of a curve may differ from that where it touches, to count as one arc


def rotated(alpha: float, x: Array, z: Array) -> tuple[Array, Array]:
    """Return (t, n) of vectors (x, z) in the frame of a rod inclined at ``alpha``, rad."""
    return np.cos(alpha) * x + np.sin(alpha) * z, np.cos(alpha) * z - np.sin(alpha) * x


def nearest_skin(rounds: list[Round], alpha: float) -> Array:
    """Return the place (x, z), m, of each curve that is, or is nearest to being, lowest at ``alpha``, rad."""
    curves = [[one for one in rounds if one.curve == k] for k in range(rounds[-1].curve + 1)]
    places = []
    for arcs in curves:
        turned = min(max(alpha, arcs[0].low), arcs[-1].high)
        x, z, r, *_ = next(arc for arc in arcs if turned <= arc.high)
        places.append((x + r * np.sin(turned), z - r * np.cos(turned)))
    return np.array(places)


def sites_of(
    rounds: list[Round], centre: tuple[float, float], angle: float, along_t: Array, along_n: Array
) -> Sites:
    """Return the sites of a rod at first contact.

    Parameters
    ----------
    rounds : of its outline; centre : (x, z) of its mass centre, m
    angle : rad; at one below 0 the rod is the mirror image of one inclined as much the other way
    along_t, along_n : (s, k) displacement of each curve by each mode, kg^-1/2, in the frame of that rod
    """
    side, alpha = -1.0 if angle < 0 else 1.0, abs(angle)
    # each contiguous: the kernels would be compiled once more for strided ones
    x, z, radius, low, high, curve = np.ascontiguousarray(np.array(rounds).T)
    t, n = rotated(alpha, x - centre[0] * side, z - centre[1])
    if side > 0:
        low, high = low - alpha, high - alpha
    else:
        t, low, high, along_t = -t, alpha - high, alpha - low, -along_t
        t, n, radius, low, high = (part[::-1].copy() for part in (t, n, radius, low, high))
        curve, along_t, along_n = curve[-1] - curve[::-1], along_t[::-1].copy(), along_n[::-1].copy()
    begin = np.append(np.flatnonzero(np.diff(curve, prepend=-1.0)), len(curve))
    apart = np.zeros(len(along_t), np.bool_)
    sites = Sites(t, n, radius, low, high, np.zeros(len(t)), begin, along_t, along_n, -pi - angle, apart)
    for s in range(len(begin) - 1):
        _join(sites, s)
    return sites


def settle(
    sites: Sites, s: int, turn: float, radius: float, centre: tuple[float, float] | None = None
) -> None:
    """Make the arc of a site that is lowest at a ``turn``, rad, one of a ``radius``, m, through that place.

    Arcs beside it of nearly the same radius become part of it. ``centre`` (t, n), m, is its centre, if known.
    """
    turned, a = lowest(sites, s, turn)
    lean = radius - sites.radius[a]
    t, n = centre or (sites.t[a] - lean * np.sin(turned), sites.n[a] + lean * np.cos(turned))
    first, last = int(sites.begin[s]), int(sites.begin[s + 1]) - 1

    def alike(k: int) -> bool:
        return first <= k <= last and abs(sites.radius[k] / radius - 1.0) < ALIKE

    low, high = a, a
    while alike(low - 1):
        low -= 1
    while alike(high + 1):
        high += 1
    start, end = sites.low[low], sites.high[high]
    sites.low[low:a], sites.high[low:a] = start, start
    sites.low[a + 1 : high + 1], sites.high[a + 1 : high + 1] = end, end
    sites.t[a], sites.n[a], sites.radius[a], sites.low[a], sites.high[a] = t, n, radius, start, end
    _join(sites, s, a)


def lowest(sites: Sites, s: int, turn: float) -> tuple[float, int]:
    """Return the turn, rad, within the range of a site that is nearest to ``turn``, and its arc there."""
    turn -= 2 * pi * np.floor((turn - sites.base) / (2 * pi))
    first, last = int(sites.begin[s]), int(sites.begin[s + 1]) - 1
    turned = float(min(max(turn, sites.low[first]), sites.high[last]))
    return turned, int(np.argmax(sites.high[first : last + 1] >= turned)) + first


def skin(sites: Sites, s: int, turn: float) -> tuple[float, float]:
    """Return the place (t, n), m, from the mass centre at first contact of a site's skin at a turn, rad."""
    turned, a = lowest(sites, s, turn)
    return on_arc(sites, a, turned)


def on_arc(sites: Sites, a: int, turned: float) -> tuple[float, float]:
    """Return the place (t, n), m, as `skin` does, of an arc where it is lowest at a turn, rad, of its own."""
    r = sites.radius[a]
    return float(sites.t[a] + r * np.sin(turned)), float(sites.n[a] - r * np.cos(turned))


def lowest_place(sites: Sites, turn: float, q: Array) -> tuple[float, float]:
    """Return (t, n), m, from the mass centre to what is lowest of a rod at a turn, rad.

    ``q`` (k,) are the amplitudes of its modes, sqrt(kg) m.
    """
    c, sn, places = np.cos(turn), np.sin(turn), []
    for s in range(len(sites.begin) - 1):
        t, n = skin(sites, s, turn)
        t, n = t + sites.along_t[s] @ q, n + sites.along_n[s] @ q
        places.append((float(c * t + sn * n), float(c * n - sn * t)))
    return min(places, key=lambda place: place[1])


def _join(sites: Sites, s: int, start: int | None = None) -> None:
    """Set the offsets of a site, so that its place goes on from arc to arc; that of one arc is its centre."""
    first, last = int(sites.begin[s]), int(sites.begin[s + 1])

    def rolled(a: int, turn: float) -> float:
        c, sn = np.cos(turn), np.sin(turn)
        return float(c * sites.t[a] + sn * sites.n[a] - sites.radius[a] * turn)

    sites.offset[first] = sites.t[first]
    for a in range(first + 1, last):
        joint = sites.low[a]
        sites.offset[a] = sites.offset[a - 1] + rolled(a, joint) - rolled(a - 1, joint)
    if start is not None:
        sites.offset[first:last] += sites.t[start] - sites.offset[start]
