"""Records whose shapes are no part of their type.

A state has as many values as a mind has variables, and NumPy's record type knows how many; to Numba
every such type is another, and a kernel would have to be compiled for each mind of another shape.
Here a kernel is compiled once for a `Layout`: where a field lies and how long it is are read from a
table of constants, which is linked in when it is known (`linked.py`), and costs nothing then.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils, config
from numba.core.imputils import lower_getattr_generic, lower_setattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import intrinsic, models, register_model
from numba.np import numpy_support
from numba.np.arrayobj import make_array, populate_array
from numpy.typing import NDArray

PADDING = "padding"
"""The field of the bytes that no other field has, always 0: NumPy would leave them as they are."""

WORD = 8
"""Bytes of every element of a field that is an array, and what records are aligned to."""

_I8, _I64 = ir.IntType(8), ir.IntType(64)


class Field(NamedTuple):
    """A field of a record: its name, the type of its elements, and its shape.

    A length of the shape is a number, or the name of a count. An array's elements take 8 bytes.
    """

    name: str
    kind: type[np.generic]
    shape: tuple[int | str, ...] = ()


class Layout:
    """A kind of record: its fields, and the counts that their shapes are made of."""

    def __init__(self, name: str, fields: tuple[Field, ...]) -> None:
        """Lay out fields: those of one element first, the large before the small."""
        self.name = name
        self.symbol = f"animat_layout_{name}"
        single = (one for one in fields if not one.shape)
        self.single = tuple(sorted(single, key=lambda one: -np.dtype(one.kind).itemsize))
        self.arrays = tuple(one for one in fields if one.shape)
        lengths = {length for one in self.arrays for length in one.shape}
        self.counts = tuple(sorted(each for each in lengths if isinstance(each, str)))
        head = np.dtype([(one.name, one.kind) for one in self.single], align=True)
        self.offsets = {name: int(place[1]) for name, place in (head.fields or {}).items()}
        self.padding = -sum(np.dtype(one.kind).itemsize for one in self.single) % WORD
        self.elements = {one.name: _numba_type(one.kind) for one in fields}
        self.number = {one.name: n for n, one in enumerate(self.arrays)}
        self.type = RecordType(self)
        self.at = _reader(self)

    def dtype(self, counts: Mapping[str, int]) -> np.dtype:
        """Return NumPy's type of a record with these counts."""
        fields: list[Any] = [(one.name, one.kind) for one in self.single]
        if self.padding:
            fields.append((PADDING, np.uint8, (self.padding,)))
        for one in self.arrays:
            shape = tuple(counts[n] if isinstance(n, str) else n for n in one.shape)
            fields.append((one.name, one.kind, shape))
        return np.dtype((np.record, np.dtype(fields, align=True)))

    def table(self, counts: Mapping[str, int]) -> list[int]:
        """Return what a kernel reads: the size of a record, the counts, where each array begins."""
        dtype = self.dtype(counts)
        places: Any = dtype.fields
        begins = [int(places[one.name][1]) for one in self.arrays]
        return [dtype.itemsize, *(counts[name] for name in self.counts), *begins]


def _numba_type(kind: type[np.generic]) -> types.Type:
    dtype: Any = np.dtype(kind)
    return numpy_support.from_dtype(dtype)


class RecordType(types.Type):
    """The type of a record of a layout, whatever its counts."""

    def __init__(self, layout: Layout) -> None:
        """Make the type of a layout."""
        self.layout = layout
        super().__init__(name=f"record of {layout.name}")


@register_model(RecordType)
class _RecordModel(models.StructModel):
    def __init__(self, manager: Any, kind: RecordType) -> None:
        super().__init__(manager, kind, [("base", types.voidptr)])


@infer_getattr
class _RecordAttributes(AttributeTemplate):
    key = RecordType

    def generic_resolve(self, typ: RecordType, attr: str) -> types.Type | None:
        """Return the type of a field."""
        layout = typ.layout
        if attr in layout.offsets:
            return layout.elements[attr]
        if attr in layout.number:
            shape = layout.arrays[layout.number[attr]].shape
            return types.Array(layout.elements[attr], len(shape), "C")
        return None


def _entry(context: Any, builder: Any, layout: Layout, n: int) -> Any:
    """Read an entry of the table of a layout, which is linked in later."""
    table = builder.module.globals.get(layout.symbol)
    if table is None:
        length = 1 + len(layout.counts) + len(layout.arrays)
        table = ir.GlobalVariable(builder.module, ir.ArrayType(_I64, length), layout.symbol)
        table.global_constant = True
    return builder.load(builder.gep(table, [_I64(0), _I64(n)], inbounds=True))


def _place(context: Any, builder: Any, typ: RecordType, value: Any, attr: str) -> Any:
    """Return a pointer to a field, of the type of its elements, and its shape."""
    layout = typ.layout
    record = cgutils.create_struct_proxy(typ)(context, builder, value=value)
    shape = []
    if attr in layout.offsets:
        offset = _I64(layout.offsets[attr])
    else:
        number = layout.number[attr]
        offset = _entry(context, builder, layout, 1 + len(layout.counts) + number)
        for length in layout.arrays[number].shape:
            is_count = isinstance(length, str)
            shape.append(
                _entry(context, builder, layout, 1 + layout.counts.index(length))
                if is_count
                else _I64(length)
            )
    pointer = builder.gep(record.base, [offset], inbounds=True)
    data = context.get_data_type(layout.elements[attr]).as_pointer()
    return builder.bitcast(pointer, data), shape


@lower_getattr_generic(RecordType)
def _get(context: Any, builder: Any, typ: RecordType, value: Any, attr: str) -> Any:
    pointer, shape = _place(context, builder, typ, value, attr)
    element = typ.layout.elements[attr]
    if not shape:
        return context.unpack_value(builder, element, pointer)
    array = make_array(types.Array(element, len(shape), "C"))(context, builder)
    strides = [_I64(WORD)]
    for length in reversed(shape[1:]):
        strides.insert(0, builder.mul(strides[0], length))
    populate_array(
        array, data=pointer, shape=shape, strides=strides, itemsize=_I64(WORD), meminfo=None
    )
    return array._getvalue()


@lower_setattr_generic(RecordType)
def _set(context: Any, builder: Any, signature: Any, arguments: Any, attr: str) -> None:
    typ, given = signature.args
    pointer, _ = _place(context, builder, typ, arguments[0], attr)
    element = typ.layout.elements[attr]
    value = context.cast(builder, arguments[1], given, element)
    context.pack_value(builder, element, value, pointer)


def _reader(layout: Layout) -> Callable[[Any, Any], Any]:
    """Return the function that picks one of some records, in compiled code of their bytes."""

    @intrinsic
    def record_at(typing_context: Any, records: Any, n: Any) -> Any:
        def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            buffer = make_array(signature.args[0])(context, builder, arguments[0])
            record = cgutils.create_struct_proxy(layout.type)(context, builder)
            offset = builder.mul(arguments[1], _entry(context, builder, layout, 0))
            data = builder.bitcast(buffer.data, _I8.as_pointer())
            record.base = builder.gep(data, [offset], inbounds=True)
            return record._getvalue()

        return layout.type(records, types.int64), lower

    def at(records: Any, n: Any) -> Any:
        return records[n]

    compiled_at: Any = record_at
    return at if getattr(config, "DISABLE_JIT", False) else compiled_at


BYTES = types.Array(types.uint8, 1, "C")
"""Records as a kernel is given them."""


def raw(records: NDArray[np.void]) -> NDArray[Any]:
    """Return contiguous records [N] as a kernel takes them: the bytes, which they share.

    With `NUMBA_DISABLE_JIT=1` it takes the records themselves.
    """
    return records if getattr(config, "DISABLE_JIT", False) else records.view(np.uint8)
