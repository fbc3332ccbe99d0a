"""Where two lives part: the first step that differs, field by field."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.mind.mind import Mind
from animat.names import KEPT
from animat.recording.checkpoint import Fields, Kept, opened
from animat.world.world import World


class Field(NamedTuple):
    """A value that differs, by its name, as a text that says it to the last bit."""

    name: str
    recorded: str
    again: str


class Difference(NamedTuple):
    """The first step in which a life, lived again, is not the one that was recorded.

    `fields` are those that differ: of the state before the step, where it was kept, then of what
    the trace says of the step. In all that was recorded of earlier steps both lives agree.
    """

    step: int
    fields: tuple[Field, ...]


def parted(
    recorded: pa.Table, again: pa.Table, fields: Fields, mind: Mind, world: World
) -> tuple[int, tuple[Field, ...]] | None:
    """Return the first row in which two parts of a recording differ and how, or None."""
    rows = min(recorded.num_rows, again.num_rows)
    here, there = recorded.slice(0, rows), again.slice(0, rows)
    differs = np.zeros(rows, np.bool_)
    for name in recorded.column_names:
        differs |= _differs(here[name], there[name])
    for row in np.flatnonzero(differs):
        found = tuple(_fields(here.slice(row, 1), there.slice(row, 1), fields, mind, world))
        if found:
            return int(row), found
    if recorded.num_rows != again.num_rows:
        goes, has = "goes on", "has ended"
        longer = recorded.num_rows > again.num_rows
        return rows, (Field("life", *((goes, has) if longer else (has, goes))),)
    return None


def kept_fields(
    recorded: Kept, again: Kept, fields: Fields, mind: Mind, world: World
) -> Iterator[Field]:
    """Yield what differs between two moments; the digest only where nothing else does."""
    state, present = opened(recorded, fields)
    other, there = opened(again, fields)
    names = _names(mind, world)
    equal = True
    for name in state.dtype.names or ():
        for place in np.argwhere(_unlike(state[name][0], other[name][0])):
            equal = False
            place = tuple(place)  # noqa: PLW2901
            yield _field(
                name + _written(place, names.get(name, ())),
                state[name][0][place],
                other[name][0][place],
            )
    if len(present) != len(there):
        equal = False
        yield _field("sites", len(present), len(there))
    else:
        for site in np.flatnonzero(present != there):
            equal = False
            yield _field(f"present[{site}]", present[site], there[site])
    if equal and recorded.digest != again.digest:
        yield Field("digest", recorded.digest, again.digest)


def kept_in(row: pa.Table) -> Kept | None:
    """Return the moment kept in a row of a recording, if one is."""
    state, present, digest = (row[name][0].as_py() for name in KEPT)
    return (
        None if state is None or present is None or digest is None else Kept(state, present, digest)
    )


def _fields(
    row: pa.Table, other: pa.Table, fields: Fields, mind: Mind, world: World
) -> Iterator[Field]:
    kept, there = kept_in(row), kept_in(other)
    if kept is not None and there is not None:
        yield from kept_fields(kept, there, fields, mind, world)
    elif kept is not there:
        said = ["no" if each is None else each.digest for each in (kept, there)]
        yield Field("state kept", *said)
    for name in row.column_names:
        if name not in KEPT and _differs(row[name], other[name])[0]:
            yield _field(name, row[name][0].as_py(), other[name][0].as_py())


def _differs(column: pa.ChunkedArray, other: pa.ChunkedArray) -> NDArray[np.bool_]:
    """Tell in which rows two columns differ, in a single bit even."""
    if pa.types.is_floating(column.type):
        return _unlike(column.to_numpy(), other.to_numpy())
    if pa.types.is_dictionary(column.type):
        column, other = column.cast(pa.string()), other.cast(pa.string())
    if column.equals(other):
        return np.zeros(len(column), np.bool_)
    return np.array([a != b for a, b in zip(column.to_pylist(), other.to_pylist(), strict=True)])


def _unlike(values: Any, others: Any) -> NDArray[np.bool_]:
    """Tell which elements differ; every not-a-number is the same, zeros of either sign are not."""
    values, others = np.asarray(values), np.asarray(others)
    if values.dtype.kind != "f":
        return values != others
    bits = np.dtype(f"<i{values.dtype.itemsize}")
    return (values.view(bits) != others.view(bits)) & ~(np.isnan(values) & np.isnan(others))


def _field(name: str, recorded: Any, again: Any) -> Field:
    said = [
        repr(each.item() if isinstance(each, np.generic) else each) for each in (recorded, again)
    ]
    return Field(name, *said)


def _written(place: tuple[int, ...], names: tuple[str, ...]) -> str:
    """Return where in a field an element is: its name, then numbers."""
    text = ""
    for axis, index in enumerate(place):
        text += f"[{names[index] if axis == 0 and index < len(names) else index}]"
    return text


def _names(mind: Mind, world: World) -> dict[str, tuple[str, ...]]:
    """Return the names of the elements of the fields that have any."""
    variables = dict.fromkeys(("values", "previous", "changes"), tuple(mind.resolved_variables()))
    behaviours = ("estimates", "likelihoods", "weights", "acts_by_behaviour")
    return {
        **variables,
        "drives": tuple(mind.drives),
        "features": world.feature_names,
        **dict.fromkeys((*behaviours, "successes_by_behaviour"), tuple(mind.behaviours)),
    }
