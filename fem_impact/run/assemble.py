"""The outcome of an impact from how it ended, the same for every fidelity, and how far to trust it."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import cos, inf, sin
from typing import Self

import numpy as np

from fem_impact.arrays import Array
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import EFFECTS
from fem_impact.outcome import groups
from fem_impact.outcome.groups import Limitation, limitations
from fem_impact.outcome.keys import Num, Unknown, unknown
from fem_impact.outcome.record import Outcome, installed_versions, utc_now
from fem_impact.outcome.strikes import Strikes
from fem_impact.physics.contact import between
from fem_impact.run.common import (
    CUT_OFF,
    OPEN_LEDGER,
    RESIDUAL_LIMIT,
    angular_momentum_error,
    barrier_motion,
    momentum_error,
    motion,
    open_end,
    restitution,
    strikes_again,
)
from fem_impact.run.resolution import without, without_end
from fem_impact.run.unusual import unusual
from fem_impact.scene.impact import FIRST
from fem_impact.scene.types import digest

NO_READINGS = unknown(
    groups.Readings, "only finite elements follow the dent that stays and the strain along the projectile"
)
ONE_POINT = Unknown("only finite elements find where the bodies touch: this fidelity has one contact point")
NO_TARGET = Unknown("the scene gives a mesh, not the error it allows")
NOT_REDUCED = Unknown("it is told of the reduced model alone")
FIRST_ALONE = "the scene asks for the first impact alone (impact.until)"
GRAVITY_TOLD, GRAVITY_RULES = 0.01, 0.5  # speed gained by falling over the approach: told, and too much


@dataclass(frozen=True, slots=True)
class ImpactEnd:
    """How an impact ended.

    Attributes
    ----------
    V_n, V_t, Omega : of the rod, m/s, rad/s, what gravity gave it removed, as seen from the barrier before
    mass, k2 : of the rod, kg, m2
    base : velocity (n, t), m/s, that the impact gave the barrier
    leaving : normal velocity of the rod as seen from the barrier after the impact, m/s
    contacts : (m, 4) start and end, s, and impulses along n and t, N s, of each; None where it takes no time
    missing : what the energy ledger misses, of E_0
    finished : whether the impact is over
    reason : why the computation ended, a sentence
    other_end : s, how much later the other end strikes, for which it ended; infinite where it did not
    turn : of a barrier that turns: its spin, rad/s, and the rod's mass centre from its own (n, t), m, before
        and after
    """

    V_n: float
    V_t: float
    Omega: float
    mass: float
    k2: float
    base: tuple[float, float]
    leaving: float
    contacts: Array | None
    missing: float
    finished: bool
    reason: str
    other_end: float = inf
    turn: tuple[float, tuple[float, float], tuple[float, float]] | None = None


@dataclass(frozen=True, slots=True)
class Reduction:
    """An impact's end, with the motions and coefficients that follow from it."""

    case: Case
    end: ImpactEnd
    motion: groups.RodMotion
    barrier: groups.BarrierMotion
    restitution: groups.Restitution

    @classmethod
    def of(cls, case: Case, end: ImpactEnd) -> Self:
        """Return the motions, and the coefficients of the relative motion."""
        rod = motion(case, end.V_n, end.V_t, end.Omega, end.mass, end.k2)
        touched = np.zeros((0, 2)) if end.contacts is None else end.contacts[:, :2]
        g, alpha, borne = case.slots.gravity or 0.0, case.scene.impact.vertical, float(np.diff(touched).sum())
        fallen = g * between(touched)
        held = (fallen + g * borne) * cos(alpha), fallen * sin(alpha)
        barrier = barrier_motion(case, *end.base, momentum_error(case, rod, end.base, held))
        if end.turn is not None:
            error = angular_momentum_error(case, rod, barrier, *end.turn, held)
            barrier = replace(barrier, Omega_b=end.turn[0], angular_momentum_error=error)
        return cls(case, end, rod, barrier, restitution(case, rod, barrier, fallen))

    def outcome(
        self,
        energy: groups.Energy,
        markers: groups.Markers,
        heat: groups.Heat,
        cost: groups.RunCost,
        *,
        peak_force: Num,
        choices: tuple[groups.EffectChoice, ...] | Unknown,
        unmeshed: str,
        limited: Iterable[Limitation],
        withheld: str = "",
        sites: tuple[groups.ContactSite, ...] | Unknown = ONE_POINT,
        readings: groups.Readings = NO_READINGS,
    ) -> Outcome:
        """Return the outcome; what a failed, cut off or unresolved run does not know is unknown there.

        Parameters
        ----------
        choices : of effects, or why there are none
        unmeshed : why there is no limit of two meshes
        limited : limitations of the fidelity and of this run; those of the case are added, and those that the
            result shows
        withheld : why the contact counts as not resolved, empty where it does not
        sites : places of contact
        readings : dent and strain
        """
        case, named = self.case, self.case.scene.projectile.named
        end = replace(self.end, reason=named(self.end.reason))
        gravity, ruled = _gravity(case, end.contacts)
        failed = _open_ledger(end.missing, case.fidelity) or ruled
        cut = failed or ("" if end.finished else end.reason)
        origin = groups.Provenance(
            fidelity=case.fidelity,
            scene_id=case.scene.id,
            scene_title=case.scene.title,
            scene_digest=digest(case.scene),
            created_utc=utc_now(),
            versions=installed_versions(),
            effects=tuple(name for name in case.active if case.fidelity in EFFECTS[name].fidelities),
            effect_choices=choices,
        )
        numbers = origin, self.motion, self.restitution, energy
        shown = () if withheld or cut else unusual(*numbers, case.contact)
        over, alone = end.finished and not failed, case.scene.impact.until == FIRST
        again = strikes_again(case, end.leaving, end.Omega) if over else ""
        near = open_end(case, end.contacts, end.leaving, end.Omega, end.other_end) if over else ""
        named_again = named(again) if alone and end.other_end == inf else ""
        next_one = named_again or (end.reason if alone and again else "")
        intervals: tuple[groups.ContactInterval, ...] | Unknown = Unknown(unmeshed)
        if end.contacts is not None:
            intervals = tuple(
                groups.ContactInterval(start=start, end=stop, impulse_n=normal, impulse_t=tangential)
                for start, stop, normal, tangential in end.contacts.tolist()
            )
        of_result = limitations("result", *shown, gravity, next_one, f"{near}." * bool(near))
        outcome = Outcome(
            provenance=origin,
            validity=groups.Validity(
                finished=over,
                stopped_because=f"{failed or end.reason} {named_again}".rstrip(),
                limitations=case.said((*limited, *case.limitations, *of_result)),
                accuracy_target=NO_TARGET,
                achieved_error=NO_TARGET,
                achieved_wall=NO_TARGET,
                mesh_limit=Unknown(unmeshed),
                mesh_band=Unknown(unmeshed),
                model_band=NOT_REDUCED,
            ),
            motion=self.motion,
            barrier=self.barrier,
            restitution=self.restitution,
            energy=energy,
            contact=groups.Contact(
                intervals=intervals,
                sites=sites,
                strikes_again=(Unknown(near) if near else bool(again)) if end.finished else CUT_OFF,
                peak_force=peak_force,
                readings=readings,
                markers=markers,
            ),
            heat=heat,
            strikes=replace(unknown(Strikes, FIRST_ALONE), until=case.scene.impact.until),
            cost=cost,
        )
        outcome = without(outcome, Unknown(withheld)) if withheld else outcome
        return without_end(outcome, cut) if cut else outcome


def _open_ledger(share: float, fidelity: str) -> str:
    """Return why a run whose ledger misses a share of E_0 failed, nothing where it closes."""
    if abs(share) <= RESIDUAL_LIMIT:
        return ""
    limit = f"more than {RESIDUAL_LIMIT:g}: do not use this run."
    remedy = " Give half the accuracy.step." * (fidelity == "solid")  # no other fidelity takes it
    return f"{OPEN_LEDGER} {abs(share):.2e} of E_0, {limit}{remedy}"


def _gravity(case: Case, contacts: Array | None) -> tuple[str, str]:
    """Return a sentence where gravity acts so long in contact that it moves the result, and why it rules it.

    Where it rules, the run failed: it was no impact.
    """
    if contacts is None:
        return "", ""
    speed = (case.slots.gravity or 0.0) * (float(contacts[-1, 1]) - between(contacts[:, :2]))
    share = speed * cos(case.scene.impact.vertical) / case.contact.approach
    gained = (
        f"Gravity gives the rod {speed * 1e3:.3g} mm/s while it touches, {100 * share:.2g} % of its approach"
    )
    if share > GRAVITY_RULES:
        remedy = "it is no impact any more. Give a higher speed, or leave out the gravity effect."
        return "", f"{gained}: {remedy}"
    if share > GRAVITY_TOLD:
        why = (
            "The contact bears the weight meanwhile: V_n, e and E_r change by about a tenth of that, mu by "
            "up to half of it."
        )
        return f"{gained}. {why}", ""
    return "", ""
