"""Four numbers in one vector register, for the product of `fem_impact.fem.sparse.NodeProduct` alone.

A node has three displacements and three forces: no loop long enough for the compiler to make vector
instructions of. So the product calls the functions below, each of which is an instruction or two of LLVM, the
compiler behind numba, on a vector of four doubles; the fourth is padding. In NumPy's words, with ``a`` an
array of float64 in C order, ``x`` a number, and ``i`` an index into ``flat = a.ravel()``:

========================= ========================
``load(a, i)``            ``flat[i : i + 4]``
``store(a, i, v)``        ``flat[i : i + 4] = v``
``spread(x)``             ``np.full(4, x)``
``add_product(s, v, w)``  ``s + v * w``
``sum_of_three(v)``       ``v[0] + v[1] + v[2]``
========================= ========================

An index beyond the array is not noticed. Plain loops give the same bits (tests/fem/test_vectors.py holds them
and compares) and need no knowledge of LLVM, but take 1.5 to 2 times as long. A whole step then takes 5 %
(t3-machined) to 14 % (elastic-frictionless) longer, and 63 % where nearly all elements are elastic
(plate-10mm). Should a new numba break this module, those loops can stand in its place.

How numba's ``intrinsic`` works: the function gets the numba types of its arguments and returns the signature,
``result(argument, ...)``, and a function that appends instructions through an `llvmlite.ir.IRBuilder`.
"""

from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.extending import models, register_model

VECTOR = ir.VectorType(ir.DoubleType(), 4)
ALIGNMENT = 8  # bytes: of one number, so that a load or a store may begin at any index
intrinsic: Any = extending.intrinsic  # its callers leave out the first argument


class Four(types.Type):
    """The numba type of four float64 in one vector register."""

    def __init__(self) -> None:
        super().__init__(name="Four")


FOUR = Four()


@register_model(Four)
class _Register(models.PrimitiveModel):
    def __init__(self, manager, of):  # type: ignore[no-untyped-def]
        super().__init__(manager, of, VECTOR)


def _address(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
    """Return the address of the four numbers of the first argument from the index that is the second on."""
    array = context.make_array(signature.args[0])(context, builder, arguments[0])
    return builder.bitcast(builder.gep(array.data, [arguments[1]]), VECTOR.as_pointer())


@intrinsic
def load(typing, array, index):  # type: ignore[no-untyped-def]
    """Return four numbers of an array from a flat index on."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.load(_address(context, builder, signature, arguments), align=ALIGNMENT)

    return FOUR(array, types.intp), code


@intrinsic
def store(typing, array, index, vector):  # type: ignore[no-untyped-def]
    """Set four numbers of an array from a flat index on."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        builder.store(arguments[2], _address(context, builder, signature, arguments), align=ALIGNMENT)
        return context.get_dummy_value()

    return types.void(array, types.intp, FOUR), code


@intrinsic
def spread(typing, number):  # type: ignore[no-untyped-def]
    """Return four times the same number."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        first = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), arguments[0], ir.IntType(32)(0))
        return builder.shuffle_vector(first, first, ir.Constant(ir.VectorType(ir.IntType(32), 4), [0] * 4))

    return FOUR(types.float64), code


@intrinsic
def add_product(typing, total, a, b):  # type: ignore[no-untyped-def]
    """Return total + a b, number by number."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        total, a, b = arguments
        return builder.fadd(total, builder.fmul(a, b))

    return FOUR(FOUR, FOUR, FOUR), code


@intrinsic
def sum_of_three(typing, vector):  # type: ignore[no-untyped-def]
    """Return the sum of the first three numbers."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        a, b, c = (builder.extract_element(arguments[0], ir.IntType(32)(place)) for place in range(3))
        return builder.fadd(builder.fadd(a, b), c)

    return types.float64(FOUR), code
