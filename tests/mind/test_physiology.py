import math

import pytest

from animat.mind.physiology import PHYSIOLOGIES, Variable

TABLE_2 = {"nutrition": (1e-4, 0.9), "stamina": (1e-4, 0.2), "restlessness": (1e-3, 0.1)}
NAMES = list(TABLE_2)


@pytest.mark.parametrize("name", PHYSIOLOGIES)
def test_every_physiology_has_the_rates_and_set_points_of_table_2(name):
    physiology = PHYSIOLOGIES[name]
    assert {n: (v.rate, v.set_point) for n, v in physiology.items()} == TABLE_2
    assert list(physiology) == NAMES
    assert {(v.start, v.low, v.high, v.lethal) for v in physiology.values()} == {
        (0.5, 0.0, 1.0, True)
    }


@pytest.mark.parametrize(
    ("name", "laws", "kinds", "margin"),
    [
        ("excess", ("decay", "growth", "growth"), "dee", 0.0),
        ("decay", ("decay", "decay", "decay"), "ddd", 0.05),
        ("relax", ("decay", "relax", "relax"), "dee", 0.05),
        ("linear", ("linear", "linear", "linear"), "dee", 0.0),
    ],
)
def test_a_physiology_is_what_its_name_says(name, laws, kinds, margin):
    variables = PHYSIOLOGIES[name].values()
    assert tuple(v.law for v in variables) == laws
    assert [v.is_deficit for v in variables] == [kind == "d" for kind in kinds]
    assert {v.lethal_margin for v in variables} == {margin}


@pytest.mark.parametrize(
    ("law", "kind", "deficit"),
    [
        ("decay", None, True),
        ("decay", "deficit", True),
        ("relax", None, False),
        ("growth", "excess", False),
        ("linear", "deficit", True),
        ("linear", "excess", False),
        ("mine.py:law", "excess", False),
        (math.exp, "deficit", True),
    ],
)
def test_the_kind_follows_from_the_law_or_is_given(law, kind, deficit):
    assert Variable(law=law, kind=kind, rate=0.1, set_point=0.5).is_deficit == deficit


def test_the_lethal_margin_lies_on_the_side_the_variable_drifts_to():
    falling = Variable(law="decay", rate=0.1, set_point=0.5, low=-1, high=3, lethal_margin=0.25)
    assert (falling.dies_below, falling.dies_above) == (math.nextafter(-0.75, 0), 3)
    rising = Variable(law="growth", rate=0.1, set_point=0.5, low=-1, high=3, lethal_margin=0.25)
    assert (rising.dies_below, rising.dies_above) == (-1, math.nextafter(2.75, 0))
    plain = Variable(law="decay", rate=0.1, set_point=0.5, low=-1, high=3)
    assert (plain.dies_below, plain.dies_above) == (-1, 3)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"rate": 0.0}, r"rate.*greater than 0"),
        ({"rate": -1e-4}, r"rate.*greater than 0"),
        ({"rate": 1.0}, r"rate.*less than 1"),
        ({"rate": math.nan}, r"rate.*finite"),
        ({"rate": "fast"}, r"rate.*number"),
        ({"low": 1.0}, r"low = 1\.0 must be below high = 1\.0"),
        ({"low": 2.0}, r"low = 2\.0 must be below high = 1\.0"),
        ({"high": math.inf}, r"high.*finite"),
        ({"set_point": 1.2}, r"set_point = 1\.2 lies outside the viability zone \[0\.0, 1\.0\]"),
        ({"set_point": -0.1}, r"set_point = -0\.1 lies outside the viability zone"),
        ({"start": 1.5}, r"start = 1\.5 lies outside the viability zone"),
        ({"lethal_margin": 1.0}, r"lethal_margin = 1\.0 leaves no viability zone"),
        ({"lethal_margin": -0.1}, r"lethal_margin.*greater than or equal to 0"),
        ({"lethal_margin": 0.5}, r"start = 0\.5 is lethal at once"),
        ({"lethal_margin": 0.6, "start": 0.6}, r"start = 0\.6 is lethal at once"),
        ({"kind": "excess"}, r'kind = "excess" contradicts law = "decay" \(deficit\)'),
        ({"kind": "defict"}, r"kind.*did you mean \"deficit\""),
        ({"law": "growth", "kind": "deficit"}, r'kind = "deficit" contradicts law = "growth"'),
        ({"law": "linear"}, r'law = "linear" needs kind = "deficit" or "excess"'),
        ({"law": "mine.py:law"}, r'law = "mine\.py:law" needs kind'),
        ({"law": "growht"}, r'law = "growht" is no law, nor FILE\.py:NAME; did you mean "growth"'),
        ({"law": "chaos", "kind": "deficit"}, r"known: decay, relax, growth, linear"),
        ({"sepoint": 0.5}, r"sepoint: unknown key"),
    ],
)
def test_impossible_variables_are_refused(changes, told):
    possible = {"law": "decay", "rate": 1e-4, "set_point": 0.9}
    Variable(**possible)
    with pytest.raises(ValueError, match=told):
        Variable(**{**possible, **changes})


def test_a_variable_that_kills_nobody_may_start_in_the_lethal_margin():
    spared = Variable(
        law="decay", rate=1e-4, set_point=0.9, start=0.01, lethal_margin=0.05, lethal=False
    )
    assert spared.start == 0.01


@pytest.mark.parametrize(("law", "start"), [("decay", 0.0), ("decay", 1.0), ("growth", 1.0)])
def test_a_life_may_start_at_a_bound_of_the_viability_zone(law, start):
    assert Variable(law=law, rate=1e-4, set_point=0.9, start=start).start == start
