"""Run hard cases in processes, keep each row so that a stopped command goes on, and tabulate the rows."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Sequence
from concurrent.futures import as_completed
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.errors import ResultError, RunError, SceneError
from fem_impact.evidence.hard_cases.scenes import CASES, HardCase
from fem_impact.files.atomic import make_directory, read_text, write_text
from fem_impact.files.lock import directory_lock
from fem_impact.jobs.executors import LocalProcesses
from fem_impact.options import RunOptions
from fem_impact.tables.table import Table

if TYPE_CHECKING:
    from fem_impact.case.plan import Plan
    from fem_impact.solid.model import Model
    from fem_impact.solid.run import SolidResult


ROW = "row.json"
CHECKPOINT_INTERVAL = 10.0  # s of wall time
HEAD = ["scene", "what is hard", "verdict", "ledger / E_0", "elements", "steps", "CPU s"]


@dataclass(frozen=True, slots=True)
class Row:
    """What became of one case.

    Attributes
    ----------
    difficulty : what is hard about the case
    verdict : ``closed``, ``refused`` or ``detected``; ``passed`` says whether that was expected
    reason : why it was refused or stopped, or which balance does not hold
    residual, growth : of E_0, None where nothing was computed
    """

    name: str
    difficulty: str
    verdict: str
    passed: bool
    reason: str = ""
    residual: float | None = None
    growth: float | None = None
    steps: int = 0
    elements: int = 0
    time_s: float = 0.0
    cpu_s: float = 0.0


def run_cases(names: Sequence[str], out: Path, report: Callable[[Row], None], workers: int) -> list[Row]:
    """Run cases in processes; rows of the same scenes and sources that lie in ``out`` are kept."""
    with directory_lock(out):
        rows = {name: row for name in names if (row := _kept(CASES[name], out)) is not None}
        waiting = [name for name in names if name not in rows]
        with LocalProcesses(min(workers, max(len(waiting), 1))) as pool:
            futures = [pool.submit(run_case, name, out) for name in waiting]
            for done in as_completed(futures):
                rows[done.result().name] = done.result()
                report(done.result())
    return [rows[name] for name in names]


def run_case(name: str, out: Path) -> Row:
    """Run one case and keep its row; whatever happens is a row."""
    case, begun = CASES[name], time.process_time()
    try:
        row = _bounces(case) if case.bounces else _judged(case, _solved(case, out / name), out / name)
    except SceneError as refusal:
        row = _row(case, "refused", str(refusal))
    except RunError as stop:
        row = _row(case, "detected", str(stop))
    except Exception as error:  # a fault of the program: the others go on, and the table shows it
        row = replace(_row(case, "fault", repr(error)), passed=False)
    row = replace(row, cpu_s=time.process_time() - begun)
    write_text(out / name / ROW, json.dumps({"stamp": _stamp(case), **asdict(row)}, indent=1))
    return row


def _row(case: HardCase, verdict: str, reason: str = "", **more: Any) -> Row:
    return Row(case.name, case.difficulty, verdict, verdict == case.expected, reason, **more)


def _solved(case: HardCase, out: Path) -> SolidResult:
    """Run a case from its checkpoint in ``out`` if there is one, else from the start."""
    from fem_impact.case.plan import plan
    from fem_impact.files.run_directory import CHECKPOINT
    from fem_impact.run.program import stamp
    from fem_impact.solid.run import solve

    planned = plan(case.scene())
    make_directory(out)
    options = RunOptions(out, checkpoint_s=CHECKPOINT_INTERVAL, stamp=stamp(planned.scene))
    if (out / CHECKPOINT).exists():
        try:
            return solve(planned, replace(options, resume=True), _model(case, planned))
        except ResultError:  # of another scene or program
            (out / CHECKPOINT).unlink()
    return solve(planned, options, _model(case, planned))


def _model(case: HardCase, plan: Plan) -> Model:
    """Return the case's model: a start and a step of its own."""
    from fem_impact.fem.stable import SAFETY
    from fem_impact.solid.build import build

    model = build(plan, case.gap)
    x, v = model.start[0].copy(), model.start[1]
    x[model.layout.rod[:, 0]] += case.shifted
    steps = {body: step * case.step / SAFETY for body, step in model.steps.items()}
    return replace(model, start=(x, v), steps=steps)


def _judged(case: HardCase, result: SolidResult, out: Path) -> Row:
    from fem_impact.evidence.hard_cases.judge import balance
    from fem_impact.files.run_directory import CHECKPOINT
    from fem_impact.outcome.keys import known
    from fem_impact.run.solid import reduce

    outcome = reduce(result)  # which holds no NaN
    (out / CHECKPOINT).unlink(missing_ok=True)
    outcome.write(out / "outcome.json")
    balances = balance(result, out / "history.csv")
    faults = balances.faults()
    elements = known(outcome.cost.elements_rod) + known(outcome.cost.elements_barrier)
    stopped = "max_time" not in result.reason and not result.finished
    verdict = "detected" if stopped else "FAILED" if faults else "closed"
    reason = result.reason if stopped else "; ".join(faults)
    shares = {"residual": balances.residual, "growth": balances.growth}
    return _row(case, verdict, reason, **shares, steps=result.steps, elements=elements, time_s=result.time)


def _bounces(case: HardCase) -> Row:
    from fem_impact.evidence.problems.catalogue import verify

    done = verify("bar", {"bounces": case.bounces})
    checks = {check.name: check for check in done.checks}
    most = checks["largest energy of all bounces / E_0"]
    verdict = "closed" if done.passed else "FAILED"
    reason = "; ".join(check.name for check in done.checks if not check.passed)
    gained = max(0.0, most.computed - 1.0)
    return _row(case, verdict, reason, residual=gained, growth=gained, steps=done.cost.steps)


def _stamp(case: HardCase) -> str:
    from fem_impact.run.program import source_digest

    return f"{case!r} {source_digest()}"


def _kept(case: HardCase, out: Path) -> Row | None:
    """Return a stored row if it is whole and of this case and program."""
    path = out / case.name / ROW
    if not path.is_file():
        return None
    try:
        values = json.loads(read_text(path))
        return Row(**values) if values.pop("stamp") == _stamp(case) else None
    except (ResultError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None


def page(rows: Sequence[Row]) -> str:
    """Return counts, the table, and a sentence for each case that did not simply close."""
    passed, cpu = sum(row.passed for row in rows), sum(row.cpu_s for row in rows)
    line = f"{passed} of {len(rows)} as they must be, {cpu / 60:.1f} minutes of CPU."
    notes = [f"- `{row.name}`: {row.reason}" for row in rows if row.reason]
    cells = []
    for row in rows:
        verdict = row.verdict if row.passed else f"**{row.verdict}**"
        counts = [f"{n}" if n else "" for n in (row.elements, row.steps)]
        cells.append([f"`{row.name}`", row.difficulty, verdict, _share(row), *counts, f"{row.cpu_s:.0f}"])
    return "\n".join([line, "", Table.of(HEAD, cells).markdown(), "", *notes]).rstrip()


def row_line(row: Row) -> str:
    """Return one line on a case."""
    mark = "ok  " if row.passed else "FAIL"
    reason = f": {row.reason}" if row.reason else ""
    return f"{mark} {row.name}: {row.verdict}, ledger {_share(row)}, {row.cpu_s:.1f} s of CPU{reason}"


def _share(row: Row) -> str:
    return "-" if row.residual is None else f"{row.residual:.0e}"
