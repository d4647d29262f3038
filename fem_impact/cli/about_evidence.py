"""Options and help of the commands that prove the program and examine the publication."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fem_impact.cli.command import add_command, add_out, add_page, add_workers

if TYPE_CHECKING:
    from fem_impact.cli.command import Commands


def add_verify(commands: Commands) -> None:
    """Add ``verify``."""
    summary = "run problems with known answers through the solver and judge it"
    examples = ("fem-impact verify bar", 'fem-impact verify modes --set length="120 mm"')
    parser = add_command(commands, "verify", summary, "fem_impact.cli.verify:verify", examples)
    parser.add_argument(
        "problem", nargs="?", metavar="NAME", help="one problem, such as bar (default: all of them)"
    )
    changed = "change one parameter, such as --set length='80 mm' (a bare number is SI); may be repeated"
    parser.add_argument(
        "--set", dest="changes", action="append", default=[], metavar="PARAMETER=VALUE", help=changed
    )
    parser.add_argument("--parameters", action="store_true", help="list the parameters of a problem")
    add_page(parser, "run all problems and")


def add_stress(commands: Commands) -> None:
    """Add ``stress``."""
    summary = "run extreme scenes; each must close its energy balance, or be refused or stopped with a reason"
    examples = ("fem-impact stress --only angle-60",)
    parser = add_command(commands, "stress", summary, "fem_impact.cli.study:stress", examples)
    parser.add_argument(
        "--only", default="", metavar="NAME", help="one case, such as angle-60 (default: all of them)"
    )
    add_out(parser, "results/stress")
    add_workers(parser, "cases at a time (default: one a core)")
    add_page(parser, "run all cases and")


def add_audit(commands: Commands) -> None:
    """Add ``audit``."""
    summary, handler = (
        "recompute every printed column of the paper's tables",
        "fem_impact.cli.rigid:audit",
    )
    parser = add_command(commands, "audit", summary, handler, ("fem-impact audit --set t5b",))
    parser.add_argument("--set", dest="set_id", metavar="ID", help="one measured set, such as t5b")
    parser.add_argument("--out", type=Path, metavar="CSV", help="write every number with its recomputation")


def add_figure(commands: Commands) -> None:
    """Add ``figure``."""
    summary, handler = (
        "draw a figure of the paper, with intervals and its data",
        "fem_impact.cli.rigid:figure",
    )
    parser = add_command(commands, "figure", summary, handler, ("fem-impact figure 7",))
    parser.add_argument("number", type=int, choices=(4, 5, 6, 7), help="of the paper")
    add_out(parser, "results/paper")
