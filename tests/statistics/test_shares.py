import pytest

from animat.statistics.claims import CLAIMS
from animat.statistics.estimates import share
from animat.statistics.shares import VERDICTS, verdict_shares


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
