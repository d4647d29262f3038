"""Commands, options and help of the command line."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

from fem_impact.errors import EXIT_CODES
from fem_impact.options import CHECKPOINT_INTERVAL, FIDELITIES

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction[argparse.ArgumentParser]

_SCENE = "id of a shipped scene (see `fem-impact scenes`) or path of a scene file"
_SET = "change one value, such as --set accuracy.tip_size='0.5 mm'; may be repeated"
STUDIES = {
    "sets": "the published series of tests beside the model",
    "convergence": "their limits for vanishing elements",
    "gamma": "vibration against slenderness",
    "criterion": "when a rod may be called rigid",
    "effects": "effects chosen by the scene beside everything on, and what each costs",
    "reduced": "the reduced model beside the finite elements",
    "validation": "errors of the model with every uncertainty (ASME V&V 20), and what causes them",
}
REPORT = {"report": "one page over all studies beside it"}
FILMED = ("strain", "stress", "velocity", "plastic")  # what a film can show, the default first
_RESULT = "directory that a run or a study wrote"
_ROD = '\\\n      --length "80 mm" --diameter "19 mm" --angle "45 deg"'
EXAMPLES = {
    "run": ("fem-impact run quick", "fem-impact run t5b --fidelity modal --set impact.angle='30 deg'"),
    "study": ("fem-impact study sets --quick", "fem-impact study gamma --estimate"),
    "render": ("fem-impact render results/quick",),
    "report": ("fem-impact report results/quick",),
    "scenes": ("fem-impact scenes",),
    "check": ("fem-impact check t5b --set accuracy.tip_size='0.5 mm'",),
    "cost": ('fem-impact cost t5b --target "5 %" --budget "30 s" --of e,mu',),
    "verify": ("fem-impact verify bar", 'fem-impact verify modes --set length="120 mm"'),
    "stress": ("fem-impact stress --only angle-60",),
    "audit": ("fem-impact audit --set t5b",),
    "coefficients": (f"fem-impact coefficients tests.csv {_ROD}",),
    "figure": ("fem-impact figure 7",),
    "sweep": ("fem-impact sweep t5b --vary impact.angle=15..60:5deg",),
    "assess": (
        "fem-impact assess t5b",
        f'fem-impact assess --height "0.82 m" --surface machined {_ROD}',
    ),
}
"""Command lines that the help of each command shows."""


class Options(argparse.Namespace):
    """Options of the command line; those of other commands than the given one have their defaults."""

    handler: str = ""
    version: bool = False
    json: bool = False
    quiet: bool = False
    scene: str = ""
    changes: Sequence[str] = ()
    vary: Sequence[str] = ()
    fidelity: str = ""
    ids: Sequence[str] = ()
    name: str = ""
    out: Path | None = None
    problem: str | None = None
    only: str = ""
    parameters: bool = False
    page: str = ""
    quick: bool = False
    workers: int | None = None
    scheduler: str = ""
    target: str = ""
    budget: str = ""
    of: str = ""
    finest: str = ""
    stored: bool = False
    estimate: bool = False
    resume: bool = False
    checkpoint: float = CHECKPOINT_INTERVAL
    field: str = "strain"
    frames: int | None = None
    first: str = ""
    last: str = ""
    speed: str = ""
    size: tuple[int, int] = (1280, 720)
    result: Path
    results: list[Path]
    set_id: str | None = None
    file: Path
    number: int
    length: str | None = None
    diameter: str | None = None
    tip: str = ""
    tip_radius: str | None = None
    d_c: str | None = None
    d_d: str | None = None
    angle: str | None = None
    height: str | None = None
    surface: str | None = None
    tolerance: str = ""
    heat: bool = False


def build_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    codes = "\n".join(f"  {code:>3}  {meaning}" for code, meaning in EXIT_CODES.items())
    parser = argparse.ArgumentParser(
        prog="fem-impact",
        description="Where the energy of a dropped steel rod goes: finite elements and rigid theory.",
        epilog=f"exit codes:\n{codes}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="store_true", help="print the version")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for add in (_add_run, _add_sweep, _add_study, _add_render, _add_report):
        add(commands)
    _command(commands, "scenes", "list the shipped scenes", "fem_impact.commands.run:scenes")
    for add in (_add_check, _add_cost, _add_verify, _add_stress):
        add(commands)
    add_rigid_commands(commands, _command)
    return parser


def read_line(argv: Sequence[str] | None) -> Options:
    """Read the command line; one that is not understood ends the program with exit code 2.

    argparse does not assign arguments that follow an option after ``ID ...``, as in
    ``study sets --quick t4``: it returns them as unknown, and they are added to the ids.
    """
    parser = build_parser()
    options, rest = parser.parse_known_args(argv, namespace=Options())
    unknown = [argument for argument in rest if argument.startswith("-")]
    if unknown or (rest and not options.handler.endswith(":study")):
        parser.error(f"not understood: {' '.join(rest)} (fem-impact COMMAND --help lists the options)")
    options.ids = [*options.ids, *rest]
    return options


def _command(commands: Commands, name: str, summary: str, handler: str) -> argparse.ArgumentParser:
    """Add one command with the options that all share."""
    parser = commands.add_parser(
        name,
        help=summary,
        description=fill(f"{summary[0].upper()}{summary[1:]}.", 79),
        epilog="\n  ".join(["example:" if len(EXAMPLES[name]) == 1 else "examples:", *EXAMPLES[name]]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--json", action="store_true", help="print one JSON document on standard output")
    parser.add_argument("--quiet", action="store_true", help="show no progress")
    parser.set_defaults(handler=handler)
    return parser


def _add_run(commands: Commands) -> None:
    parser = _command(
        commands, "run", "compute one scene and write its results", "fem_impact.commands.run:run"
    )
    _add_scene_options(parser)
    parser.add_argument(
        "--fidelity",
        choices=FIDELITIES,
        default="",
        help="rigid: impulses (at once); modal: vibration modes and a contact law (a second); "
        "solid: finite elements (default)",
    )
    parser.add_argument(
        "--budget",
        default="",
        metavar="TIME",
        help="wall time for a scene that states its error, if no similar scene was measured (default: 2 min)",
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="where to write (default: results/SCENE)")
    parser.add_argument("--resume", action="store_true", help="go on from the checkpoint of a stopped run")
    parser.add_argument(
        "--checkpoint",
        type=_seconds,
        default=30.0,
        metavar="SECONDS",
        help="time between checkpoints (default: 30)",
    )


def _add_study(commands: Commands) -> None:
    parser = _command(
        commands,
        "study",
        "compute many runs and draw conclusions from them",
        "fem_impact.commands.study:study",
    )
    every = {**STUDIES, **REPORT}.items()
    listed = [fill(f"  {name:<12} {words}", 79, subsequent_indent=" " * 15) for name, words in every]
    parser.epilog = "\n".join(["studies:", *listed, "", str(parser.epilog)])
    parser.add_argument("name", choices=[*STUDIES, *REPORT], metavar="NAME", help="a study of those below")
    parser.add_argument(
        "ids",
        nargs="*",
        metavar="ID",
        help="measured sets, such as t5b, for studies about them (default: all)",
    )
    parser.add_argument("--quick", action="store_true", help="a small version, for a first look")
    _add_many(parser)
    parser.add_argument(
        "--estimate", action="store_true", help="say how long it takes on 1 to 1000 workers, and stop"
    )
    _add_page(parser, "also")


def _add_sweep(commands: Commands) -> None:
    summary = "compute a scene with values varied in all combinations"
    parser = _command(commands, "sweep", summary, "fem_impact.commands.sweep:sweep")
    _add_scene_options(parser)
    values = (
        "values of one key, such as impact.angle=15..60:5deg or projectile.length=0.2,0.4m; may be repeated"
    )
    parser.add_argument(
        "--vary", action="append", required=True, metavar="KEY=VALUES", default=[], help=values
    )
    parser.add_argument("--fidelity", choices=FIDELITIES, default="", help="of the runs (default: modal)")
    _add_many(parser)


def _add_many(parser: argparse.ArgumentParser) -> None:
    """Add the options of many runs."""
    parser.add_argument("--out", type=Path, metavar="DIR", help="where to write (default: below results)")
    parser.add_argument(
        "--workers", type=_at_least_one, metavar="N", help="runs at a time (default: one a core)"
    )
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a dask.distributed cluster to run on")


def _add_render(commands: Commands) -> None:
    parser = _command(
        commands, "render", "make a film of the stress waves", "fem_impact.commands.show:render"
    )
    several = f"{_RESULT}; several make one film side by side"
    film = "film to write: .mp4, .webp, .gif, or .png for a folder of frames (default: beside the fields)"
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help=several)
    parser.add_argument("--out", type=Path, metavar="FILE", help=film)
    parser.add_argument(
        "--field",
        choices=FILMED,
        default=FILMED[0],
        help="colours of the film (default: strain along the axis)",
    )
    parser.add_argument("--frames", type=int, metavar="N", help="number of frames (default: 144)")
    parser.add_argument(
        "--from", dest="first", default="", metavar="TIME", help="first time, such as '20 us'"
    )
    parser.add_argument(
        "--until", dest="last", default="", metavar="TIME", help="last time, such as '0.3 ms'"
    )
    parser.add_argument(
        "--speed", default="", metavar="TIME", help="motion in one second of the film, such as '25 us'"
    )
    size = "size of the film in pixels, multiples of 16 (default: 1280x720)"
    parser.add_argument("--size", type=_size, default=(1280, 720), metavar="WxH", help=size)


def _add_report(commands: Commands) -> None:
    parser = _command(
        commands, "report", "write the report as one HTML file", "fem_impact.commands.show:report"
    )
    parser.add_argument("result", type=Path, metavar="RESULT", help=_RESULT)


def _add_check(commands: Commands) -> None:
    summary = "check a scene and print it with units, sources and effects, without computing"
    _add_scene_options(_command(commands, "check", summary, "fem_impact.commands.check:check"))


def _add_cost(commands: Commands) -> None:
    summary = "show what accuracy costs: error and computing time of every setting"
    parser = _command(commands, "cost", summary, "fem_impact.commands.cost:cost")
    _add_scene_options(parser)
    parser.add_argument(
        "--target",
        default="",
        metavar="SHARE",
        help="name the cheapest setting within an error, such as '2 %%'",
    )
    parser.add_argument(
        "--budget",
        default="",
        metavar="TIME",
        help="run no more than takes so much CPU time, such as '30 s', and name the best setting",
    )
    parser.add_argument(
        "--of", default="", metavar="NAMES", help="quantities that count, as --of e,mu (default: e,E_vib)"
    )
    parser.add_argument(
        "--finest", default="", metavar="SIZE", help="leave out finer meshes than this, such as '0.25 mm'"
    )
    parser.add_argument("--stored", action="store_true", help="judge what has run so far, and run nothing")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="where to write (default: results/cost/SCENE)"
    )


def _add_verify(commands: Commands) -> None:
    summary = "run problems with known answers through the solver and judge it"
    parser = _command(commands, "verify", summary, "fem_impact.commands.verify:verify")
    parser.add_argument(
        "problem", nargs="?", metavar="NAME", help="one problem, such as bar (default: all of them)"
    )
    changed = "change one parameter, such as --set length='80 mm' (a bare number is SI); may be repeated"
    parser.add_argument(
        "--set", dest="changes", action="append", default=[], metavar="PARAMETER=VALUE", help=changed
    )
    parser.add_argument("--parameters", action="store_true", help="list the parameters of a problem")
    _add_page(parser, "run all problems and")


def _add_stress(commands: Commands) -> None:
    summary = "run extreme scenes; each must close its energy balance, or be refused or stopped with a reason"
    parser = _command(commands, "stress", summary, "fem_impact.commands.verify:stress")
    parser.add_argument(
        "--only", default="", metavar="NAME", help="one case, such as angle-60 (default: all of them)"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="where to write (default: results/stress)")
    parser.add_argument(
        "--workers", type=_at_least_one, metavar="N", help="cases at a time (default: one a core)"
    )
    _add_page(parser, "run all cases and")


def _add_page(parser: argparse.ArgumentParser, words: str) -> None:
    help_text = (
        f"{words} write the result as a page with date, machine and commit, such as docs/evidence/NAME.md"
    )
    parser.add_argument("--page", default="", metavar="FILE.md", help=help_text)


def _add_scene_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help=_SCENE)
    parser.add_argument("--set", dest="changes", action="append", default=[], metavar="KEY=VALUE", help=_SET)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < 1e6:
        raise argparse.ArgumentTypeError(f"{text!r} is not a time in seconds (0 to 1e6)")
    return value


def _size(text: str) -> tuple[int, int]:
    width, by, height = text.partition("x")
    if not (by and width.isdecimal() and height.isdecimal()):
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 1280x720")
    return int(width), int(height)


def _at_least_one(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes (1 to 1024)")
    return int(text)


if TYPE_CHECKING:
    Command = Callable[[Commands, str, str, str], argparse.ArgumentParser]

_MODULE = "fem_impact.commands.rigid"


def add_rigid_commands(commands: Commands, command: Command) -> None:
    """Add the four commands; `command` adds one with the options that all share."""
    for add in (_add_audit, _add_coefficients, _add_figure, _add_assess):
        add(commands, command)


def _add_audit(commands: Commands, command: Command) -> None:
    summary = "recompute every printed column of the paper's tables"
    parser = command(commands, "audit", summary, f"{_MODULE}:audit")
    parser.add_argument("--set", dest="set_id", metavar="ID", help="one measured set, such as t5b")
    parser.add_argument("--out", type=Path, metavar="CSV", help="write every number with its recomputation")


def _add_coefficients(commands: Commands, command: Command) -> None:
    summary = "work out e, mu and e_m of your own camera data, with intervals"
    parser = command(commands, "coefficients", summary, f"{_MODULE}:coefficients")
    columns = "v_n_m_per_s, v_t_m_per_s, V_n_m_per_s, V_t_m_per_s, Omega_rad_per_s"
    parser.add_argument("file", type=Path, metavar="FILE.csv", help=f"one test a row; columns {columns}")
    _add_rod(parser)
    parser.add_argument("--angle", required=True, help='rod axis to barrier normal, such as "45 deg"')
    parser.add_argument("--d-c", metavar="LENGTH", help="arm along the slope (default: of the tip's shape)")
    parser.add_argument("--d-d", metavar="LENGTH", help="arm along the normal (default: of the tip's shape)")


def _add_figure(commands: Commands, command: Command) -> None:
    summary = "draw a figure of the paper, with intervals and its data"
    parser = command(commands, "figure", summary, f"{_MODULE}:figure")
    parser.add_argument("number", type=int, choices=(4, 5, 6, 7), help="of the paper")
    parser.add_argument("--out", type=Path, metavar="DIR", help="where to write (default: results/paper)")


def _add_assess(commands: Commands, command: Command) -> None:
    summary = "say whether rigid theory may be used for a scene, and what vibration costs"
    parser = command(commands, "assess", summary, "fem_impact.commands.assess:assess")
    parser.add_argument("scene", metavar="SCENE", nargs="?", default="", help=_SCENE)
    parser.add_argument("--set", dest="changes", action="append", default=[], metavar="KEY=VALUE", help=_SET)
    parser.add_argument(
        "--fidelity",
        choices=["auto", "modal", "solid"],
        default="auto",
        help="auto (default): modal, and solid where the known error of modal leaves the answer open",
    )
    parser.add_argument("--tolerance", default="", help="change of e that may be neglected (default: 0.05)")
    parser.add_argument(
        "--budget", default="", metavar="TIME", help="wall time of the finite elements (default: 60 s)"
    )
    parser.add_argument(
        "--workers", type=_at_least_one, metavar="N", help="runs at a time, 1 or 2 (default: one a core)"
    )
    carried = "also carry the measured tests over: losses, worst case, bound of the friction heat"
    parser.add_argument("--heat", action="store_true", help=carried)
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write a page to print and sign, and verdict.json"
    )
    short = parser.add_argument_group("a dropped steel rod, instead of SCENE")
    _add_rod(short, required=False)
    short.add_argument("--height", help='drop height, such as "0.82 m"')
    short.add_argument("--angle", help='rod axis to barrier normal, such as "45 deg"')
    surfaces = ("machined", "contaminated", "cleaned")
    short.add_argument("--surface", choices=surfaces, help="state of tip and plate")


def _add_rod(parser: argparse._ActionsContainer, required: bool = True) -> None:
    parser.add_argument("--length", required=required, help='of the rod, such as "240 mm"')
    parser.add_argument("--diameter", required=required, help='such as "19 mm"')
    tips = "A: round nose, B: rounded edge (default), plain: sharp edge, or one added to rigid.SHAPES"
    parser.add_argument("--tip", default="", help=tips)
    radii = "default: 7 mm for A, 3 mm for B; an added tip needs it"
    parser.add_argument("--tip-radius", metavar="LENGTH", help=radii)
