"""Strikes of one finite-element rod one after the other: shape, stresses and hardening go on.

All strikes are those of one mesh of the rod, which is fine wherever the reduced or the rigid model has it
strike. Flights are crossed exactly: the rigid motion under gravity, and each mode of the rod as a damped
oscillator. The barrier is a new block under each strike, but where an earlier one has dented it: there the
block of that strike goes on, with its dent, hardening and residual stress.
"""

from dataclasses import dataclass, field, replace
from math import sqrt
from typing import NamedTuple

import numpy as np
from scipy.spatial import KDTree

from fem_impact.arrays import Array
from fem_impact.case.bodies import WEAKEST, Bodies, LaterStrike
from fem_impact.case.case import Case
from fem_impact.case.record import ContactRecord, expected_record, joined
from fem_impact.errors import SceneError
from fem_impact.fem.flight import FreeVibration
from fem_impact.modal.rod import ModalRod
from fem_impact.modal.sites import skin
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.strikes import StrikeRecord
from fem_impact.run.modal_strikes import ModalCourse, loss_told, modal_loss, swung
from fem_impact.run.resolution import unresolved
from fem_impact.run.solid import readings
from fem_impact.run.strikes import Followed
from fem_impact.solid.build import START_GAP, build
from fem_impact.solid.carry import carry, dented, later_view, lowered
from fem_impact.solid.frame import turned
from fem_impact.solid.run import SolidResult, solve
from rigid.strikes import Finish, FlightState, next_touch

TOLD = (
    "{} strikes are computed with finite elements of one rod, which keeps its dents, hardening and residual "
    "stress; {} In flight {} modes swing on, damped by the loss factor {}; what vibrates above them ends "
    "with its strike."
)
FRESH = "each meets a surface that no strike before has dented."
AGAIN = "on the barrier strikes {} meet the dents of earlier ones, all others an undented surface."
BEYOND = (
    "Strike {} lands partly on the dent of strike {}, beyond its fine cells, and meets a surface without "
    "that dent."
)
ELSEWHERE = (
    "Strike {} lands {:.2g} mm beside the fine cells that are held ready: finite elements end before it."
)
ALONE = (
    "Where it will strike is foretold by rigid theory alone, as the reduced model refuses the scene: its {}."
)
STOPPED = "Strike {} is not that of finite elements, which did not see its end. {}"
NARROW = "Of strike {} {}."
"""What is told of a strike whose contact is narrow: its number, and how narrow."""
NEAR, ALIKE = 0.1, 0.9
"""Logarithm of the ratio of frequencies, and cosine between movements, within which two modes are one."""
WITHIN = 1.0  # cells beyond what may touch, within which a strike counts as on it


def with_sites(case: Case, count: int) -> Case:
    """Return a case whose rod has fine cells wherever the first ``count`` strikes are expected.

    They are those of the rigid and, where it holds the scene, of the reduced model.
    """
    if count < 2:
        return case
    rigid = Followed.of(case)
    rigid.upto = count
    rigid.go_on(rigid.coming)
    courses, by_modes = [rigid], _by_modes(case)
    if isinstance(by_modes, Case):
        modal = Followed.of(by_modes)
        modal.upto = count
        ModalCourse.at_first(modal.case, modal).to_the_end()
        courses.append(modal)
    later = [course.later(course.struck_as(one)) for course in courses for one in course.each[1:]]
    edges = case.zones.tip_size, case.zones.barrier_size
    first = case.record or expected_record(case.bodies, *edges)
    rods = [expected_record(_bodies(case, one), *edges).rod for one in later]
    return Case(case.scene, "solid", replace(first, rod=joined([first.rod, *rods])))


def _bodies(case: Case, later: LaterStrike) -> Bodies:
    return Bodies(case.scene, case.active, later)


def _by_modes(case: Case) -> Case | str:
    """Return the case of the reduced model, or why that refuses the scene."""
    try:
        return Case.of(case.scene, "modal")
    except SceneError as refused:
        return f"{refused.key} {refused.problem.rstrip('.')}"


class StruckDent(NamedTuple):
    """A block of the barrier that was struck.

    ``along``, m, is where its frame begins on the barrier, ``pressed`` (k, 3), m, what of its skin has been
    pressed so far, ``strike`` the number of the last strike on it, with its ``case`` and ``end``.
    """

    along: float
    pressed: Array
    strike: int
    case: Case
    end: SolidResult


@dataclass(eq=False)
class SolidCourse:
    """Strikes by finite elements so far.

    Attributes
    ----------
    case : of the first strike
    body : with the records of the strikes
    last : the run of the last strike
    begun : inclination, rad, at which that run began
    state : the rigid motion now
    flight : its vibration now
    loss : loss factor of the modes in flight
    damped : energy, J, that the modes have lost since the last strike
    dents : of the barrier
    told : what limits trust in them
    """

    case: Case
    body: Followed
    last: SolidResult
    begun: float
    state: FlightState
    flight: FreeVibration
    loss: float
    damped: float = 0.0
    dents: list[StruckDent] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    @classmethod
    def at_first(cls, body: Followed, end: SolidResult) -> "SolidCourse":
        """Return the course after the first strike.

        The body has the inertia of its mesh from then on.
        """
        body.pull = replace(body.pull, k2=end.motion.inertia / end.motion.mass)
        begin, case = body.coming, body.case
        course = cls(case, body, end, case.bodies.mesh_inclination, begin, end.flight, modal_loss(case))
        course._enter(begin, end, 0.0)
        course._keep_dent(begin, case, None)
        return course

    @property
    def vibration(self) -> float:
        """Energy of the vibration, J."""
        return self.flight.energy

    @property
    def limits(self) -> list[str]:
        """What limits trust in them."""
        if self.body.upto == 1:
            return self.told
        met = sorted(self.body.again)
        struck = AGAIN.format(", ".join(map(str, met))) if met else FRESH
        loss, by_modes = loss_told(self.case, self.loss), _by_modes(self.case)
        several = [TOLD.format(len(self.body.each), struck, len(self.flight.a), loss)]
        if isinstance(by_modes, str):
            several.append(ALONE.format(by_modes))
        return [*several, *self.told]

    def to_the_end(self, options: RunOptions) -> Finish:
        """Follow the rod: hard strikes by finite elements, what lies between them as a rigid body."""
        body = self.body
        while body.missing != 0:
            at = next_touch(body.shape, self.state, body.pull.g_n)
            touch = at and self.state.flown(at[0], body.pull.g_n, body.pull.g_t)
            if touch is None or not body.hard(touch):
                state, finish = body.go_on(self.state, WEAKEST)
                self.swing_on(state)
                if finish is not Finish.STRONG:
                    return finish
                touch = state
            if body.tumbles(touch):
                break
            later = body.later(touch)
            beside = self._beside(later)
            if beside > 0.0:
                self.told.append(ELSEWHERE.format(len(body.each) + 1, 1e3 * beside))
                break
            if not self._strike(touch, later, options):
                break
        return Finish.COUNTED

    def in_modes_of(self, rod: ModalRod) -> tuple[Array, Array]:
        """Return amplitudes and rates (k,) of the reduced model's modes, sqrt(kg) m, sqrt(kg) m/s.

        Both models have modes of the same rod on other meshes: those of like frequency that move what may
        touch alike are one, and keep their energy. Vibration without such a partner is left out.
        """
        modes, last = self.flight.modes, self.last
        back = self.case.scene.impact.angle - self.begun  # to the attitude in which the other's modes stand
        sites = range(len(rod.sites.along_t))
        x = turned(last.model.geometry.rod_points - last.view.rigid(last.model.initial_state()).centre, back)
        free = np.flatnonzero(~last.model.geometry.rod.mesh.is_hanging)
        nearest = [int(np.hypot(*(x[free][:, [0, 2]] - skin(rod.sites, s, 0.0)).T).argmin()) for s in sites]
        shape = turned(modes.shape[last.model.layout.rod[free[nearest]]], back)
        shapes = np.concatenate([shape[:, 0], shape[:, 2]])
        other = np.concatenate([rod.sites.along_t, rod.sites.along_n])
        alike = (shapes / np.linalg.norm(shapes, axis=0)).T @ (other / np.linalg.norm(other, axis=0))
        alike[np.abs(np.log(rod.omega / modes.omega[:, None])) > NEAR] = 0.0
        q, rate = np.zeros(len(rod.omega)), np.zeros(len(rod.omega))
        for i, row in enumerate(alike):
            j = int(np.abs(row).argmax())
            if abs(row[j]) > ALIKE and i == int(np.abs(alike[:, j]).argmax()):
                size = np.sign(row[j]) * sqrt(2.0) * modes.omega[i]  # amplitudes are those of the half rod
                q[j], rate[j] = size * self.flight.a[i] / rod.omega[j], size * self.flight.b[i]
        return q, rate

    def swing_on(self, state: FlightState) -> None:
        """Take over a later state of the rigid body; what the modes lose meanwhile is damping."""
        held, modes = self.vibration, self.flight.modes
        dt, rates = state.time - self.state.time, self.flight.b * modes.omega
        a, rate = swung(modes.omega, self.loss, dt, self.flight.a, rates)
        self.flight = replace(self.flight, a=a, b=rate / modes.omega)
        self.damped += held - self.vibration
        self.state = state

    def _beside(self, later: LaterStrike) -> float:
        """Return how far, m, a place lies beside what may touch of the rod's mesh; 0 or less on it."""
        g = self.last.model.geometry
        mesh, (x, z) = g.rod.mesh, later.lowest
        touching = mesh.free_skin if g.barrier is None else np.unique(mesh.cells[g.touching])
        away = np.hypot(mesh.points[touching, 0] - x, mesh.points[touching, 2] - z)
        return float(away.min()) - WITHIN * g.tip_size

    def _strike(self, before: FlightState, later: LaterStrike, options: RunOptions) -> bool:
        """Strike at a later state in flight; return whether the bodies part again."""
        turn = before.alpha - self.state.alpha
        self.body.gravity += self.body.work(self.state, before)
        self.swing_on(before)
        zones = self.case.zones
        accuracy = replace(self.case.scene.accuracy, tip_size=zones.tip_size, barrier_size=zones.barrier_size)
        scene = replace(self.case.scene, accuracy=accuracy, effects=self.case.active)
        expected = expected_record(_bodies(self.case, later), zones.tip_size, zones.barrier_size)
        assert self.case.record is not None, "a rod that strikes again has its zones from a record"
        dent = self._dent(before, expected)
        record = replace(expected, rod=self.case.record.rod)
        case = Case(scene, "solid", record, later, dent.case.zones if dent else None)
        model = build(case, mesh=self.last.model.geometry.rod)
        view = later_view(model, self.last, before.alpha - self.begun)
        motion = view.rigid(model.initial_state())
        centre = np.array([motion.centre[0], 0.0, before.height])
        if dent is not None:
            model, centre[0] = dented(model, dent.end), before.along - dent.along
            self.body.again.add(len(self.body.each) + 1)
        moved = replace(motion, centre=centre, V_n=before.V_n, V_t=before.V_t, Omega=before.Omega)
        vibration = replace(self.flight, modes=view.modes)
        model = lowered(carry(model, view, self.last, turn, moved, vibration), START_GAP)
        taken = vibration.energy
        end = solve(case, replace(options, out=None, resume=False), model, view)
        if not end.finished:
            self.told.append(STOPPED.format(len(self.body.each) + 1, end.reason))
            return False
        self.begun = before.alpha
        self._enter(before, end, taken)
        self._keep_dent(before, case, dent)
        return True

    def _dent(self, before: FlightState, expected: ContactRecord) -> StruckDent | None:
        """Return the dent on which a strike lands that may touch ``expected``; None: there is none."""
        if expected.barrier is None:
            return None
        size, lowest = self.last.model.geometry.barrier_size, before.along - self.body.comes(before)[1]
        for dent in self.dents:
            place = expected.barrier.touched + np.array([lowest - dent.along, 0.0, 0.0])
            if not (_away(dent.pressed, place) < size).any():
                continue
            block = dent.end.model.geometry.barrier
            assert block is not None, "what is pressed is meshed"
            fine = block.points[np.unique(block.cells[block.finest])]
            if (_away(fine, place) < WITHIN * size).all():
                return dent
            number = len(self.body.each) + 1
            self.told.append(BEYOND.format(number, dent.strike))
        return None

    def _keep_dent(self, before: FlightState, case: Case, dent: StruckDent | None) -> None:
        """Keep the block that was struck last, in place of the ``dent`` on which that strike landed."""
        touched, number = self.last.record.barrier, len(self.body.each)
        if touched is None or not any(zone.body == "barrier" for zone in self.last.model.zones):
            return
        if dent is None:
            start = self.last.view.rigid(self.last.model.initial_state())
            along, pressed = before.along - float(start.centre[0]), touched.touched
        else:
            along, pressed = dent.along, np.concatenate([dent.pressed, touched.touched])
            self.dents.remove(dent)
        self.dents.append(StruckDent(along, pressed, number, case, self.last))

    def _enter(self, before: FlightState, end: SolidResult, taken: float) -> None:
        """Enter a strike, and go on from the state after it."""
        motion, begin = end.motion, end.view.rigid(end.model.initial_state())
        after = before._replace(
            time=before.time + end.time,
            height=float(motion.centre[2]),
            along=before.along + float(motion.centre[0] - begin.centre[0]),
            alpha=before.alpha - end.view.angle(end.state, end.model),
            V_n=motion.V_n,
            V_t=motion.V_t,
            Omega=motion.Omega,
        )
        self.body.each.append(self._recorded(before, after, end, taken))
        if narrow := unresolved(end):
            self.told.append(NARROW.format(len(self.body.each), narrow))
        self.state, self.last, self.flight, self.damped = after, end, end.flight, 0.0
        self.swing_on(self.body.leave_dent(after))

    def _recorded(
        self, before: FlightState, after: FlightState, end: SolidResult, taken: float
    ) -> StrikeRecord:
        """Return the record of a strike that began with a vibration ``taken``, J."""
        body, accounts = self.body, end.accounts
        p, q = (float(part) for part in end.model.book.table[:, 2:].sum(axis=0))
        fell = -accounts["gravity"]
        body.gravity += fell
        read = readings(end)
        record = body.record(
            "solid",
            *(body.lowest(before), after, (p, q)),
            force=end.peak_force,
            dent=or_none(read.dent_depth),
            gauge=(or_none(read.gauge_highest), or_none(read.gauge_lowest)),
            friction=accounts["friction"],
            plastic=accounts["plastic_rod"] + accounts["plastic_barrier"],
            damping=accounts["damping"] + self.damped,
            vibration=end.flight.energy,
            taken=taken,
        )
        spent = record.vibration + record.friction + record.plastic + accounts["damping"]
        return replace(record, other=record.lost + taken + fell - spent)


def _away(places: Array, of: Array) -> Array:
    """Return how far, m, each point ``of`` (m, 3) lies from the nearest of some places (k, 3)."""
    return np.asarray(KDTree(places).query(of)[0])
