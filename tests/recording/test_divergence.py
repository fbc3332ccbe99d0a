"""Where two recordings part: the first row, and every field of it that differs."""

from __future__ import annotations

import math
import struct

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.life.life import birth, live_unrecorded
from animat.life.scenario import bring_together
from animat.mind.mind import Mind
from animat.recording.checkpoint import Kept, fields_of, keep
from animat.recording.divergence import KEPT, Field, kept_fields, parted

ROWS = 6


@pytest.fixture(scope="module")
def moment(small):
    moment = birth(bring_together(Mind(agent="LEARNING"), small), 1, 2)
    live_unrecorded(moment, 500)
    return moment


@pytest.fixture(scope="module")
def named(moment):
    """What gives the fields their names."""
    setting = moment.setting
    return fields_of(moment.states.dtype), setting.mind, setting.world


def rows(moment=None, **columns):
    """Return a few rows of a recording, the moment kept in the third."""
    told = {
        "step": list(range(ROWS)),
        "x": [0.5] * ROWS,
        "object": ["TS", None, "TS", "CL", None, "CL"],
        **columns,
    }
    table = pa.table(told)
    place = table.column_names.index("object")
    table = table.set_column(place, "object", table["object"].dictionary_encode())
    kept = [None] * ROWS if moment is None else [None, None, moment, None, None, None]
    for number, name in enumerate(KEPT):
        values = [None if one is None else one[number] for one in kept]
        kind = pa.string() if name == "kept_digest" else pa.binary()
        table = table.append_column(name, pa.array(values, kind))
    return table


def changed(moment, field, place, value):
    """Return a moment as kept, with another value in a field."""
    other = moment.copy()
    if field == "present":
        other.present[0, place] = value
    else:
        other.states[field][(0, *np.atleast_1d(place).astype(int))] = value
    return keep(other, fields_of(moment.states.dtype))


def test_equal_rows_do_not_part(moment, named):
    assert parted(rows(), rows(), *named) is None
    kept = keep(moment, named[0])
    assert parted(rows(kept), rows(kept), *named) is None


@given(row=st.integers(0, ROWS - 1), later=st.integers(0, ROWS - 1))
def test_the_first_row_that_differs_is_told(named, row, later):
    xs, steps = [0.5] * ROWS, list(range(ROWS))
    xs[row] = 0.25
    steps[max(row, later)] = -7
    found = parted(rows(), rows(x=xs, step=steps), *named)
    assert found is not None
    fields = [Field("x", "0.5", "0.25")]
    if later <= row:
        fields.insert(0, Field("step", str(row), "-7"))
    assert found == (row, tuple(fields))


@given(value=st.floats(allow_nan=False), other=st.floats(allow_nan=False))
def test_numbers_are_compared_to_the_last_bit_and_told_so(named, value, other):
    found = parted(rows(x=[value] * ROWS), rows(x=[other] * ROWS), *named)
    if struct.pack("d", value) == struct.pack("d", other):
        assert found is None
    else:
        assert found is not None
        ((_, old, new),) = found[1]
        assert struct.pack("2d", float(old), float(new)) == struct.pack("2d", value, other)


def test_every_not_a_number_is_the_same(named):
    (odd,) = struct.unpack("d", struct.pack("Q", (0x7FF8 << 48) + 5))
    assert math.isnan(odd)
    assert parted(rows(x=[math.nan] * ROWS), rows(x=[odd] * ROWS), *named) is None
    assert parted(rows(x=[math.nan] * ROWS), rows(), *named) is not None


@pytest.mark.parametrize(
    ("row", "word", "told"), [(0, "TL", "'TL'"), (0, None, "None"), (1, "TS", "'TS'")]
)
def test_words_differ_and_so_does_none(named, row, word, told):
    words = ["TS", None, "TS", "CL", None, "CL"]
    before = repr(words[row])
    words[row] = word
    assert parted(rows(), rows(object=words), *named) == (row, (Field("object", before, told),))


def test_a_life_that_has_ended_earlier_parts_at_its_end(named):
    whole, short = rows(), rows().slice(0, 4)
    assert parted(whole, short, *named) == (4, (Field("life", "goes on", "has ended"),))
    assert parted(short, whole, *named) == (4, (Field("life", "has ended", "goes on"),))


@pytest.mark.parametrize(
    ("field", "place", "name"),
    [
        ("x", (), "x"),
        ("values", 1, "values[stamina]"),
        ("previous", 0, "previous[nutrition]"),
        ("drives", 2, "drives[curiosity]"),
        ("features", 1, "features[size]"),
        ("weights", (2, 8), "weights[interact][8]"),
        ("acts_by_behaviour", 0, "acts_by_behaviour[eat]"),
        ("abandoned", 3, "abandoned[3]"),
        ("mode", (), "mode"),
        ("dead", (), "dead"),
        ("present", 2, "present[2]"),
    ],
)
def test_a_moment_that_differs_is_told_by_the_names_of_its_fields(
    moment, named, field, place, name
):
    other = changed(moment, field, place, 7 if field != "dead" else True)
    found = parted(rows(keep(moment, named[0])), rows(other), *named)
    assert found is not None
    row, ((told, old, new),) = found
    assert (row, told) == (2, name)
    was = moment.present[0] if field == "present" else moment.states[field][0]
    assert old == repr(np.asarray(was)[place].item())
    assert new in {"7", "7.0", "True"}


def test_the_state_is_told_before_what_the_trace_says_of_the_step(moment, named):
    other = changed(moment, "values", 0, 0.25)
    xs = [0.5, 0.5, 0.25, 0.5, 0.5, 0.5]
    found = parted(rows(keep(moment, named[0])), rows(other, x=xs), *named)
    assert found is not None
    assert [name for name, *_ in found[1]] == ["values[nutrition]", "x"]


def test_a_moment_that_one_has_kept_and_the_other_has_not_is_told(moment, named):
    kept = keep(moment, named[0])
    assert parted(rows(kept), rows(), *named) == (2, (Field("state kept", kept.digest, "no"),))
    assert parted(rows(), rows(kept), *named) == (2, (Field("state kept", "no", kept.digest),))


def test_a_digest_alone_can_differ(moment, named):
    kept = keep(moment, named[0])
    other = kept._replace(digest="0" * 32)
    assert list(kept_fields(kept, other, *named)) == [Field("digest", kept.digest, "0" * 32)]
    odd = Kept(kept.state, kept.present + b"\1", "0" * 32)
    sites = len(kept.present)
    assert list(kept_fields(kept, odd, *named)) == [Field("sites", str(sites), str(sites + 1))]
