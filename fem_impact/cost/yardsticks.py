"""What this machine can do, so that a time can be read as a ratio: bandwidth, and a sparse product."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cache

import numpy as np
import scipy.sparse as sp

__all__ = ["yardsticks"]

NODES = (21, 21, 41)  # of the box whose stiffness pattern is multiplied: about 54 000 unknowns


@cache
def yardsticks() -> dict[str, float]:
    """Return triad bandwidth, GB/s, and a CSR product, ns an element-step, on one core."""
    return {"triad_GB_per_s": round(_triad(), 2), "csr_ns_per_element_step": round(_csr(), 1)}


def _least(work: Callable[[], object], repeats: int) -> float:
    """Return the smallest wall time of one call, s: the others were disturbed."""
    times = []
    for _ in range(repeats):
        begun = time.perf_counter()
        work()
        times.append(time.perf_counter() - begun)
    return min(times)


def _triad() -> float:
    b, c, a = (np.ones(4_000_000) for _ in range(3))

    def triad() -> None:
        np.multiply(c, 3.0, out=a)
        np.add(a, b, out=a)

    return 5 * 8 * len(a) / _least(triad, 7) / 1e9


def _csr() -> float:
    """Time K x for the pattern of trilinear elements on a box, three unknowns a node."""
    pattern = sp.identity(1, format="csr")
    for n in NODES:
        pattern = sp.kron(pattern, sp.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(n, n)), format="csr")
    K = sp.kron(pattern, np.ones((3, 3)), format="csr")
    x, elements = np.ones(K.shape[0]), np.prod([n - 1 for n in NODES])
    return float(_least(lambda: K @ x, 9) / elements * 1e9)
