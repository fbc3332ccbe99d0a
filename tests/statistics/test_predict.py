import pytest

from animat.statistics.predict import LEAVES, available, predict


@pytest.fixture(scope="module")
def told(planted, readings):
    return {one.claim: one for one in predict(planted, readings)}


def test_the_tree_says_the_planted_rule(told):
    rules = told["C1"].rules
    assert set(rules[0].conditions) == {"overflow ≠ lethal", "effect ≠ 0"}
    assert rules[0].share.value > 0.95
    assert 2 <= len(rules) <= LEAVES
    assert told["C7"].rules[0].conditions == ("cycles ≠ 1",)


def test_every_universe_falls_under_one_rule(told, planted):
    for one in told.values():
        assert sum(rule.universes for rule in one.rules) == planted.num_rows


def test_a_model_predicts_more_than_the_more_frequent_answer(told):
    assert told["C1"].always == pytest.approx(0.75, abs=0.03)
    for score in (told["C1"].tree, told["C1"].pairs):
        assert score.low > 0.95
    assert told["C7"].single.value == told["C7"].tree.value == 1.0


def test_pairs_predict_what_single_readings_cannot(make_universes, combinations, readings):
    """It holds if just one of two is so: no sum of single effects says that."""

    def gain(one):
        return 4.0 if (one["overflow"] == "clamp") != (one["effect"] == "0.2") else 0.5

    universes = make_universes(combinations(copies=3), gain)
    (told,) = (one for one in predict(universes, readings) if one.claim == "C1")
    assert told.single.value < 0.75
    assert told.pairs.low > 0.9


def test_of_a_claim_that_hardly_ever_holds_nothing_is_learnt(told):
    assert "C4" not in told
    assert available()
