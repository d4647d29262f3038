"""How many random scenes finished, were not resolved, refused or left out, and why; what broke a rule."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from invariants import faults, is_resolved

from fem_impact.errors import FemImpactError
from fem_impact.outcome.record import Outcome
from fem_impact.run.simulate import simulate
from fem_impact.scene.types import Scene

FINISHED, UNRESOLVED, ENDED, REFUSED, DEAR = "finished", "not resolved", "ended", "refused", "over budget"
SLENDER, BRISK = 3.0, 0.5  # length over diameter, m/s


@dataclass(frozen=True, slots=True)
class Case:
    """One random scene: how it ended, why, and which rules its outcome breaks."""

    scene: Scene
    fidelity: str
    end: str
    reason: str = ""
    faults: tuple[str, ...] = ()
    outcome: Outcome | None = None

    @property
    def slender(self) -> bool:
        """Whether it is one of those of which two of three must finish: a slender rod at .5 m/s or more."""
        rod, impact = self.scene.projectile, self.scene.impact
        return rod.length >= SLENDER * rod.diameter and impact.v_n**2 + impact.v_t**2 >= BRISK**2


def run(scene: Scene, fidelity: str) -> Case:
    """Compute a scene and judge its outcome; what is refused with a reason breaks no rule."""
    try:
        outcome = simulate(scene, fidelity)
    except FemImpactError as refusal:
        return Case(scene, fidelity, REFUSED, str(refusal))
    end, told = ENDED, outcome.validity
    if told.finished:
        end = FINISHED if is_resolved(outcome) else UNRESOLVED
    return Case(scene, fidelity, end, told.stopped_because, tuple(faults(outcome)), outcome)


def told(cases: Iterable[Case]) -> str:
    """Return the number of cases by fidelity, end and reason, and each broken rule."""
    counts = Counter((case.fidelity, case.end, _kind(case)) for case in cases)
    lines = [f"{n:6d} {' '.join(key)}" for key, n in sorted(counts.items(), key=lambda one: one[0])]
    broken = (f"{case.fidelity} {case.scene.id}: {fault}" for case in cases for fault in case.faults)
    return "\n".join([*lines, *broken])


def _kind(case: Case) -> str:
    """Return the reason without its numbers, so that alike ones are counted together."""
    if case.end in (FINISHED, UNRESOLVED):
        return "and strikes again" if "strikes again" in case.reason else ""
    return re.sub(r"[-+\d.e]*\d[-+\d.e]*", "#", case.reason)[:90]
