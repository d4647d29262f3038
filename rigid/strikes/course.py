"""From the first strike of a rigid body to its rest: flights, strikes, and contacts that are held.

Rules that the theory of impact does not give by itself:

- two feet that touch at the same instant strike one after the other, each with its own restitution; a face
  or a side that comes down level and without spin strikes in its middle;
- a strike that brings along its normal less than a share ``least`` of the most with which one began does not
  rebound: its contact is held, and the body pivots, rolls or slides on it, or flies again;
- a body on two feet of which neither moves faster than that stands on them; what it moved with is lost;
- a body of which `LOSSLESS` strikes in a row lose nothing along their normal is followed no further to its
  rest, of which theory tells nothing;
- a body that has fallen so far down a slope that it is far faster than at first tumbles on.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from ..path.resolve import sliding_path
from ..rounds import TURN
from .flight import FlightState, next_touch
from .held import Ending, Pull, hold
from .outline import LEVEL_ANGLE, Outline
from .record import Approach, Finish, Phase, Sequence, Strike

LEAST = 1e-4
MOST = 1000
LOSSLESS = 200
"""Strikes in a row without a loss along their normal, after which a body is not followed on to its rest."""
EVENTS = 5
"""Flights and contacts at most, over the most strikes."""
LONGEST = 30.0
"""Of a contact that is held, in times that the mass centre takes to fall by the body's width."""
LEVEL_SPIN = 1e-9
"""Speed by which a line that comes down turns its ends, over its own, below which it comes down level."""
LEVEL_LINE = 1e-4
"""Of the width: a shorter straight part is a place where one arc passes into the next."""
FOREVER = 1e6
"""Time, s: a body that would slide longer slides on."""
TOUCHING = 1e-9
"""Normal velocity, over that of all energy at first touch, within which a corner keeps touching."""
GRAZING = 1e-3
"""Of that velocity: a contact that comes down more slowly only touches."""
RUNAWAY = 10.0
"""Kinetic energy before a strike, over that at first touch and that of a fall by twice the width, above which
a body tumbles down a slope faster and faster."""
UNSTICK = 1e-4
"""Of that time, or of the time of a turn by a radian: so long a corner that lifts off is not looked at."""

Restitution = Callable[[Approach], float]
Moved = Callable[[Strike], Strike]


def as_it_is(strike: Strike) -> Strike:
    """Return a strike as the law of its restitution gives it."""
    return strike


def sequence(
    outline: Outline,
    start: FlightState,
    pull: Pull,
    restitution: Restitution,
    *,
    until: int | None = None,
    least: float = LEAST,
    most: int = MOST,
    energy: float | None = None,
    most_energy: float = 0.0,
    strong: float = math.inf,
    moved: Moved = as_it_is,
) -> Sequence:
    """Follow a rigid body from its first touch.

    Parameters
    ----------
    outline : of the body
    start : the motion just before it touches; its height is that at which it does
    pull : gravity, squared radius of gyration and friction
    restitution : energetic restitution of a strike
    until : number of strikes after which to stop; None: follow it to its rest
    least : share of the most kinetic energy before any strike below which one does not rebound
    most : strikes at most; a body that loses nothing strikes for ever
    energy : kinetic energy at the first touch of a body that has struck before, per unit mass, m2/s2
    most_energy : the most that such a body has had before a strike, the same
    strong : share of it along the normal at which to stop before a strike, for another model to take over
    moved : changes a strike that counts, such as by what another model gives of it

    Raises
    ------
    ImpactError
        The body does not come down on the barrier.

    Examples
    --------
    >>> from rigid import Projectile
    >>> from rigid.strikes import outline
    >>> rod = Projectile(0.24, 0.019, "B", 0.003, 7850.0)
    >>> body = outline(rod)
    >>> start = FlightState(0.0, rod.arms(1.4).d_d, 0.0, 1.4, -2.0, 0.0, 0.0)
    >>> found = sequence(body, start, Pull(9.81, 0.0, rod.k2, 0.3), lambda strike: 0.5)
    >>> found.finish.value
    'rests'
    """
    course = _Course(
        outline, pull, restitution, until, least, most, start, energy, most_energy, strong, moved
    )
    corner: int | None = None
    for _ in range(EVENTS * most):
        corner = course.fly() if corner is None else course.keep(corner)
        if course.finish is not None:
            break
    return course.result(start)


@dataclass
class _Course:
    """A sequence as it grows; `fly` and `keep` return the corner on which the contact is held, or None."""

    outline: Outline
    pull: Pull
    restitution: Restitution
    until: int | None
    least: float
    most: int
    state: FlightState
    energy: float | None
    most_energy: float
    strong: float
    moved: Moved
    strikes: list[Strike] = field(default_factory=list)
    small: list[Strike] = field(default_factory=list)
    phases: list[Phase] = field(default_factory=list)
    settled: float = 0.0
    settling: tuple[float, float, float] = (0.0, 0.0, 0.0)
    finish: Finish | None = None
    slips: bool = False
    lossless: int = 0
    lifting: float = 0.0

    def __post_init__(self) -> None:
        self.E_0 = self._moving if self.energy is None else self.energy
        self.most_energy = max(self.most_energy, self.E_0)
        g = math.hypot(self.pull.g_n, self.pull.g_t)
        self.touching = TOUCHING * math.sqrt(2.0 * self.E_0)
        self.runaway = RUNAWAY * (self.E_0 + 2.0 * g * self.outline.widest)
        self.unit = math.sqrt(self.outline.widest / g) if g else math.inf

    @property
    def _moving(self) -> float:
        """Kinetic energy now, per unit mass, m2/s2."""
        return self.state.moving(self.pull.k2)

    def fly(self) -> int | None:
        """Fly to the next touch and strike."""
        touch = next_touch(self.outline, self.state, self.pull.g_n, self.lifting)
        self.lifting = 0.0
        if touch is None:
            self.finish = Finish.LEAVES
            return None
        dt, corner = touch
        if dt > 0.0:
            after = self.state.flown(dt, self.pull.g_n, self.pull.g_t)
            self.phases.append(Phase(True, (self.state, after)))
            self.state = after
        if self._moving > self.runaway:
            self.finish = Finish.TUMBLES
            return None
        return self._strike(corner)

    def keep(self, corner: int) -> int | None:
        """Hold the contact with a corner until something changes."""
        other = self._other_foot(corner)
        if other is not None:
            tips = self._stand(corner, other)
            if self.finish is not None:
                return None
            if tips is None and min(self._speed(corner), self._speed(other)) < -self.touching:
                return None  # a foot strikes at once
            corner = corner if tips is None else tips
        if self._speed(corner) > self.touching:
            return None
        held = hold(self.outline.corners[corner], self.state, self.pull, LONGEST * self.unit, self.slips)
        self.slips = held.ending is Ending.SLIPPED
        if len(held.states) > 1:
            self.phases.append(Phase(False, held.states, held.impulse, held.heat))
            self.state = held.states[-1]
        if held.ending is Ending.LIFTED:
            turning = 1.0 / abs(self.state.Omega) if self.state.Omega else math.inf
            soon = UNSTICK * min(self.unit, turning)
            self.lifting = soon if math.isfinite(soon) else 0.0
            return None
        if held.ending is Ending.LINE:
            return self._roll_over(corner)
        if held.ending is Ending.JAMS:
            self.finish = Finish.JAMS
        elif held.ending is Ending.LASTS:
            self.finish = Finish.SLIDES if held.slid else Finish.ROLLS
        return corner

    def result(self, start: FlightState) -> Sequence:
        """Return what was found; a body that neither rests nor leaves after all its strikes bounces on."""
        lost = sum(one.normal + one.friction for one in (*self.strikes, *self.small))
        lost += self.settled + sum(phase.heat for phase in self.phases)
        return Sequence(
            start,
            self.state,
            tuple(self.strikes),
            tuple(self.small),
            tuple(self.phases),
            self.settled,
            self.settling,
            self.finish or Finish.BOUNCES,
            self._energy(start) - self._energy(self.state) - lost,
        )

    def _energy(self, state: FlightState) -> float:
        """Return kinetic and potential energy, per unit mass, m2/s2."""
        pull = self.pull
        return state.moving(pull.k2) + pull.g_n * state.height + pull.g_t * state.along

    def _approach(self, corner: int) -> Approach:
        """Return the approach of a corner, or of the level line from it."""
        state, one = self.state, self.outline.corners[corner]
        (d_c, d_d), place, line = one.arms(state.alpha), one.place(state.alpha), 0.0
        other = self._other_foot(corner)
        if other is not None:
            far = self.outline.corners[other]
            away = far.arms(state.alpha)[0]
            if abs(state.Omega * (away - d_c)) <= LEVEL_SPIN * abs(state.V_n):
                line, d_c = abs(away - d_c), 0.5 * (away + d_c)
                x, z = far.place(state.alpha)
                place = 0.5 * (place[0] + x), 0.5 * (place[1] + z)
        return Approach(state, corner, place, d_c, d_d, line)

    def _speed(self, corner: int) -> float:
        """Return the normal velocity, m/s, of a corner's lowest point."""
        return self.state.V_n + self.outline.corners[corner].arms(self.state.alpha)[0] * self.state.Omega

    def _other_foot(self, corner: int) -> int | None:
        """Return the number of a corner that touches beside one: at the other end of a level line."""
        one, state = self.outline.corners[corner], self.state
        for step, bound in ((1, one.high), (-1, one.low)):
            away = (state.alpha - bound + 0.5 * TURN) % TURN - 0.5 * TURN
            if abs(away) < LEVEL_ANGLE and self._is_line(corner, step):
                return self.outline.beside(corner, step)
        return None

    def _is_line(self, corner: int, step: int) -> bool:
        return self.outline.flat(corner, step) > LEVEL_LINE * self.outline.widest

    def _strike(self, corner: int) -> int | None:
        """Strike; return the corner if its contact is held."""
        before = self._approach(corner)
        if before.normal >= -GRAZING * self.touching:
            self._settle(self.state._replace(V_n=self.state.V_n - before.normal))
            return corner
        along_normal = 0.5 * before.normal**2 / (1.0 + before.d_c**2 / self.pull.k2)
        self.most_energy = max(self.most_energy, self._moving)
        if along_normal >= self.strong * self.most_energy:
            self.finish = Finish.STRONG
            return None
        first = self.energy is None and not self.strikes
        counts = first or along_normal >= self.least * self.most_energy
        e = self.restitution(before) if counts else 0.0
        strike = _resolved(before, e, self.pull)
        strike = self.moved(strike) if counts else strike
        (self.strikes if counts else self.small).append(strike)
        if counts:
            self.lossless = self.lossless + 1 if strike.e_energetic == 1.0 else 0
        self.state = strike.after
        if counts and len(self.strikes) == self.until:
            self.finish = Finish.COUNTED
        elif counts and len(self.strikes) >= self.most:
            self.finish = Finish.BOUNCES
        elif counts and self.until is None and self.lossless >= LOSSLESS:
            self.finish = Finish.LOSSLESS
        return None if self._speed(corner) > self.touching else corner

    def _stand(self, corner: int, other: int) -> int | None:
        """Stand on both feet if they hardly move; return the foot over which the body then tips, if it does.

        None where a foot still strikes, or where the body has come to its end.
        """
        state, k2 = self.state, self.pull.k2
        feet = [self.outline.corners[one].arms(state.alpha)[0] for one in (corner, other)]
        moving = 0.5 * (state.V_n**2 + k2 * state.Omega**2)
        weak = [
            0.5 * (state.V_n + d_c * state.Omega) ** 2 / (1.0 + d_c**2 / k2) < self.least * self.most_energy
            for d_c in feet
        ]
        if moving > 1e-20 * self.E_0 and not all(weak):
            return None
        V_t = 0.0 if abs(state.V_t) <= self.touching else state.V_t
        self._settle(state._replace(V_n=0.0, V_t=V_t, Omega=0.0))
        return self._slide((corner, feet[0]), (other, feet[1]))

    def _slide(self, foot: tuple[int, float], other: tuple[int, float]) -> int | None:
        """Slide on two feet, each a number and its arm d_c, or return the foot over which the body tips."""
        pull, state = self.pull, self.state
        most = pull.f * pull.g_n
        if state.V_t:
            a_t = -math.copysign(most, state.V_t)
        else:
            a_t = pull.g_t if abs(pull.g_t) <= most else math.copysign(most, pull.g_t)
        d_d = state.height
        load = (a_t * d_d - pull.g_n * foot[1]) / (other[1] - foot[1])  # that of the other foot, per mass
        if load < 0.0:
            return foot[0]
        if load > pull.g_n:
            return other[0]
        gain = a_t - pull.g_t
        if state.V_t * gain < 0.0 and abs(state.V_t) < FOREVER * abs(gain):
            dt = -state.V_t / gain  # it slides so long
            way = dt * (state.V_t + 0.5 * dt * gain)
            after = state._replace(time=state.time + dt, along=state.along + way, V_t=state.V_t + dt * gain)
            self.phases.append(Phase(False, (state, after), (dt * pull.g_n, dt * a_t, 0.0), -a_t * way))
            self.state = after._replace(V_t=0.0)
            return self._slide(foot, other)
        self.finish = Finish.SLIDES if state.V_t or gain else Finish.RESTS
        return None

    def _roll_over(self, corner: int) -> int | None:
        """Pass on from a corner that the body has turned over: roll on to the next, or strike with it."""
        one = self.outline.corners[corner]
        past_middle = math.remainder(self.state.alpha - 0.5 * (one.low + one.high), TURN) > 0.0
        step = 1 if past_middle else -1
        following = self.outline.beside(corner, step)
        if self._is_line(corner, step):
            return self._strike(following)
        d_c, d_d = self.outline.corners[following].arms(self.state.alpha)
        self._settle(self.state._replace(V_n=-d_c * self.state.Omega, height=d_d))
        return following

    def _settle(self, state: FlightState) -> None:
        """Go on with a state at the same time and book what that loses."""
        was, (p, q, moment) = self.state, self.settling
        turned = self.pull.k2 * (state.Omega - was.Omega)
        self.settling = p + state.V_n - was.V_n, q + state.V_t - was.V_t, moment + turned
        self.settled += self._energy(was) - self._energy(state)
        self.state = state


def _resolved(before: Approach, e: float, pull: Pull) -> Strike:
    state = before.state
    path = sliding_path(
        *(state.V_n, state.V_t), e=e, f=pull.f, d_c=before.d_c, d_d=before.d_d, k2=pull.k2, omega=state.Omega
    )
    V_n, V_t, Omega = (float(v) for v in path.motion)
    p = V_n - state.V_n
    return Strike(
        before,
        *(V_n, V_t, Omega),
        e=float(path.e),
        e_energetic=e,
        mu=float(path.mu),
        p=p,
        q=V_t - state.V_t,
        normal=-float(sum(path.normal_work)),
        friction=-float(sum(path.tangential_work)),
    )
