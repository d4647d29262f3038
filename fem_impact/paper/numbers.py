"""Numbers for JSON and for reading: what is not finite is said so, never written as a number."""

from __future__ import annotations

import math
from typing import Any

from rigid import Estimate
from rigid.experiments import Statistic

__all__ = ["estimate_entry", "finite", "statistic_entry"]


def finite(value: Any) -> float | None:
    """Return a float, or None where it is infinite or undefined."""
    number = float(value)
    return number if math.isfinite(number) else None


def statistic_entry(found: Statistic) -> dict[str, Any]:
    """Return mean, SD and 95 % interval of the mean by name."""
    numbers = {name: finite(getattr(found, name)) for name in ("mean", "sd", "low", "high")}
    return {**numbers, "tests": found.n}


def estimate_entry(found: Estimate) -> dict[str, Any]:
    """Return value, standard uncertainty, 95 % interval and its sources by name."""
    numbers = {name: finite(getattr(found, name)) for name in ("value", "sd", "low", "high")}
    return {**numbers, "parts": {name: finite(part) for name, part in found.parts.items()}}
