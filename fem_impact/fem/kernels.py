"""Decorators of the compiled kernels, and the cache of their machine code."""

import hashlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numpy as np
from llvmlite.binding import get_host_cpu_features
from numba import extending
from numba.core import event
from numpy.typing import NDArray

SETTINGS: Any = numba.config
F = TypeVar("F", bound=Callable[..., Any])
Counts = NDArray[np.uint32]
"""Indices that compiled code reads: unsigned, so that it does not test for negative ones."""

# Contraction and reciprocals are allowed; reordering of sums is not, so results do not depend on the
# vector width of the machine. NaN is not assumed away: a diverging run must be detected.
FAST = {"contract", "arcp", "nsz"}
KEPT = {"cache": True}  # on disk, across runs
COUNTLESS = {"_nrt": False}  # no reference counts of arrays


def _cache_folder() -> Path:
    """Return the cache folder, named after a digest of all sources with compiled code.

    It lies in the folder that NUMBA_CACHE_DIR states, else beside this file. numba checks one source file
    per kernel only: a kernel would keep an outdated copy of a helper inlined from another file.
    """
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        source = path.read_bytes()
        if b"fem_impact.fem.kernels import" in source or b"numba" in source:
            digest.update(source)
    folder = os.environ.get("NUMBA_CACHE_DIR") or Path(__file__).parent / "__pycache__"
    return Path(folder) / f"kernels-{digest.hexdigest()[:16]}"


if os.environ.get("NUMBA_CACHE_DIR") or os.access(Path(__file__).parent, os.W_OK):
    SETTINGS.CACHE_DIR = str(_cache_folder())


# loops take whole registers of 512 bits, by default 256, where the processor has AVX-512 VBMI2: those with
# AVX-512 but without VBMI2 (before 2019) run slower with 512 bits; results do not change
_FEATURES = get_host_cpu_features().flatten()
if SETTINGS.CPU_FEATURES is None and "+avx512vbmi2" in _FEATURES.split(","):
    SETTINGS.CPU_FEATURES = f"{_FEATURES},-prefer-256-bit"


def compiled_before(name: str = "yielding_kernel.update") -> bool:
    """Return whether the cache has a kernel ``name`` compiled by an earlier run of the same sources."""
    return any(Path(SETTINGS.CACHE_DIR or _cache_folder()).rglob(f"{name}-*.nbi"))


class _Compiling(event.Listener):
    """Wall and processor time of all compilations so far, s; nested ones count once."""

    def __init__(self) -> None:
        self.wall, self.cpu = 0.0, 0.0
        self._depth = 0

    def on_start(self, _: object) -> None:
        """Start the clock at the outermost compilation."""
        if self._depth == 0:
            self._begun = time.perf_counter(), time.process_time()
        self._depth += 1

    def on_end(self, _: object) -> None:
        """Add the time of the outermost compilation."""
        self._depth -= 1
        if self._depth == 0:
            wall, cpu = self._begun
            self.wall += time.perf_counter() - wall
            self.cpu += time.process_time() - cpu


COMPILING = _Compiling()
event.register("numba:compile", COMPILING)


def kernel(function: F) -> F:
    """Compile a loop that allocates no arrays, cached on disk across runs.

    Reference counting of arrays is off: in short loops over views it costs as much as the arithmetic.
    """
    return _compiled(function, **KEPT, **COUNTLESS)


def allocating_kernel(function: F) -> F:
    """Compile a loop that allocates arrays: as `kernel`, with reference counting."""
    return _compiled(function, **KEPT)


def inlined(function: F) -> F:
    """Compile a helper that is inlined into every caller; called from Python it runs as it is written.

    That it has no wrapper for Python makes the first compilation a quarter shorter.
    """
    options: Any = {"fastmath": FAST, "error_model": "numpy", "forceinline": True, **COUNTLESS}
    return extending.register_jitable(**options)(function)


def by_type(argument: str, others: dict[type, Callable[..., Any]]) -> Callable[[F], F]:
    """Compile a helper whose body follows from the named tuple that is its ``argument``.

    The choice is made when the caller is compiled: its loop has one body and no branch. ``others`` are the
    bodies of some types of named tuple; the decorated function is that of all the rest.
    """

    def decorate(function: F) -> F:
        def choose(*arguments: Any) -> Callable[..., Any]:
            named = dict(zip(function.__code__.co_varnames, arguments, strict=False))
            return others.get(named[argument].instance_class, function)

        options: Any = {"fastmath": FAST, "error_model": "numpy", "forceinline": True}
        extending.overload(function, jit_options=options, strict=False)(choose)
        return function

    return decorate


def _compiled(function: F, **options: Any) -> F:
    return cast(F, numba.njit(fastmath=FAST, error_model="numpy", **options)(function))
