"""Standard output and error of the command: texts of scenes, files and paths reach them printable."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from typing import TextIO

from fem_impact.errors import printable


class PrintableStream(io.TextIOBase):
    """A stream that escapes control and direction characters of what is written to another one.

    Line breaks pass, and a carriage return that is written alone, by which a progress line is rewritten.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write a text, escaped; return its length."""
        self._stream.write(text if text == "\r" else printable(text))
        return len(text)

    def flush(self) -> None:
        """Flush the other stream."""
        self._stream.flush()

    def fileno(self) -> int:
        """Return the file descriptor of the other stream."""
        return self._stream.fileno()

    def isatty(self) -> bool:
        """Return whether the other stream is a terminal."""
        return self._stream.isatty()


@contextmanager
def printable_streams() -> Iterator[None]:
    """Let everything that is written to standard output and error pass through a `PrintableStream`."""
    with redirect_stdout(PrintableStream(sys.stdout)), redirect_stderr(PrintableStream(sys.stderr)):
        yield
