"""The command ``schema``: the JSON Schema of an outcome."""

from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import print_json


def schema(options: Options) -> int:
    """Print the JSON Schema of an outcome."""
    from fem_impact.outcome.check import json_schema
    from fem_impact.outcome.record import KEYS

    print_json(json_schema(KEYS))
    return 0
