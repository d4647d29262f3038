"""The command ``audit``: the printed columns of the paper's tables, recomputed."""

from pathlib import Path

from fem_impact.cli.parser import CommandParser, Options
from fem_impact.cli.paths import checked_file
from fem_impact.cli.terminal import print_answer


def add_options(parser: CommandParser) -> None:
    """State the command and its options."""
    parser.state(audit, "fem-impact audit --set t5b")
    parser.add_argument("--set", dest="set_id", metavar="ID", help="one measured set, such as t5b")
    parser.add_argument("--out", type=Path, metavar="CSV", help="write every number with its recomputation")


def audit(options: Options) -> int:
    """Recompute the printed columns and print where they disagree."""
    out = checked_file(options.out) if options.out else None
    from fem_impact.evidence.paper.audit import audit_document, audit_text, records_table
    from fem_impact.files.atomic import write_text

    document = audit_document(options.set_id)
    if out:
        write_text(out, records_table(document).csv())
    print_answer(options, document, audit_text(document))
    return 0
