"""How many random scenes finished, were not resolved, refused or left out, and why; what broke a rule."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace

from invariants import HIGHEST_E, LOWEST_E, faults, is_resolved

from fem_impact.case.case import Case
from fem_impact.case.cells import ADVISED, FINEST, kind, size_for
from fem_impact.errors import FemImpactError
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import or_none
from fem_impact.outcome.record import Outcome
from fem_impact.run.simulate import simulate
from fem_impact.scene.types import Scene

FINISHED, UNRESOLVED, ENDED, REFUSED, DEAR = "finished", "not resolved", "ended", "refused", "over budget"
SLENDER, BRISK = 3.0, 0.5  # length over diameter, m/s
COARSEST = 10e-3  # m, largest tip size that a scene may state
LITTLE = 0.1  # of e, by which half the tip size may move one that is out of the plain range


@dataclass(frozen=True, slots=True)
class RandomCase:
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
        brisk = impact.v_n**2 + impact.v_t**2 >= BRISK**2
        return brisk and rod.length >= SLENDER * rod.diameter

    @property
    def no_impact(self) -> bool:
        """Whether it was refused because its tip does not come down, or would be crushed as a whole."""
        return self.end == REFUSED and any(word in self.reason for word in ("lifts the", "would press"))


def run(scene: Scene, fidelity: str) -> RandomCase:
    """Compute a scene and judge its outcome; what is refused with a reason breaks no rule."""
    try:
        outcome = simulate(scene, fidelity)
    except FemImpactError as refusal:
        return RandomCase(scene, fidelity, REFUSED, str(refusal))
    end, told = ENDED, outcome.validity
    if told.finished:
        end = FINISHED if is_resolved(outcome) else UNRESOLVED
    return RandomCase(scene, fidelity, end, told.stopped_because, tuple(faults(outcome)), outcome)


def run_solid(scene: Scene, budget: float, cells: float | None = None) -> RandomCase:
    """Compute a scene with so many cells over the contact's radius, if it takes at most a budget, s.

    Without a number they are as many as the program advises.
    """
    try:
        fine = with_cells(scene, cells)
        cost = Case.of(fine).size.time
    except FemImpactError as refusal:
        return RandomCase(scene, "solid", REFUSED, str(refusal))
    if cost > budget:
        return RandomCase(fine, "solid", DEAR)
    case = run(fine, "solid")
    if case.end != FINISHED:
        return case
    return replace(case, faults=(*case.faults, *_beside_finer(case), *_beside_modal(case)))


def with_cells(scene: Scene, cells: float | None) -> Scene:
    """Return the scene with so many cells over the radius of its contact, by default as many as advised."""
    bodies = Case.of(scene, "modal").bodies
    size = size_for(bodies, cells or ADVISED[kind(bodies)])
    size = min(max(size, FINEST), COARSEST, scene.projectile.diameter / 4)
    return replace(scene, accuracy=replace(scene.accuracy, tip_size=size))


def _beside_finer(case: RandomCase) -> list[str]:
    """A restitution that no plain blow gives is the same with half the tip size."""
    e = restitution(case)
    if e is None or LOWEST_E <= e <= HIGHEST_E:
        return []
    accuracy = replace(case.scene.accuracy, tip_size=case.scene.accuracy.tip_size / 2)
    finer = restitution(run(replace(case.scene, accuracy=accuracy), "solid"))
    if finer is not None and abs(finer - e) <= LITTLE * max(1.0, abs(e)):
        return []
    return [f"e = {e:.4g} is not confirmed with half the tip size: {finer}"]


def _beside_modal(case: RandomCase) -> list[str]:
    """The tip rebounds in both models or in neither, or the outcome says why not."""
    e, modal = restitution(case), restitution(run(case.scene, "modal"))
    if e is None or modal is None or e * modal >= 0 or any("e = -" in w for w in _warnings(case)):
        return []
    return [f"e = {e:.4g}, but {modal:.4g} in the reduced model"]


def restitution(case: RandomCase) -> float | None:
    """Return e with the arms of the edge; None where it is not known or the run did not finish."""
    known = case.outcome is not None and case.end == FINISHED
    return or_none(case.outcome.restitution.edge.e) if known and case.outcome else None


def _warnings(case: RandomCase) -> tuple[str, ...]:
    return texts(case.outcome.validity.limitations) if case.outcome else ()


def told(cases: Iterable[RandomCase]) -> str:
    """Return the number of cases by fidelity, end and reason, and each broken rule."""
    counts = Counter((case.fidelity, case.end, _kind(case)) for case in cases)
    lines = [f"{n:6d} {' '.join(key)}" for key, n in sorted(counts.items(), key=lambda one: one[0])]
    broken = (f"{case.fidelity} {case.scene.id}: {fault}" for case in cases for fault in case.faults)
    return "\n".join([*lines, *broken])


def _kind(case: RandomCase) -> str:
    """Return the reason without its numbers, so that alike ones are counted together."""
    if case.end in (FINISHED, UNRESOLVED):
        return "and strikes again" if "strikes again" in case.reason else ""
    return re.sub(r"[-+\d.e]*\d[-+\d.e]*", "#", case.reason)[:90]
