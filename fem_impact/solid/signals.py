"""Numbers that two threads tell each other by: read, set and counted as wholes, and waited for.

A thread that waits looks again and again, for waking one that sleeps takes the time of many kernels. It naps
when the wait is long.
"""

from __future__ import annotations

import platform
from typing import Any

import numpy as np
from llvmlite import ir
from numba import extending, types
from numpy.typing import NDArray

from fem_impact.solid.kernels import inlined, kernel

__all__ = ["Signal", "add_one", "look", "make_signals", "tell", "wait_for"]

Signal = NDArray[np.int64]

APART = 16  # places from one signal to the next: threads do not contend for one line of the caches
LOOKS = 5000  # before the first nap, some 0.2 ms, longer than all that only one thread does in a step
NAP = 20  # us
PATIENCE = 500  # naps

intrinsic: Any = extending.intrinsic  # its callers leave out the first argument
NUMBER = ir.IntType(64)
# tells the processor that this is a loop of looks; others need no such word
PAUSE = {"x86_64": "llvm.x86.sse2.pause", "AMD64": "llvm.x86.sse2.pause"}.get(platform.machine())
_sleep: Any = types.ExternalFunction("usleep", types.int32(types.uint32))


def make_signals(count: int) -> Signal:
    """Return (count, APART): each row a signal, its first number, and room."""
    return np.zeros((count, APART), dtype=np.int64)


def _place(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
    """Return the address of the first number of an array."""
    return context.make_array(signature.args[0])(context, builder, arguments[0]).data


@intrinsic
def look(typing, signal):  # type: ignore[no-untyped-def]
    """Return a signal; all that was done before it was set is seen from now on."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.load_atomic(_place(context, builder, signature, arguments), "acquire", 8)

    return types.int64(signal), code


@intrinsic
def tell(typing, signal, value):  # type: ignore[no-untyped-def]
    """Set a signal, after all that was done before."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        builder.store_atomic(arguments[1], _place(context, builder, signature, arguments), "release", 8)
        return context.get_dummy_value()

    return types.void(signal, types.int64), code


@intrinsic
def add_one(typing, signal):  # type: ignore[no-untyped-def]
    """Add one to a signal and return what it was: no two threads get the same."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        place = _place(context, builder, signature, arguments)
        return builder.atomic_rmw("add", place, ir.Constant(NUMBER, 1), "monotonic")

    return types.int64(signal), code


@intrinsic
def _pause(typing):  # type: ignore[no-untyped-def]
    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        if PAUSE:
            kind = ir.FunctionType(ir.VoidType(), [])
            builder.call(builder.module.declare_intrinsic(PAUSE, (), kind), [])
        return context.get_dummy_value()

    return types.void(), code


@inlined
def _looked(signal, least):  # type: ignore[no-untyped-def]
    for _ in range(LOOKS):
        if look(signal) >= least:
            return True
        _pause()
    return False


@kernel
def wait_for(signal, least):  # type: ignore[no-untyped-def]
    """Wait until a signal is ``least`` or more; return whether it is after 10 ms or a little more."""
    if _looked(signal, least):
        return True
    for _ in range(PATIENCE):
        _sleep(NAP)
        if look(signal) >= least:
            return True
    return False
