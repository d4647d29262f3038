"""The resolved sliding path: Coulomb friction with stick and reversal, in the impulse domain."""

from .eq22 import interval_ratio, painleve_threshold
from .resolve import LAWS, End, SlidingPath, sliding_path

__all__ = ["LAWS", "End", "SlidingPath", "interval_ratio", "painleve_threshold", "sliding_path"]
