"""Compiler settings shared by the compiled kernels, and where their machine code is kept."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.core import event
from numba.core.codegen import get_host_cpu_features

SETTINGS: Any = numba.config
F = TypeVar("F", bound=Callable[..., Any])

# Contraction and reciprocals are allowed; reordering of sums is not, so results do not depend on the
# vector width of the machine. NaN stays visible, because a diverging run must be seen.
FAST = {"contract", "arcp", "nsz"}
KEPT = {"cache": True}
COUNTLESS = {"_nrt": False}


def _cache_folder() -> Path:
    """Return a folder named after all sources of the solver that hold compiled code.

    The compiler's own check looks at one file at a time: a kernel would keep an outdated copy of a
    helper that it took from another file.
    """
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.rglob("*.py")):
        source = path.read_bytes()
        if b"fem_impact.solid.kernels import" in source or b"numba" in source:
            digest.update(source)
    return Path(__file__).parent / "__pycache__" / f"kernels-{digest.hexdigest()[:16]}"


def _keep_compiled_code() -> None:
    folder = _cache_folder()
    if "NUMBA_CACHE_DIR" not in os.environ and os.access(Path(__file__).parent, os.W_OK):
        SETTINGS.CACHE_DIR = str(folder)


_keep_compiled_code()


def _use_whole_registers() -> None:
    """Let loops have 512 bits where the machine has them; by itself the compiler takes half of them.

    Older machines than those with AVX-512 VBMI2 (2019) run slower while they do. No bit of a result changes.
    """
    features = get_host_cpu_features()
    if SETTINGS.CPU_FEATURES is None and "+avx512vbmi2" in features.split(","):
        SETTINGS.CPU_FEATURES = f"{features},-prefer-256-bit"


_use_whole_registers()


def compiled_before(name: str = "yielding_kernel.update") -> bool:
    """Return whether a kernel that an earlier run of these sources compiled lies in the cache."""
    return any(Path(SETTINGS.CACHE_DIR or _cache_folder()).rglob(f"{name}-*.nbi"))


class _Compiling(event.Listener):
    """Wall and processor time of all compilations so far, s; one within another counts once."""

    def __init__(self) -> None:
        self.wall, self.cpu = 0.0, 0.0
        self._depth = 0

    def on_start(self, _: object) -> None:
        """Begin to measure."""
        if self._depth == 0:
            self._begun = time.perf_counter(), time.process_time()
        self._depth += 1

    def on_end(self, _: object) -> None:
        """Add what has passed."""
        self._depth -= 1
        if self._depth == 0:
            wall, cpu = self._begun
            self.wall += time.perf_counter() - wall
            self.cpu += time.process_time() - cpu


COMPILING = _Compiling()
event.register("numba:compile", COMPILING)


def kernel(function: F) -> F:
    """Compile a hot loop, cached on disk across runs.

    It makes no arrays. So it needs no counts of references to them, which in short loops over views cost as
    much as the arithmetic.
    """
    return _compiled(function, **KEPT, **COUNTLESS)


def allocating_kernel(function: F) -> F:
    """Compile a loop that makes arrays."""
    return _compiled(function, **KEPT)


def inlined(function: F) -> F:
    """Compile a helper that every caller absorbs."""
    return _compiled(function, forceinline=True, **COUNTLESS)


def _compiled(function: F, **options: Any) -> F:
    return cast(F, numba.njit(fastmath=FAST, error_model="numpy", **options)(function))
