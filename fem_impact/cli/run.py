"""The commands ``run``, which computes a scene, and ``scenes``, which lists those shipped."""

from __future__ import annotations

import math
import shlex
import sys
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.cli.common import (
    changed_scene,
    checked_out,
    print_json,
    say_kept,
    shown_path,
    size_text,
    stated_budget,
    told_kept,
)
from fem_impact.cli.options import Options
from fem_impact.cli.terminal import chosen_meter, print_table
from fem_impact.errors import RunError, UsageError
from fem_impact.files.run_directory import CHECKPOINT
from fem_impact.jobs.executors import cores
from fem_impact.options import RunOptions
from fem_impact.progress import clock_text
from fem_impact.scene.library import materials, shipped
from fem_impact.scene.shipped import load
from fem_impact.scene.types import OWN, Scene
from fem_impact.scene.write import digest
from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped

if TYPE_CHECKING:
    from fem_impact.answers.refine.loop import OwnLadder
    from fem_impact.answers.wanted_error import ChosenSetting
    from fem_impact.outcome.record import Outcome


LONG = 600.0
"""Expected computing time, s, above which `run` prints it before it starts."""


def run(options: Options) -> int:
    """Compute one scene, write its results and print them."""
    scene = changed_scene(options.scene, options.changes)
    if options.resume and options.fidelity in ("rigid", "modal"):
        problem = f"is for finite elements only: a {options.fidelity} run takes seconds."
        raise UsageError(problem, key="--resume", remedy="Leave it out.")
    say_kept(scene, options)
    chosen = _setting(scene, options)
    _say_plan(scene, chosen.sentence if chosen else "", options)
    out = checked_out(options.out or _default_out(scene, options))
    if options.resume and scene.accuracy.target is None and not (out / CHECKPOINT).exists():
        sys.stderr.write(f"fem-impact: {out} holds no checkpoint: the run starts at the beginning\n")
    from fem_impact.answers.wanted_error import simulate
    from fem_impact.cli.outcome import print_outcome

    try:
        with told_kept(out, options), closing(chosen_meter(options)) as meter:
            run_options = RunOptions(out, meter, options.resume, options.checkpoint)
            outcome = simulate(scene, options.fidelity or None, run_options, cores(), chosen=chosen)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"what was computed so far is kept. Results: {out}; {_way_on(out)}") from None
    if options.json:
        sys.stdout.write(outcome.to_json().rstrip("\n") + "\n")
    else:
        print_outcome(outcome, out, own_tests=(scene.measured or "").endswith(OWN))
        _say_comparison(scene, outcome, options)
        _say_screening(scene, options)
    if outcome.validity.finished:
        return 0
    cause = outcome.validity.stopped_because
    sys.stderr.write(f"fem-impact: error: the run stopped early: {cause} Results: {out}\n")
    return RunError.exit_code


def _say_comparison(scene: Scene, outcome: Outcome, options: Options) -> None:
    """Print the outcome beside the tests that its scene names."""
    from fem_impact.answers.compare import compare
    from fem_impact.run.tests import count, doubtful_tests, tests_of

    tests = tests_of(scene)
    if tests is None:
        return
    head = ("", "model", "measured", "SD", "")
    rows = [
        (
            row["quantity"],
            *(f"{row[key]:.4g}" for key in ("model", "measured_mean", "measured_sd")),
            row["verdict"],
        )
        for row in compare(outcome, tests)
        if row["measured_mean"] is not None and row["model"] is not None
    ]
    sys.stdout.write(f"beside {count(tests)} measured tests ({shown_path(str(scene.measured))}):\n")
    print_table(Table.of(head, rows, left=(0, 4)), options, indent="  ")
    sys.stdout.writelines(f"{line}\n" for one in doubtful_tests(scene) for line in wrapped(f"warning: {one}"))


def _say_screening(scene: Scene, options: Options) -> None:
    """Print the closed-form screening of the scene and the command of its verdict."""
    from fem_impact.answers.verdict.screening import screening
    from fem_impact.answers.verdict.sentences import lines_of, screening_lines

    changes = [word for change in options.changes for word in ("--set", change)]
    titled = screening_lines(screening(scene), shlex.join([options.scene, *changes]))
    lines = lines_of(titled, indent="")
    sys.stdout.write("\n".join(lines) + "\n")


def _setting(scene: Scene, options: Options) -> ChosenSetting | OwnLadder | None:
    """Return what is run for the target error of a scene; None where the scene gives a mesh."""
    budget = stated_budget(options)
    if scene.accuracy.target is None:
        if budget is not None:
            remedy = """Add --set 'accuracy="5 %"', or leave it out."""
            raise UsageError(
                "is for a wanted error, and the scene gives a mesh.", key="--budget", remedy=remedy
            )
        return None
    from fem_impact.answers.wanted_error import settle

    return settle(scene, options.fidelity or None, cores(), budget)


def _say_plan(scene: Scene, chosen: str, options: Options) -> None:
    """Print the setting chosen for the scene's target error, or without one the time of a long run."""
    sentence = chosen or ("" if options.fidelity in ("rigid", "modal") else _long_run(scene))
    if sentence and not options.quiet:
        sys.stderr.write(f"{sentence}\n")


def _long_run(scene: Scene) -> str:
    from fem_impact.case.plan import plan

    size = plan(scene).size
    if size.time <= LONG:
        return ""
    return f"This run takes about {clock_text(size.time)} ({size_text(size)}); a larger tip_size is quicker."


def _way_on(out: Path) -> str:
    if (out / CHECKPOINT).exists():
        return "--resume goes on from the last checkpoint."
    return "no checkpoint was due yet (--checkpoint SECONDS), so --resume would start at the beginning."


def _default_out(scene: Scene, options: Options) -> Path:
    """Return results/ID, with 8 digits of the digest of a changed scene and the fidelity if not solid."""
    name = f"{scene.id}-{digest(scene)[:8]}" if options.changes else scene.id
    return Path("results") / (name if options.fidelity in ("", "solid") else f"{name}-{options.fidelity}")


def scenes(options: Options) -> int:
    """List the shipped scenes, or the shipped materials."""
    if options.materials:
        return _materials(options)
    listed = [_listed(load(name)) for name in shipped()]
    if options.json:
        print_json({"scenes": listed})
    else:
        rows = [[scene[key] for key in ("id", "speed", "title")] for scene in listed]
        print_table(Table.of(("id", "speed", "title"), rows, left=range(3)), options)
    return 0


def _materials(options: Options) -> int:
    """List the shipped materials with their values."""
    head = ("material", "E_Pa", "nu", "rho_kg_per_m3", "yield_stress_Pa", "ultimate_stress_Pa")
    rows = [
        (name, m.E, m.nu, m.rho, *(x if x < math.inf else None for x in (m.yield_stress, m.ultimate_stress)))
        for name, m in materials().items()
    ]
    if options.json:
        print_json({"materials": [dict(zip(head, row, strict=True)) for row in rows]})
    else:
        told = [(row[0], *("none" if x is None else f"{x:.4g}" for x in row[1:])) for row in rows]
        print_table(Table.of(head, told), options)
    return 0


def _listed(scene: Scene) -> dict[str, Any]:
    speed = math.hypot(scene.relative.v_n, scene.relative.v_t)
    return {
        "id": scene.id,
        "title": scene.title,
        "speed": f"{speed:.2f} m/s",
        "measured": scene.measured,
        "digest": digest(scene),
    }
