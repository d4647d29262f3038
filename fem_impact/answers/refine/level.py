"""One level of a run: the runs that share its mesh, and what they found."""

from dataclasses import dataclass, replace

from fem_impact.answers.refine.extrapolate import NARROW, MeshRuns
from fem_impact.answers.refine.needed import ROWS
from fem_impact.case.case import Case
from fem_impact.case.record import ContactRecord
from fem_impact.files.atomic import read_text, write_text
from fem_impact.files.run_directory import RECORD, STAMP
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.record import Outcome
from fem_impact.run.common import OPEN_LEDGER
from fem_impact.run.program import stamp
from fem_impact.run.resolution import NOT_RESOLVED, without
from fem_impact.run.simulate import simulate_recorded
from fem_impact.scene.types import Scene
from fem_impact.solid.stepguard import THIN_CRUSHED


@dataclass(frozen=True, slots=True)
class LevelRun:
    """A level that has run.

    Attributes
    ----------
    splits : how often the cells at the contact are split there
    size : edge of the cells that resolve the contact, m
    cases, outcomes : of its last runs: at the places of the barrier's grid, or of a scene and its twin
    record : what they found together
    wall_s : wall time, s, of all its runs
    repeats : how often it ran again, with more room, without thin cells or with shorter steps
    earlier : processor time, s, of each run before the last of these
    late : why another repeat has no outcome, where the budget did not hold it
    """

    splits: int
    size: float
    cases: tuple[Case, ...]
    outcomes: tuple[Outcome, ...]
    record: ContactRecord
    wall_s: float
    repeats: int = 0
    earlier: tuple[float, ...] = ()
    late: str = ""

    @property
    def outcome(self) -> Outcome:
        """The outcome of the scene itself, at the first place of the grid."""
        return self.outcomes[0]

    @property
    def left(self) -> str:
        """Say that contact or flow left its zones, empty where they did not."""
        if not self.record.left:
            return ""
        again = f" (it ran {1 + self.repeats} times, with wider ones)" if self.repeats else ""
        return f"Contact or plastic flow left the finely meshed zones of the level{again}."

    @property
    def lost(self) -> str:
        """Say why it did not run again, though it was to; empty where it did, or needed none."""
        return f"Another repeat of the level has no outcome. {self.late}" if self.late else ""

    @property
    def narrow(self) -> str:
        """Say how narrow the contact is that it resolves, and what that means; empty where it is wide."""
        rows = self.record.rows
        if rows >= ROWS or not self.record.resolved:
            return ""
        return (
            f"The contact is {rows} node{'s' * (rows > 1)} wide across its narrow side, and {ROWS} resolve "
            f"it: half-widths are {NARROW:g} times the larger of the last changes by halved cells"
        )

    @property
    def without_thin(self) -> str:
        """Say that its mesh has no thin cells, and why; empty where it has, or needs none."""
        before = self.cases[0].record
        if before is None or not before.crushed:
            return ""
        return (
            "The mesh has no thin rows and columns at the contact: with them a cell was squeezed until it "
            f"folded or lowered the step of the whole run to under {THIN_CRUSHED:g} of the first."
        )

    @property
    def loses(self) -> bool:
        """Whether the energy ledger of one of its runs does not close."""
        return any(one.validity.stopped_because.startswith(OPEN_LEDGER) for one in self.outcomes)

    def shorter_steps(self, scene: Scene) -> str:
        """Say that its steps are shorter than those of the scene as stated, and why; empty if not."""
        step, stated = self.cases[0].scene.accuracy.step, scene.accuracy.step
        why = f"with {stated:g}, as stated, the energy ledger did not close."
        return f"The run's accuracy.step is {step:g}: {why}" if step < stated else ""

    @property
    def found(self) -> ContactRecord:
        """What the next level's mesh follows; without thin cells after one without: small ones fold soon."""
        return replace(self.record, crushed=bool(self.without_thin))

    @property
    def cut_off(self) -> list[Outcome]:
        """Its runs that did not see the bodies part."""
        return [outcome for outcome in self.outcomes if isinstance(outcome.motion.V_n, Unknown)]

    @property
    def withheld(self) -> Outcome:
        """Its outcome, without the numbers that a contact gives which is not resolved."""
        unresolved = [
            limitation.text
            for limitation in self.outcome.validity.limitations
            if limitation.text.startswith(NOT_RESOLVED)
        ]
        resolved = self.record.resolved or not unresolved
        return self.outcome if resolved else without(self.outcome, Unknown(unresolved[0]))

    @property
    def stopped(self) -> str:
        """Why the first of `cut_off` ended, empty where there is none."""
        return next((outcome.validity.stopped_because for outcome in self.cut_off), "")

    @property
    def runs(self) -> MeshRuns:
        """What its limits follow from."""
        resolved = self.record.resolved
        wide = resolved and self.record.rows >= ROWS
        return MeshRuns(
            self.size, list(self.outcomes), resolved, wide, self.record.rows, self.repeats, self.earlier
        )


def with_half_step(scene: Scene) -> Scene:
    """Return the scene with time steps half as long."""
    return replace(scene, accuracy=replace(scene.accuracy, step=0.5 * scene.accuracy.step))


def simulate_level(case: Case, options: RunOptions) -> tuple[Outcome, ContactRecord]:
    """Return outcome and record of a run of a level, from its files where it ran before it was resumed."""
    assert case.record is not None, "a level follows a record"
    computed = f"{stamp(case.scene)}record {case.record.digest()}\n"
    out = options.out
    if out is not None and options.resume and (out / STAMP).is_file():
        if read_text(out / STAMP) == computed and (out / "outcome.json").is_file():
            return Outcome.read(out / "outcome.json"), ContactRecord.read(out / RECORD)
        options = replace(options, resume=read_text(out / STAMP) == computed)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
        write_text(out / STAMP, computed)
    outcome, record = simulate_recorded(case.scene, "solid", options, case)
    assert record is not None, "finite elements leave a record"
    return outcome, record
