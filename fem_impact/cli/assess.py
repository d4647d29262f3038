"""The command ``assess``: the verdict on one scene, and measured tests carried over to it on demand."""

import sys
from collections.abc import Callable
from typing import Any

from fem_impact.answers.verdict.assess import BUDGET, TOLERANCE, sequence_verdict
from fem_impact.answers.verdict.assess import assess as assessed
from fem_impact.answers.verdict.chart import chart
from fem_impact.answers.verdict.criteria import LIMITED, Criterion, Rigidity
from fem_impact.answers.verdict.dropped import RodDropInput, dropped, scene_of
from fem_impact.answers.verdict.limit import judge
from fem_impact.answers.verdict.limit_verdict import limit_document
from fem_impact.answers.verdict.sentences import document, lines_of
from fem_impact.answers.verdict.text import transfer_text
from fem_impact.answers.verdict.transfer import transfer
from fem_impact.answers.verdict.vibration import CHANGED
from fem_impact.cli import scene_options
from fem_impact.cli.parser import Options, stated_budget
from fem_impact.cli.paths import checked_out
from fem_impact.cli.terminal import print_answer
from fem_impact.cli.values import read_all
from fem_impact.errors import SceneError, UsageError
from fem_impact.figures.panels import Picture
from fem_impact.files.run_directory import refuse_other_scene
from fem_impact.pages.run_page import write_verdict
from fem_impact.scene.impact import FIRST
from fem_impact.scene.types import Scene, to_toml
from fem_impact.scene.units import option_quantity, parse_change
from fem_impact.tables.text import wrapped

RIGID = "rigid"  # the question that is asked where no other is
SHORT = ("length", "diameter", "height", "angle", "surface")
"""Options of a dropped steel rod that must be given where no scene is."""


def assess(options: Options) -> int:
    """Assess one scene and print the verdict, before anything else the lines of its box."""
    of_limits = options.question != RIGID
    limited = of_limits or bool(options.uncertain)
    unused = {
        "--limit": (options.limit, not of_limits, "Ask for it: --for heat, force or dent."),
        "--within": (options.within, of_limits, "Leave it out: --limit states what is allowed."),
        "--heat": (options.heat, limited, "Leave it out: it is of the verdict of one scene on rigid theory."),
    }
    for key, (value, refused, remedy) in unused.items():
        if value and refused:
            raise UsageError("has no question here.", key=key, value=value, remedy=remedy)
    out = checked_out(options.out) if options.out else None
    scene = scene_options.named_scene(options, SHORT)
    if scene is None:
        height = option_quantity(options.height, "length", "--height")
        rod, angle = scene_options.rod_of(options), scene_options.angle_of(options)
        scene = scene_of(RodDropInput(rod, height, angle, options.surface))
    if out is not None:
        refuse_other_scene(out / "scene.toml", to_toml(scene))
    answer, picture = (_limited if limited else _rigid)(options, scene)
    if out is not None:
        answer["page"] = str(write_verdict(scene, answer, out, picture))
    print_answer(options, answer, _text(answer))
    return 0


EXAMPLES = {"temperature": "430 degC", "force": "5 kN", "length": "0.2 mm"}
"""Limits by their dimensions, for messages."""


def _rigid(options: Options, scene: Scene) -> tuple[dict[str, Any], Picture | None]:
    """Return the verdict on rigid theory as plain JSON, and the design chart with its point, if any."""
    case = dropped(scene) if options.heat else None
    of, change = _within(options)
    verdict = assessed(scene, options.fidelity, change, *_means(options), tell=_telling(options), of=of)
    # without the options that the next step may add
    names = *SHORT, *scene_options.SHAPE, "within", "workers"
    answer = document(verdict, scene_options.command_line(options, "assess", *names))
    if scene.impact.until != FIRST:
        answer["sequence"] = sequence_verdict(scene, verdict.tolerance)
    if case is not None:
        answer["transfer"] = transfer(case)
    return answer, chart(verdict)


def _means(options: Options) -> tuple[float, int | None]:
    """Return the budget of the finite elements, s, and how many runs go on at a time, if stated."""
    budget = stated_budget(options)
    return BUDGET if budget is None else budget, options.workers


def _telling(options: Options) -> Callable[[str], None]:
    """Return what prints a sentence to a terminal that waits."""
    shown = not options.quiet and sys.stderr.isatty()
    return lambda sentence: print(sentence, file=sys.stderr) if shown else None


def _limited(options: Options, scene: Scene) -> tuple[dict[str, Any], None]:
    """Return the verdict on a number and its limit, over the intervals that are stated, as plain JSON."""
    criterion: Criterion
    if options.question == RIGID:
        of, limit = _within(options)
        criterion = Rigidity(of)
    else:
        criterion = LIMITED[options.question]
        if not options.limit:
            remedy = f'Give what it must stay below, such as --limit "{EXAMPLES[criterion.dimension]}".'
            raise UsageError(f"is missing beside --for {options.question}.", key="--limit", remedy=remedy)
        limit = option_quantity(options.limit, criterion.dimension, "--limit")
    uncertain: dict[str, Any] = read_all(options.uncertain, "--uncertain")
    means = options.fidelity, *_means(options)
    found = judge(scene, criterion, limit, uncertain, *means, tell=_telling(options))
    given = "question", "limit", "uncertain", "within", "workers"
    command = scene_options.command_line(options, "assess", *SHORT, *scene_options.SHAPE, *given)
    return limit_document(found, command.replace("--question", "--for")), None


def _within(options: Options) -> tuple[str, float]:
    """Return of what a change may be neglected, and how large it may be."""
    if not options.within:
        return "e", TOLERANCE
    of, _, text = options.within.strip().partition(" ")
    remedy = f'Name one of {", ".join(CHANGED)} and a change of it, such as "e 0.05" or "energy 2 %".'
    problem = "is not a change of a number, above 0 and below 1."
    wrong = UsageError(problem, key="--within", value=options.within, remedy=remedy)
    if of not in CHANGED:
        raise wrong
    try:
        change = parse_change(text, "--within")
    except SceneError as error:
        raise wrong from error
    if not 0.0 < change < 1.0:
        raise wrong
    return of, change


def _text(answer: dict[str, Any]) -> str:
    lines = [line for title, sentence in answer["box"] for line in wrapped(f"{title} {sentence}")]
    lines += wrapped(f"Missing: {answer['missing']}") if answer["missing"] else []
    lines += [f"Next step: {answer['next_step']}"] if answer["next_step"] else []
    if "sequence" in answer:
        lines += ["", "The strikes that follow"]
        lines += [line for sentence in answer["sequence"] for line in wrapped(sentence)]
    lines += ["", "What this rests on", *lines_of(answer["basis"], indent="  ")]
    lines += ["", "What it does not cover"]
    lines += [line for sentence in answer["not_covered"] for line in wrapped(f"- {sentence}", "  ")]
    if "transfer" in answer:
        carried = transfer_text(answer["transfer"]).rstrip()
        lines += ["", "Measured tests carried over to this drop", "", carried]
    lines += [f"page: {answer['page']}"] if "page" in answer else []
    return "\n".join(lines) + "\n"
