"""Compiler settings and the small algebra shared by the compiled kernels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

F = TypeVar("F", bound=Callable[..., Any])

# Contraction and reciprocals are allowed; reordering of sums is not, so results do not depend on the
# vector width of the machine. NaN stays visible, because a diverging run must be seen.
FAST = {"contract", "arcp", "nsz"}


def kernel(function: F) -> F:
    """Compile a hot loop, cached on disk across runs."""
    return numba.njit(cache=True, fastmath=FAST, error_model="numpy")(function)  # type: ignore[no-any-return]


def inlined(function: F) -> F:
    """Compile a helper that every caller absorbs."""
    return numba.njit(fastmath=FAST, error_model="numpy", forceinline=True)(function)  # type: ignore[no-any-return]
