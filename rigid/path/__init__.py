"""The resolved sliding path: Coulomb friction with stick and reversal, in the impulse domain."""

from .eq22 import interval_ratio, painleve_threshold
from .over_speed import path_over_speed
from .resolve import LAWS, End, SlidingPath, sliding_path

__all__ = [
    "LAWS",
    "End",
    "SlidingPath",
    "interval_ratio",
    "painleve_threshold",
    "path_over_speed",
    "sliding_path",
]
