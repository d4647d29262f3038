"""Problems with known answers, run through the solver's own parts.

Every problem takes its physical parameters and returns computed values beside a reference made by other
means (`fem_impact.evidence.references`), with error, tolerance, verdict and cost.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module

from fem_impact.errors import UsageError, did_you_mean
from fem_impact.evidence.problems.problem import Check, Problem, Verification
from fem_impact.tables.table import Table

# name -> module and its problem; a module is imported when its problem is asked for
PROBLEMS = {
    "bar": ("bar", "PROBLEM"),
    "hertz": ("spheres", "HERTZ"),
    "oblique-sphere": ("spheres", "OBLIQUE_SPHERE"),
    "plate": ("plates", "PLATE"),
    "thin-plate": ("plates", "THIN_PLATE"),
    "sears": ("sears_rod", "PROBLEM"),
    "thornton": ("thornton_tip", "PROBLEM"),
    "taylor": ("taylor_bar", "PROBLEM"),
    "hardness": ("hardness_cone", "PROBLEM"),
    "wall-bar": ("square_bars", "WALL_BAR"),
    "tilted-bar": ("square_bars", "TILTED_BAR"),
    "modes": ("waves", "MODES"),
    "waves": ("waves", "WAVES"),
    "free-spin": ("free_flight", "SPIN"),
    "momentum": ("free_flight", "MOMENTUM"),
    "oblique-rod": ("oblique_rod", "PROBLEM"),
}


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
    module, attribute = PROBLEMS[name]
    found: Problem = getattr(import_module(f"fem_impact.evidence.problems.{module}"), attribute)
    return found


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


def _use(check: Check) -> float:
    """Return the share of its tolerance that a check uses up."""
    error = abs(check.error)
    return error / check.tolerance if check.tolerance else (float("inf") if error else 0.0)


def _row(found: Verification) -> list[str]:
    judged = [check for check in found.checks if check.judged]
    nearest = max(judged, key=_use)
    unit = "" if nearest.unit == "1" else f" {nearest.unit}"
    return [
        f"`{found.name}`",
        f"{sum(check.passed for check in judged)} of {len(judged)}",
        nearest.name,
        f"{nearest.computed:.5g}{unit}",
        f"{nearest.reference:.5g}{unit}",
        f"{nearest.error:+.1e}",
        f"{nearest.tolerance:.3g} {nearest.kind}",
        f"{found.cost.cpu_s:.0f}",
    ]


def page(done: Sequence[Verification]) -> str:
    """Return counts and cost, and a row for every problem."""
    every = [check for found in done for check in found.checks]
    checks = [check for check in every if check.judged]
    wall = sum(found.cost.wall_s for found in done)
    line = (
        f"All parameters at their defaults: {sum(check.passed for check in checks)} of {len(checks)} "
        f"checks passed, {len(every) - len(checks)} more are only shown, {wall / 60:.1f} minutes."
    )
    return f"{line}\n\n{Table.of(HEAD, map(_row, done)).markdown()}"
