import math
import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from animat.numerics import streams
from animat.numerics.compiled import compiled
from animat.numerics.streams import bits, philox4x32, uniforms, whole

PURPOSES = {
    "START": 0,
    "MOTORS": 1,
    "SENSORS": 2,
    "WANDER": 3,
    "WEIGHTS": 4,
    "OUTCOMES": 5,
    "SELECTION": 6,
    "FEATURES": 7,
    "PLACEMENT": 8,
    "LAYOUT": 9,
}

word = st.integers(0, 2**32 - 1)
long_word = st.integers(0, 2**64 - 1)

N = 20_000


@compiled
def fill(seed, life, purpose, first, out):
    for i in range(out.shape[0]):
        out[i] = uniforms(seed, life, purpose, first + i)


def draw(seed=1, life=0, purpose=streams.MOTORS, first=0, n=N):
    out = np.empty((n, 4))
    fill(np.uint64(seed), np.uint64(life), purpose, first, out)
    return out


def words(*values):
    return tuple(int(word) for word in philox4x32(*(np.uint64(value) for value in values)))


def reference(width, counter, key):
    """Philox4xW-10 as the paper writes it, in Python's own integers."""
    mask = 2**width - 1
    multipliers, weyl = {
        32: ((0xD2511F53, 0xCD9E8D57), (0x9E3779B9, 0xBB67AE85)),
        64: (
            (0xD2E7470EE14C6C93, 0xCA5A826395121157),
            (0x9E3779B97F4A7C15, 0xBB67AE8584CAA73B),
        ),
    }[width]
    left, right = list(counter[::2]), list(counter[1::2])
    for turn in range(10):
        keys = [(k + turn * w) & mask for k, w in zip(key, weyl, strict=True)]
        products = [m * x for m, x in zip(multipliers, left, strict=True)]
        high, low = [p >> width for p in products], [p & mask for p in products]
        left = [high[1] ^ right[0] ^ keys[0], high[0] ^ right[1] ^ keys[1]]
        right = [low[1], low[0]]
    return left[0], right[0], left[1], right[1]


@pytest.mark.parametrize(
    ("counter", "key", "expected"),
    [
        ("00000000 " * 4, "00000000 " * 2, "6627e8d5 e169c58d bc57ac4c 9b00dbd8"),
        ("ffffffff " * 4, "ffffffff " * 2, "408f276d 41c83b0e a20bc7c6 6d5451fd"),
        (
            "243f6a88 85a308d3 13198a2e 03707344",
            "a4093822 299f31d0",
            "d16cfe09 94fdcceb 5001e420 24126ea1",
        ),
    ],
)
def test_known_answers_of_random123(counter, key, expected):
    given_words = [int(text, 16) for text in (counter + " " + key).split()]
    assert words(*given_words) == tuple(int(text, 16) for text in expected.split())


@given(st.lists(word, min_size=6, max_size=6))
def test_equals_the_paper_s_algorithm(given_words):
    assert words(*given_words) == reference(32, given_words[:4], given_words[4:])


@given(st.lists(long_word, min_size=6, max_size=6))
def test_the_reference_at_64_bits_is_numpy_s(given_words):
    counter, key = given_words[:4], given_words[4:]
    number = sum(value << (64 * place) for place, value in enumerate(counter))
    before = (number - 1) % 2**256  # NumPy counts up before it draws.
    generator = np.random.Philox(counter=before, key=key[0] | key[1] << 64)
    assert tuple(int(v) for v in generator.random_raw(4)) == reference(64, counter, key)


@given(long_word, long_word, st.integers(0, 255), st.integers(0, 2**56 - 1))
def test_the_address_fills_key_and_counter(seed, life, purpose, index):
    low = 2**32 - 1
    expected = words(
        index & low, life & low, life >> 32, purpose << 24 | index >> 32, seed & low, seed >> 32
    )
    address = (np.uint64(seed), np.uint64(life), purpose, index)
    assert tuple(int(b) for b in bits(*address)) == expected
    assert uniforms(*address) == tuple(b / 2**32 for b in expected)


def test_an_address_takes_plain_integers():
    assert bits(5, 6, 7, 8) == bits(np.uint64(5), np.uint64(6), 7, 8)


def test_purposes_are_fixed_and_apart():
    """A changed purpose is a changed life, so the numbers stand here a second time."""
    named = {name: value for name, value in vars(streams).items() if name.isupper()}
    public = {name: value for name, value in named.items() if not name.startswith("_")}
    assert public == PURPOSES


@pytest.mark.parametrize("part", ["seed", "life", "purpose", "index"])
def test_one_bit_of_an_address_turns_half_of_the_bits(part):
    width = {"seed": 64, "life": 64, "purpose": 8, "index": 56}[part]
    turned = []
    for base in range(64):
        for place in range(width):
            address = {"seed": 11 + base, "life": 3, "purpose": 1, "index": 1000 * base}
            changed = dict(address)
            changed[part] ^= 1 << place
            pair = [
                bits(np.uint64(a["seed"]), np.uint64(a["life"]), a["purpose"], a["index"])
                for a in (address, changed)
            ]
            turned.append(sum(int(x ^ y).bit_count() for x, y in zip(*pair, strict=True)))
    turned = np.array(turned)
    assert turned.min() >= 32
    assert abs(turned.mean() - 64) < 5 * math.sqrt(32 / len(turned))


def test_uniforms_lie_in_the_unit_interval_and_come_near_its_ends():
    drawn = draw(n=200_000)
    assert drawn.min() >= 0
    assert drawn.max() < 1
    assert drawn.min() < 1e-4
    assert drawn.max() > 1 - 1e-4


@pytest.mark.parametrize("lane", range(4))
@pytest.mark.parametrize("purpose", [0, 1, 9])
def test_uniforms_are_uniform(purpose, lane):
    lane_draws = draw(purpose=purpose)[:, lane]
    assert stats.kstest(lane_draws, "uniform").pvalue > 1e-3
    assert abs(lane_draws.mean() - 0.5) < 4 / math.sqrt(12 * N)
    assert abs((lane_draws**2).mean() - 1 / 3) < 4 * math.sqrt(4 / 45 / N)


def test_every_bit_is_fair():
    raw = (draw() * 2**32).astype(np.uint64)
    for place in range(32):
        ones = ((raw >> np.uint64(place)) & np.uint64(1)).mean(axis=0)
        assert np.all(np.abs(ones - 0.5) < 5 * 0.5 / math.sqrt(N))


def correlations(columns):
    """The correlations between all columns, in standard errors."""
    matrix = np.corrcoef(columns, rowvar=False)
    return matrix[np.triu_indices_from(matrix, 1)] * math.sqrt(len(columns))


@pytest.mark.parametrize("lag", [1, 2, 3, 7, 64, 256])
def test_a_stream_does_not_remember(lag):
    drawn = draw()
    joint = np.column_stack([drawn[:-lag], drawn[lag:]])
    assert np.abs(correlations(joint)).max() < 4.5


@pytest.mark.parametrize(
    "addresses",
    [
        [{"life": life} for life in (0, 1, 2, 3, 255, 256, 2**32, 2**32 + 1, 2**63)],
        [{"seed": seed} for seed in (0, 1, 2, 3, 255, 256, 2**32, 2**32 + 1, 2**63)],
        [{"purpose": purpose} for purpose in range(10)],
        [{"first": first} for first in (0, 2**20, 2**31, 2**32, 2**33, 2**48)],
        [{"seed": a, "life": b} for a, b in ((1, 2), (2, 1), (3, 0), (0, 3))],
    ],
    ids=["lives", "seeds", "purposes", "stretches", "swapped"],
)
def test_streams_know_nothing_of_each_other(addresses):
    drawn = np.column_stack([draw(**address) for address in addresses])
    scores = correlations(drawn)
    assert np.abs(scores).max() < 4.5
    assert abs(scores.std() - 1) < 5 / math.sqrt(2 * len(scores))


def test_first_draws_of_many_lives_are_uniform():
    firsts = np.concatenate([draw(life=life, n=1)[0] for life in range(5_000)])
    assert stats.kstest(firsts, "uniform").pvalue > 1e-3
    assert abs(np.corrcoef(firsts[:-4], firsts[4:])[0, 1]) < 4 / math.sqrt(len(firsts))


@given(st.integers(0, 2**32 - 1), st.integers(1, 2**21))
def test_whole_is_the_exact_floor(raw, n):
    assert whole(raw * 2.0**-32, n) == raw * n >> 32


def test_whole_numbers_are_equally_likely():
    counts = np.bincount([whole(u, 6) for u in draw().ravel()], minlength=6)
    assert len(counts) == 6
    assert stats.chisquare(counts).pvalue > 1e-3


SAMPLE = """
import hashlib, struct
import numpy as np
from animat.numerics.streams import bits, uniforms, whole
digest = hashlib.sha256()
for i in range(300):
    seed, life = np.uint64(i * 0x9E3779B97F4A7C15 % 2**64), np.uint64((i << 57 | i) % 2**64)
    index = i * 0x1F123BB5159A55 % 2**56
    digest.update(struct.pack("<4Q", *(int(b) for b in bits(seed, life, i % 256, index))))
    drawn = uniforms(seed, life, i % 256, index)
    digest.update(struct.pack("<4dq", *drawn, whole(drawn[0], i + 1)))
print(digest.hexdigest())
"""


def test_uncompiled_draws_are_the_same_and_warn_of_nothing(capsys):
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "error", "-c", SAMPLE]
    plain = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    exec(SAMPLE, {})
    assert plain.stdout == capsys.readouterr().out
