"""What a sequence of strikes leaves: each strike, what lies between, and how it ended."""

from dataclasses import dataclass
from enum import Enum

from .flight import FlightState


class Finish(Enum):
    """How a sequence of strikes ends."""

    RESTS = "rests"
    ROLLS = "rolls on"
    SLIDES = "slides on"
    LEAVES = "leaves"
    COUNTED = "goes on"
    BOUNCES = "bounces on"
    LOSSLESS = "loses nothing"
    TUMBLES = "tumbles on"
    JAMS = "jams"
    STRONG = "strikes hard"


@dataclass(frozen=True, slots=True)
class Approach:
    """A body that is about to strike.

    Attributes
    ----------
    state : its motion
    corner : number of the corner of the outline that strikes
    place : (x, z) of the contact from the mass centre, m
    d_c, d_d : arms, m
    line : length, m, of a straight part that comes down level and without spin, struck in its middle; else 0
    """

    state: FlightState
    corner: int
    place: tuple[float, float]
    d_c: float
    d_d: float
    line: float

    @property
    def normal(self) -> float:
        """Velocity of the contact point out of the barrier, m/s, below 0."""
        return self.state.V_n + self.d_c * self.state.Omega

    @property
    def sliding(self) -> float:
        """Velocity of the contact point up the slope, m/s."""
        return self.state.V_t - self.d_d * self.state.Omega


@dataclass(frozen=True, slots=True)
class Strike:
    """One strike; impulses and losses per unit mass.

    Attributes
    ----------
    before : the approach
    V_n, V_t, Omega : after it, m/s, rad/s
    e, e_energetic : ratio of the normal velocities of the contact point, and root of the ratio of works
    mu : ratio of impulses
    p, q : normal and tangential impulse, m/s
    normal, friction : energy lost along the normal and to friction, m2/s2
    """

    before: Approach
    V_n: float
    V_t: float
    Omega: float
    e: float
    e_energetic: float
    mu: float
    p: float
    q: float
    normal: float
    friction: float

    @property
    def after(self) -> FlightState:
        """The motion just after it."""
        return self.before.state._replace(V_n=self.V_n, V_t=self.V_t, Omega=self.Omega)

    def having(self, e: float, mu: float, friction: float, k2: float) -> "Strike":
        """Return it with another restitution, impulse ratio and friction loss; as it is where it would jam.

        The contact point's normal velocity changes by p (1 + d_c (d_c - mu d_d)/k^2); ``k2``, m2.
        """
        before, state = self.before, self.before.state
        ease = 1.0 + before.d_c * (before.d_c - mu * before.d_d) / k2
        if ease <= 0.0:
            return self
        p = -before.normal * (1.0 + e) / ease
        q, turn = mu * p, p * (before.d_c - mu * before.d_d) / k2
        lost = -p * (state.V_n + 0.5 * p) - q * (state.V_t + 0.5 * q) - k2 * turn * (state.Omega + 0.5 * turn)
        V_n, V_t, Omega = state.V_n + p, state.V_t + q, state.Omega + turn
        return Strike(before, V_n, V_t, Omega, e, self.e_energetic, mu, p, q, lost - friction, friction)


@dataclass(frozen=True, slots=True)
class Phase:
    """What lies between strikes: a flight, whose two states are exact, or a contact that is held.

    ``impulse`` is that of the contact along n and t, per unit mass, m/s, and about the mass centre, m2/s;
    ``heat`` that of friction, per unit mass, m2/s2.
    """

    flies: bool
    states: tuple[FlightState, ...]
    impulse: tuple[float, float, float] = (0.0, 0.0, 0.0)
    heat: float = 0.0


@dataclass(frozen=True, slots=True)
class Sequence:
    """Strikes from the first touch on; energies per unit mass, m2/s2.

    Attributes
    ----------
    start, end : the motion at first touch and at the end
    strikes : those that count
    small : strikes too weak to count, which end without rebound
    phases : flights and contacts that were held, in order of time
    settled : energy of the last rocking on both feet, lost at once; ``settling``: its impulses, as of a phase
    finish : how it ended
    residual : what the balance of energy, gravity's potential included, misses
    """

    start: FlightState
    end: FlightState
    strikes: tuple[Strike, ...]
    small: tuple[Strike, ...]
    phases: tuple[Phase, ...]
    settled: float
    settling: tuple[float, float, float]
    finish: Finish
    residual: float

    @property
    def held_heat(self) -> float:
        """Friction heat of contacts that are held: sliding between strikes and at the end."""
        return sum(phase.heat for phase in self.phases)
