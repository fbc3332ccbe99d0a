"""Identities: equal ones are equal lives, and what the kernel reads makes another."""

from __future__ import annotations

import pytest

from animat.life.lives import live_many
from animat.life.scenario import LifeError
from animat.mind.mind import Mind
from animat.robot.khepera import Khepera
from animat.study.plan import identity as module
from animat.study.plan.identity import Lived, identity
from animat.world.world import World

AGENTS = ("BLIND", "LEARNING", "ORACLE", "RANDOM")

LEARNING = {
    "cycles": {"learning": {"cycles": 2}},
    "rate": {"learning": {"rate": 0.1}},
    "threshold": {"learning": {"threshold": 0.3}},
}
ASKING = {
    "noise": {"feature_noise": 0.4},
    "biases": {"learning": {"biases": False}},
    "hidden units": {"learning": {"hidden_units": 3}},
}
TRUSTING = {"likelihood threshold": {"likelihood_threshold": 0.9}}
ALWAYS = {
    "error": {"error": "absolute"},
    "overflow": {"overflow": "lethal"},
    "a rate": {"variables": {"nutrition": {"rate": 3e-4}}},
    "speed": {"cruise_speed": 4},
    "gate": {"gate": "always"},
}
CHANGES = LEARNING | ASKING | TRUSTING | ALWAYS


def lived(world=None, robot=None, seed=1, steps=2_000, taught="", **settings):
    mind = Mind(**settings)
    return Lived(
        mind, world or World.abundant(), robot or Khepera(), mind.functions(), seed, steps, taught
    )


def table(one):
    return live_many(one.mind, one.world, lives=12, seed=one.seed, steps=one.steps).table


@pytest.mark.parametrize("agent", AGENTS)
@pytest.mark.parametrize("selector", [None, "affordance_times_drive"])
def test_lives_of_equal_identity_are_equal(agent, selector):
    """Every change of a mind makes another identity, or no other life."""
    plain = lived(agent=agent, selector=selector)
    rows = table(plain)
    shared = set()
    for name, change in CHANGES.items():
        changed = lived(agent=agent, selector=selector, **change)
        if identity(changed) == identity(plain):
            shared.add(name)
            assert table(changed).equals(rows), name
    assert shared == expected(agent, selector)


def expected(agent, selector):
    """The changes an agent never looks at."""
    if agent == "LEARNING":
        return {*TRUSTING, "overflow"}  # it cannot die
    if agent == "ORACLE":
        return {*LEARNING, *ASKING}
    asks = selector is not None
    return {*LEARNING, *TRUSTING} | (set() if asks else set(ASKING))


def test_what_an_agent_never_looks_at_still_stands_in_its_trace():
    for change in ASKING.values():
        plain, changed = lived(agent="BLIND"), lived(agent="BLIND", **change)
        assert identity(plain) == identity(changed)
        assert identity(plain, traced=True) != identity(changed, traced=True)


OTHERS = {
    "seed": {"seed": 2},
    "cap": {"steps": 2_001},
    "world": {"world": World.scarce()},
    "name of the world": {"world": World(World.abundant().layout, "Eden")},
    "resolution": {"world": World(World.abundant().layout, "abundant", 1.0)},
    "robot": {"robot": Khepera(turn_noise=0.1)},
    "agent": {"agent": "ORACLE"},
    "a name": {"behaviours": {"feed": {"serves": "hunger", "needs": "grasp"}}},
}


@pytest.mark.parametrize("what", OTHERS)
def test_what_lives_are_lived_in_makes_another_identity(what):
    assert identity(lived(**OTHERS[what])) != identity(lived())


def test_networks_that_are_given_count_where_they_are_asked():
    for agent, counts in (("BLIND", False), ("LEARNING", True)):
        one, other = (identity(lived(agent=agent, taught=t)) for t in ("a", "b"))
        assert (one != other) == counts


def test_another_engine_lives_other_lives(monkeypatch):
    before = identity(lived())
    monkeypatch.setattr(module, "ENGINE", module.ENGINE + 1)
    assert identity(lived()) != before


WALK = """
def walk(readings, aheads, sides, memory, u_a, u_b, speed, turn):
    return speed, speed - {number}
"""


def test_a_function_counts_by_what_it_does_and_not_by_where_it_lies(tmp_path):
    identities = {}
    for name, number in (("a", 1), ("b", 1), ("c", 2)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "own.py").write_text(WALK.format(number=number))
        identities[name] = identity(lived(wander=f"{tmp_path / name / 'own.py'}:walk"))
    assert identities["a"] == identities["b"]
    assert len({identity(lived()), *identities.values()}) == 3


def test_a_function_that_nobody_can_name_is_refused():
    unknown = [object()]

    def walk(readings, aheads, sides, memory, u_a, u_b, speed, turn):
        return (speed, speed) if unknown else (0, 0)

    functions = lived().functions._replace(wander=walk)
    with pytest.raises(LifeError, match="walk depends on unknown, which is of type object"):
        identity(lived()._replace(functions=functions))


def test_what_does_not_fit_together_is_refused():
    with pytest.raises(LifeError, match="spare"):
        identity(lived(consumed=True))
