"""The one record that every fidelity and every command's ``--json`` speaks: flat, versioned, SI."""

from fem_impact.outcome.document import markdown_table
from fem_impact.outcome.keys import ARMS, KEYS, SCHEMA_VERSION, Key
from fem_impact.outcome.provenance import installed_versions, utc_now
from fem_impact.outcome.record import Outcome
from fem_impact.outcome.table import KEY_TABLE

__all__ = [
    "ARMS",
    "KEYS",
    "KEY_TABLE",
    "SCHEMA_VERSION",
    "Key",
    "Outcome",
    "installed_versions",
    "markdown_table",
    "utc_now",
]
