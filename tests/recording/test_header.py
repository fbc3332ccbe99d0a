"""The head of a recording holds all that a life is a function of, and refuses what it cannot."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from animat.files.settings import SettingsError
from animat.life.engine import ENGINE
from animat.life.life import birth, live_unrecorded
from animat.life.scenario import LifeError, bring_together
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.recording.checkpoint import keep, restored
from animat.recording.header import ended, head_of, read_head
from animat.robot.khepera import Khepera, Sensor
from animat.world.arena import Arena
from animat.world.layout import Layout, Placement
from animat.world.objects import ObjectType
from animat.world.world import World

PRODUCT = Path(__file__).parents[2] / "docs" / "examples" / "product.py"
MADE = {"made": "today", "versions": {"animat": "0.1"}}

OWN = ObjectType(
    name="großer Stein",
    shape=((0.0, 0.0), (41.3, 0.0), (0.0, 35.1)),
    features={"shape": 0.1, "size": 1 / 3},
    affords={"interact": 0.7, "grasp": 1e-300, "shelter": 0.0},
)
WORLD = World(
    Layout(
        placements=(Placement(type=OWN.name, x=250.0, y=251.7, angle=-0.1),),
        types=(OWN,),
        spares=(Placement(type=OWN.name, x=400.0, y=400.0),),
        arena=Arena(width=600.0, height=600.0, left=1.5),
        minimum_gap=31.4,
    ),
    name="§ its own",
    resolution=2.5,
)


def recorded(mind, world, robot=None, seed=5, index=2**64 - 1, steps=100):
    """Return the head of a recording of a few steps, as it is read back."""
    moment = birth(bring_together(mind, world, robot), seed, index)
    head = head_of(moment, steps, 7, MADE)
    live_unrecorded(moment, 30)
    text = ended(head, moment).json_text()
    assert text.isascii()
    return read_head(text), moment


def test_a_setting_comes_back_whole():
    mind = Mind(
        agent="LEARNING",
        physiology="relax",
        consumed=True,
        variables={"warmth": {"law": "linear", "kind": "deficit", "rate": 2e-4, "set_point": 0.9}},
        behaviours={"rest": {"serves": "fatigue", "needs": "shelter", "failure": {"warmth": -0.1}}},
        learning={"hidden_units": 3, "biases": False},
        selector=f"{PRODUCT}:product",
    )
    robot = Khepera(radius=25.0, sensors=(Sensor(x=1 / 3, y=0.1, direction=11.0),) * 8)
    head, moment = recorded(mind, WORLD, robot)
    setting = head.setting()
    assert setting.mind == mind
    assert setting.world == WORLD
    assert setting.robot == robot
    assert setting.mind_parameters.tobytes() == moment.setting.mind_parameters.tobytes()
    assert setting.robot_parameters.tobytes() == moment.setting.robot_parameters.tobytes()
    again = birth(setting, head.seed, head.life)
    live_unrecorded(again, 30)
    assert again.digest == moment.digest
    end = restored(head.kept_end(), head.fields, setting, head.seed, head.life)
    assert end.digest == moment.digest
    assert (head.made, head.first, head.last, head.steps, head.every) == (MADE, 0, 30, 100, 7)


@settings(max_examples=settings().max_examples // 2)
@given(weights=st.lists(st.floats(-1e300, 1e300), min_size=27, max_size=27))
def test_networks_come_back_to_the_bit(small, weights):
    behaviours, features = ("eat", "shelter", "interact"), ("shape", "size")
    networks = Networks(behaviours, features, 2, np.array(weights).reshape(3, 9))
    head, moment = recorded(Mind(agent="AF", networks=networks), small)
    assert head.setting().mind.networks == networks
    assert keep(moment, head.fields) == head.kept_end()


def test_how_a_life_ended_is_told(small):
    for start, death in ((0.999, "stamina high, metabolism"), (0.5, None)):
        variables = {"stamina": {"start": start, "set_point": 0.2}}
        mind = Mind(variables={**variables, "restlessness": {"lethal": False}})
        moment = birth(bring_together(mind, small), 0, 0)
        head = head_of(moment, 100, 7, MADE)
        live_unrecorded(moment, 60)
        assert ended(head, moment).death == death


@pytest.mark.parametrize(
    ("first", "last", "every", "moments"),
    [
        (0, 1, 7, 2),
        (0, 7, 7, 2),
        (0, 8, 7, 3),
        (3, 8, 7, 3),
        (7, 8, 7, 2),
        (3, 7, 7, 2),
        (0, 9, 1, 10),
    ],
)
def test_the_moments_kept_are_counted(small, first, last, every, moments):
    moment = birth(bring_together(Mind(), small), 0, 0)
    head = head_of(moment, 100, every, MADE)
    assert head.model_copy(update={"first": first, "last": last}).moments == moments
    before = [step for step in range(first, last) if step == first or step % every == 0]
    assert len(before) + 1 == moments


def own(drives, likelihoods, serves, u, memory):
    return 0


def test_a_function_without_a_file_is_refused(small):
    moment = birth(bring_together(Mind(selector=own), small), 0, 0)
    with pytest.raises(LifeError, match=r"selector: .* must find own again; .* FILE\.py:NAME"):
        head_of(moment, 100, 7, MADE)


def test_a_function_that_has_changed_or_is_gone_is_refused(small, tmp_path):
    path = tmp_path / "product.py"
    path.write_bytes(PRODUCT.read_bytes())
    head, _ = recorded(Mind(selector=f"{path}:product"), small)
    assert head.setting().mind.selector == f"{path}:product"
    path.write_text(path.read_text().replace("best = 0", "best = 1"))
    with pytest.raises(LifeError, match=r"selector: .*product\.py:product has changed since"):
        head.setting()
    path.write_text("")
    with pytest.raises(SettingsError, match='has no function "product"'):
        head.setting()
    path.unlink()
    with pytest.raises(SettingsError, match="no such file"):
        head.setting()


def test_another_engine_is_refused(small):
    head, _ = recorded(Mind(), small)
    other = head.model_copy(update={"engine": ENGINE + 1})
    with pytest.raises(
        LifeError, match=f"was lived by engine {ENGINE + 1}; this is engine {ENGINE}"
    ):
        other.setting()


def test_a_text_that_is_no_head_is_refused(small):
    head, _ = recorded(Mind(), small)
    good = json.loads(head.json_text())

    def why(text: str) -> list[str]:
        with pytest.raises(SettingsError) as caught:
            read_head(text)
        return list(caught.value.problems)

    reads = "this animat reads format 1"
    assert why("") == why("[]") == why("{}") == [f"is of format None; {reads}"]
    assert why(json.dumps({**good, "format": 2})) == [f"is of format 2; {reads}"]
    seed, soul = why(json.dumps({**good, "seed": -1, "soul": 1}))
    assert seed.startswith("its head: key seed = -1: must be ")
    assert soul.startswith("its head: key soul: unknown key")
    for key in set(good) - {"format"}:
        (line,) = why(json.dumps({name: each for name, each in good.items() if name != key}))
        assert line == f"its head: key {key}: missing key; it must be given"
    mind = {**good["mind"], "physiology": "exces"}
    (line,) = why(json.dumps({**good, "mind": mind}))
    assert 'did you mean "excess"?' in line
