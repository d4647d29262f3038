"""Free flight over a barrier, exact: a parabola and a constant spin, until the outline touches."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from scipy.optimize import brentq

from ..rounds import TURN, Round
from .outline import Outline

EXACT, SOON = 1e-15, 1e-20  # relative and absolute error, s, of a root
TWICE = 2.0  # the time that a body which does not slow down takes to come out of its dent


class FlightState(NamedTuple):
    """A body in the plane of motion.

    Attributes
    ----------
    time : s
    height, along : of the mass centre over the barrier and up the slope, m
    alpha : inclination, rad, counted on over full turns
    V_n, V_t, Omega : m/s, rad/s
    """

    time: float
    height: float
    along: float
    alpha: float
    V_n: float
    V_t: float
    Omega: float

    def moving(self, k2: float) -> float:
        """Return the kinetic energy per unit mass, m2/s2, of a body of squared radius of gyration k2, m2."""
        return 0.5 * (self.V_n**2 + self.V_t**2 + k2 * self.Omega**2)

    def flown(self, dt: float, g_n: float, g_t: float) -> "FlightState":
        """Return the state after a flight of ``dt``, s, under accelerations g_n, g_t, m/s2, out of -n, -t."""
        return FlightState(
            self.time + dt,
            self.height + dt * (self.V_n - 0.5 * dt * g_n),
            self.along + dt * (self.V_t - 0.5 * dt * g_t),
            self.alpha + dt * self.Omega,
            self.V_n - dt * g_n,
            self.V_t - dt * g_t,
            self.Omega,
        )


def next_touch(
    outline: Outline, state: FlightState, g_n: float, lifting: float = 0.0
) -> tuple[float, int] | None:
    """Return when, s from now, a body in flight touches the barrier next, and with which corner.

    None of a body that never does. The corner that is lowest changes at known times, so that the gap under
    each is a parabola and a sinusoid; between the times at which its curvature changes sign (closed form) it
    has one extreme value at most, and between those one root at most, which Brent's method finds.
    A gap of zero that opens is no touch. The corner that is lowest now is not looked at for a time
    ``lifting``, s, in which its gap is no more than round-off.
    """
    end = _latest(outline, state, g_n)
    if end is None:
        return None
    for start, stop, number in _turns(outline, state, g_n, end):
        start = start or min(lifting, stop)
        touch = _first_root(outline.corners[number], state, g_n, start, stop)
        if touch is not None:
            return touch, number
    return None


def clears(outline: Outline, state: FlightState, g_n: float) -> float | None:
    """Return when, s from now, a body that has pressed itself in comes out; None if it does not.

    It is 0 of a body that stands above the barrier.
    """

    def gap(dt: float) -> float:
        flown = state.flown(dt, g_n, 0.0)
        one = outline.corners[outline.lowest(flown.alpha, flown.Omega)]
        return flown.height - one.arms(flown.alpha)[1]

    sunk, one = -gap(0.0), outline.corners[outline.lowest(state.alpha, state.Omega)]
    if sunk <= 0.0:
        return 0.0
    rises = state.V_n + one.arms(state.alpha)[0] * state.Omega
    late = TWICE * sunk / rises if rises > 0.0 else 0.0
    return float(brentq(gap, 0.0, late, xtol=SOON, rtol=EXACT)) if gap(late) > 0.0 else None


def _latest(outline: Outline, state: FlightState, g_n: float) -> float | None:
    """Return a time, s, by which the body has touched if it ever does, None where it cannot."""
    fall = max(state.height - outline.least, 0.0)
    if g_n > 0.0:
        return (state.V_n + math.sqrt(state.V_n**2 + 2.0 * g_n * fall)) / g_n * (1.0 + 1e-9) + 1e-12
    if state.V_n < 0.0:
        return -fall / state.V_n * (1.0 + 1e-9) + 1e-12
    rise = max(outline.widest - state.height, 0.0)
    turn = TURN / abs(state.Omega) if state.Omega else 0.0
    return min(turn, rise / state.V_n) if state.V_n > 0.0 else turn or None


def _turns(
    outline: Outline, state: FlightState, g_n: float, end: float
) -> Iterator[tuple[float, float, int]]:
    """Yield start and end, s, of each time in which one corner is lowest, and its number.

    Those in which the body is too high to touch are left out.
    """
    number, spin = outline.lowest(state.alpha, state.Omega), state.Omega
    if not spin:
        yield 0.0, end, number
        return
    step, start = (1 if spin > 0.0 else -1), 0.0
    one = outline.corners[number]
    base = state.alpha - (state.alpha - one.low) % TURN  # of the corner's own turn
    if base + (one.high - one.low) < state.alpha - 1e-9:
        base += TURN
    bound = base + (one.high - one.low) if spin > 0.0 else base
    widest, turn = outline.widest, TURN / abs(spin)
    over, above = state.V_n**2 - 2.0 * g_n * (widest - state.height), (math.inf, math.inf)
    if g_n > 0.0 and over > 0.0:  # the mass centre is higher than that between two times
        above = (state.V_n - math.sqrt(over)) / g_n, (state.V_n + math.sqrt(over)) / g_n
    while start < end:
        if above[0] < start < above[1]:  # whole turns are too high to touch
            skipped = max(0, int((min(above[1], end) - start) / turn) - 1)
            start += skipped * turn
            bound += step * skipped * TURN
        stop = min(end, max(start, (bound - state.alpha) / spin))
        height = min(state.height + t * (state.V_n - 0.5 * g_n * t) for t in (start, stop))
        if height <= widest:
            yield start, stop, number
        start, number = stop, outline.beside(number, step)
        bound += step * (outline.corners[number].high - outline.corners[number].low)


def _first_root(one: Round, state: FlightState, g_n: float, start: float, stop: float) -> float | None:
    """Return the first time between two, s, at which the gap under a corner closes."""
    spin = state.Omega

    def gap(t: float) -> float:
        height = state.height + t * (state.V_n - 0.5 * g_n * t)
        return height - one.arms(state.alpha + spin * t)[1]

    def closing(t: float) -> float:
        return state.V_n - g_n * t + spin * one.arms(state.alpha + spin * t)[0]

    for a, b in pairwise(_pieces(one, state, g_n, start, stop)):
        ends = closing(a), closing(b)
        turn = [brentq(closing, a, b, xtol=SOON, rtol=EXACT)] if ends[0] * ends[1] < 0.0 else []
        for low, high in pairwise([a, *turn, b]):
            if high > low and closing(0.5 * (low + high)) < 0.0 and gap(high) <= 0.0:
                return low if gap(low) <= 0.0 else float(brentq(gap, low, high, xtol=SOON, rtol=EXACT))
    return None


def _pieces(one: Round, state: FlightState, g_n: float, start: float, stop: float) -> list[float]:
    """Return times, s, between which the second derivative of a gap does not change sign.

    It is -g_n - Omega^2 n, where n = rho cos(alpha + phi) is the height of the corner's centre over the mass
    centre.
    """
    away, spin = math.hypot(one.x, one.z), state.Omega
    if spin == 0.0 or away * spin**2 <= g_n:
        return [start, stop]
    phase, angle = math.atan2(one.x, one.z), math.acos(-g_n / (away * spin**2))
    first, last = sorted(state.alpha + spin * t for t in (start, stop))
    places = []
    for root in (angle - phase, -angle - phase):
        at = root + TURN * math.ceil((first - root) / TURN)
        while at < last:
            places.append(at)
            at += TURN
    inside = sorted((at - state.alpha) / spin for at in places)
    return [start, *(t for t in inside if start < t < stop), stop]
