"""Strikes of the reduced model one after the other: between them its modes swing on and are damped."""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np
from scipy.optimize import brentq

from fem_impact.arrays import Array
from fem_impact.case.bodies import WEAKEST
from fem_impact.case.case import PERIODS, Case
from fem_impact.case.effects.damping import loss_factor, states_loss
from fem_impact.case.effects.registry import is_wanted
from fem_impact.modal.dents import Dent
from fem_impact.modal.impact import Arrival, ModalResult
from fem_impact.modal.motion import AT
from fem_impact.modal.rod import ModalRod, modal_rod
from fem_impact.modal.sites import lowest_place
from fem_impact.outcome.strikes import PHASED, StrikeRecord
from fem_impact.run.certain import SEEN
from fem_impact.run.modal import closed
from fem_impact.run.strikes import Followed
from rigid.strikes import Finish, FlightState, next_touch

MOST = 40
"""Strikes that modes compute at most."""
LOOK, LOOKS = 0.5, 1000  # rad of the fastest mode between looks at a rod that nearly touches, and most looks
MARGIN = 1.2  # over the amplitudes of the modes together, about which a touch is looked for
TOLD = (
    "{} strikes are computed with modes, {}; what touches again within {:g} bending periods belongs to the "
    "strike before, but for the slap of the other end after the first. In flight the modes swing on, damped "
    "by the loss factor {}. Strikes after {} by modes are those of a rigid body, and so are weak ones; the "
    "modes do not feel them."
)
FRESH = "each on a surface that no strike before has dented"
AGAIN = (
    "of which {} meet the dents of earlier ones, which give nearly all back (e of a ball .99, by finite "
    "elements .96), all others an undented surface"
)
OF_IRON = "{:g} of iron, as the material states none (`loss_factor`)"
QUARTERS = (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)
"""Cosine and sine of the phases by which vibration that comes in is moved on, to see what that changes."""
LEAST = 1e-3
"""Vibration that comes in, over the energy of the rigid motion, from which on its phase counts."""
SMOOTH = "A rod that leaves its dent touches nothing until it is above the surface beside that."


def modal_loss(case: Case) -> float:
    """Return the loss factor of the modes in flight: 0 only where the scene leaves their damping out."""
    return loss_factor(case.bodies) if is_wanted("material-damping", case.scene.effects) else 0.0


def loss_told(case: Case, loss: float) -> str:
    """Return a loss factor of modes in flight in words: that of iron where the material states none."""
    return OF_IRON.format(loss) if loss and not states_loss(case.bodies) else f"{loss:g}"


@dataclass(eq=False)
class ModalCourse:
    """Strikes by modes so far: the rod after the last of them, with its modes, and a record of each.

    Attributes
    ----------
    rod : with the sites and modes of the case
    state : the rigid motion; q, rate : (k,) amplitudes and rates of the modes, sqrt(kg) m, sqrt(kg) m/s
    loss : loss factor of the modes in flight
    strikes : by modes so far; finished : whether the last one ended
    damped : energy, J, that the modes have lost since the last strike
    dents : that its strikes have left
    """

    case: Case
    followed: Followed
    rod: ModalRod
    state: FlightState
    q: Array
    rate: Array
    loss: float
    strikes: int = 0
    finished: bool = True
    damped: float = 0.0
    dents: tuple[Dent, ...] = ()

    @classmethod
    def at_first(cls, case: Case, followed: Followed) -> "ModalCourse":
        """Return the course after the first strike."""
        first, begin = closed(case), followed.coming
        course = cls(case, followed, first.rod, begin, first.last.q, first.last.rate, modal_loss(case))
        course._enter(begin, first, 0.0, [])
        return course

    @classmethod
    def going_on(cls, case: Case, followed: Followed, state: FlightState) -> "ModalCourse":
        """Return the course of a rod at rest in itself that moves on from a ``state``."""
        rod = modal_rod(case.bodies, case.slots.vibrating)
        rest = np.zeros(len(rod.omega))
        return cls(case, followed, rod, state, rest, rest.copy(), modal_loss(case))

    @property
    def vibration(self) -> float:
        """Energy of the modes, J."""
        return float(self.rod.energies(self.q, self.rate).sum())

    @property
    def told(self) -> tuple[str, ...]:
        """What is to be told of strikes by modes."""
        met = sorted(self.followed.again)
        struck = AGAIN.format(", ".join(map(str, met))) if met else FRESH
        return TOLD.format(self.strikes, struck, PERIODS, loss_told(self.case, self.loss), MOST), SMOOTH

    def to_the_end(self) -> Finish:
        """Follow the rod: hard strikes by modes, what lies between and after them as a rigid body."""
        while self.followed.missing != 0 and self.strikes < MOST and self.finished:
            touch = self._touch()
            if touch is None or not self.followed.hard(touch):
                state, finish = self.followed.go_on(self.state, WEAKEST)
                self.swing_on(state)
                if finish is not Finish.STRONG:
                    return finish
                touch = state
            if self.followed.tumbles(touch):
                break
            self.strike(touch)
        end, finish = self.followed.go_on(self.state)
        self.swing_on(end)
        return finish

    def swing_on(self, state: FlightState) -> None:
        """Take over a later state of the rigid body; what the modes lose meanwhile is damping."""
        held = self.vibration
        self.q, self.rate = self._swung(state.time - self.state.time)
        self.damped += held - self.vibration
        self.state = state

    def strike(self, before: FlightState) -> None:
        """Strike at a later state in flight."""
        self.followed.gravity += self.followed.work(self.state, before)
        self.swing_on(before)
        turn, omega, taken = before.alpha - self.case.scene.impact.angle, self.rod.omega, self.vibration
        arrival = Arrival(
            *(before.V_n, before.V_t, before.Omega, turn, self.q, self.rate), before.along, self.dents
        )
        counts = len(self.followed.each) < SEEN and taken > LEAST * self.followed.kinetic(before)
        others = [
            replace(arrival, q=c * self.q + s * self.rate / omega, rate=c * self.rate - s * omega * self.q)
            for c, s in (QUARTERS if counts else ())
        ]
        nominal, *moved = (closed(self.case, arrival=one, alone=False) for one in (arrival, *others))
        self._enter(before, nominal, taken, moved)

    def _touch(self) -> FlightState | None:
        """Return the rigid motion in which the vibrating rod touches next.

        It is looked for about the touch of the rigid rod, as long as that takes to come by the amplitudes. A
        weak touch is that of the rigid rod.
        """
        pull, rod = self.followed.pull, self.rod
        rigid = next_touch(self.followed.shape, self.state, pull.g_n)
        if rigid is None:
            return None
        touch = self.state.flown(rigid[0], pull.g_n, pull.g_t)
        q, rate = self._swung(rigid[0])
        swing = np.hypot(q, rate / rod.omega) if len(q) else q
        along = np.hypot(rod.sites.along_t, rod.sites.along_n)
        early = MARGIN * float((along @ swing).max(initial=0.0)) / self.followed.comes(touch)[0]
        if early == 0.0 or not self.followed.hard(touch):
            return touch
        step = max(LOOK / float(rod.omega.max()), 2.0 * early / LOOKS)
        looks = np.arange(max(0.0, rigid[0] - early), rigid[0] + early, step).tolist()
        gaps = [self._gap(dt) for dt in looks]
        for low, high, open_, closed_ in zip(looks, looks[1:], gaps, gaps[1:], strict=False):
            if open_ > 0.0 >= closed_:
                dt = float(brentq(self._gap, low, high, xtol=1e-15))
                return self.state.flown(dt, pull.g_n, pull.g_t)
        return touch

    def _gap(self, dt: float) -> float:
        """Return the height, m, of what is lowest of the vibrating rod, ``dt``, s, from now."""
        state = self.state.flown(dt, self.followed.pull.g_n, self.followed.pull.g_t)
        turn = state.alpha - self.case.scene.impact.angle
        return state.height + lowest_place(self.rod.sites, turn, self._swung(dt)[0])[1]

    def _swung(self, dt: float) -> tuple[Array, Array]:
        """Return amplitudes and rates of the modes ``dt``, s, from now: exact damped oscillators."""
        return swung(self.rod.omega, self.loss, dt, self.q, self.rate)

    def _enter(
        self, before: FlightState, result: ModalResult, taken: float, moved: list[ModalResult]
    ) -> None:
        """Enter a strike that began with a vibration ``taken``, J, and go on from the state after it.

        ``moved`` is the same with vibration of other phases.
        """
        after, last = self._after(before, result), result.last
        self.followed.gravity += result.gravity
        if result.met:
            self.followed.again.add(len(self.followed.each) + 1)
        self.dents = (*(dent for dent in self.dents if dent not in result.met), *result.dents)
        record = self._record(before, result, taken)
        others = [self._record(before, other, taken) for other in moved]
        swings = {
            f"{name}_phase": max(abs(getattr(other, name) - getattr(record, name)) for other in others)
            for name in (PHASED if others else ())
        }
        self.followed.each.append(replace(record, **swings))
        self.state, self.rod, self.q, self.rate = after, result.rod, last.q, last.rate
        self.strikes, self.finished, self.damped = self.strikes + 1, result.finished, 0.0
        self.swing_on(self.followed.leave_dent(after))

    def _after(self, before: FlightState, result: ModalResult) -> FlightState:
        """Return the motion after a strike."""
        last = result.last
        V_n, V_t, Omega = (float(v) for v in last.rigid[:3])
        return before._replace(
            time=before.time + result.time,
            height=float(last.rigid[AT.height]),
            along=before.along + float(last.rigid[AT.along]),
            alpha=self.case.scene.impact.angle + float(last.rigid[AT.turn]),
            V_n=V_n,
            V_t=V_t,
            Omega=Omega,
        )

    def _record(self, before: FlightState, result: ModalResult, taken: float) -> StrikeRecord:
        """Return the record of a strike that began with a vibration ``taken``, J."""
        p, q = (float(one) for one in result.contacts[:, 2:].sum(axis=0))
        record = self.followed.record(
            "modal",
            *(self.followed.lowest(before), self._after(before, result), (p, q)),
            force=result.force,
            friction=result.friction,
            plastic=result.plastic,
            damping=result.viscous + self.damped,
            vibration=result.vibration,
            taken=taken,
        )
        spent = record.vibration + result.friction + result.plastic + result.viscous
        return replace(record, other=record.lost + taken + result.gravity - spent)


def swung(omega: Array, loss: float, dt: float, q: Array, rate: Array) -> tuple[Array, Array]:
    """Return amplitudes and rates (k,) of damped oscillators after a time ``dt``, s, exactly."""
    slow, free = 0.5 * loss * omega, omega * sqrt(1.0 - 0.25 * loss**2)
    decay, c, s = np.exp(-slow * dt), np.cos(free * dt), np.sin(free * dt)
    drive = (rate + slow * q) / free
    swinging = decay * (c * q + s * drive)
    return swinging, decay * (free * (c * drive - s * q)) - slow * swinging
