"""Numbers of crossings side by side, as vectors that compiled loops keep in the registers of the processor.

A type and some operations for numba, of as many lanes as the tuple ``lanes`` is long, so that the same loop serves
one crossing and eight. Only to be imported where numba is.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic, models, register_model

_DOUBLE = ir.DoubleType()
_FUSED = ("contract",)  # a product and a sum may be one instruction


class Vector(types.Type):
    """So many floats."""

    def __init__(self, count: int) -> None:
        self.count = count
        super().__init__(name=f"Vector({count})")


class VectorModel(models.PrimitiveModel):
    """A vector of the processor."""

    def __init__(self, manager: Any, kind: Vector) -> None:
        super().__init__(manager, kind, ir.VectorType(_DOUBLE, kind.count))  # type: ignore[no-untyped-call, unused-ignore]


register_model(Vector)(VectorModel)


def _place(context: Any, builder: Any, kind: Any, array: Any, at: Any, count: int) -> Any:
    """Pointer to some entries of an array (n,) in one piece."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [at]), ir.VectorType(_DOUBLE, count).as_pointer())


def _repeated(builder: Any, value: Any, count: int) -> Any:
    one = builder.insert_element(
        ir.Constant(ir.VectorType(_DOUBLE, count), ir.Undefined), value, ir.Constant(ir.IntType(32), 0)
    )
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(ir.IntType(32), count), [0] * count))


def _read(context_of_types: Any, lanes: Any, array: Any, at: Any) -> Any:
    """``array[at : at + len(lanes)]``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        where = _place(context, builder, signature.args[1], arguments[1], arguments[2], lanes.count)
        return builder.load(where, align=8)

    return Vector(lanes.count)(lanes, array, types.uint64), code


def _put(context_of_types: Any, array: Any, at: Any, t: Any) -> Any:
    """``array[at : at + len(t)] = t``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store(
            arguments[2],
            _place(context, builder, signature.args[0], arguments[0], arguments[1], t.count),
            align=8,
        )
        return context.get_dummy_value()

    return types.void(array, types.uint64, t), code


def _plus(context_of_types: Any, t: Any, factor: Any, s: Any) -> Any:
    """``t + factor * s``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        product = builder.fmul(_repeated(builder, arguments[1], t.count), arguments[2], flags=_FUSED)
        return builder.fadd(arguments[0], product, flags=_FUSED)

    return t(t, types.float64, s), code


def _scaled(context_of_types: Any, factor: Any, t: Any) -> Any:
    """``factor * t``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fmul(_repeated(builder, arguments[0], t.count), arguments[1], flags=_FUSED)

    return t(types.float64, t), code


def _times(context_of_types: Any, t: Any, s: Any) -> Any:
    """``t * s``, entry by entry."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fmul(arguments[0], arguments[1])

    return t(t, s), code


def _plus_size(context_of_types: Any, t: Any, s: Any) -> Any:
    """``t + abs(s)``."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = ir.VectorType(_DOUBLE, t.count)
        name = f"llvm.fabs.v{t.count}f64"
        magnitude = builder.module.globals.get(name) or ir.Function(
            builder.module, ir.FunctionType(kind, [kind]), name
        )
        return builder.fadd(arguments[0], builder.call(magnitude, [arguments[1]]))

    return t(t, s), code


def _total(context_of_types: Any, t: Any) -> Any:
    """``t.sum()``, of a power of two entries, by halves."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        rest, count = arguments[0], t.count
        while count > 1:
            count //= 2
            halves = [
                builder.shuffle_vector(
                    rest, rest, ir.Constant(ir.VectorType(ir.IntType(32), count), list(range(a, a + count)))
                )
                for a in (0, count)
            ]
            rest = builder.fadd(*halves)
        return builder.extract_element(rest, ir.Constant(ir.IntType(32), 0))

    return types.float64(t), code


read: Any = intrinsic(_read)
put: Any = intrinsic(_put)
plus: Any = intrinsic(_plus)
scaled: Any = intrinsic(_scaled)
times: Any = intrinsic(_times)
plus_size: Any = intrinsic(_plus_size)
total: Any = intrinsic(_total)
