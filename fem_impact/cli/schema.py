"""The command ``schema``: the JSON Schema of an outcome."""

from fem_impact.cli.parser import CommandParser, Options
from fem_impact.cli.terminal import print_json

ABOUT = (
    "Print the JSON Schema (draft 7) of outcome.json, which `run` writes and `run --json` prints: every "
    "key with its meaning and type."
)


def add_options(parser: CommandParser) -> None:
    """State the command."""
    parser.state(schema, "fem-impact schema > outcome.schema.json", about=ABOUT)


def schema(options: Options) -> int:
    """Print the JSON Schema of an outcome."""
    from fem_impact.outcome.check import json_schema
    from fem_impact.outcome.record import KEYS

    print_json(json_schema(KEYS))
    return 0
