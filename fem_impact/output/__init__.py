"""Result files: whole-or-nothing writes, tables with units in the header, fields over time."""

from fem_impact.output.atomic import atomic_path, make_directory, read_text, write_bytes, write_text
from fem_impact.output.columns import COMPARISON, CONTACTS, HISTORY
from fem_impact.output.fields_read import Fields, read_fields
from fem_impact.output.fields_write import FieldWriter
from fem_impact.output.history import HistoryWriter
from fem_impact.output.tables import Table, read_table, write_table

__all__ = [
    "COMPARISON",
    "CONTACTS",
    "HISTORY",
    "FieldWriter",
    "Fields",
    "HistoryWriter",
    "Table",
    "atomic_path",
    "make_directory",
    "read_fields",
    "read_table",
    "read_text",
    "write_bytes",
    "write_table",
    "write_text",
]
