"""Four numbers that a kernel handles as one, where the compiler does not see by itself that it could.

They are a vector of LLVM's, which becomes a register of the machine, or two of half the width, so that
results do not depend on it. The kernel that uses them sets the rules of their arithmetic.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.extending import models, register_model

__all__ = ["add_product", "load", "spread", "store", "three"]

VECTOR, LANE = ir.VectorType(ir.DoubleType(), 4), ir.IntType(32)
intrinsic: Any = extending.intrinsic  # its callers leave out the first argument
NUMBER = 8  # bytes: places need not be multiples of four


class Four(types.Type):
    """Four float64."""

    def __init__(self) -> None:
        super().__init__(name="Four")


FOUR = Four()


@register_model(Four)
class _Register(models.PrimitiveModel):
    def __init__(self, manager, of):  # type: ignore[no-untyped-def]
        super().__init__(manager, of, VECTOR)


def _place(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
    """Return the address of four numbers of an array from a place on."""
    array = context.make_array(signature.args[0])(context, builder, arguments[0])
    return builder.bitcast(builder.gep(array.data, [arguments[1]]), VECTOR.as_pointer())


@intrinsic
def load(typing, values, place):  # type: ignore[no-untyped-def]
    """Return four numbers of a contiguous array, counted over all its axes, from ``place`` on."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.load(_place(context, builder, signature, arguments), align=NUMBER)

    return FOUR(values, types.intp), code


@intrinsic
def store(typing, values, place, lanes):  # type: ignore[no-untyped-def]
    """Put four numbers into a contiguous array, counted as for `load`."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        builder.store(arguments[2], _place(context, builder, signature, arguments), align=NUMBER)
        return context.get_dummy_value()

    return types.void(values, types.intp, FOUR), code


@intrinsic
def spread(typing, number):  # type: ignore[no-untyped-def]
    """Return a number four times."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        none = ir.Constant(VECTOR, ir.Undefined)
        one = builder.insert_element(none, arguments[0], LANE(0))
        return builder.shuffle_vector(one, none, ir.Constant(ir.VectorType(LANE, 4), [0] * 4))

    return FOUR(types.float64), code


@intrinsic
def add_product(typing, total, a, b):  # type: ignore[no-untyped-def]
    """Return total + a b, lane by lane."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        total, a, b = arguments
        return builder.fadd(total, builder.fmul(a, b))

    return FOUR(FOUR, FOUR, FOUR), code


@intrinsic
def three(typing, lanes):  # type: ignore[no-untyped-def]
    """Return the sum of the first three numbers."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        a, b, c = (builder.extract_element(arguments[0], LANE(k)) for k in range(3))
        return builder.fadd(builder.fadd(a, b), c)

    return types.float64(FOUR), code
