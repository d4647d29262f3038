"""The shapes of tips by name: those of `rigid`, and those that other packages add."""

from collections.abc import Callable, Mapping
from functools import cache

from fem_impact.plugins import added
from rigid import SHAPES, Nose


@cache
def tips() -> Mapping[str, Callable[[float, float], Nose]]:
    """Return what makes the meridian of each tip; what packages add is entered into ``rigid.SHAPES``."""
    SHAPES.update(added("shapes", SHAPES))
    return SHAPES
