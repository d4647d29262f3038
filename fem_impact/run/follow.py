"""The strikes that a scene asks for, one after the other, each by the model of its stage."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fem_impact.options import RunOptions
from fem_impact.outcome.groups import limitations
from fem_impact.outcome.keys import Unknown, unknown
from fem_impact.outcome.strikes import Strikes
from fem_impact.run.certain import with_spread, without_spread
from fem_impact.run.strikes import RULES, Followed
from rigid.strikes import Finish, FlightState

if TYPE_CHECKING:
    from fem_impact.case.case import Case
    from fem_impact.outcome.record import Outcome
    from fem_impact.run.modal_strikes import ModalCourse
    from fem_impact.run.solid_strikes import SolidCourse
    from fem_impact.solid.run import SolidResult

LATER = "Strikes of a rigid body after those of a finer model do not feel its vibration."
PASSED = "Modes take over {:.0%} of the vibration that finite elements left; the rest counts as damped."
CHANGE = (
    "Strikes after the first {count} are those of the {model} model. Of strike {count} it gives "
    "e = {new.e:.3g}, a spin after it of {new.Omega:.3g} rad/s and {new.after:.3g} J of motion; the "
    "{old.fidelity} model gave {old.e:.3g}, {old.Omega:.3g} and {old.after:.3g}."
)


def with_strikes(
    case: Case, outcome: Outcome, end: SolidResult | None = None, options: RunOptions = RunOptions()
) -> Outcome:
    """Return an outcome with the strikes that its scene asks for, from its first impact on.

    ``end`` is that of finite elements, whose later strikes tell their progress as the ``options`` say.
    """
    after, said = [outcome.motion.V_n, outcome.motion.V_t, outcome.motion.Omega], outcome.validity
    # where a finished run has none, its contact is not resolved, which is told of the strike
    lost = "" if said.finished else next((v.reason for v in after if isinstance(v, Unknown)), "")
    body = Followed.of(case)
    course = _FollowedCourse(case, end, options, body, body.coming)
    if end is None or not lost:
        course.follow()
    if body.each:
        strikes = body.strikes(course.state, course.finish, *course.held)
        told = case.said(limitations("model", *course.told, *RULES, *body.doubts()))
        said = replace(said, limitations=(*said.limitations, *told))
    else:
        why = f"the motion after the first impact is not known: {lost or said.stopped_because}"
        strikes = replace(unknown(Strikes, why), until=case.scene.impact.until)
    open_errors = outcome.half_widths if case.fidelity == "modal" else None
    if isinstance(open_errors, Unknown):  # nor are those of the strikes known
        strikes = without_spread(strikes, open_errors)
    else:
        strikes = with_spread(case, strikes)
    return replace(outcome, strikes=strikes, validity=said)


@dataclass(eq=False)
class _FollowedCourse:
    """A sequence of strikes as it grows, stage by stage.

    Attributes
    ----------
    end : of the first impact by finite elements
    options : of later ones
    body : with the records of its strikes
    state : its rigid motion after the last of them, at first before it touches
    finish : how the last stage ended
    solid, modal : with the vibration, once finite elements or modes have computed a strike
    told : what limits trust
    """

    case: Case
    end: SolidResult | None
    options: RunOptions
    body: Followed
    state: FlightState
    finish: Finish = Finish.COUNTED
    solid: SolidCourse | None = None
    modal: ModalCourse | None = None
    told: list[str] = field(default_factory=list)

    @property
    def held(self) -> tuple[float, float]:
        """Energy, J, that vibration holds, and that it has lost since the last strike."""
        vibrating = self.modal or self.solid
        return (vibrating.vibration, vibrating.damped) if vibrating else (0.0, 0.0)

    def follow(self) -> None:
        """Follow the body through all stages."""
        models = {"rigid": self._by_rigid, "modal": self._by_modes, "solid": self._by_elements}
        for model, count in self.case.scene.strikes.stages(self.case.fidelity):
            done, self.body.upto = len(self.body.each), None
            if self.finish is not Finish.COUNTED or self.body.missing == 0 or (self.modal and not done):
                break
            if done:
                self._tell_change(model, done)
            self.body.upto = None if count is None else done + count
            models[model]()
        if self.modal:
            self.told += self.modal.told

    def _by_rigid(self) -> None:
        self.state, self.finish = self.body.go_on(self.state)
        if vibrating := self.modal or self.solid:
            vibrating.swing_on(self.state)

    def _by_modes(self) -> None:
        from fem_impact.run.modal_strikes import ModalCourse

        if not self.body.each:
            self.modal = ModalCourse.at_first(self.case, self.body)
            if not self.modal.finished:  # nothing is known of what follows
                self.body.each.clear()
                return
        else:
            self.modal = ModalCourse.going_on(self.case, self.body, self.state)
            if self.solid:
                self.modal.q, self.modal.rate = self.solid.in_modes_of(self.modal.rod)
                self.modal.damped = self.solid.damped + self.solid.vibration - self.modal.vibration
                self.told.append(PASSED.format(self.modal.vibration / (self.solid.vibration or 1.0)))
        self.finish = self.modal.to_the_end()
        self.state = self.modal.state

    def _by_elements(self) -> None:
        from fem_impact.run.solid_strikes import SolidCourse

        assert self.end is not None, "finite elements compute the first strike"
        self.solid = SolidCourse.at_first(self.body, self.end)
        self.finish = self.solid.to_the_end(self.options)
        self.state, self.told = self.solid.state, [*self.told, *self.solid.limits]

    def _tell_change(self, model: str, count: int) -> None:
        """Tell how far the model of the next strikes is from that of the last one, which both compute.

        It computes that without vibration before it.
        """
        old, body = self.body.each[-1], Followed.of(self.case)
        before = body.struck_as(old)
        if model == "rigid":
            body.upto = 1
            body.go_on(before)
        else:
            from fem_impact.run.modal_strikes import ModalCourse

            ModalCourse.going_on(self.case, body, before).strike(before)
        self.told.append(CHANGE.format(model=model, count=count, old=old, new=body.each[0]))
        if model == "rigid":
            self.told.append(LATER)
