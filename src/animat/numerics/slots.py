"""Slots: where a kernel calls a function that is linked into it later (`linked.py`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils, config
from numba.core.typing.templates import signature
from numba.extending import intrinsic

from animat.numerics.compiled import compiled

SLOT, CUSTOM = "animat_slot_", "animat_any_custom"
"""How the symbol of a slot begins, and the symbol that says whether one holds a custom function."""


class Role(NamedTuple):
    """What is asked of a function in a slot: the types it is given, and the one it returns."""

    arguments: tuple[types.Type, ...]
    result: types.Type


def slot(name: str, role: Role) -> Any:
    """Return a compiled function that calls what will be linked into the slot of a role."""

    def lower(context: Any, builder: Any, _: Any, given: Any) -> Any:
        kind = context.call_conv.get_function_type(role.result, role.arguments)
        known = builder.module.globals.get(SLOT + name)
        function = known or ir.Function(builder.module, kind, name=SLOT + name)
        status, result = context.call_conv.call_function(
            builder, function, role.result, role.arguments, given
        )
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return result

    count, found = len(role.arguments), (signature(role.result, *role.arguments), lower)
    call = intrinsic(with_arguments("typing_context, {}", "found", count, found=found))
    return compiled(with_arguments("{}", "call({})", count, call=call))


@intrinsic
def _any_custom(typing_context):
    def lower(context: Any, builder: Any, _: Any, given: Any) -> Any:
        known = builder.module.globals.get(CUSTOM)
        if known is None:
            byte = ir.IntType(8)
            known = ir.GlobalVariable(builder.module, byte, CUSTOM)
            vars(known).update(linkage="weak", global_constant=True, initializer=byte(1))
        return builder.trunc(builder.load(known), ir.IntType(1))

    return signature(types.boolean), lower


_ANY_CUSTOM: Any = (lambda: True) if getattr(config, "DISABLE_JIT", False) else _any_custom


@compiled
def any_custom():
    """Tell whether a slot may hold a custom function; a constant where kernels are linked."""
    return _ANY_CUSTOM()


def with_arguments(given: str, result: str, count: int, **around: Any) -> Callable[..., Any]:
    """Return a function of so many arguments: Numba compiles no `*arguments` for a signature."""
    arguments = ", ".join(f"a{n}" for n in range(count))
    exec(f"def made({given.format(arguments)}): return {result.format(arguments)}", around)
    around["made"].__module__ = __name__
    return around["made"]
