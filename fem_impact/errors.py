"""What can go wrong for a user: typed errors, each with the exit code that the command line returns."""

import json
import re
from collections.abc import Callable, Collection, Iterable
from typing import Any, ClassVar


class FemImpactError(ValueError):
    """Anything a user can cause and mend; the message names the cause and the remedy, in printable text."""

    exit_code: ClassVar[int] = 1
    lasting: ClassVar[bool] = False
    """Whether the same computation, made again, would end so again."""

    def __init__(self, message: str = "") -> None:
        super().__init__(printable(message))


class StatementError(FemImpactError):
    """A key, an option or a name that cannot be used as the user stated it.

    Parameters
    ----------
    problem : str
        What is wrong, in physical words.
    key : str, optional
        Dotted key in the scene, such as ``projectile.length``; an argument of a function with its sign,
        ``height=``; or an option of the command line, ``--height``.
    value : object, optional
        The refused value as the user gave it; left out of the message when None.
    remedy : str, optional
        What to write instead.
    source : str, optional
        The file, or the Python object, in which the key stands.
    """

    def __init__(
        self, problem: str, *, key: str = "", value: Any = None, remedy: str = "", source: str = ""
    ) -> None:
        self.problem, self.key, self.value = problem, key, value
        self.remedy, self.source = remedy, source
        shown = "" if value is None else _short(value)
        between = "" if key.endswith("=") else " " if key.startswith("--") else " = "
        stated = f"{key}{between}{shown}" if shown and key else key or shown
        parts = [part for part in (source, stated, problem) if part]
        super().__init__(f"{': '.join(parts)} {remedy}".strip())


class UsageError(StatementError):
    """A command line or call that names what there is not, leaves out a unit, or contradicts itself."""

    exit_code: ClassVar[int] = 2


class SceneError(StatementError):
    """A scene, a rod or a parameter that is understood and cannot be run as stated."""

    exit_code: ClassVar[int] = 3
    lasting: ClassVar[bool] = True

    def under(self, prefix: str, source: str = "") -> "SceneError":
        """Return the same complaint, with its key placed below ``prefix`` and its file named."""
        key = ".".join(part for part in (prefix, self.key) if part)
        return SceneError(
            self.problem, key=key, value=self.value, remedy=self.remedy, source=source or self.source
        )

    def worded(self, say: Callable[[str], str]) -> "SceneError":
        """Return the same complaint with its problem and remedy as ``say`` words them."""
        return SceneError(
            say(self.problem), key=self.key, value=self.value, remedy=say(self.remedy), source=self.source
        )


class OutputPathError(FemImpactError):
    """Results cannot be written where the user asked for them."""

    exit_code: ClassVar[int] = 4


class ResultError(FemImpactError):
    """A result directory or file handed in cannot be read as one."""

    exit_code: ClassVar[int] = 5


class RunError(FemImpactError):
    """A run that began and could not be finished or trusted."""

    exit_code: ClassVar[int] = 6
    lasting: ClassVar[bool] = True


class MissingLibraryError(FemImpactError):
    """A system library or an optional package is missing; computed results are kept."""

    exit_code: ClassVar[int] = 7


EXIT_CODES: dict[int, str] = {
    0: "done",
    1: "a fault of the program (please report it with the command and the scene)",
    UsageError.exit_code: "the command line is wrong: unknown name, missing unit, options at odds",
    SceneError.exit_code: "the scene, the rod or a parameter was refused before any work",
    OutputPathError.exit_code: "the output place cannot be written, or the disk is full",
    ResultError.exit_code: "a result handed in cannot be read",
    RunError.exit_code: "a run stopped early or its ledger did not close, or `verify` failed",
    MissingLibraryError.exit_code: "a library that this command needs is missing; results are kept",
    130: "interrupted; what was computed is kept",
}


def _bare(name: str) -> str:
    return name.lower().lstrip("-")


_ARGUMENT = re.compile(r"(?<![\w.\"'-])([a-z_]+)=(True\b)?(?=(\S?))")


def in_options(message: str, options: Collection[str]) -> str:
    """Return a message in which arguments of functions are options: ``tip_radius=`` is ``--tip-radius``.

    ``options`` are those that there are, by the names of the arguments.

    Examples
    --------
    >>> in_options('out="a.md": cannot be written. Choose another out=.', {"out"})
    '--out "a.md": cannot be written. Choose another --out.'
    """

    def option(found: re.Match[str]) -> str:
        name, true, after = found.groups()
        between = " " if not true and re.match("[\\w\"'\\[{/]", after) else ""
        return f"--{name.replace('_', '-')}{between}" if name in options else found[0]

    return _ARGUMENT.sub(option, message)


def did_you_mean(name: str, known: Iterable[str], otherwise: str) -> str:
    """Return a remedy that proposes the `nearest` known name, ``otherwise`` where none is near."""
    near = nearest(name, known)
    return f"Did you mean {near}?" if near else otherwise


def nearest(name: str, known: Iterable[str], bare: Callable[[str], str] = _bare) -> str:
    """Return the nearest known name in any case, empty where none is near.

    Hyphens before a name do not make it nearer to another, and of two names that differ in them alone the one
    like the given name is proposed; ``bare`` may leave out other parts of names. A name with one wrong letter
    behind its first is nearer than one that lacks a letter: mn is mm, not m.
    """
    from difflib import get_close_matches

    like_it_last = sorted(known, key=lambda candidate: candidate.startswith("-") == name.startswith("-"))
    by_bare = {bare(candidate): candidate for candidate in like_it_last}
    asked = bare(name)
    mistyped = [
        one
        for one in by_bare
        if len(one) == len(asked) and one[:1] == asked[:1] and sum(map(str.__ne__, one, asked)) <= 1
    ]
    near = sorted(mistyped, key=lambda one: one != asked) or get_close_matches(asked, by_bare, 1)
    return by_bare[near[0]] if near else ""


def printable(text: str) -> str:
    """Return text for a terminal: control and direction characters are escaped, line breaks are not.

    The escapes are those of JSON, so that a JSON document stays one. Spaces of other widths pass.
    """
    if text.isprintable():
        return text
    return "".join(
        char if char.isprintable() or char in _PASSING else json.dumps(char)[1:-1] for char in text
    )


_PASSING = "\n\u00a0\u2009\u202f"


def _short(value: Any) -> str:
    text = f'"{value}"' if isinstance(value, str) else repr(value)
    if isinstance(value, float) and len(text) > 8:
        text = f"{value:.4g}"
    return text if len(text) <= 60 else text[:57] + "..."
