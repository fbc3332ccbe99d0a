import json

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from animat.statistics.claims import ABUNDANT_GAIN, CELLS, SCARCE_GAIN, above, inside
from animat.statistics.estimates import Estimate
from animat.statistics.paper_claims import Claim, claims_json, judge

from .tables import make_likelihoods, make_lives


def lives(lives_table, means, n=400, spread=0.5, seed=1, **settings):
    """Four cells with exactly the mean lifespans given: rich blind, rich af, poor blind, poor af.

    Lives of one number are independent of each other.
    """
    names = [("abundant", "BLIND"), ("abundant", "AF"), ("scarce", "BLIND"), ("scarce", "AF")]
    rng = np.random.default_rng(seed)
    planted = {}
    for name, mean in zip(names, means, strict=True):
        drawn = rng.gamma(1 / spread**2, size=n)
        planted[name] = np.rint(1e6 * mean * drawn / drawn.mean())
    return lives_table(planted, **settings)


def judged(table, **settings):
    """The claims C1 to C6."""
    return judge(table, make_likelihoods(2), **settings)[:6]


def learning(likelihoods):
    """The claim C7."""
    lives = make_lives({cell: [10, 20] for cell in CELLS})
    return judge(lives, likelihoods, resamples=3_999)[6]


def verdicts(table):
    return {claim.id: claim.verdict for claim in judged(table, resamples=999)}


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (1.0001, 2.0, "holds"),
        (1.0, 2.0, "undecided"),
        (0.5, 1.0, "undecided"),
        (0.5, 0.9999, "fails"),
        (0.5, 2.0, "undecided"),
        (np.nan, np.nan, "undecided"),
    ],
)
def test_a_direction_is_decided_by_the_whole_interval(low, high, expected):
    assert above(Estimate(1.5, low, high), 1.0) == expected


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (1.75, 2.25, "holds"),
        (1.7499, 2.25, "undecided"),
        (1.75, 2.2501, "undecided"),
        (1.0, 3.0, "undecided"),
        (2.25, 2.5, "undecided"),
        (1.5, 1.75, "undecided"),
        (2.2501, 3.0, "fails"),
        (1.0, 1.7499, "fails"),
        (np.nan, np.nan, "undecided"),
    ],
)
def test_a_size_is_decided_by_the_whole_interval(low, high, expected):
    assert inside(Estimate(2.0, low, high), (1.75, 2.25)) == expected


def test_the_bands_of_both_gains_meet_halfway_between_them():
    assert ABUNDANT_GAIN[0] == SCARCE_GAIN[1] == (2.0 + 1.5) / 2


def test_a_world_as_the_paper_saw_it_holds_in_everything(lives_table, likelihoods_table):
    claims = judge(lives(lives_table, [2, 4, 1, 1.5], n=2000), likelihoods_table(100))
    assert [claim.id for claim in claims] == ["C1", "C2", "C3", "C4", "C5", "C6", "C7"]
    assert {claim.verdict for claim in claims} == {"holds"}
    for claim, ours in zip(claims, [2, 1.5, 2, 2, 1.5, 0.5, 0.05], strict=True):
        assert claim.ours == pytest.approx(ours, rel=1e-5)
        assert claim.low <= claim.ours + 1e-12
        assert claim.ours <= claim.high + 1e-12


@pytest.mark.parametrize(
    ("claim", "means", "expected"),
    [
        ("C1", [2, 1.5, 1, 1], "fails"),
        ("C1", [2, 2, 1, 1], "undecided"),
        ("C1", [2, 2.6, 1, 1], "holds"),
        ("C2", [2, 2, 1, 0.7], "fails"),
        ("C2", [2, 2, 1, 1], "undecided"),
        ("C2", [2, 2, 1, 1.3], "holds"),
        ("C3", [1, 1, 1.5, 1.5], "fails"),
        ("C3", [1, 2, 1.5, 1], "fails"),
        ("C3", [2, 1, 1, 1.5], "fails"),
        ("C3", [1, 2, 1, 1], "undecided"),
        ("C3", [2, 1, 1, 1], "undecided"),
        ("C3", [1.5, 1.5, 1, 1], "holds"),
        ("C4", [1, 2.8, 1, 1], "fails"),
        ("C4", [1, 1.3, 1, 1], "fails"),
        ("C4", [1, 1.75, 1, 1], "undecided"),
        ("C4", [1, 2.25, 1, 1], "undecided"),
        ("C4", [1, 2, 1, 1], "holds"),
        ("C5", [1, 1, 1, 2.1], "fails"),
        ("C5", [1, 1, 1, 1], "fails"),
        ("C5", [1, 1, 1, 1.25], "undecided"),
        ("C5", [1, 1, 1, 1.75], "undecided"),
        ("C5", [1, 1, 1, 1.5], "holds"),
        ("C6", [1, 1.5, 1, 2], "fails"),
        ("C6", [1, 1.5, 1, 1.5], "undecided"),
        ("C6", [1, 2, 1, 1.5], "holds"),
    ],
)
def test_planted_lifespans_get_the_verdict_they_deserve(lives_table, claim, means, expected):
    assert verdicts(lives(lives_table, means))[claim] == expected


def test_with_few_lives_the_same_means_leave_a_claim_open(lives_table):
    assert verdicts(lives(lives_table, [1, 1.3, 1, 1]))["C1"] == "holds"
    assert verdicts(lives(lives_table, [1, 1.3, 1, 1], n=10))["C1"] == "undecided"


def test_the_worlds_are_compared_for_both_agents_and_the_worse_decides(lives_table):
    claim = judged(lives(lives_table, [3, 1, 1, 1.5]), resamples=999)[2]
    assert [(part.label, part.verdict) for part in claim.parts] == [
        ("BLIND", "holds"),
        ("AF", "fails"),
    ]
    assert claim.ours == claim.parts[1].ours == pytest.approx(1 / 1.5, rel=1e-5)
    assert "decides (AF)" in claim.how
    assert "BLIND 3.00 holds, AF 0.67 fails" in claim.how


def test_of_two_agents_for_whom_it_holds_the_less_sure_one_is_shown(lives_table):
    claim = judged(lives(lives_table, [1.5, 3, 1, 1]), resamples=999)[2]
    assert claim.verdict == "holds"
    assert claim.ours == pytest.approx(1.5, rel=1e-5)


def test_how_says_what_was_cut(lives_table):
    whole = judged(lives(lives_table, [2, 4, 1, 1.5], n=50), resamples=99)
    assert "restricted" not in whole[0].how
    cut = judged(lives(lives_table, [2, 4, 1, 1.5], n=50, cap=5_000_000), resamples=99)
    assert "paired bootstrap over lives, means restricted at 5,000,000 steps" in cut[0].how
    assert "of 100 lives went on" in cut[0].how
    assert "of 200 lives went on" in cut[5].how


def test_a_life_that_is_missing_in_a_cell_is_left_out_in_all(lives_table):
    table = lives(lives_table, [2, 4, 1, 1.5], n=50)
    some = table.slice(3)
    without = table.filter(pc.field("life") >= 3)
    assert judged(some, resamples=99) == judged(without, resamples=99)
    with pytest.raises(ValueError, match="four cells"):
        judged(table.slice(50))


def test_verdicts_and_intervals_are_the_same_again(lives_table):
    table = lives(lives_table, [2, 3, 1, 1.2], n=60)
    once = judged(table, resamples=499, seed=5)
    assert once == judged(table, resamples=499, seed=5)
    assert once != judged(table, resamples=499, seed=6)


def test_the_order_of_the_rows_does_not_matter_to_paired_lives(lives_table):
    table = lives(lives_table, [2, 3, 1, 1.2], n=60)
    shuffled = table.take(pa.array(np.random.default_rng(1).permutation(table.num_rows)))
    assert judged(table, resamples=99) == judged(shuffled, resamples=99)


@pytest.mark.parametrize(
    ("seeds", "wrong", "expected"),
    [(100, 0, "holds"), (100, 3, "holds"), (100, 12, "undecided"), (100, 60, "fails")],
)
def test_learning_is_judged_by_the_worst_mean_likelihood(likelihoods_table, seeds, wrong, expected):
    claim = learning(likelihoods_table(seeds, wrong, ("eat", "TS"), 0.0))
    assert claim.verdict == expected
    assert claim.ours == pytest.approx(0.05 + 0.95 * wrong / seeds)
    assert claim.low <= claim.ours <= claim.high
    assert f"{seeds - wrong} of {seeds} robots" in claim.how


@pytest.mark.parametrize(
    ("flaw", "value", "verdict"),
    [
        (("eat", "TS"), 0.81, "holds"),
        (("eat", "TS"), 0.79, "fails"),
        (("eat", "CL"), 0.19, "holds"),
        (("eat", "CL"), 0.21, "fails"),
        (("shelter", "TL"), 0.5, "fails"),
        (("shelter", "CS"), 0.5, "fails"),
        (("interact", "CL"), 0.79, "fails"),
    ],
)
def test_every_likelihood_has_its_border(likelihoods_table, flaw, value, verdict):
    claim = learning(likelihoods_table(10, 10, flaw, value))
    assert claim.verdict == verdict
    wrong = [part.label for part in claim.parts if part.verdict != "holds"]
    assert wrong == ([] if verdict == "holds" else [" ".join(flaw)])


def test_interacting_must_be_near_one_whatever_the_table_says(likelihoods_table):
    table = likelihoods_table(10, 10, ("interact", "TS"), 0.05)
    afforded = [0.0 if (row["network"], row["object"]) == ("interact", "TS") else row["afforded"]
                for row in table.to_pylist()]  # fmt: skip
    column = table.schema.get_field_index("afforded")
    claim = learning(table.set_column(column, "afforded", pa.array(afforded)))
    assert claim.ours == pytest.approx(0.95)
    assert claim.verdict == "fails"


def test_learning_shows_the_mean_of_every_network_and_object(likelihoods_table, paper_table):
    claim = learning(likelihoods_table(50, 10, ("eat", "TS"), 0.45))
    parts = {part.label: part for part in claim.parts}
    assert set(parts) == {f"{network} {thing}" for network, thing in paper_table}
    assert parts["eat TS"].ours == pytest.approx(0.85)
    assert parts["eat TS"].low < 0.85 < parts["eat TS"].high
    assert parts["eat TL"].ours == pytest.approx(0.05)


@pytest.mark.parametrize("fault", ["a row lacks", "a row twice", "twice for another", "none"])
def test_likelihoods_that_lack_something_are_refused(likelihoods_table, fault):
    table = likelihoods_table(3)
    rows = list(range(table.num_rows))
    rows = {
        "a row lacks": rows[:-1],
        "a row twice": [*rows, 0],
        "twice for another": [*rows[:-1], rows[-2]],
        "none": [],
    }[fault]
    with pytest.raises(ValueError, match=r"one likelihood|empty"):
        learning(table.take(pa.array(rows, pa.int64())))


def test_json_says_everything_and_has_no_number_that_is_none():
    claim = Claim("C1", "é", "p", 1.5, float("nan"), float("inf"), "undecided", "h")
    assert json.loads(claims_json([claim])) == [
        {"id": "C1", "text": "é", "paper": "p", "ours": 1.5, "low": None, "high": None,
         "verdict": "undecided", "how": "h", "parts": []}
    ]  # fmt: skip


def test_json_names_the_parts(likelihoods_table):
    (record,) = json.loads(claims_json([learning(likelihoods_table(20))]))
    first = record["parts"][0]
    assert (first["label"], first["verdict"]) == ("eat TS", "holds")
    assert [first[key] for key in ("ours", "low", "high")] == pytest.approx([0.95] * 3)
