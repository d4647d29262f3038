"""The command ``run``: one scene."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli_changes import changed_scene
from fem_impact.cli_meter import chosen_meter
from fem_impact.cli_out import checked_out
from fem_impact.cli_parser import Options
from fem_impact.cli_print import print_outcome
from fem_impact.cores import cores
from fem_impact.errors import RunError, UsageError
from fem_impact.run_files import CHECKPOINT

if TYPE_CHECKING:
    from fem_impact.outcome import Outcome
    from fem_impact.scene import Scene

__all__ = ["run"]


def run(options: Options) -> int:
    """Compute one scene, write its results and print them."""
    scene = changed_scene(options.scene, options.changes)
    if options.resume and options.fidelity in ("rigid", "modal"):
        problem, remedy = "is of finite elements: this run takes seconds.", "Leave it out."
        raise UsageError(problem, key="--resume", value=options.fidelity, remedy=remedy)
    _say_plan(scene, options)
    out = checked_out(options.out or _default_out(scene, options))
    from fem_impact.earlier import earlier

    meter, before = chosen_meter(options), earlier(out)
    try:
        outcome = _simulation(scene)(
            scene,
            fidelity=options.fidelity or None,
            out=out,
            progress=meter,
            resume=options.resume,
            checkpoint_s=options.checkpoint,
        )
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"Results: {out}; {_way_on(out)}") from None
    finally:
        meter.close()
        _say_kept(out, before, options)
    if options.json:
        sys.stdout.write(outcome.to_json().rstrip("\n") + "\n")
    else:
        print_outcome(outcome, out)
    return 0 if outcome.validity.finished else _stopped(outcome.validity.stopped_because, out)


def _simulation(scene: Scene) -> Callable[..., Outcome]:
    """Return what computes the scene: a scene with a target runs two meshes side by side on two cores."""
    if scene.accuracy.target is None:
        from fem_impact.simulate import simulate

        return simulate
    from fem_impact.cost import simulate_to_target

    return partial(simulate_to_target, workers=cores())


def _say_plan(scene: Scene, options: Options) -> None:
    """Before the work: what the measured costs chose for the error that the scene allows."""
    if scene.accuracy.target is None:
        return
    from fem_impact.cost import plan

    sentence = plan(scene, options.fidelity or None, cores()).sentence
    if not options.quiet:
        sys.stderr.write(f"{sentence}\n")


def _way_on(out: Path) -> str:
    if (out / CHECKPOINT).exists():
        return "--resume goes on from the last checkpoint."
    return "no checkpoint was due yet (--checkpoint SECONDS), so --resume would start at the beginning."


def _say_kept(out: Path, before: list[Path], options: Options) -> None:
    from fem_impact.earlier import earlier

    for place in earlier(out):
        if place not in before and not options.quiet:
            sys.stderr.write(f"An older run that was in {out} is kept in {place}\n")


def _default_out(scene: Scene, options: Options) -> Path:
    """Return results/ID, with the digest's start when the scene was changed, and the fidelity if reduced."""
    name = f"{scene.id}-{scene.digest()[:8]}" if options.changes else scene.id
    return Path("results") / (name if options.fidelity in ("", "solid") else f"{name}-{options.fidelity}")


def _stopped(cause: str, out: Path) -> int:
    sys.stderr.write(f"fem-impact: error: the run stopped early: {cause} Results: {out}\n")
    return RunError.exit_code
