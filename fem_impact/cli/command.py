"""A command: its parser, its help with examples, and the options that several commands share."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, NoReturn

from fem_impact.cli.options import at_least_one
from fem_impact.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    Commands = argparse._SubParsersAction["CommandParser"]

WIDTH = 79  # letters of a line of help
_SET = "change one value, such as --set accuracy.tip_size='0.5 mm'; may be repeated"


class HelpLines(argparse.RawDescriptionHelpFormatter):
    """Help with its paragraphs as they are; argparse leaves no room for the indent of listed commands."""

    def add_argument(self, action: argparse.Action) -> None:
        """Add an argument and, of listed commands, their indent."""
        super().add_argument(action)
        if isinstance(action, argparse._SubParsersAction):
            self._action_max_length += 2


class CommandParser(argparse.ArgumentParser):
    """A parser that raises `UsageError` instead of ending the program, and answers with the nearest name."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(formatter_class=HelpLines, **settings)

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


def add_command(
    commands: Commands, name: str, summary: str, handler: str, examples: Sequence[str], about: str = ""
) -> CommandParser:
    """Add one command with its help and the options that all commands share.

    Parameters
    ----------
    commands : where it is added
    name : as it is typed
    summary : one line in the list of all commands
    handler : ``module:function``, imported when the command is called
    examples : whole command lines that the help shows
    about : what it does, where ``summary`` is not enough; paragraphs are parted by empty lines
    """
    parser: CommandParser = commands.add_parser(
        name,
        help=summary,
        description=_paragraphs(about or f"{summary[0].upper()}{summary[1:]}."),
        epilog="\n  ".join(["example:" if len(examples) == 1 else "examples:", *examples]),
    )
    parser.add_argument("--json", action="store_true", help="print one JSON document on standard output")
    parser.add_argument("--quiet", action="store_true", help="show no progress")
    parser.set_defaults(handler=handler)
    return parser


def _paragraphs(text: str) -> str:
    return "\n\n".join(fill(" ".join(part.split()), WIDTH) for part in text.split("\n\n"))


def add_scene(parser: CommandParser, optional: bool = False) -> None:
    """Add the scene and the changes of its values."""
    about = "id of a shipped scene (see `fem-impact scenes`) or path of a scene file"
    if optional:
        parser.add_argument("scene", metavar="SCENE", nargs="?", default="", help=about)
    else:
        parser.add_argument("scene", metavar="SCENE", help=about)
    add_changes(parser)


def add_changes(parser: argparse._ActionsContainer) -> None:
    """Add the changes of a scene's values."""
    parser.add_argument("--set", dest="changes", action="append", default=[], metavar="KEY=VALUE", help=_SET)


def add_out(parser: CommandParser, default: str) -> None:
    """Add the directory to write to."""
    parser.add_argument("--out", type=Path, metavar="DIR", help=f"where to write (default: {default})")


def add_workers(parser: CommandParser, what: str = "runs at a time (default: one a core)") -> None:
    """Add the number of processes."""
    parser.add_argument("--workers", type=at_least_one, metavar="N", help=what)


def add_cluster(parser: CommandParser) -> None:
    """Add the address of a cluster."""
    parser.add_argument(
        "--scheduler", default="", metavar="ADDRESS", help="run on this dask.distributed cluster instead"
    )


def add_page(parser: CommandParser, words: str) -> None:
    """Add the page of evidence to write."""
    text = f"{words} write the result as a page with date, machine and commit, such as docs/evidence/NAME.md"
    parser.add_argument("--page", default="", metavar="FILE.md", help=text)
