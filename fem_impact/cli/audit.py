"""The command ``audit``: the printed columns of the paper's tables, recomputed."""

from fem_impact.cli.parser import Options
from fem_impact.cli.paths import checked_file
from fem_impact.cli.terminal import print_answer


def audit(options: Options) -> int:
    """Recompute the printed columns and print where they disagree."""
    out = checked_file(options.out) if options.out else None
    from fem_impact.evidence.paper.audit import audit_document, audit_text, records_table
    from fem_impact.files.atomic import write_text

    document = audit_document(options.set_id or None)
    if out:
        write_text(out, records_table(document).csv())
    print_answer(options, document, audit_text(document))
    return 0
