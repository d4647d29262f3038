"""The hard cases as a study: each is computed and judged by itself; the report is their table.

Judged are balances of energy and momentum, and the sign of friction work, which every run must obey.
"""

import hashlib
import json
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, Literal

import numpy as np

from fem_impact import Case, RunOptions, Scene, known, load, replace_all
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.errors import ResultError, RunError, SceneError
from fem_impact.evidence.data import read_stated, scene_keys
from fem_impact.evidence.problems.problem import verify
from fem_impact.fem.stable import SAFETY
from fem_impact.files.atomic import make_directory
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.jobs.job import Failure, JobKind
from fem_impact.run.program import source_digest, stamp
from fem_impact.run.solid import reduce
from fem_impact.solid.build import build
from fem_impact.solid.model import Model
from fem_impact.solid.run import SolidResult, solve
from fem_impact.tables.table import Column, Table, read_csv

Expected = Literal["closed", "refused", "detected"]


@dataclass(frozen=True, slots=True)
class HardCase:
    """One hard case of cases.toml.

    Attributes
    ----------
    difficulty : what is hard about it
    changes : of the base scene, as a scene file writes them
    expected : ``closed`` run, ``refused`` before the run, or trouble ``detected`` during it
    gap : height of the lowest point at the start, m
    shifted : place of the rod along t, m
    step : share of the stable step
    bounces : between two walls instead of a scene, 0 for none
    """

    name: str
    difficulty: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    expected: Expected = "closed"
    gap: float = 2e-6
    shifted: float = 0.0
    step: float = 0.9
    bounces: int = 0

    def scene(self) -> Scene:
        """Return its scene (SceneError if it is refused already here)."""
        named = {"id": f"stress-{self.name.replace('.', '-')}"}
        return replace_all(load("t5b"), scene_keys(_BASE) | scene_keys(self.changes) | named)


_STATED = read_stated("hard_cases/cases.toml")
_BASE = _STATED.pop("base")
CASES = {name: HardCase(name, **stated) for name, stated in _STATED.items()}


LEDGER = 1e-3  # of E_0: most that the ledger may miss, to either side
FED = 1e-6  # of E_0: most that friction may give back between two rows of the history
MOMENTUM = 1e-3  # of the momentum at the start plus the impulse
SPIN = 2e-3  # of the same for angular momentum, whose best-fit angle holds to second order only


@dataclass(frozen=True, slots=True)
class Balance:
    """The balances of a run, each as a share.

    Attributes
    ----------
    residual : largest miss of the ledger over E_0, growth : largest gain of energy over E_0
    fed : largest energy that friction gave between two rows over E_0
    momentum, spin : misses of linear and angular momentum over their size
    """

    residual: float
    growth: float
    fed: float
    momentum: float
    spin: float

    def faults(self) -> list[str]:
        """Return a sentence for each balance that does not hold."""
        limits = (
            (self.residual, LEDGER, "the ledger misses {:.1e} of E_0"),
            (self.growth, LEDGER, "the energy grew by {:.1e} of E_0"),
            (self.fed, FED, "friction fed {:.1e} of E_0"),
            (self.momentum, MOMENTUM, "momentum misses {:.1e}"),
            (self.spin, SPIN, "angular momentum misses {:.1e}"),
        )
        return [sentence.format(value) for value, most, sentence in limits if not value <= most]


def balance(result: SolidResult, history: Path) -> Balance:
    """Return the balances of a finished or stopped run."""
    table = read_csv(history)
    E_0 = result.E_0
    heat = table.numbers("W_friction_J")
    # what linear and angular momentum about the origin miss of the contact's impulses
    motion, impact, view = result.motion, result.case.scene.impact, result.view
    x = result.model.start[0][view.places]
    centre = view.mass @ x / view.mass.sum()
    weight = (result.case.slots.gravity or 0.0) * result.time
    down = weight * np.array([-np.sin(impact.angle), -np.cos(impact.angle)])
    middle = 0.5 * (centre + np.asarray(motion.centre))  # mean place of the mass centre
    moment = motion.mass * (middle[2] * down[0] - middle[0] * down[1])
    p = 2 * result.model.book.impulse
    m = motion.mass
    gained = m * (np.array([motion.V_t - impact.v_t, motion.V_n - impact.v_n]) - down)
    size = m * float(np.hypot(impact.v_t, impact.v_n)) + float(np.abs(p[:2]).sum())
    before = motion.inertia * impact.omega + m * (centre[2] * impact.v_t - centre[0] * impact.v_n)
    turned = motion.spin - before + p[2] - moment
    arm = float(np.linalg.norm(centre))
    momentum, spin = float(np.linalg.norm(gained - p[:2])) / size, abs(float(turned)) / (size * arm)
    return Balance(
        residual=result.worst / E_0,
        growth=float(np.max(-table.numbers("residual_J"), initial=0.0)) / E_0,
        fed=float(np.max(-np.diff(heat), initial=0.0)) / E_0,
        momentum=momentum,
        spin=spin,
    )


CHECKPOINT_INTERVAL = 10.0  # s of wall time
PLANNED = 2.0  # s of processor time, about what a case takes
HEAD = (
    *(Column(name, left=True) for name in ("scene", "what is hard", "verdict")),
    Column("ledger / E_0", digits=1),
    *(Column(name) for name in ("elements", "steps")),
    Column("CPU s", digits=1),
)


@dataclass(frozen=True, slots=True)
class HardCaseResult:
    """What became of a hard case that ended as it must.

    Attributes
    ----------
    verdict : ``closed``, ``refused`` or ``detected``
    reason : why it was refused or stopped, empty where it closed
    residual : largest miss of the energy ledger over E_0; None where nothing was computed
    steps, elements : of its run, 0 where none was made
    cpu_s : processor time, s
    """

    verdict: str
    reason: str = ""
    residual: float | None = None
    steps: int = 0
    elements: int = 0
    cpu_s: float = 0.0


@dataclass(frozen=True, slots=True)
class HardCaseJob:
    """The computation of one hard case; ``out`` takes its history, its outcome and its checkpoint."""

    case: HardCase
    out: Path
    fidelity: ClassVar[str] = "hard case"
    kind: ClassVar[JobKind] = ("hard case", 0.0)
    planned_s: ClassVar[float] = PLANNED

    @property
    def name(self) -> str:
        """Name of the case."""
        return self.case.name

    @property
    def key(self) -> str:
        """Digest of the case and the program."""
        return hashlib.sha256(f"{self.case!r} {source_digest()}".encode()).hexdigest()

    def run(self) -> str:
        """Return the `HardCaseResult` as JSON.

        Raises
        ------
        RunError
            The case did not end as it must: the sentence says how, and why.
        """
        begun = time.process_time()
        try:
            case = self.case
            result = _bounced(case.bounces) if case.bounces else _judged(self._solved(), self.out)
        except SceneError as refusal:
            result = HardCaseResult("refused", str(refusal))
        except RunError as stop:
            result = HardCaseResult("detected", str(stop))
        result = replace(result, cpu_s=time.process_time() - begun)
        if result.verdict != self.case.expected:
            raise RunError(f"{result.verdict}, not {self.case.expected}: {result.reason}")
        return json.dumps(asdict(result))

    def read(self, text: str) -> HardCaseResult:
        """Return the result from its JSON text; raises ResultError where that is damaged."""
        try:
            return HardCaseResult(**json.loads(text))
        except (ValueError, TypeError) as error:
            raise ResultError(f"{self.name}: its stored result is damaged ({error}).") from error

    def cpu_s(self, result: HardCaseResult) -> float:
        """Return the processor time of a result, s."""
        return result.cpu_s

    def _solved(self) -> SolidResult:
        """Run the case from its checkpoint if there is one, else from the start."""
        planned = Case.of(self.case.scene())
        make_directory(self.out)
        options = RunOptions(self.out, checkpoint_s=CHECKPOINT_INTERVAL, stamp=stamp(planned.scene))
        if (self.out / CHECKPOINT).exists():
            try:
                return solve(planned, replace(options, resume=True), model_of(self.case, planned))
            except ResultError:  # of another scene or program
                (self.out / CHECKPOINT).unlink()
        return solve(planned, options, model_of(self.case, planned))


def model_of(case: HardCase, planned: Case) -> Model:
    """Return the solver's model of a case, which starts `gap` above the barrier and `shifted` along t, m.

    Its time step is `step` times the stable one.
    """
    model = build(planned, case.gap)
    x, v = model.start[0].copy(), model.start[1]
    x[model.layout.rod[:, 0]] += case.shifted
    steps = {body: step * case.step / SAFETY for body, step in model.steps.items()}
    return replace(model, start=(x, v), steps=steps)


def _judged(result: SolidResult, out: Path) -> HardCaseResult:
    """Write the outcome of a run, which then holds no NaN, and judge its balances."""
    outcome = reduce(result)
    (out / CHECKPOINT).unlink(missing_ok=True)
    outcome.write(out / "outcome.json")
    balances = balance(result, out / "history.csv")
    faults = balances.faults()
    elements = known(outcome.cost.elements_rod) + known(outcome.cost.elements_barrier)
    stopped = "max_time" not in result.reason and not result.finished
    verdict = "detected" if stopped else "FAILED" if faults else "closed"
    reason = result.reason if stopped else "; ".join(faults)
    return HardCaseResult(verdict, reason, balances.residual, result.steps, elements)


def _bounced(bounces: int) -> HardCaseResult:
    """Judge the bounces of a bar between two walls, by the problem of `fem-impact verify bar`."""
    done = verify("bar", {"bounces": bounces})
    checks = {check.name: check for check in done.checks}
    gained = max(0.0, checks["largest energy of all bounces / E_0"].computed - 1.0)
    reason = "; ".join(check.name for check in done.checks if not check.passed)
    return HardCaseResult("closed" if done.passed else "FAILED", reason, gained, done.cost.steps)


def plan(request: Request, results: object) -> list[HardCaseJob]:
    """Return the requested cases, all when none is named."""
    out = request.out.absolute()
    return [HardCaseJob(CASES[name], out / name) for name in request.ids or CASES]


def conclude(request: Request, results: Mapping[str, HardCaseResult | Failure]) -> StudyReport:
    """Return the report: how many cases ended as they must, the table, and why a case did not close."""
    done = {name: result for name, result in results.items() if not isinstance(result, Failure)}
    verdicts = [result.verdict for result in done.values()]
    worst = max((r.residual or 0.0 for r in done.values() if r.verdict == "closed"), default=0.0)
    minutes = sum(result.cpu_s for result in done.values()) / 60
    unknown = HardCaseResult("**FAILED**")
    ended = {name: done.get(name, unknown) for name in results}
    rows = tuple(
        (
            *(name, CASES[name].difficulty, r.verdict, r.residual, r.elements or None, r.steps or None),
            r.cpu_s if name in done else None,
        )
        for name, r in ended.items()
    )
    return StudyReport(
        "stress",
        "Hard cases",
        [
            f"{len(done)} of {len(results)} scenes that are hard on the solver end as they must: "
            f"{verdicts.count('closed')} close their balances, the energy within {worst:.1g} of E_0, "
            f"{verdicts.count('refused')} are refused and {verdicts.count('detected')} stopped or cut "
            f"short, with a reason ({minutes:.1f} minutes of processor time).",
            *(f"`{name}`: {result.reason}" for name, result in done.items() if result.reason),
        ],
        sheets=[
            Sheet(
                "hard-cases",
                "Scenes that are hard on the solver, on coarse meshes. Each must close its balances, be "
                "refused before the run with its reason, or be detected during it.",
                Table(HEAD, rows),
            )
        ],
    )
