"""Vector registers for compiled kernels: `LANES` doubles at once, as one value.

numba turns loops over many columns into vector instructions, but pays for it on every entry of a short loop. A value
of type `Lanes` stands for a row of `LANES` doubles that stays in registers; whatever the processor's registers hold,
the result is the same to the last bit, since every lane is computed by itself and in the order that is written.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic as numba_intrinsic
from numba.extending import models, register_model

LANES = 32
"""Wide enough that the cost of an index is spread over four registers of 512 bits."""

_LINE = 8  # doubles

intrinsic: Any = numba_intrinsic

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_EVERY_LANE = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)


class _LanesType(types.Type):
    def __init__(self) -> None:
        super().__init__(name="Lanes")


@register_model(_LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _VECTOR)


_LANES = _LanesType()


@intrinsic
def load(_: Any, array: Any, index: Any) -> Any:
    """`array[index : index + LANES]` of a flat float64 array."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_address(context, builder, signature, arguments), align=8)

    return _LANES(array, index), generate


@intrinsic
def store(_: Any, array: Any, index: Any, lanes: Any) -> Any:
    """`array[index : index + LANES] = lanes` of a flat float64 array."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store(arguments[2], _address(context, builder, signature, arguments), align=8)
        return context.get_dummy_value()

    return types.void(array, index, _LANES), generate


@intrinsic
def filled(_: Any, scalar: Any) -> Any:
    """Lanes that all hold `scalar`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _spread(builder, arguments[0])

    return _LANES(types.float64), generate


@intrinsic
def scaled(_: Any, lanes: Any, scalar: Any) -> Any:
    """`lanes * scalar`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fmul(arguments[0], _spread(builder, arguments[1]))

    return _LANES(_LANES, types.float64), generate


@intrinsic
def add_scaled(_: Any, lanes: Any, scalar: Any, other: Any) -> Any:
    """`lanes + scalar * other`, rounded once."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = ir.FunctionType(_VECTOR, [_VECTOR] * 3)
        fused = cgutils.get_or_insert_function(builder.module, kind, f"llvm.fma.v{LANES}f64")
        return builder.call(fused, [_spread(builder, arguments[1]), arguments[2], arguments[0]])

    return _LANES(_LANES, types.float64, _LANES), generate


@njit(cache=True, nogil=True)
def aligned(size: Any) -> Any:
    """A flat float64 array that begins where a cache line does, so that no register straddles two of them."""
    buffer = np.empty(size + _LINE - 1)
    first = -(buffer.ctypes.data // buffer.itemsize) % _LINE
    return buffer[first : first + size]


def _address(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
    index = context.cast(builder, arguments[1], signature.args[1], types.intp)
    return builder.bitcast(builder.gep(data, [index]), _VECTOR.as_pointer())


def _spread(builder: Any, scalar: Any) -> Any:
    undefined = ir.Constant(_VECTOR, ir.Undefined)
    first = builder.insert_element(undefined, scalar, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(first, undefined, _EVERY_LANE)
