"""The commands that compute: ``run`` and ``study``."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli_changes import changed_scene
from fem_impact.cli_out import checked_out
from fem_impact.cli_parser import Options
from fem_impact.cli_print import print_json, print_outcome
from fem_impact.errors import RunError, SceneError
from fem_impact.progress import Meter, NullMeter, meter_for

if TYPE_CHECKING:
    from fem_impact.scene import Scene

__all__ = ["run", "study"]

QUICK_SETS = ("t3-machined", "t4", "t5b")


def run(options: Options) -> int:
    """Compute one scene, write its results and print them."""
    scene = changed_scene(options.scene, options.changes)
    out = checked_out(options.out or _default_out(scene, options))
    from fem_impact.simulate import simulate

    meter = _meter(options)
    try:
        outcome = simulate(scene, fidelity="solid", out=out, progress=meter)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"Results: {out}") from None
    finally:
        meter.close()
    if options.json:
        sys.stdout.write(outcome.to_json().rstrip("\n") + "\n")
    else:
        print_outcome(outcome, out)
    return 0 if outcome["finished"] else _stopped(outcome["stopped_because"], out)


def study(options: Options) -> int:
    """Run the named study and print its table."""
    return {"sets": _sets, "convergence": _convergence}[options.name](options)


def _convergence(options: Options) -> int:
    """Compute measured sets on a family of meshes and print every quantity's limit."""
    ids = _checked_ids(options.ids)
    out = checked_out(options.out or Path("results") / "convergence")
    from fem_impact.study import run_convergence
    from fem_impact.study.convergence import ACROSS, QUICK_ACROSS

    meter = _meter(options)
    try:
        across = QUICK_ACROSS if options.quick else ACROSS
        result = run_convergence(ids, across, out, meter, options.workers or _cores())
    finally:
        meter.close()
    if options.json:
        print_json({name: getattr(result, name) for name in ("rows", "failures")})
    else:
        sys.stderr.writelines(f"failed: {f['scene_id']}: {f['error']}\n" for f in result.failures)
        sys.stdout.write(f"{result.table}\nresults: {out}\n")
    return RunError.exit_code if result.failures else 0


def _sets(options: Options) -> int:
    """Compute measured sets, compare them with the paper and print the table."""
    ids = _checked_ids(options.ids) or (QUICK_SETS if options.quick else ())
    out = checked_out(options.out or Path("results") / "sets")
    from fem_impact.study import run_sets

    meter = _meter(options)
    try:
        result = run_sets(ids, options.quick, out, meter, options.workers or _cores())
    finally:
        meter.close()
    if options.json:
        told = ("rows", "comparison", "failures", "notes")
        print_json({name: getattr(result, name) for name in told})
    else:
        sys.stderr.writelines(f"note: {note}\n" for note in result.notes)
        sys.stdout.write(f"{result.table}\nresults: {out}\nreport:  {out / 'report.html'}\n")
    return RunError.exit_code if result.failures else 0


def _default_out(scene: Scene, options: Options) -> Path:
    """Return results/ID, with a part of the digest when the shipped scene was changed."""
    name = f"{scene.id}-{scene.digest()[:8]}" if options.changes else scene.id
    return Path("results") / name


def _checked_ids(ids: Sequence[str]) -> tuple[str, ...]:
    from fem_impact.scene import MEASURED_SETS

    for name in ids:
        if name not in MEASURED_SETS:
            near = get_close_matches(name, MEASURED_SETS, 1)
            remedy = f"Did you mean {near[0]}?" if near else f"Measured: {', '.join(MEASURED_SETS)}."
            raise SceneError("is not a measured set.", key="ID", value=name, remedy=remedy)
    return tuple(dict.fromkeys(ids))


def _meter(options: Options) -> Meter:
    if options.quiet:
        return NullMeter()
    return meter_for(sys.stderr, width=max(40, shutil.get_terminal_size((100, 24)).columns - 1))


def _cores() -> int:
    """Return how many processor cores this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def _stopped(cause: str, out: Path) -> int:
    sys.stderr.write(f"fem-impact: error: the run stopped early: {cause} Results: {out}\n")
    return RunError.exit_code
