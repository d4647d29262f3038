"""A body that keeps touching with one corner: it pivots, rolls or slides until that ends."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from ..inputs import Floats
from ..path.segments import compliances
from ..rounds import Round
from .flight import FlightState
from .outline import LEVEL_ANGLE

TOLERANCE = 1e-12
STUCK = 1e-12
"""Sliding speed, over speeds of the body and that of a fall by its height, below which it counts as none."""

BEYOND = 0.01 * LEVEL_ANGLE
"""Turn, rad, beyond the end of a corner at which it ends, so that none ends by round-off as it begins."""


class Ending(Enum):
    """How a contact that is held ends."""

    LIFTED = "it lifts off"
    LINE = "the next corner comes down"
    SLIPPED = "it begins to slide"
    STUCK = "it stops sliding"
    LASTS = "it goes on"
    JAMS = "friction drives it into the barrier"


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """A contact that was held.

    Attributes
    ----------
    states : (m,) from its begin to its end
    heat : of friction, per unit mass, m2/s2
    impulse : of the contact along n and t, per unit mass, m/s, and about the mass centre, m2/s
    ending : why it ended
    slid : whether it slid
    """

    states: tuple[FlightState, ...]
    heat: float
    impulse: tuple[float, float, float]
    ending: Ending
    slid: bool


@dataclass(frozen=True, slots=True)
class Pull:
    """What acts: accelerations g_n, g_t out of -n and -t, m/s2, squared radius of gyration, m2, friction."""

    g_n: float
    g_t: float
    k2: float
    f: float


def hold(one: Round, state: FlightState, pull: Pull, longest: float, slips: bool = False) -> Held:
    """Follow a contact with one corner that does not rebound, for a time, s, at most.

    With the normal and tangential acceleration a_n, a_t by the contact, the mass centre's height over the
    corner gives a_n - g_n = -d_c spin' - (d_d - r) spin^2, and spin' = (a_n d_c - a_t d_d)/k^2. It sticks, or
    rolls, where abs(a_t) <= f a_n holds its place; else a_t = -f a_n against the sliding. One that ``slips``
    has just reached that limit.
    """
    sliding = _sliding(one, state, pull, slips) if pull.f else 1.0
    a_n = _forces(one, pull, sliding, state.alpha, state.Omega)[0]
    if math.isnan(a_n):
        return Held((state,), 0.0, (0.0, 0.0, 0.0), Ending.JAMS, False)
    if a_n <= 0.0:
        return Held((state,), 0.0, (0.0, 0.0, 0.0), Ending.LIFTED, False)
    return _integrated(one, state, pull, sliding, longest)


def _sliding(one: Round, state: FlightState, pull: Pull, slips: bool) -> float:
    """Return 1 or -1 for a contact that slides up or down the slope, 0 for one that sticks."""
    d_c, d_d = one.arms(state.alpha)
    w = state.V_t - d_d * state.Omega
    fast = abs(state.V_t) + (abs(d_c) + abs(d_d)) * abs(state.Omega) + math.sqrt(pull.g_n * abs(d_d))
    if abs(w) > STUCK * fast:
        return math.copysign(1.0, w)
    a_n, a_t, _ = _forces(one, pull, 0.0, state.alpha, state.Omega)
    if abs(a_t) <= pull.f * a_n and not slips:
        return 0.0
    return -math.copysign(1.0, a_t)  # friction would have to hold it by more than it can


def _forces(one: Round, pull: Pull, sliding: float, alpha: float, spin: float) -> tuple[float, float, float]:
    """Return a_n and a_t, m/s2, by the contact, and the change of the spin, rad/s2; nan where it jams."""
    (d_c, d_d), k2 = one.arms(alpha), pull.k2
    push = pull.g_n - (d_d - one.radius) * spin**2
    if sliding:
        ratio = -pull.f * sliding
        stiffness = 1.0 + d_c * (d_c - ratio * d_d) / k2
        a_n = push / stiffness if stiffness > 0.0 else math.nan
        a_t = ratio * a_n
    else:
        # 1 + d_c^2/k2   -d_c d_d/k2    a_n   push
        # -d_c d_d/k2    1 + d_d^2/k2   a_t   g_t - d_c spin^2
        n_n, n_t, t_t = compliances(d_c, d_d, k2)
        drag = pull.g_t - d_c * spin**2
        det = n_n * t_t - n_t**2
        a_n, a_t = (push * t_t - n_t * drag) / det, (n_n * drag - n_t * push) / det
    return a_n, a_t, (a_n * d_c - a_t * d_d) / k2


def _integrated(one: Round, state: FlightState, pull: Pull, sliding: float, longest: float) -> Held:
    """Integrate alpha, spin, V_t, way along the barrier, heat and the three impulses of the contact."""
    from scipy.integrate import solve_ivp

    def rates(_: float, y: Floats) -> list[float]:
        alpha, spin, V_t = float(y[0]), float(y[1]), float(y[2])
        a_n, a_t, turn = _forces(one, pull, sliding, alpha, spin)
        d_d = one.arms(alpha)[1]
        w = V_t - d_d * spin if sliding else 0.0
        along = V_t if sliding else d_d * spin
        return [spin, turn, a_t - pull.g_t, along, -a_t * w, a_n, a_t, pull.k2 * turn]

    base = state.alpha - one.low - (state.alpha - one.low) % (2.0 * math.pi)
    low, high = base + one.low, base + one.high
    if state.alpha > high + 1e-9:  # it stands at the end that is the begin of a full turn
        low, high = low + 2.0 * math.pi, high + 2.0 * math.pi

    def lifts(_: float, y: Floats) -> float:
        return _forces(one, pull, sliding, float(y[0]), float(y[1]))[0]

    def changes(_: float, y: Floats) -> float:
        if sliding:
            return sliding * float(y[2] - one.arms(float(y[0]))[1] * y[1])
        a_n, a_t, _turn = _forces(one, pull, 0.0, float(y[0]), float(y[1]))
        return pull.f * a_n - abs(a_t)

    full = high - low > 2.0 * math.pi - 1e-9
    watched: list[tuple[Callable[[float, Floats], float], float, Ending]] = [
        (lifts, -1.0, Ending.LIFTED),
        *([(changes, -1.0, Ending.STUCK if sliding else Ending.SLIPPED)] if pull.f else []),
        *([] if full else [(lambda _, y: float(y[0]) - high - BEYOND, 1.0, Ending.LINE)]),
        *([] if full else [(lambda _, y: low - float(y[0]) - BEYOND, 1.0, Ending.LINE)]),
    ]
    start = [min(max(state.alpha, low), high), state.Omega, state.V_t, state.along, 0.0, 0.0, 0.0, 0.0]
    scale = max(abs(state.Omega), math.sqrt(pull.g_n / (math.hypot(one.x, one.z) + one.radius)))
    size = math.sqrt(pull.k2)
    rate = np.array(
        [1.0, scale, size * scale, size, (size * scale) ** 2, *[size * scale] * 2, pull.k2 * scale]
    )
    found: Any = solve_ivp(
        rates,
        (0.0, longest),
        start,
        method="DOP853",
        rtol=TOLERANCE,
        atol=TOLERANCE * 1e-2 * rate,
        events=[_event(function, way) for function, way, _ in watched],
    )
    ended = [ending for (_, _, ending), at in zip(watched, found.t_events, strict=True) if len(at)]
    states = tuple(
        _state(one, state.time + float(t), y, sliding) for t, y in zip(found.t, found.y.T, strict=True)
    )
    heat, *impulse = (float(v) for v in found.y[4:, -1])
    ending = ended[0] if ended else Ending.LASTS
    return Held(states, heat, (impulse[0], impulse[1], impulse[2]), ending, bool(sliding))


def _event(function: Callable[[float, Floats], float], way: float) -> Callable[[float, Floats], float]:
    """Return a function that ends an integration where it crosses zero upwards (1) or downwards (-1)."""

    def event(t: float, y: Floats) -> float:
        return function(t, y)

    event.terminal, event.direction = True, way  # type: ignore[attr-defined]
    return event


def _state(one: Round, time: float, y: Floats, sliding: float) -> FlightState:
    """Return a state on the corner, whose velocities keep the contact."""
    alpha, spin, V_t, along = (float(v) for v in y[:4])
    d_c, d_d = one.arms(alpha)
    return FlightState(time, d_d, along, alpha, -d_c * spin, V_t if sliding else d_d * spin, spin)
