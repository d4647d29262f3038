"""Standard output and error: printable text, answers as text or JSON; tables and progress on a terminal.

rich is imported only where a terminal is.
"""

from __future__ import annotations

import io
import json
import os
import re
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from typing import TYPE_CHECKING, Any, TextIO

from fem_impact.errors import printable
from fem_impact.progress import CaseProgress, LineMeter, Notice, NullMeter, Progress, ProgressMeter, describe
from fem_impact.tables.text import wrapped

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress as Bar

    from fem_impact.case.size import RunSize
    from fem_impact.cli.parser import Options
    from fem_impact.outcome.groups import Limitation
    from fem_impact.tables.table import Table


class PrintableStream(io.TextIOBase):
    """A stream that escapes control and direction characters, not line breaks, for the one ``beneath``."""

    def __init__(self, stream: TextIO) -> None:
        self.beneath = stream

    def write(self, text: str) -> int:
        """Write a text, escaped; return its length."""
        self.beneath.write(printable(text))
        return len(text)

    def flush(self) -> None:
        """Flush the other stream."""
        self.beneath.flush()

    def fileno(self) -> int:
        """Return the file descriptor of the other stream."""
        return self.beneath.fileno()

    def isatty(self) -> bool:
        """Return whether the other stream is a terminal."""
        return self.beneath.isatty()


@contextmanager
def printable_streams() -> Iterator[None]:
    """Let everything that is written to standard output and error pass through a `PrintableStream`."""
    with redirect_stdout(PrintableStream(sys.stdout)), redirect_stderr(PrintableStream(sys.stderr)):
        yield


def chosen_meter(options: Options) -> ProgressMeter:
    """Return a meter on standard error: silent, a live line on a terminal, or plain lines."""
    if options.quiet:
        return NullMeter()
    if not sys.stderr.isatty() or _plain(options):
        return LineMeter(sys.stderr)
    return LiveMeter(_console(sys.stderr, options))


def print_json(document: Any) -> None:
    """Print one JSON document; NaN and infinity raise ValueError."""
    sys.stdout.write(json.dumps(document, indent=2, allow_nan=False, ensure_ascii=False) + "\n")


def print_answer(options: Options, document: Any, text: str, notes: Iterable[str] = ()) -> None:
    """Print what a command found: with ``--json`` its document, else notes on standard error and its text."""
    if options.json:
        print_json(document)
    else:
        print_notes(notes)
        sys.stdout.write(text)


def print_notes(notes: Iterable[str]) -> None:
    """Print notes on standard error."""
    sys.stderr.writelines(f"note: {note}\n" for note in notes)


def print_table(table: Table, options: Options, indent: str = "") -> None:
    """Print a table on standard output."""
    if not sys.stdout.isatty() or _plain(options):
        sys.stdout.write(table.terminal(indent=indent) + "\n")
        return
    from rich.box import SIMPLE_HEAD
    from rich.table import Table as Drawn
    from rich.text import Text

    drawn = Drawn(box=SIMPLE_HEAD, pad_edge=False)
    for column in table.columns:
        drawn.add_column(Text(printable(column.title)), justify="left" if column.left else "right")
    for row in table.plain_rows():
        drawn.add_row(*(Text(printable(text)) for text in row))
    _console(sys.stdout, options).print(drawn)


def print_markdown(text: str, options: Options) -> None:
    """Print Markdown on standard output: set as a page on a terminal, as it is elsewhere."""
    if not sys.stdout.isatty():
        sys.stdout.write(f"{text.rstrip()}\n")
        return
    from rich.markdown import Markdown

    without_pictures = re.sub(r"!\[[^\]]*\]\([^)]*\)\n*", "", printable(text))
    _console(sys.stdout, options).print(Markdown(without_pictures, hyperlinks=False))


def _plain(options: Options) -> bool:
    """Return whether a terminal shall get plain text as well."""
    return bool(options.quiet or os.environ.get("NO_COLOR")) or os.environ.get("TERM") == "dumb"


def _console(stream: TextIO, options: Options) -> Console:
    """Return a console of rich on a terminal; texts for it must be printable."""
    from rich.console import Console

    beneath = stream.beneath if isinstance(stream, PrintableStream) else stream
    plain = _plain(options)
    return Console(file=beneath, highlight=False, color_system=None if plain else "auto", no_color=plain)


class LiveMeter:
    """A bar and one line on a terminal, redrawn at most ten times a second."""

    def __init__(self, console: Console, clock: Callable[[], float] = time.monotonic) -> None:
        self._console, self._clock = console, clock
        self._next = 0.0
        self._bar: Bar | None = None

    def __call__(self, progress: Progress | CaseProgress | Notice) -> None:
        """Redraw when a tenth of a second has passed; a notice gets a line of its own."""
        if isinstance(progress, Notice):
            self._console.print(printable(progress.text), markup=False)
            return
        now = self._clock()
        if now < self._next:
            return
        self._next = now + 0.1
        if self._bar is None:
            from rich.progress import BarColumn, TextColumn
            from rich.progress import Progress as Bar
            from rich.table import Column

            line = Column(no_wrap=True, overflow="ellipsis")
            bar_of = BarColumn(bar_width=20, table_column=Column(width=20))
            columns = bar_of, TextColumn("{task.description}", markup=False, table_column=line)
            self._bar = Bar(*columns, console=self._console, auto_refresh=False)
            self._bar.add_task("")
            self._bar.start()
        done, total = (
            (progress.done, progress.total)
            if isinstance(progress, CaseProgress)
            else (progress.time_s, progress.end_time_s)
        )
        text = printable(describe(progress))
        task = self._bar.task_ids[0]
        self._bar.update(task, description=text, completed=done, total=total, refresh=True)

    def close(self) -> None:
        """Leave the last line standing and go to the next."""
        if self._bar:
            self._bar.stop()
            self._bar = None


def headed(scene_id: str, title: str) -> str:
    """Return the line that names a scene; one without a title has its id for it."""
    return scene_id if title == scene_id else f"{scene_id}: {title}"


def limitation_lines(limitations: Iterable[Limitation], indent: str = "") -> list[str]:
    """Return each limitation after its kind, wrapped, heaviest first."""
    from fem_impact.outcome.groups import by_weight

    return [line for one in by_weight(limitations) for line in wrapped(f"{one.kind}: {one.text}", indent)]


def size_text(size: RunSize) -> str:
    """Return numbers of elements and steps in words."""
    from fem_impact.case.size import about

    return f"{about(size.rod + size.barrier)} elements, {about(size.steps)} steps"
