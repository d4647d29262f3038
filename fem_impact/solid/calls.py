"""Calls of kernels that compiled code makes by itself, without the interpreter.

A call is a named tuple of a kernel's arguments, of a class that stands for this kernel.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable
from inspect import signature
from typing import Any

from numba.extending import overload

__all__ = ["Call", "call_of", "perform"]

Call = tuple[Any, ...]


def call_of(kernel: Callable[..., Any], name: str) -> Callable[..., Call]:
    """Return the class of a kernel's calls, to be kept by that ``name`` in the kernel's module."""
    kind = namedtuple(name, signature(kernel).parameters, module=kernel.__module__)  # type: ignore[misc]
    kind.kernel = kernel  # type: ignore[attr-defined]
    return kind


def perform(calls: Any) -> None:
    """Make all calls, one after the other; for compiled code alone."""


@overload(perform)
def _perform(calls):  # type: ignore[no-untyped-def]
    if not len(calls):
        return lambda calls: None
    kernel = calls[0].instance_class.kernel

    def first_and_rest(calls):  # type: ignore[no-untyped-def]
        kernel(*calls[0])
        perform(calls[1:])

    return first_and_rest
