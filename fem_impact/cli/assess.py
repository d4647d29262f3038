"""The command ``assess``: the verdict on one scene, and measured tests carried over to it on demand."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from fem_impact.cli.common import checked_out, print_json, stated_budget
from fem_impact.cli.options import Options
from fem_impact.cli.rigid import SHAPE, angle_of, named_scene, rod_of
from fem_impact.errors import UsageError
from fem_impact.tables.text import wrapped

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene

SHORT = ("length", "diameter", "height", "angle", "surface")
"""Options of a dropped steel rod that must be given where no scene is."""


def assess(options: Options) -> int:
    """Assess one scene and print the verdict, before anything else its three lines."""
    from fem_impact.answers.verdict.assess import assess as assessed
    from fem_impact.answers.verdict.dropped import dropped
    from fem_impact.answers.verdict.sentences import document
    from fem_impact.jobs.executors import cores

    means = _budget(options), min(options.workers or cores(), 2)
    scene = named_scene(options, SHORT) or _short(options)
    case = dropped(scene) if options.heat else None
    out = checked_out(options.out) if options.out else None
    if out is not None:
        from fem_impact.files.run_directory import refuse_other_scene
        from fem_impact.scene.write import to_toml

        refuse_other_scene(out / "scene.toml", to_toml(scene))
    try:
        verdict = assessed(scene, options.fidelity, _tolerance(options), *means, tell=_teller(options))
    except KeyboardInterrupt:
        remedy = "--budget bounds the time of the next one, --fidelity modal takes seconds."
        raise KeyboardInterrupt(f"an assessment that is stopped keeps nothing: {remedy}") from None
    found = document(verdict, _command(options))
    if case is not None:
        from fem_impact.answers.verdict.transfer import transfer

        found["transfer"] = transfer(case)
    if out is not None:
        from fem_impact.pages.run_page import write_verdict

        found["page"] = str(write_verdict(verdict, found, out))
    if options.json:
        print_json(found)
    else:
        sys.stdout.write(_text(found))
    return 0


def _command(options: Options) -> str:
    """Return the command without the options that the next step may add."""
    if options.scene:
        given = [options.scene, *(word for change in options.changes for word in ("--set", change))]
    else:
        names = [name for name in (*SHORT, *SHAPE) if getattr(options, name, None)]
        given = [word for name in names for word in (f"--{name.replace('_', '-')}", getattr(options, name))]
    tolerance = ["--tolerance", options.tolerance] if options.tolerance else []
    return shlex.join(["fem-impact", "assess", *given, *tolerance])


def _short(options: Options) -> Scene:
    """Return the scene of the dropped steel rod that the options state."""
    from fem_impact.answers.verdict.drop import DroppedRod
    from fem_impact.answers.verdict.dropped import scene_of
    from fem_impact.scene.units import option_quantity

    height = option_quantity(options.height or "", "length", "--height")
    return scene_of(DroppedRod(rod_of(options), height, angle_of(options), options.surface or ""))


def _tolerance(options: Options) -> float:
    from fem_impact.answers.verdict.assess import TOLERANCE

    if not options.tolerance:
        return TOLERANCE
    try:
        return float(options.tolerance)
    except ValueError:
        remedy = "It is the change of e that may be neglected: give one such as 0.05."
        raise UsageError(
            "is not a number.", key="--tolerance", value=options.tolerance, remedy=remedy
        ) from None


def _budget(options: Options) -> float:
    from fem_impact.answers.verdict.assess import BUDGET

    stated = stated_budget(options)
    return BUDGET if stated is None else stated


def _teller(options: Options) -> Callable[[str], object]:
    """Return a function that prints a sentence to a terminal that waits; silent where nobody looks on."""
    if options.quiet or not sys.stderr.isatty():
        return lambda sentence: None
    return lambda sentence: sys.stderr.write(f"{sentence}\n")


def _text(found: dict[str, Any]) -> str:
    from fem_impact.answers.verdict.sentences import lines_of

    lines = [line for title, sentence in found["box"] for line in wrapped(f"{title} {sentence}")]
    lines += [f"Next step: {found['next_step']}"] if found["next_step"] else []
    lines += ["", "What this rests on", *lines_of(found["basis"], indent="  ")]
    lines += ["", "What it does not cover"]
    lines += [line for sentence in found["not_covered"] for line in wrapped(f"- {sentence}", "  ")]
    if "transfer" in found:
        from fem_impact.answers.verdict.text import transfer_text

        lines += [
            "",
            "Measured tests carried over to this drop",
            "",
            transfer_text(found["transfer"]).rstrip(),
        ]
    return "\n".join([*lines, *([f"page: {found['page']}"] if "page" in found else [])]) + "\n"
