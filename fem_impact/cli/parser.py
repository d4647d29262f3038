"""The command line: its options, its parser, the list of all commands, and how a line is read."""

import argparse
import sys
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache, partial
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, NoReturn

from fem_impact.errors import EXIT_CODES, UsageError, did_you_mean
from fem_impact.options import CHECKPOINT_INTERVAL

if TYPE_CHECKING:
    from fem_impact.scene.types import Scene


PAPER = "paper"
"""In place of a scene: all sets of the paper."""


class Options(argparse.Namespace):
    """Options of the command line; those of other commands than the given one have their defaults."""

    handler: "Callable[[Options], int] | None" = None
    version: bool = False
    json: bool = False
    quiet: bool = False
    scene: str = ""
    changes: Sequence[str] = ()
    asked: "Scene | None" = None
    read_s: float = 0.0
    vary: Sequence[str] = ()
    columns: str = ""
    fidelity: str = ""
    until: str = ""
    ids: Sequence[str] = ()
    name: str = ""
    out: Path | None = None
    drawing: Path | None = None
    long: bool = False
    problem: str = ""
    only: str = ""
    parameters: bool = False
    materials: bool = False
    friction: bool = False
    page: str = ""
    quick: bool = False
    workers: int | None = None
    scheduler: str = ""
    target: str = ""
    budget: str = ""
    of: str = ""
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
    set_id: str = ""
    file: Path
    number: int
    shell: str = ""
    length: str = ""
    diameter: str = ""
    tip: str = ""
    tip_radius: str = ""
    d_c: str = ""
    d_d: str = ""
    angle: str = ""
    height: str = ""
    surface: str = ""
    within: str = ""
    heat: bool = False


def processes(text: str) -> int:
    """Read a number of processes."""
    if not text.isdecimal() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes (1 to 1024)")
    return int(text)


def number(text: str) -> int:
    """Read a number of scenes or a seed."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number, 1 or more")
    return int(text)


def seconds(text: str) -> float:
    """Read a time in s."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < 1e6:
        raise argparse.ArgumentTypeError(f"{text!r} is not a time in seconds (0 to 1e6)")
    return value


def pixels(text: str) -> tuple[int, int]:
    """Read width and height in pixels."""
    width, by, height = text.partition("x")
    if not (by and width.isdecimal() and height.isdecimal()):
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 1280x720")
    return int(width), int(height)


TYPES: Mapping[str, Callable[[str], Any]] = {
    one.__name__: one for one in (int, processes, number, seconds, pixels)
} | {"path": Path}
"""How the text of an option is read, by the name of its type in data/commands.toml."""


@cache
def stated() -> Mapping[str, Any]:
    """Return what data/commands.toml states, by command; not read for the list of all commands."""
    text = files("fem_impact.cli").joinpath("data/commands.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def add_options(place: argparse._ActionsContainer, options: Iterable[str | Mapping[str, Any]]) -> None:
    """Add options as data/commands.toml states them: by the name of a shared one, or by their settings.

    ``like`` names a shared option whose other settings hold, ``group`` and ``exclusive`` hold options.
    A text that is left out is empty, a list of texts too.
    """
    shared = stated()["shared"]
    for one in options:
        settings = dict(shared[one] if isinstance(one, str) else shared.get(one.get("like"), {}) | one)
        if "exclusive" in settings:
            add_options(place.add_mutually_exclusive_group(), settings["options"])
        elif "group" in settings:
            add_options(place.add_argument_group(settings["group"]), settings["options"])
        else:
            names = settings.pop("name")
            settings.pop("like", None)
            if "type" in settings:
                settings["type"] = TYPES[settings["type"]]
            elif settings.get("action") != "store_true":
                several = settings.get("action") == "append" or settings.get("nargs") == "*"
                settings.setdefault("default", [] if several else "")
            place.add_argument(*([names] if isinstance(names, str) else names), **settings)


def stated_budget(options: Options) -> float | None:
    """Return the time, s, of ``--budget``, None where it is not given."""
    from fem_impact.scene.units import option_quantity

    if not options.budget:
        return None
    budget = option_quantity(options.budget, "time", "--budget")
    if budget <= 0:
        raise UsageError("must lie above 0.", key="--budget", value=options.budget)
    if options.fidelity in ("rigid", "modal"):
        problem = f"is for finite elements, and --fidelity {options.fidelity} runs none."
        raise UsageError(problem, key="--budget", value=options.budget, remedy="Leave out one of the two.")
    return budget


COMMANDS = {
    "run": "compute one scene and write its results",
    "check": "check a scene and say what it comes to, without computing",
    "validate": "compare a scene with its tests, with uncertainties: which input to measure better",
    "assess": "say whether rigid theory may be used for a scene, and what vibration costs",
    "sweep": "compute a scene with values varied in all combinations",
    "cost": "show what accuracy costs: error and computing time of every setting",
    "hardness": "say which hardened layers give the hardness that a material states",
    "scenes": "list the shipped scenes, or the materials",
    "report": "write the report as one HTML file",
    "render": "make a film of the stress waves",
    "study": "compute many runs and draw conclusions from them",
    "verify": "run problems with known answers through the solver and judge it",
    "stress": "run extreme scenes; each must close its energy balance, or be refused or stopped with a "
    "reason",
    "audit": "recompute every printed column of the paper's tables",
    "coefficients": "work out e, mu and e_m of your own camera data, with intervals",
    "figure": "draw a figure of the paper, with intervals and its data",
    "schema": "print the JSON Schema of outcome.json",
    "compile": "compile the loops of the models, so that the first run need not",
    "cite": "print as BibTeX what a paper that uses a run should cite",
    "completion": "print a script that lets the shell complete commands and options",
}
"""What each command does, in the order of the help. Its module of the same name here states the rest."""

WIDTH = 79  # letters of a line of help


class HelpLines(argparse.RawDescriptionHelpFormatter):
    """Help with its paragraphs as they are; argparse leaves no room for the indent of listed commands."""

    def add_argument(self, action: argparse.Action) -> None:
        """Add an argument and, of listed commands, their indent."""
        super().add_argument(action)
        if isinstance(action, argparse._SubParsersAction):
            self._action_max_length += 2


class Once(argparse.Action):
    """The action ``once``: store a value, and refuse a second one."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        """Store the value, or raise ArgumentError."""
        if getattr(namespace, self.dest) != self.default:
            raise argparse.ArgumentError(self, "is given twice. Keep one of the two.")
        setattr(namespace, self.dest, values)


class CommandParser(argparse.ArgumentParser):
    """A parser that raises `UsageError` instead of ending the program, and answers with the nearest name."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(formatter_class=HelpLines, **settings)
        self.register("action", "once", Once)

    def state(self, handler: Callable[[Options], int], stated: Mapping[str, Any]) -> None:
        """State what a command does, and add its options and those that all commands have.

        Parameters
        ----------
        handler : function that carries it out and returns the exit code
        stated : as a table of data/commands.toml. ``examples``: whole command lines that the help shows;
            ``options``; ``about``: what it does, where its line in `COMMANDS` is not enough, with empty lines
            between paragraphs
        """
        about, examples = stated.get("about", f"{self.description}"), stated["examples"]
        paragraphs = (fill(" ".join(part.split()), WIDTH) for part in about.split("\n\n"))
        self.description = "\n\n".join(paragraphs)
        self.epilog = "\n  ".join(["example:" if len(examples) == 1 else "examples:", *examples])
        self.add_argument("--json", action="store_true", help="print one JSON document on standard output")
        self.add_argument("--quiet", action="store_true", help="show no progress")
        self.set_defaults(handler=handler)
        add_options(self, stated.get("options", ()))

    def error(self, message: str) -> NoReturn:
        """Raise a `UsageError` that names the command and its help."""
        place = self.prog.removeprefix("fem-impact").strip()
        sentence = message if message.endswith((".", "?")) else f"{message}."
        raise UsageError(sentence, source=place, remedy=f"`{self.prog} --help` lists what there is.")

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: Any = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Read a command line; all of it must be understood.

        argparse gives a positional that may be left out nothing once an option stands before it, as in
        ``study sets --quick t4``: what is left over goes to that positional here.
        """
        options, rest = super().parse_known_args(args, namespace)
        unknown = next((word for word in rest if word.startswith("-")), None)
        if unknown:
            known = did_you_mean(unknown.partition("=")[0], self._option_string_actions, "")
            self.error(f"there is no option {unknown}. {known}".rstrip())
        if rest and not self._take(options, rest):
            self.error(f"{' '.join(rest)!r} is not expected here")
        return options, []

    def _take(self, options: argparse.Namespace, rest: list[str]) -> bool:
        """Give the rest to the positional that may be left out; return whether there is one that takes it."""
        for action in self._get_positional_actions():
            if action.nargs == argparse.ZERO_OR_MORE:
                setattr(options, action.dest, [*getattr(options, action.dest), *rest])
                return True
            if action.nargs == argparse.OPTIONAL and len(rest) == 1 and not getattr(options, action.dest):
                setattr(options, action.dest, rest[0])
                return True
        return False

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Refuse a value that is none of the choices, with the nearest one."""
        if action.choices is not None and value not in action.choices:
            known = [str(choice) for choice in action.choices]
            hint = did_you_mean(str(value), known, f"Known: {', '.join(known)}.")
            raise argparse.ArgumentError(action, f"there is no {str(value)!r}. {hint}")


def carry_out(name: str, options: Options) -> int:
    """Call the function of a command, whose module is imported only now; return the exit code."""
    code: int = getattr(import_module(f"fem_impact.cli.{name}"), name)(options)
    return code


def build_parser(words: Collection[str] = COMMANDS) -> CommandParser:
    """Return the parser of all commands; those named in ``words`` have their options.

    No other module is imported, so that the list of commands and the help of one come at once.
    """
    codes = "\n".join(f"  {code:>3}  {meaning}" for code, meaning in EXIT_CODES.items())
    parser = CommandParser(
        prog="fem-impact",
        description="Where the energy of a projectile goes when it strikes a barrier: finite elements\n"
        "beside the theory of rigid bodies.",
        epilog=f"exit codes:\n{codes}",
    )
    parser.add_argument("--version", action="store_true", help="print the version")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for name, summary in COMMANDS.items():
        command = commands.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        if name in words:
            command.state(partial(carry_out, name), stated()[name])
            if name == "study":
                import_module("fem_impact.cli.study").add_studies(command)
    return parser


def every_command(parser: argparse.ArgumentParser, name: str = "") -> Iterator[tuple[str, CommandParser]]:
    """Return name and parser of every command, as ``study gamma``, in the order of the help."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for word, command in action.choices.items():
                yield f"{name} {word}".strip(), command
                yield from every_command(command, f"{name} {word}".strip())


def read_line(argv: Sequence[str] | None) -> Options:
    """Read the command line, that of the program where it is None.

    Raises
    ------
    UsageError
        It is not understood.
    SystemExit
        It asks for help, which is printed.
    """
    words = sys.argv[1:] if argv is None else argv
    return build_parser(words).parse_args(words, namespace=Options())
