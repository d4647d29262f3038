"""Options of the command line: their types, and those that several commands share."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

from fem_impact.errors import UsageError
from fem_impact.options import CHECKPOINT_INTERVAL


class Options(argparse.Namespace):
    """Options of the command line; those of other commands than the given one have their defaults."""

    handler: Callable[[Options], int] | None = None
    version: bool = False
    json: bool = False
    quiet: bool = False
    scene: str = ""
    changes: Sequence[str] = ()
    vary: Sequence[str] = ()
    columns: str = ""
    fidelity: str = ""
    until: str = ""
    ids: Sequence[str] = ()
    name: str = ""
    out: Path | None = None
    drawing: Path | None = None
    long: bool = False
    problem: str = ""
    only: str = ""
    parameters: bool = False
    materials: bool = False
    friction: bool = False
    page: str = ""
    quick: bool = False
    workers: int | None = None
    scheduler: str = ""
    target: str = ""
    budget: str = ""
    of: str = ""
    finest: str = ""
    stored: bool = False
    estimate: bool = False
    resume: bool = False
    checkpoint: float = CHECKPOINT_INTERVAL
    field: str = "strain"
    frames: int | None = None
    first: str = ""
    last: str = ""
    speed: str = ""
    size: tuple[int, int] = (1280, 720)
    result: Path
    results: list[Path]
    set_id: str | None = None
    file: Path
    number: int
    shell: str = ""
    length: str = ""
    diameter: str = ""
    tip: str = ""
    tip_radius: str = ""
    d_c: str = ""
    d_d: str = ""
    angle: str = ""
    height: str = ""
    surface: str = ""
    within: str = ""
    heat: bool = False


def add_text(parser: argparse._ActionsContainer, option: str, metavar: str, meaning: str) -> None:
    """Add an option that takes a text, empty where it is left out."""
    parser.add_argument(option, default="", metavar=metavar, help=meaning)


def add_out(parser: argparse.ArgumentParser, default: str) -> None:
    """Add the directory to write to."""
    parser.add_argument("--out", type=Path, metavar="DIR", help=f"where to write (default: {default})")


def add_workers(
    parser: argparse.ArgumentParser, meaning: str = "runs at a time (default: one a core)"
) -> None:
    """Add the number of processes."""
    parser.add_argument("--workers", type=at_least_one, metavar="N", help=meaning)


def add_cluster(parser: argparse.ArgumentParser) -> None:
    """Add the address of a cluster."""
    add_text(parser, "--scheduler", "ADDRESS", "run on this dask.distributed cluster instead")


def add_page(parser: argparse.ArgumentParser, words: str) -> None:
    """Add the page of evidence to write."""
    text = f"{words} write the result as a page with date, machine and commit, such as docs/evidence/NAME.md"
    add_text(parser, "--page", "FILE.md", text)


def at_least_one(text: str) -> int:
    """Read a number of processes."""
    if not text.isdecimal() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes (1 to 1024)")
    return int(text)


def stated_budget(options: Options) -> float | None:
    """Return the time, s, of ``--budget``, None where it is not given."""
    from fem_impact.scene.units import option_quantity

    if not options.budget:
        return None
    budget = option_quantity(options.budget, "time", "--budget")
    if budget <= 0:
        raise UsageError("must lie above 0.", key="--budget", value=options.budget)
    if options.fidelity in ("rigid", "modal"):
        problem = f"is for finite elements, and --fidelity {options.fidelity} runs none."
        raise UsageError(problem, key="--budget", value=options.budget, remedy="Leave out one of the two.")
    return budget
