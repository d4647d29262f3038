"""Compiler settings and the small algebra shared by the compiled kernels."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

F = TypeVar("F", bound=Callable[..., Any])

# Contraction and reciprocals are allowed; reordering of sums is not, so results do not depend on the
# vector width of the machine. NaN stays visible, because a diverging run must be seen.
FAST = {"contract", "arcp", "nsz"}


def compiled_before() -> bool:
    """Return whether compiled kernels of an earlier run lie in the cache beside the sources."""
    return any((Path(__file__).parent / "__pycache__").glob("yielding_kernel.update-*.nbi"))


def kernel(function: F) -> F:
    """Compile a hot loop, cached on disk across runs."""
    return cast(F, numba.njit(cache=True, fastmath=FAST, error_model="numpy")(function))


def inlined(function: F) -> F:
    """Compile a helper that every caller absorbs."""
    return cast(F, numba.njit(fastmath=FAST, error_model="numpy", forceinline=True)(function))
