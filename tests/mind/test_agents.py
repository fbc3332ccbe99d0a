import pytest

from animat.mind.agents import ACCEPT_ALL, AGENTS, ASK_NETWORKS, ASK_TRUTH
from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.mind.selection import SELECTORS


@pytest.mark.parametrize(
    ("agent", "judge", "learns", "mortal", "selector"),
    [
        ("BLIND", ACCEPT_ALL, False, True, "winner_take_all"),
        ("AF", ASK_NETWORKS, False, True, "winner_take_all"),
        ("LEARNING", ACCEPT_ALL, True, False, "winner_take_all"),
        ("ORACLE", ASK_TRUTH, False, True, "winner_take_all"),
        ("RANDOM", ACCEPT_ALL, False, True, "random"),
    ],
)
def test_an_agent_is_what_its_name_says(agent, judge, learns, mortal, selector):
    record = parameters(Mind(agent=agent), ("grasp", "shelter", "interact"))
    assert record.judge == judge
    assert bool(record.learns) == learns
    assert bool(record.mortal) == mortal
    assert record.selector == SELECTORS[selector]


def test_a_mind_takes_each_agent_there_is_and_no_other():
    assert set(AGENTS) == {"BLIND", "AF", "LEARNING", "ORACLE", "RANDOM"}
    assert {Mind(agent=name).nature for name in AGENTS} == set(AGENTS.values())
    with pytest.raises(ValueError, match=r"BLIND.*AF.*LEARNING.*ORACLE.*RANDOM"):
        Mind(agent="blind")


@pytest.mark.parametrize("agent", AGENTS)
@pytest.mark.parametrize("death", [True, False])
def test_whether_it_may_die_can_be_set_for_every_agent(agent, death):
    assert Mind(agent=agent, death=death).mortal == death
