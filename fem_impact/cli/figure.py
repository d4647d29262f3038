"""The command ``figure``: a figure of the paper, drawn anew."""

from pathlib import Path

from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import print_answer
from fem_impact.tables.text import wrapped


def figure(options: Options) -> int:
    """Draw one figure of the paper, and print which of the paper's statements hold on it."""
    from fem_impact.evidence.paper.figures import FIGURES

    drawn = FIGURES[options.number](Path(options.out or "results/paper"))
    document = {
        "figure": drawn.number,
        "picture": str(drawn.picture),
        "data": str(drawn.data),
        "sentence": drawn.sentence,
        "statements": [{"claim": s.claim, "found": s.found, "holds": s.holds} for s in drawn.statements],
    }
    lines = [*wrapped(drawn.sentence, hang=""), "", "The paper's statements:"]
    for s in drawn.statements:
        lines += wrapped(f"{'holds' if s.holds else 'FAILS'}: {s.claim}: {s.found}", "  ")
    paths = ["", f"picture: {drawn.picture}", f"data: {drawn.data}"]
    print_answer(options, document, "\n".join([*lines, *paths]) + "\n")
    return 0
