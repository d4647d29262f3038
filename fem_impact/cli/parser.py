"""The command line: all commands with their options, and how a line is read."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence

from fem_impact.cli.about_evidence import add_audit, add_figure, add_stress, add_verify
from fem_impact.cli.about_results import (
    add_coefficients,
    add_completion,
    add_render,
    add_report,
    add_schema,
)
from fem_impact.cli.about_scenes import add_assess, add_check, add_cost, add_run, add_scenes, add_sweep
from fem_impact.cli.about_studies import add_study
from fem_impact.cli.command import CommandParser
from fem_impact.cli.options import Options
from fem_impact.errors import EXIT_CODES

COMMANDS = (
    *(add_run, add_check, add_assess, add_sweep, add_cost, add_scenes),
    *(add_report, add_render, add_study, add_verify, add_stress),
    *(add_audit, add_coefficients, add_figure, add_schema, add_completion),
)
"""What adds each command, in the order of the help."""


def build_parser() -> CommandParser:
    """Return the parser of all commands."""
    codes = "\n".join(f"  {code:>3}  {meaning}" for code, meaning in EXIT_CODES.items())
    parser = CommandParser(
        prog="fem-impact",
        description="Where the energy of a projectile goes when it strikes a barrier: finite elements\n"
        "beside the theory of rigid bodies.",
        epilog=f"exit codes:\n{codes}",
    )
    parser.add_argument("--version", action="store_true", help="print the version")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for add in COMMANDS:
        add(commands)
    return parser


def every_command(parser: argparse.ArgumentParser, name: str = "") -> Iterator[tuple[str, CommandParser]]:
    """Return name and parser of every command, as ``study gamma``, in the order of the help."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for word, command in action.choices.items():
                yield f"{name} {word}".strip(), command
                yield from every_command(command, f"{name} {word}".strip())


def read_line(argv: Sequence[str] | None) -> Options:
    """Read the command line.

    Raises
    ------
    UsageError
        It is not understood.
    SystemExit
        It asks for help, which is printed.
    """
    return build_parser().parse_args(argv, namespace=Options())
