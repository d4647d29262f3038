"""One scene of the study computed by one model as a user would, and what became of it."""

import hashlib
import json
import tempfile
import time
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from math import inf
from pathlib import Path
from typing import Any, Literal

import fem_impact
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.extrapolate import own_limits
from fem_impact.answers.refine.level import LevelRun
from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.answers.verdict.assess import BUDGET, assess
from fem_impact.answers.verdict.levels import by_levels, next_step
from fem_impact.answers.verdict.vibration import CHANGED, Answer, VibrationEffect, solid_effect, twins
from fem_impact.errors import FemImpactError, ResultError, SceneError
from fem_impact.evidence.studies.coverage.scenes import DrawnScene
from fem_impact.jobs.job import JobKind
from fem_impact.outcome.keys import Unknown, or_none
from fem_impact.outcome.record import Outcome
from fem_impact.progress import Notice, Progress
from fem_impact.run.program import source_digest
from fem_impact.scene.types import Scene

Trouble = Literal["", "refused", "stopped", "too dear", "fault"]
"""Why a run has no outcome: refused before any work, stopped by an error, broken off by the study, a fault of
the program."""
MODELS = "default", "finer", "finest", "modal", "twins", "assess", "check"
DEFAULT, FINER, FINEST, MODAL, TWINS, ASSESS, CHECK = MODELS
LEVELS: Mapping[str, int] = {FINER: 1, FINEST: 2}
"""Levels more than a scene's own by model."""
PLANNED: Mapping[str, float] = dict(zip(MODELS, (20.0, 50.0, 100.0, 0.5, 40.0, 30.0, 90.0), strict=True))
"""Processor time, s, that a run of each model is expected to take."""
MOST: Mapping[str, float] = dict(zip(MODELS, (60.0, 90.0, 180.0, 60.0, 90.0, BUDGET, 180.0), strict=True))
"""Processor time, s, after which a run of each model is broken off: it is too dear for the study. Verdicts,
their checks and twins get it as the budget of their levels, s of wall time."""
NEXT: Mapping[str, tuple[str, float]] = {FINER: (DEFAULT, 11.0), FINEST: (FINER, 10.0), TWINS: (MODAL, inf)}
"""After which run another follows, and the processor time, s, that this may have taken at most."""
NARROW = 0.02
"""Half-width of the change of e by vibration at which twins get no finer level."""


@dataclass(frozen=True, slots=True)
class CoverageResult:
    """What became of a run.

    Attributes
    ----------
    outcome : None where there is none
    trouble, reason : why there is none, in a word and in the program's words; empty where there is one
    cpu_s, wall_s : processor and wall time of all of it, s
    planned_s : least and most processor time, s, told before the run; None: nothing was
    forecast_s, left_s : least and most time, s, that were told after the pilot to be left, at the processor
        time that a second had given until then, and the processor time that it then took; None where nothing
        was told
    notices : sentences told during the run
    own_halves : half-widths, by key, that the levels of a run tell by themselves
    changes : of twins: change by vibration and its half-width, by the numbers of `CHANGED`
    verdict : ``answer``, ``model`` and ``levels`` of a verdict, what was ``tried`` last, what is ``missing``,
        and what to type ``next``
    """

    outcome: Outcome | None
    trouble: Trouble = ""
    reason: str = ""
    cpu_s: float = 0.0
    wall_s: float = 0.0
    planned_s: tuple[float, float] | None = None
    forecast_s: tuple[float, float] | None = None
    left_s: float | None = None
    notices: tuple[str, ...] = ()
    own_halves: Mapping[str, float] = field(default_factory=dict)
    changes: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    verdict: Mapping[str, Any] = field(default_factory=dict)

    @property
    def end(self) -> str:
        """How it ended, in words.

        Of a run with numbers: finished, or strikes again (another end of the projectile comes down later, and
        the numbers are those before). Without: not resolved, cut off, or its trouble.
        """
        if self.outcome is None:
            return self.trouble
        finished = self.outcome.validity.finished
        if self.has_numbers:
            return "finished" if finished else "strikes again"
        return "not resolved" if finished else "cut off"

    @property
    def has_numbers(self) -> bool:
        """Whether it gave the numbers of an impact."""
        return self.outcome is not None and not isinstance(self.outcome.restitution.mu, Unknown)

    @property
    def why(self) -> str:
        """Why it gave no numbers, or those before a later strike alone; empty where it finished with them."""
        if self.outcome is None:
            return self.reason
        mu, told = self.outcome.restitution.mu, self.outcome.validity
        if isinstance(mu, Unknown):
            return mu.reason
        return "" if told.finished else told.stopped_because


class TooDearError(Exception):
    """A run takes longer than the study affords."""


@dataclass
class _Listener:
    """Keeps what a run tells: notices, and the first forecast of the time left with when it was told.

    Raises `TooDearError` once ``most_s`` of processor time, s, are used up.
    """

    most_s: float
    notices: list[str] = field(default_factory=list)
    forecast: tuple[tuple[float, float], float] | None = None
    begun: float = field(default_factory=time.process_time)
    wall: float = field(default_factory=time.perf_counter)

    def __call__(self, progress: Progress | Notice) -> None:
        if isinstance(progress, Notice):
            self.notices.append(progress.text)
            return
        if self.forecast is None and progress.eta_range_s is not None and ", level 2" in progress.note:
            at = time.process_time()
            pace = (at - self.begun) / (time.perf_counter() - self.wall)
            least, most = progress.eta_range_s
            self.forecast = (pace * least, pace * most), at
        if time.process_time() - self.begun > self.most_s:
            raise TooDearError(f"took more than {self.most_s:g} s of processor time at {progress.note}")


@dataclass(frozen=True, slots=True)
class CoverageRun:
    """A drawn scene by one model: levels as by default, one or two finer, with a twin, or the reduced model.

    The twin cannot vibrate. A verdict may take several models; its check is twins on so many ``levels``.
    """

    drawn: DrawnScene
    model: str
    levels: int = 0

    @property
    def name(self) -> str:
        """Name of scene and model."""
        return f"{self.drawn.name}: {self.model}"

    @property
    def key(self) -> str:
        """Digest of scene, model, time and program."""
        stated = json.dumps([asdict(self), MOST[self.model]], sort_keys=True)
        return hashlib.sha256(f"{stated} {source_digest()}".encode()).hexdigest()

    @property
    def fidelity(self) -> str:
        """The model, by which times compare."""
        return self.model

    @property
    def kind(self) -> JobKind:
        """The model; the mesh is the run's own affair."""
        return self.model, 0.0

    @property
    def planned_s(self) -> float:
        """Expected processor time, s."""
        return PLANNED[self.model]

    def run(self) -> str:
        """Return the `CoverageResult` as JSON; an error of whatever kind is a result."""
        listener, wall = _Listener(MOST[self.model]), time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            result = self._result(Path(folder), listener)
        ended, wall_s = time.process_time(), time.perf_counter() - wall
        forecast_s, told = listener.forecast or (None, None)
        result = replace(
            result,
            cpu_s=ended - listener.begun,
            wall_s=wall_s,
            forecast_s=forecast_s,
            left_s=None if told is None else ended - told,
            notices=tuple(listener.notices),
        )
        kept = asdict(replace(result, outcome=None))
        return json.dumps({**kept, "outcome": result.outcome and result.outcome.to_json()})

    def read(self, text: str) -> CoverageResult:
        """Return the result from its JSON text; raises ResultError where that is damaged."""
        try:
            kept: dict[str, Any] = json.loads(text)
            outcome = kept.pop("outcome")
            kept["notices"] = tuple(kept["notices"])
            for told in ("planned_s", "forecast_s"):
                kept[told] = kept[told] and tuple(kept[told])
            return CoverageResult(outcome and Outcome.from_json(outcome, self.name), **kept)
        except (ValueError, TypeError, KeyError) as error:
            raise ResultError(f"{self.name}: its stored result is damaged ({error}).") from error

    def cpu_s(self, result: CoverageResult) -> float:
        """Return the processor time of a result, s."""
        return result.cpu_s

    def _result(self, folder: Path, listener: _Listener) -> CoverageResult:
        """Compute the scene in an empty folder."""
        try:
            scene = self.drawn.scene(folder)
            if self.model == MODAL:
                return CoverageResult(fem_impact.simulate(scene, "modal"))
            if self.model in (TWINS, CHECK):
                return CoverageResult(None, changes=_changes(scene, MOST[self.model], self.levels))
            if self.model == ASSESS:
                return _verdict(scene)
            levels = scene.accuracy.levels + LEVELS.get(self.model, 0)
            scene = replace(scene, accuracy=replace(scene.accuracy, levels=levels))
            chain = LevelChain(fem_impact.Case(scene), fem_impact.RunOptions(progress=listener))
            outcome = chain.run()
            halves = or_none(own_limits([level.runs for level in chain.done[: chain.counted]])[1]) or {}
            return CoverageResult(outcome, planned_s=_expected_s(scene), own_halves=halves)
        except TooDearError as dear:
            return CoverageResult(None, "too dear", str(dear))
        except SceneError as refusal:
            return CoverageResult(None, "refused", str(refusal).replace(str(folder), "."))
        except FemImpactError as error:
            return CoverageResult(None, "stopped", str(error).replace(str(folder), "."))
        except Exception:  # a fault is what the study looks for: it is counted, with its traceback
            return CoverageResult(None, "fault", traceback.format_exc())


@dataclass(frozen=True, slots=True)
class _Effects:
    """Changes by vibration on levels of finite elements, by the numbers of `CHANGED` that these give.

    ``enough`` says whether no finer level is wanted.
    """

    known: Mapping[str, VibrationEffect]
    enough: bool

    def answer(self, limit: float) -> Answer:
        """Say undecided until the levels are enough."""
        return "yes" if self.enough else "undecided"

    def graded(self, limit: float) -> Answer:
        """Return the answer."""
        return self.answer(limit)

    def over(self, limit: float) -> float:
        """Return 1: another level is asked for."""
        return 1.0


def _changes(scene: Scene, budget_s: float, levels: int) -> dict[str, tuple[float, float]]:
    """Return changes by vibration and half-widths by the numbers of `CHANGED`, none where nothing is told.

    Finer levels run until e is known within `NARROW`; or until they are so many, and fewer tell nothing.
    """

    def estimate(done: Sequence[LevelRun]) -> _Effects | None:
        effects = {of: solid_effect([level.runs for level in done], of) for of in CHANGED}
        known = {of: effect for of, effect in effects.items() if effect}
        if "e" not in known:
            return None
        return _Effects(known, len(done) >= levels if levels else known["e"].band <= NARROW)

    pair, means = twins(scene.untargeted), (budget_s, 1)
    found, _, _ = by_levels(pair, estimate, str, NARROW, means, lambda _: None, [])
    if found is None or (levels and not found.enough):
        return {}
    return {of: (effect.value, effect.band) for of, effect in found.known.items()}


def _verdict(scene: Scene) -> CoverageResult:
    """Return the verdict of `assess` within its own budget."""
    v = assess(scene, tell=lambda _: None)
    told = {
        "answer": v.answer,
        "model": v.fidelity,
        "levels": sum(step.startswith("finite elements, level") for step in v.steps),
        "tried": "; ".join([*v.steps[-1:], *v.notes]),
        "missing": v.missing,
        "next": next_step("fem-impact assess", v.more) or "",
    }
    return CoverageResult(None, changes={"e": (v.here.value, v.here.band)} if v.here else {}, verdict=told)


def _expected_s(scene: Scene) -> tuple[float, float] | None:
    """Return the processor time, s, that is told before the run; None where none can be."""
    try:
        return LevelMeshes.of(fem_impact.Case(scene)).whole_s
    except SceneError:  # of a scene that the levels alone can compute
        return None
