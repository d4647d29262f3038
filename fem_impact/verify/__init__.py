"""Problems with known answers, run through the solver's own parts.

Every problem takes its physical parameters and returns computed values beside a reference made by other
means (`fem_impact.verify.reference`), with error, tolerance, verdict and cost.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module

from fem_impact.errors import UsageError, did_you_mean
from fem_impact.verify.problem import Check, Cost, Parameter, Problem, Verification

__all__ = ["PROBLEMS", "Check", "Cost", "Parameter", "Problem", "Verification", "problem", "verify"]

# name -> module and its problem; a module is imported when its problem is asked for
PROBLEMS = {
    "bar": ("bar", "PROBLEM"),
    "hertz": ("hertz_sphere", "PROBLEM"),
    "oblique-sphere": ("oblique_sphere", "PROBLEM"),
    "sears": ("sears_rod", "PROBLEM"),
    "thornton": ("thornton_tip", "PROBLEM"),
    "taylor": ("taylor_bar", "PROBLEM"),
    "wall-bar": ("wall_bar", "PROBLEM"),
    "tilted-bar": ("tilted_bar", "PROBLEM"),
    "modes": ("free_modes", "PROBLEM"),
    "waves": ("bloch", "PROBLEM"),
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
    found: Problem = getattr(import_module(f"fem_impact.verify.{module}"), attribute)
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
