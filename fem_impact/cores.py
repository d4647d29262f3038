"""How many processor cores there are to use."""

from __future__ import annotations

import os

__all__ = ["cores", "idle_cores"]


def cores() -> int:
    """Return how many processor cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def idle_cores() -> float:
    """Return how many of them nobody kept busy in the last minute; 1 where that is not told."""
    return cores() - os.getloadavg()[0] if hasattr(os, "getloadavg") else 1.0
