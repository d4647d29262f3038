"""Options of the command line, and how their values are read."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from fem_impact.options import CHECKPOINT_INTERVAL


class Options(argparse.Namespace):
    """Options of the command line; those of other commands than the given one have their defaults."""

    handler: str = ""
    version: bool = False
    json: bool = False
    quiet: bool = False
    scene: str = ""
    changes: Sequence[str] = ()
    vary: Sequence[str] = ()
    columns: str = ""
    fidelity: str = ""
    ids: Sequence[str] = ()
    name: str = ""
    out: Path | None = None
    drawing: Path | None = None
    long: bool = False
    problem: str | None = None
    only: str = ""
    parameters: bool = False
    materials: bool = False
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
    length: str | None = None
    diameter: str | None = None
    tip: str = ""
    tip_radius: str | None = None
    d_c: str | None = None
    d_d: str | None = None
    angle: str | None = None
    height: str | None = None
    surface: str | None = None
    tolerance: str = ""
    heat: bool = False


def seconds(text: str) -> float:
    """Read a time in s."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value < 1e6:
        raise argparse.ArgumentTypeError(f"{text!r} is not a time in seconds (0 to 1e6)")
    return value


def size(text: str) -> tuple[int, int]:
    """Read width and height in pixels."""
    width, by, height = text.partition("x")
    if not (by and width.isdecimal() and height.isdecimal()):
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 1280x720")
    return int(width), int(height)


def at_least_one(text: str) -> int:
    """Read a number of processes."""
    if not text.isdecimal() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes (1 to 1024)")
    return int(text)
