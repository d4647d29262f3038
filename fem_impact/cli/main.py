"""The ``fem-impact`` command: reads the command line, calls one handler, turns errors into exit codes.

A command's module is imported when the line names it, so that ``--help`` loads no numerical library.
"""

import errno
import os
import signal
import sys
import threading
from _thread import interrupt_main
from collections.abc import Callable, Sequence
from types import FrameType

from fem_impact.cli.parser import PAPER, Options, build_parser, read_line
from fem_impact.cli.terminal import print_json, printable_streams
from fem_impact.errors import (
    EXIT_CODES,
    FemImpactError,
    OutputPathError,
    RunError,
    SceneError,
    UsageError,
    in_options,
)
from fem_impact.version import __version__

LATER = 0.02
"""Time, s, after which a stop that would have been lost is tried again."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code (`fem_impact.errors.EXIT_CODES` lists them)."""
    # a run has no large dense algebra: further threads of the linear-algebra library only cost time
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # None after `>&-`
    sys.stdout = sys.stdout or open(os.devnull, "w", encoding="utf-8")
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")
    with printable_streams():
        try:
            options = read_line(argv)
        except UsageError as error:
            asked = sys.argv[1:] if argv is None else argv
            return _complain(str(error), error.exit_code, Options(json="--json" in asked))
        if options.version:
            sys.stdout.write(f"fem-impact {__version__}\n")
            return 0
        if not options.handler:
            build_parser(()).print_help(sys.stderr)
            return 2
        if threading.current_thread() is threading.main_thread():  # signals are set there only
            signal.signal(signal.SIGTERM, _stop)  # cleans up like Ctrl-C
            if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # not of one told to ignore it
                signal.signal(signal.SIGINT, _stop)
            sys.unraisablehook = _not_lost
        return _guarded(options.handler, options)


def _stop(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt; within the compiler's library, called from C and losing it, a little later."""
    while frame is not None:
        if frame.f_globals.get("__name__", "").startswith("llvmlite"):
            threading.Timer(LATER, interrupt_main, (number,)).start()
            return
        frame = frame.f_back
    raise KeyboardInterrupt


def _not_lost(lost: "sys.UnraisableHookArgs") -> None:
    """Stop a little later where a stop was raised within a callback that loses it (of a weak reference)."""
    if lost.exc_type is KeyboardInterrupt:
        threading.Timer(LATER, interrupt_main, (signal.SIGTERM,)).start()
    else:
        sys.__unraisablehook__(lost)


def _guarded(handler: Callable[[Options], int], options: Options) -> int:
    """Call the handler; errors of the user and of the disk become one message and an exit code."""
    try:
        if options.scene not in ("", PAPER):  # before what computes is imported, which takes a second
            from fem_impact.cli.scene_options import asked_scene

            asked_scene(options)
        code = handler(options)
        sys.stdout.flush()
        return code
    except SceneError as error:
        from fem_impact.cli.scene_options import placed

        return _complain(str(placed(error, options)), error.exit_code, options)
    except FemImpactError as error:
        return _complain(str(error), error.exit_code, options)
    except KeyboardInterrupt as stop:
        return _complain(str(stop) or "what was computed so far is kept.", 130, options)
    except MemoryError:
        remedy = "Use a larger accuracy.tip_size or fewer workers."
        return _complain(f"out of memory. {remedy}", RunError.exit_code, options)
    except BrokenPipeError:
        # the reader of the output closed it (`| head`): end without a message
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        remedy = "Check that the place exists and can be written, or choose another --out."
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            remedy = "The disk is full: free some space or choose another --out, then run again."
        return _complain(f"{place}{error.strerror or error}. {remedy}", OutputPathError.exit_code, options)


def _complain(message: str, code: int, options: Options) -> int:
    """Tell what went wrong on standard error; with ``--json`` also as a document on standard output."""
    message = in_options(message, vars(options))
    kind = "interrupted" if code == 130 else "error"
    sys.stderr.write(f"fem-impact: {kind}: {message}\n")
    if options.json:
        print_json({"error": {"kind": EXIT_CODES[code], "exit_code": code, "message": message}})
    return code
