"""Dotted keys: read, set, and refused with the nearest one where no setting has them."""

from __future__ import annotations

import copy

import pytest
from hypothesis import given
from hypothesis import strategies as st

from animat.files.settings import validated
from animat.files.validation_errors import written
from animat.mind.mind import Mind
from animat.study.file.keys import UnknownKeyError, annotation_of, known_keys, put, read_key
from animat.study.file.settings import CaseSettings
from animat.study.file.study import Study

LETTERS = st.characters(exclude_categories=["C", "Z"], exclude_characters="\"'\\")
PARTS = st.text(LETTERS | st.just(" "), min_size=1)


@given(st.lists(PARTS, min_size=1, max_size=4).map(tuple))
def test_a_key_is_read_as_it_is_written(key):
    assert read_key(written(key)) == key


@pytest.mark.parametrize(
    "text",
    ["", ".", "a.", ".a", "a..b", "a b", "a=1", 'a"b"', '"a', "a\nb", "é", '"a\\"b"', "a[0]"],
)
def test_what_is_no_key_is_refused(text):
    with pytest.raises(UnknownKeyError, match="is no key"):
        read_key(text)


def test_a_part_in_quotes_may_hold_anything():
    assert read_key("mind.variables.'my own'.\"a.b\"") == ("mind", "variables", "my own", "a.b")


def changed(text: str, value: object, base: dict | None = None) -> CaseSettings:
    data = copy.deepcopy(base or {})
    put(data, CaseSettings, read_key(text), value)
    return validated(data, CaseSettings)


def test_a_setting_is_set_and_the_others_stay():
    base = {"mind": {"agent": "RANDOM", "learning": {"rate": 0.25}}}
    settings = changed("mind.learning.cycles", 3, base)
    assert settings == validated(
        {"mind": {"agent": "RANDOM", "learning": {"rate": 0.25, "cycles": 3}}}, CaseSettings
    )


def test_a_part_of_a_default_table_leaves_its_other_parts():
    """A file that gives drives gives all of them; a key changes one number of one."""
    mind = changed("mind.drives.hunger.a.nutrition", 2.0).mind
    assert mind.drives["hunger"].a == {"nutrition": 2.0}
    paper = Mind()
    for name in ("fatigue", "curiosity"):
        assert mind.drives[name] == paper.drives[name]
    assert changed("mind.behaviours.eat.success", {"nutrition": 0.1}).mind.behaviours.keys() == (
        paper.behaviours.keys()
    )


def test_a_variable_of_the_physiology_need_not_be_written_to_be_changed():
    settings = changed("mind.variables.stamina.rate", 2e-4)
    assert settings.mind.resolved_variables()["stamina"].rate == 2e-4


def test_a_whole_table_may_be_new():
    base = {"worlds": {"rich": {"spares": 1}}}
    settings = changed("worlds.poor", {"layout": "scarce"}, base)
    assert set(settings.worlds) == {"rich", "poor"}
    assert changed("worlds.rich.spares", 2, base).worlds["rich"].spares == 2


UNKNOWN = {
    "mind.agnt": 'did you mean "mind.agent"',
    "mnd.agent": 'did you mean "mind.agent"',
    "agent": 'did you mean "mind.agent"',
    "mind.learning.cycle": 'did you mean "mind.learning.cycles"',
    "mind.zzz": "known: agent, physiology",
    "mind.networks": "unknown key",
    "mind.drives.hungr.a.nutrition": 'did you mean "mind.drives.hunger.a.nutrition"',
    "worlds.rihc.spares": 'did you mean "worlds.rich.spares"',
    "mind.agent.x": "mind.agent is no table",
    "steps.x": "steps is no table",
}


@pytest.mark.parametrize(("text", "told"), UNKNOWN.items())
def test_an_unknown_key_is_refused_with_the_nearest(text, told):
    data = {"worlds": {"rich": {}}}
    with pytest.raises(UnknownKeyError) as caught:
        put(data, CaseSettings, read_key(text), 1)
    assert told in str(caught.value)


def test_what_is_written_where_a_table_should_be_is_told():
    with pytest.raises(UnknownKeyError, match="mind is no table"):
        put({"mind": 3}, CaseSettings, ("mind", "agent"), "AF")


def test_every_known_key_can_be_set():
    data = {"worlds": {"rich": {"counts": {"TS": 1}}}}
    known = known_keys(data, Study)
    assert {"mind.agent", "worlds.rich.counts.TS", "mind.drives.hunger.a.nutrition"} < set(known)
    assert "mind.networks" not in known
    for text in known:
        key = read_key(text)
        content = copy.deepcopy(data)
        put(content, Study, key, 1)
        assert annotation_of(Study, key) is not None
        for part in key:
            content = content[part]
        assert content == 1
    assert annotation_of(Study, ("mind", "agnt")) is None
