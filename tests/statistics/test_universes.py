import numpy as np
import pyarrow as pa
import pytest

from animat.statistics.claims import (
    ABUNDANT_GAIN,
    CELLS,
    CLAIMS,
    FARTHEST,
)
from animat.statistics.estimates import share
from animat.statistics.lives import cell, column
from animat.statistics.paper_claims import judge
from animat.statistics.universes import (
    VERDICTS,
    complete,
    deaths,
    holds,
    judge_universes,
    verdict_shares,
    verdicts_by_value,
)

MEANS = [
    [2_000, 4_000, 1_000, 1_500],
    [2_000, 2_100, 1_900, 2_000],
    [4_000, 2_000, 4_000, 4_100],
    [1_000, 60_000, 1_000, 2_000],
]


@pytest.fixture(scope="module")
def lives(make_lives):
    return make_lives(MEANS)


@pytest.fixture(scope="module")
def likelihoods(make_likelihoods):
    return make_likelihoods([True, False, True, False])


@pytest.fixture(scope="module")
def judged(lives, likelihoods):
    return judge_universes(lives, likelihoods, resamples=999)


def of_universe(table, number):
    return cell(table, universe=number)


@pytest.mark.parametrize("universe", range(len(MEANS)))
def test_a_universe_is_judged_as_a_reproduction_would_be(lives, likelihoods, judged, universe):
    row = judged.to_pylist()[universe]
    assert row["universe"] == universe
    robots = of_universe(likelihoods, universe).drop_columns("universe")
    claims = judge(
        of_universe(lives, universe).drop_columns("universe"),
        robots.rename_columns({"robot": "seed"}),
        resamples=999,
    )
    by_id = {claim.id: claim for claim in claims}
    assert {name: row[name] for name in CLAIMS} == {c.id: c.verdict for c in claims}
    pairs = {"abundant_gain": by_id["C1"], "scarce_gain": by_id["C2"]}
    pairs |= {"gain_difference": by_id["C6"]}
    pairs |= dict(zip(("worlds_blind", "worlds_af"), by_id["C3"].parts, strict=True))
    for name, ours in pairs.items():
        told = [row[name], row[f"{name}_low"], row[f"{name}_high"]]
        np.testing.assert_allclose(told, [ours.ours, ours.low, ours.high], rtol=1e-12)
    assert row["learning_error"] == pytest.approx(by_id["C7"].ours, rel=1e-12)
    assert row["learning_error_low"] <= row["learning_error"] <= row["learning_error_high"]


def test_the_order_of_rows_does_not_matter(lives, likelihoods, judged):
    rng = np.random.default_rng(1)
    mixed = [table.take(rng.permutation(table.num_rows)) for table in (lives, likelihoods)]
    again = judge_universes(*mixed, resamples=999)
    assert again.select(["universe", *CLAIMS]).equals(judged.select(["universe", *CLAIMS]))
    np.testing.assert_allclose(column(again, "abundant_gain_low"),
                               column(judged, "abundant_gain_low"), rtol=1e-12)  # fmt: skip


def test_the_cells_are_told_of(lives, judged):
    for world, agent in CELLS:
        rows = cell(lives, universe=3, world=world, agent=agent)
        told = {what: judged.column(f"{what}_{world}_{agent}")[3].as_py()
                for what in ("mean", "alive", "success")}  # fmt: skip
        assert told["mean"] == pytest.approx(column(rows, "lifespan").mean())
        assert told["alive"] == pytest.approx(column(rows, "censored").mean())
        successes = column(rows, "successes").sum() / column(rows, "acts").sum()
        assert told["success"] == pytest.approx(successes)
    assert judged.column("alive_abundant_AF")[3].as_py() > 0.3


def test_nobody_acted_is_no_rate_of_success(lives, likelihoods):
    none = lives.set_column(
        lives.schema.get_field_index("acts"), "acts", pa.array(np.zeros(lives.num_rows, np.int64))
    ).set_column(
        lives.schema.get_field_index("successes"),
        "successes",
        pa.array(np.zeros(lives.num_rows, np.int64)),
    )
    judged = judge_universes(none, likelihoods, resamples=99)
    assert np.isnan(column(judged, "success_abundant_AF")).all()


def test_every_death_is_counted_once(lives):
    table = deaths(lives)
    assert column(table, "lives").sum() == lives.num_rows
    rows = cell(table, universe=3, world="abundant", agent="AF").to_pylist()
    alive = [row["lives"] for row in rows if row["death_variable"] is None]
    expected = column(cell(lives, universe=3, world="abundant", agent="AF"), "censored").sum()
    assert alive == [expected]


def test_deaths_are_counted_across_dictionaries_that_differ(lives):
    encoded = pa.concat_tables(
        lives.slice(start, 100).set_column(
            lives.schema.get_field_index("agent"),
            "agent",
            lives.slice(start, 100).column("agent").dictionary_encode(),
        )
        for start in range(0, lives.num_rows, 100)
    )
    assert deaths(encoded).equals(deaths(lives))


def test_a_claim_that_is_undecided_does_not_hold(judged):
    for claim in CLAIMS:
        told = judged.column(claim).to_pylist()
        assert holds(judged, claim).tolist() == [verdict == "holds" for verdict in told]


def border(gain, scarce=1.5, error=0.1):
    """One universe whose effects are exact."""
    effects = {
        "abundant_gain": gain,
        "scarce_gain": scarce,
        "worlds_blind": 1.2,
        "worlds_af": 1.3,
        "gain_difference": gain - scarce,
        "learning_error": error,
    }
    return pa.table({name: [float(value)] for name, value in effects.items()})


@pytest.mark.parametrize(
    ("claim", "universe", "verdict"),
    [
        ("C1", border(1.0), "undecided"),
        ("C1", border(np.nextafter(1.0, 2.0)), "holds"),
        ("C1", border(np.nextafter(1.0, 0.0)), "fails"),
        ("C2", border(2.0, scarce=1.0), "undecided"),
        ("C4", border(ABUNDANT_GAIN[0]), "holds"),
        ("C4", border(np.nextafter(ABUNDANT_GAIN[0], 0.0)), "fails"),
        ("C4", border(ABUNDANT_GAIN[1]), "holds"),
        ("C4", border(np.nextafter(ABUNDANT_GAIN[1], 9.0)), "fails"),
        ("C5", border(2.0, scarce=1.2499), "fails"),
        ("C6", border(1.5, scarce=1.5), "undecided"),
        ("C6", border(1.5001, scarce=1.5), "holds"),
        ("C7", border(2.0, error=FARTHEST), "holds"),
        ("C7", border(2.0, error=np.nextafter(FARTHEST, 1.0)), "fails"),
    ],
)
def test_at_the_borders_the_value_alone_decides(claim, universe, verdict):
    assert verdicts_by_value(universe)[claim] == [verdict]


def test_a_universe_that_lacks_something_is_found(lives, likelihoods):
    some = lives.filter(column(lives, "universe") * 1000 + column(lives, "life") != 1005)
    taught = likelihoods.filter(column(likelihoods, "universe") != 2)
    assert complete(some, taught, 30).tolist() == [0, 3]
    with pytest.raises(ValueError, match="same lives in its four cells"):
        judge_universes(some, likelihoods)
    with pytest.raises(ValueError, match="different universes"):
        judge_universes(lives, taught)
    first_robot = (column(likelihoods, "robot") == 0) & (column(likelihoods, "universe") == 1)
    with pytest.raises(ValueError, match="one likelihood a robot"):
        judge_universes(lives, likelihoods.filter(~first_robot))


def test_lives_that_are_not_of_the_four_cells_are_refused(lives, likelihoods):
    other = lives.set_column(
        lives.schema.get_field_index("agent"),
        "agent",
        pa.array(["ORACLE" if a == "AF" else a for a in lives.column("agent").to_pylist()]),
    )
    with pytest.raises(ValueError, match="four cells"):
        judge_universes(other, likelihoods)
    with pytest.raises(ValueError, match="four cells"):
        judge_universes(lives.slice(0, 0), likelihoods)


def test_lives_cut_at_different_caps_are_refused(lives, likelihoods):
    spans, alive = column(lives, "lifespan").copy(), column(lives, "censored").copy()
    spans[0], alive[0] = 10, True
    cut = lives.set_column(lives.schema.get_field_index("lifespan"), "lifespan", pa.array(spans))
    cut = cut.set_column(cut.schema.get_field_index("censored"), "censored", pa.array(alive))
    with pytest.raises(ValueError, match="one cap"):
        judge_universes(cut, likelihoods)


def test_of_a_single_life_and_a_single_robot_nothing_is_decided(make_lives, make_likelihoods):
    table = judge_universes(
        make_lives([[1_000.0, 9_000.0, 900.0, 1_000.0]], lives=1),
        make_likelihoods([True], robots=1),
    )
    assert {table[claim][0].as_py() for claim in CLAIMS} == {"undecided"}
    assert np.isfinite(table["abundant_gain"][0].as_py())


def test_the_shares_of_a_claim_add_up_and_have_wilsons_interval(planted):
    rows = verdict_shares(planted).to_pylist()
    assert [(row["claim"], row["verdict"]) for row in rows] == [
        (claim, verdict) for claim in CLAIMS for verdict in VERDICTS
    ]
    for claim in CLAIMS:
        of_claim = [row for row in rows if row["claim"] == claim]
        assert sum(row["universes"] for row in of_claim) == planted.num_rows
        assert sum(row["share_by_value"] for row in of_claim) == pytest.approx(1.0)
        for row in of_claim:
            expected = share(row["universes"], planted.num_rows)
            assert (row["share"], row["low"], row["high"]) == expected


def test_a_planted_effect_holds_in_its_share_of_universes(planted):
    rows = {(row["claim"], row["verdict"]): row for row in verdict_shares(planted).to_pylist()}
    assert rows["C1", "holds"]["share"] == pytest.approx(0.25, abs=0.03)
    assert rows["C4", "fails"]["share"] > 0.9
    assert rows["C7", "holds"]["share"] == 0.5
    # Where there is no effect, half of the estimates lie on either side of nothing.
    assert rows["C2", "undecided"]["share"] > 0.85
    assert rows["C2", "holds"]["share_by_value"] == pytest.approx(0.5, abs=0.15)
    assert rows["C2", "undecided"]["share_by_value"] == 0.0
