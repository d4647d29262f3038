"""The strikes after the first impact, by rigid theory: each with the restitution of its own contact."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import copysign, hypot, inf, pi, remainder

from fem_impact.case.bodies import WEAKEST, LaterStrike
from fem_impact.case.case import Case
from fem_impact.outcome.keys import Num, Unknown, unknown
from fem_impact.outcome.strikes import PHASED, StrikeRecord, Strikes, hardest, hardest_force, other_end
from fem_impact.physics.contact import ContactPair
from fem_impact.run.common import pull_of, rod_flows
from fem_impact.run.rigid import NormalLoss, normal_loss
from rigid import Body, kinetic_energy
from rigid.strikes import (
    LEAST,
    RUNAWAY,
    Approach,
    Finish,
    FlightState,
    Moved,
    Outline,
    Pull,
    Strike,
    as_it_is,
    clears,
    outline,
    sequence,
)

BESIDE = 1e-6  # rad from the end of a corner's inclinations, at which it touches alone
FINISHED = {
    Finish.RESTS: "It rests.",
    Finish.ROLLS: "It rolls or rocks on without a further strike.",
    Finish.SLIDES: "It slides on.",
    Finish.LEAVES: "It leaves the barrier and does not come back.",
    Finish.COUNTED: "As many strikes as asked for are done.",
    Finish.BOUNCES: "A thousand strikes do not end it: they lose too little, or a slope gives it back.",
    Finish.LOSSLESS: "Two hundred strikes in a row lose nothing along their normal, as no law of the model "
    "takes anything of so slow a strike: no rest can be told.",
    Finish.TUMBLES: "It tumbles down the slope faster and faster.",
    Finish.JAMS: "Friction drives it into the barrier as it slides, which rigid theory does not follow.",
}
RATTLE = 4.0
"""Factor that none of 19 bodies passes between the times to the rest by rigid theory and by modes (study
strikes: the largest is 3.4; it was 4 by the contact law before)."""
SLOWEST = 1e-9  # m/s, of a body that comes down
RULES = (
    f"A strike that brings along its normal less than {WEAKEST:g} ({LEAST:g} with a stated restitution) "
    "of the most energy with which one began does not rebound: its contact is held, and the body pivots, "
    "rolls or slides on it.",
    "Two feet that touch at the same instant strike one after the other; a face or side that "
    "comes down level and without spin strikes in its middle.",
)
LEVEL = (
    "{} of the strikes land a straight part level; their restitution is that of a round contact as wide as "
    "the model allows."
)
LOSSLESS = (
    "{} of the strikes lose nothing along the normal: the contact law knows no loss below its yield speed. "
    "The rattle lasts longer than a real one."
)
AGAIN = (
    "{} of the strikes land in the dent of an earlier one, but are computed as on an undented surface, which "
    "loses too much: a hardened dent gives nearly all back."
)


@dataclass(eq=False)
class Followed:
    """A body that is followed: its outline, what acts on it, a record of each strike, and the books.

    Attributes
    ----------
    losses : restitution and what follows from it, by the motion before a strike of the rigid body
    gravity, settled, heat : J, of gravity, of strikes too weak to count, of friction between strikes
    level, lossless : strikes of the rigid body that land level, and that lose nothing along the normal
    again : numbers of the strikes that met the dent of an earlier one
    upto : strikes after which another model goes on, None where none does
    moved : changes the strikes of the rigid body; see `sequence`
    """

    case: Case
    shape: Outline
    pull: Pull
    each: list[StrikeRecord] = field(default_factory=list)
    losses: dict[FlightState, NormalLoss] = field(default_factory=dict)
    gravity: float = 0.0
    settled: float = 0.0
    heat: float = 0.0
    level: int = 0
    lossless: int = 0
    again: set[int] = field(default_factory=set)
    upto: int | None = None
    moved: Moved = as_it_is

    @classmethod
    def of(cls, case: Case) -> "Followed":
        """Return the body of a case, that has not struck."""
        pull = Pull(*pull_of(case.scene), case.contact.body.k2, case.contact.f)
        return cls(case, outline(case.contact.body), pull)

    @property
    def missing(self) -> int | None:
        """How many strikes are still asked for of this model, None where they are not counted."""
        ends = [end for end in (self.case.scene.impact.most_strikes, self.upto) if end is not None]
        return min(ends) - len(self.each) if ends else None

    def go_on(self, begin: FlightState, strong: float = inf) -> tuple[FlightState, Finish]:
        """Follow the rigid body and book it, to the end or to a ``strong`` strike; see `sequence`."""
        mass = self.case.contact.body.mass
        if self.missing == 0:
            return begin, Finish.COUNTED
        course = sequence(
            self.shape,
            begin,
            self.pull,
            self._restitution,
            until=self.missing,
            least=WEAKEST if self.case.scene.restitution is None else LEAST,
            energy=self.each[0].before / mass if self.each else None,
            most_energy=self._most_energy / mass,
            strong=strong,
            moved=self.moved,
        )
        self.each += [self._record(strike) for strike in course.strikes]
        self.gravity += self.work(begin, course.end)
        self.settled += mass * (sum(one.normal + one.friction for one in course.small) + course.settled)
        self.heat += mass * course.held_heat
        self.level += sum(one.before.line > 0.0 for one in course.strikes)
        self.lossless += sum(one.e_energetic == 1.0 for one in course.strikes)
        return course.end, course.finish

    def doubts(self) -> tuple[str, ...]:
        """Return what is to be told of restitutions that follow from the law of a round contact."""
        if self.case.scene.restitution is not None:
            return ()
        counts = (LEVEL, self.level), (LOSSLESS, self.lossless), (AGAIN, self._again())
        return tuple(sentence.format(count) for sentence, count in counts if count)

    def _again(self) -> int:
        """Return how many strikes land within half a contact's length of a dent that they do not meet."""
        in_body, dents, count = rod_flows(self.case), list[tuple[StrikeRecord, float]](), 0
        for number, one in enumerate(self.each, 1):
            if one.plastic <= 0.0:
                continue
            count += (
                one.fidelity != "solid"
                and number not in self.again
                and any(
                    (hypot(one.x - old.x, one.z - old.z) if in_body else abs(one.along - old.along)) < half
                    for old, half in dents
                )
            )
            dents.append((one, self.later(self.struck_as(one)).contact.estimate.a_t))
        return count

    def kinetic(self, state: FlightState) -> float:
        """Return the kinetic energy of the rigid motion, J."""
        mass, k2 = self.case.contact.body.mass, self.pull.k2
        return float(kinetic_energy(state.V_n, state.V_t, state.Omega, mass=mass, k2=k2))

    def tumbles(self, state: FlightState) -> bool:
        """Return whether the body has become far faster than at first, down a slope; see `sequence`."""
        g = hypot(self.pull.g_n, self.pull.g_t)
        fall = 2.0 * self.case.contact.body.mass * g * self.shape.widest
        return self.kinetic(state) > RUNAWAY * (self.each[0].before + fall)

    def comes(self, state: FlightState) -> tuple[float, float]:
        """Return the speed, m/s, at which the body comes down on what is lowest, and its arm d_c, m."""
        strike = self.lowest(state)
        return max(SLOWEST, -strike.normal), strike.d_c

    def hard(self, state: FlightState) -> bool:
        """Return whether a strike is hard enough for a model that is finer than a rigid body."""
        comes, d_c = self.comes(state)
        brings = 0.5 * self.case.contact.body.mass * comes**2 / (1.0 + d_c**2 / self.pull.k2)
        return brings >= WEAKEST * max(self._most_energy, self.kinetic(state))

    @property
    def _most_energy(self) -> float:
        """The most kinetic energy, J, before a strike so far."""
        return max((one.before for one in self.each), default=0.0)

    def lowest(self, state: FlightState) -> Approach:
        """Return the body as it strikes in a state, with what is lowest of it."""
        number = self.shape.lowest(state.alpha, state.Omega)
        corner = self.shape.corners[number]
        return Approach(state, number, corner.place(state.alpha), *corner.arms(state.alpha), 0.0)

    def later(self, state: FlightState) -> LaterStrike:
        """Return how the body touches in a state, for a mesh that has it so."""
        strike, body = self.lowest(state), self.case.contact.body
        x, z = strike.place
        return LaterStrike(self._pair(strike), state.alpha, (x + body.x_c, z + body.z_c))

    def work(self, start: FlightState, end: FlightState) -> float:
        """Return the work of gravity, J, on the way from one state to another."""
        fell = self.pull.g_n * (start.height - end.height) + self.pull.g_t * (start.along - end.along)
        return self.case.contact.body.mass * fell

    def touching(self, alpha: float, v_n: float, v_t: float, omega: float) -> FlightState:
        """Return a body that touches at an inclination."""
        state = FlightState(0.0, 0.0, 0.0, alpha, v_n, v_t, omega)
        return state._replace(height=self.lowest(state).d_d)

    def struck_as(self, one: StrikeRecord) -> FlightState:
        """Return a body that touches as one did before a strike."""
        return self.touching(one.alpha, one.v_n, one.v_t, one.omega)

    def leave_dent(self, state: FlightState) -> FlightState:
        """Return a body after a strike as its flight brings it level with the surface beside its dent.

        One that does not come so far is lifted there as it is. The work of gravity is booked.
        """
        dt = clears(self.shape, state, self.pull.g_n)
        if dt is None:
            return state._replace(height=self.touching(*state[3:]).height)
        out = state.flown(dt, self.pull.g_n, self.pull.g_t)
        self.gravity += self.work(state, out)
        return out

    @property
    def coming(self) -> FlightState:
        """Return the body as it touches first, with the motion that the scene states."""
        seen = self.case.scene.relative
        return self.touching(seen.angle, seen.v_n, seen.v_t, seen.omega)

    @cached_property
    def _turned_over(self) -> Body:
        """The body with its tail as its tip."""
        return self.case.contact.body.reversed()

    def _restitution(self, strike: Approach) -> float:
        """Return the energetic restitution of a strike, and keep where its loss goes."""
        self.losses[strike.state] = loss = normal_loss(self.case, self._pair(strike))
        return loss.e

    def _pair(self, strike: Approach) -> ContactPair:
        """Return body and barrier as they touch in a strike; of its tail as those of the body turned over."""
        first, state, one = self.case.contact, strike.state, self.shape.corners[strike.corner]
        body, angle = first.body, remainder(state.alpha, 2.0 * pi)
        if not strike.line:  # a corner touches alone, beside an inclination at which a line does
            middle, half = 0.5 * (one.low + one.high), 0.5 * (one.high - one.low) - BESIDE
            angle = remainder(middle + min(max(remainder(angle - middle, 2.0 * pi), -half), half), 2.0 * pi)
        if abs(angle) > 0.5 * pi:
            body, angle = self._turned_over, angle - copysign(pi, angle)
        metal, yields = self.case.bodies.metal_at(strike.place[1] + first.body.z_c)
        return replace(
            first,
            body=body,
            angle=angle,
            v_n=state.V_n,
            v_t=state.V_t,
            omega=state.Omega,
            rod=metal,
            rod_yields=yields,
        )

    def strikes(self, end: FlightState, finish: Finish, vibration: float, damped: float) -> Strikes:
        """Return all strikes; ``vibration``, J, is in the modes, ``damped``, J, lost since the last one."""
        each, case, names = tuple(self.each), self.case, ("friction", "plastic", "damping", "other")
        sums = {name: sum(getattr(one, name) for one in each) for name in names}
        sums["friction"] += self.heat
        sums["damping"] += damped
        left, E_0 = self.kinetic(end) + vibration, each[0].before
        return replace(
            unknown(Strikes, "only one path was computed"),
            until=case.scene.impact.until,
            each=each,
            end=finish.value,
            because=FINISHED[finish],
            time=end.time,
            time_factor=self._time_factor(finish),
            way=end.along,
            hardest_energy=hardest([one.lost for one in each]),
            hardest_force=hardest_force(each),
            hardest_heat=hardest([one.friction for one in each]),
            other_end=other_end(each, case.contact.body.length),
            gravity=self.gravity,
            **sums,
            settled=self.settled,
            left=left,
            residual=(E_0 + self.gravity - sum(sums.values()) - self.settled - left) / E_0,
        )

    def _time_factor(self, finish: Finish) -> Num:
        """Return the factor within which the time to the rest lies, or why none is known."""
        if finish is not Finish.RESTS:
            return Unknown("the body was not followed to its rest")
        if self.each[-1].fidelity != "rigid":
            return Unknown("no model finer than modes is followed to the rest")
        if self.case.scene.restitution is not None:
            return Unknown("of the scene's own restitution no error is known")
        if len(self.shape.corners) == 1:
            return Unknown("rigid theory's rattle was compared with that of modes for rods alone")
        return RATTLE

    def _record(self, strike: Strike) -> StrikeRecord:
        """Return the record of one strike of the rigid body."""
        mass, loss = self.case.contact.body.mass, self.losses[strike.before.state]
        return self.record(
            "rigid",
            *(strike.before, strike.after, (mass * strike.p, mass * strike.q)),
            friction=mass * strike.friction,
            plastic=mass * loss.plastic * strike.normal,
            damping=mass * loss.viscous * strike.normal,
            other=mass * loss.unassigned * strike.normal,
        )

    def record(
        self,
        fidelity: str,
        strike: Approach,
        after: FlightState,
        impulse: tuple[float, float],
        *,
        friction: float,
        plastic: float,
        damping: float,
        force: float | None = None,
        dent: float | None = None,
        gauge: tuple[float | None, float | None] = (None, None),
        vibration: float = 0.0,
        taken: float = 0.0,
        other: float = 0.0,
    ) -> StrikeRecord:
        """Return the record of a strike.

        ``impulse``, N s, is that along n and t, ``gauge`` the largest and the smallest strain; the rest is as
        in `StrikeRecord`, J.
        """
        before, (x, z), body = strike.state, strike.place, self.case.contact.body
        return StrikeRecord(
            time=before.time,
            fidelity=fidelity,
            part=self.part_of(strike),
            x=x + body.x_c,
            z=z + body.z_c,
            along=before.along - strike.d_c + self.case.contact.arms[0],
            alpha=before.alpha,
            approach=-strike.normal,
            sliding=strike.sliding,
            v_n=before.V_n,
            v_t=before.V_t,
            omega=before.Omega,
            V_n=after.V_n,
            V_t=after.V_t,
            Omega=after.Omega,
            e=-(after.V_n + strike.d_c * after.Omega) / strike.normal,
            mu=impulse[1] / impulse[0] if impulse[0] else 0.0,  # a touch that presses nothing has no friction
            impulse_n=impulse[0],
            impulse_t=impulse[1],
            force=force,
            dent=dent,
            highest=gauge[0],
            lowest=gauge[1],
            before=self.kinetic(before),
            after=self.kinetic(after),
            friction=friction,
            plastic=plastic,
            damping=damping,
            vibration=vibration,
            taken=taken,
            other=other,
            **{f"{name}_phase": 0.0 for name in PHASED},
        )

    def part_of(self, strike: Approach) -> str:
        """Return what of the body strikes: an end, a line, a ball."""
        if len(self.shape.corners) == 1:
            return "surface"
        if strike.line:
            return "face" if abs(remainder(strike.state.alpha, pi)) < 0.25 * pi else "side"
        body = self.case.contact.body
        return "tip" if strike.place[1] + body.z_c < 0.5 * body.length else "tail"
