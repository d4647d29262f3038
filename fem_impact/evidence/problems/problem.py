"""Problems with known answers, run through the solver's own parts: checks and cost; all by name.

Every problem takes its physical parameters, stated in problems.toml, and returns computed values beside a
reference made by other means (`fem_impact.evidence.references`), with error, tolerance, verdict and cost.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib import import_module
from math import inf, isfinite
from typing import Any, Literal

from fem_impact.errors import SceneError, UsageError, did_you_mean
from fem_impact.evidence.data import read_stated
from fem_impact.scene.fields import Parameter
from fem_impact.tables.table import Table

Values = Mapping[str, float]
CheckKind = Literal["relative", "absolute", "at most", "shown"]


def within(p: Values, name: str, low: float, high: float, unit: str, why: str) -> None:
    """Refuse a parameter that others narrow: ``why`` is the reason.

    Raises
    ------
    SceneError
        If it does not lie from ``low`` to ``high``.
    """
    if not low <= p[name] <= high:
        raise SceneError(f"must lie from {low:.3g} to {high:.3g} {unit} here: {why}", key=name, value=p[name])


@dataclass(frozen=True, slots=True)
class Check:
    """A computed value beside its reference.

    ``relative`` and ``absolute`` bound the difference; ``at most`` bounds the excess of ``computed`` over
    ``reference``; ``shown`` gives the relative difference as information and judges nothing, ``note`` says
    why.
    """

    name: str
    unit: str
    computed: float
    reference: float
    tolerance: float
    kind: CheckKind = "relative"
    note: str = ""

    @classmethod
    def shown(cls, name: str, unit: str, computed: float, reference: float, note: str) -> "Check":
        """Return a comparison that bears no verdict, for the reason in ``note``."""
        return cls(name, unit, computed, reference, inf, "shown", note)

    @property
    def judged(self) -> bool:
        """Return whether the comparison bears a verdict."""
        return self.kind != "shown"

    @property
    def error(self) -> float:
        """Return the signed error in the sense of ``kind``."""
        difference = self.computed - self.reference
        if self.kind in ("relative", "shown"):
            return difference / abs(self.reference)
        return max(0.0, difference) if self.kind == "at most" else difference

    @property
    def used(self) -> float:
        """Return the share of its tolerance that the error uses up."""
        error = abs(self.error)
        return error / self.tolerance if self.tolerance else (inf if error else 0.0)

    @property
    def passed(self) -> bool:
        """Return whether the error is finite and within the tolerance, which what is only shown has not."""
        return isfinite(self.error) and bool(abs(self.error) <= self.tolerance)

    def document(self) -> dict[str, Any]:
        """Return all of it as plain values."""
        return {
            "name": self.name,
            "unit": self.unit,
            "computed": self.computed,
            "reference": self.reference,
            "error": self.error,
            "tolerance": self.tolerance if self.judged else None,
            "kind": self.kind,
            "passed": self.passed if self.judged else None,
            "note": self.note,
        }


@dataclass(frozen=True, slots=True)
class ProblemCost:
    """What a problem took: seconds, and the explicit steps and elements of its runs."""

    wall_s: float
    cpu_s: float
    steps: int
    elements: int


@dataclass(frozen=True, slots=True)
class Solved:
    """What a problem's function returns: checks, and the size of the largest run."""

    checks: tuple[Check, ...]
    steps: int = 0
    elements: int = 0


@dataclass(frozen=True, slots=True)
class Verification:
    """One problem, run: its parameters (SI), checks and cost; ``passed`` is the verdict."""

    name: str
    parameters: dict[str, float]
    checks: tuple[Check, ...]
    cost: ProblemCost

    @property
    def passed(self) -> bool:
        """Return whether every check passed."""
        return all(check.passed for check in self.checks)

    def document(self) -> dict[str, Any]:
        """Return all of it as plain values."""
        return {
            "problem": self.name,
            "passed": self.passed,
            "parameters": self.parameters,
            "checks": [check.document() for check in self.checks],
            "cost": asdict(self.cost),
        }


@dataclass(frozen=True, slots=True)
class Problem:
    """A problem: what it shows, its parameters, and the function that runs the solver on it."""

    name: str
    words: str
    parameters: tuple[Parameter, ...]
    solve: Callable[[Values], Solved]

    def run(self, changes: Mapping[str, float | str] | None = None) -> Verification:
        """Run with some parameters changed; an unknown one is refused."""
        values = self.values(changes or {})
        wall, cpu = time.perf_counter(), time.process_time()
        solved = self.solve(values)
        cost = ProblemCost(
            time.perf_counter() - wall, time.process_time() - cpu, solved.steps, solved.elements
        )
        return Verification(self.name, values, solved.checks, cost)

    def values(self, changes: Mapping[str, float | str]) -> dict[str, float]:
        """Return all parameters in SI."""
        known = {p.key: p for p in self.parameters}
        for name in changes:
            if name not in known:
                hint = did_you_mean(name, known, f"Known are: {', '.join(known)}.")
                raise SceneError(f"is no parameter of {self.name}.", key=name, remedy=hint)
        given = {key: p.read(changes[key]) for key, p in known.items() if key in changes}
        return {key: p.default for key, p in known.items() if p.default is not None} | given


# by name: words, function that solves it, parameters; its module is imported when a problem is asked for
_STATED = read_stated("problems/problems.toml")
_SHARED = _STATED.pop("shared")
PROBLEMS = tuple(_STATED)
"""Names of all problems."""


def parameters_of(name: str) -> tuple[Parameter, ...]:
    """Return the parameters of a problem as stated."""
    parameters = _STATED[name]["parameters"].items()
    return tuple(
        Parameter(key, **{"dimension": ""} | _SHARED.get(key, {}) | particular)
        for key, particular in parameters
    )


def defaults(name: str) -> dict[str, float]:
    """Return the default values of a problem's parameters, SI."""
    return {p.key: p.default for p in parameters_of(name) if p.default is not None}


def problem(name: str) -> Problem:
    """Return a problem by name.

    Raises
    ------
    UsageError
        If there is none of that name.
    """
    if name not in PROBLEMS:
        remedy = did_you_mean(name, PROBLEMS, f"Known are: {', '.join(PROBLEMS)}.")
        raise UsageError("is no problem of the verification.", key=name, remedy=remedy)
    module, solve = _STATED[name]["solve"].split(".")
    solved_by = getattr(import_module(f"fem_impact.evidence.problems.{module}"), solve)
    return Problem(name, _STATED[name]["words"], parameters_of(name), solved_by)


def verify(name: str, changes: Mapping[str, float | str] | None = None) -> Verification:
    """Run one problem with some parameters changed (numbers in SI, or text with a unit).

    Raises
    ------
    UsageError
        If there is no problem of that name.
    SceneError
        If a parameter is unknown, or a value out of range.
    """
    return problem(name).run(changes)


HEAD = ["problem", "passed", "nearest to its limit", "computed", "reference", "error", "allowed", "CPU s"]


def _row(verification: Verification) -> list[str]:
    judged = [check for check in verification.checks if check.judged]
    nearest = max(judged, key=lambda check: check.used)
    unit = "" if nearest.unit == "1" else f" {nearest.unit}"
    return [
        f"`{verification.name}`",
        f"{sum(check.passed for check in judged)} of {len(judged)}",
        nearest.name,
        f"{nearest.computed:.5g}{unit}",
        f"{nearest.reference:.5g}{unit}",
        f"{nearest.error:+.1e}",
        f"{nearest.tolerance:.3g} {nearest.kind}",
        f"{verification.cost.cpu_s:.0f}",
    ]


def page(done: Sequence[Verification]) -> str:
    """Return counts and cost, and a row for every problem."""
    every = [check for verification in done for check in verification.checks]
    checks = [check for check in every if check.judged]
    wall = sum(verification.cost.wall_s for verification in done)
    line = (
        f"All parameters at their defaults: {sum(check.passed for check in checks)} of {len(checks)} "
        f"checks passed, {len(every) - len(checks)} more are only shown, {wall / 60:.1f} minutes."
    )
    return f"{line}\n\n{Table.of(HEAD, map(_row, done)).markdown()}"
