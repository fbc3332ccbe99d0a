"""Studies: read from files, changed from the command line, written, and read back."""

from __future__ import annotations

import importlib
import math
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import animat.study
from animat.files.settings import SettingsError, read_toml, validated
from animat.life.life import live
from animat.mind.mind import Mind
from animat.study.file.cases import cases
from animat.study.file.read import read_study
from animat.study.file.settings import CaseSettings, LifeSettings, Teacher, WorldChoice
from animat.study.file.study import MOST_LIVES, Record, Study
from animat.world.world import World

TEXT = """
name = "x"
[mind]
physiology = "decay"
[worlds.rich]
layout = "random"
counts = { TS = 1 }
[teacher]
world = "rich"
[design.grid]
"mind.agent" = ["BLIND", "AF"]
"""


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "study.toml"
    path.write_text(TEXT)
    return path


def refused(file: Path, *overrides: str, text: str | bytes | None = None) -> list[str]:
    if text is not None:
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(SettingsError) as caught:
        read_study(file, overrides)
    assert str(caught.value).split("\n") == list(caught.value.problems)
    return [line.replace(str(file), "FILE") for line in caught.value.problems]


def test_a_study_is_a_settings_file_with_more_in_it(file):
    study = read_study(file)
    assert study.mind == Mind(physiology="decay")
    assert study.teacher == Teacher(world=WorldChoice(layout="rich"))
    assert (study.seed, study.lives, study.steps, study.paired) == (0, 100, 300_000, True)
    assert set(CaseSettings.model_fields) == {*LifeSettings.model_fields} | {
        "steps", "worlds", "teacher"
    }  # fmt: skip


OVERRIDES = {
    "lives=7": ("lives", 7),
    "name=other": ("name", "other"),
    'name = "a b"': ("name", "a b"),
    "paired=false": ("paired", False),
    "measures=['likelihoods']": ("measures", ["likelihoods"]),
    "record={what='all', lives=2}": ("record", Record(what="all", lives=2)),
    "record.what=every:5": ("record", Record(what="every:5")),
    "teacher.world=scarce": ("teacher", Teacher(world=WorldChoice(layout="scarce"))),
    "teacher.world.spares=1": ("teacher", Teacher(world=WorldChoice(layout="rich", spares=1))),
    "worlds.rich.counts.TS=5": (
        "worlds",
        {"rich": WorldChoice(layout="random", counts={"TS": 5})},
    ),
    "mind.learning.rate=1e-3": ("mind", Mind(physiology="decay", learning={"rate": 1e-3})),  # pyright: ignore
    "mind.drives.hunger.a.nutrition=2": (
        "mind",
        Mind(
            physiology="decay",
            drives=Mind().drives | {"hunger": {"a": {"nutrition": 2.0}}},  # pyright: ignore
        ),
    ),
    "world.layout=islands/a-b.toml": ("world", WorldChoice(layout="islands/a-b.toml")),
}


@pytest.mark.parametrize("text", OVERRIDES)
def test_a_line_is_changed_for_one_call(file, text):
    name, value = OVERRIDES[text]
    changed, before = read_study(file, [text]), read_study(file)
    assert getattr(changed, name) == value != getattr(before, name)
    assert changed.model_copy(update={name: getattr(before, name)}) == before


def test_a_later_change_goes_before_an_earlier_one(file):
    assert read_study(file, ["lives=7", "lives=8"]).lives == 8
    worlds = ["teacher.world=scarce", "teacher.world.spares=1"]
    assert read_study(file, worlds).teacher == (
        Teacher(world=WorldChoice(layout="scarce", spares=1))
    )
    study = read_study(file, ["design.grid={}", 'design.grid."mind.gate"=["always"]'])
    assert study.design.grid == {"mind.gate": ["always"]}


WRONG_OVERRIDES = {
    "lives": '--set "lives": is not written key=value',
    "=3": '--set "=3": "" is no key',
    "lifes=3": '--set "lifes=3": unknown key; did you mean "lives"?',
    "mind.agnt=AF": 'unknown key; did you mean "mind.agent"?',
    "lives=0": "--set: key lives = 0: must be greater than or equal to 1",
    "lives=many": '--set: key lives = "many": must be a whole number',
    "lives=3 4": "its value is neither TOML nor a bare word",
    "lives=[": "its value is neither TOML nor a bare word",
    "lives=": "its value is neither TOML nor a bare word",
    "name='a": "its value is neither TOML nor a bare word",
    "lives=3\nseed=4": "its value is neither TOML nor a bare word",
    "lives=3\n[mind]": "its value is neither TOML nor a bare word",
    "name=2020-01-01\nx=1": "its value is neither TOML nor a bare word",
    f"lives={'[' * 100_000}": "its value is neither TOML nor a bare word",
    "mind.agent=ORACLE": "--set mind.agent: the design varies it; change the design",
    "mind={agent='AF'}": "--set mind: the design varies it; change the design",
    "mind.gate=alway": '--set: key mind.gate = "alway": must be one of',
    "worlds.rihc.spares=1": 'unknown key; did you mean "worlds.rich.spares"?',
    "mind.drives.hungr.a.nutrition=1": "did you mean",
    "mind.contact_range=40": "FILE: key mind: contact_range = 40.0 is wider than",
    "world.layout=rihc": '--set: key world.layout: world "rihc": no such world',
    'design.grid."mind.agent"=["AFF"]': '--set: key design.grid."mind.agent"[0] = "AFF": must',
    "a\x1b[31m=1": "is no key",
    "seed=\x1b[31m": "its value is neither TOML nor a bare word",
}


@pytest.mark.parametrize("text", WRONG_OVERRIDES)
def test_a_wrong_change_is_told_as_one_of_the_command_line(file, text):
    (line,) = refused(file, text)
    assert WRONG_OVERRIDES[text] in line
    assert line.isprintable()


@pytest.mark.parametrize("word", ["2020-01-01", "x", "7up", "a/b.py:c", "1e", "last:5", "Ä"])
def test_a_bare_word_is_a_string(file, word):
    assert read_study(file, [f"mind.behaviours.eat.needs={word}"]).mind.behaviours["eat"].needs == (
        word
    )


def test_all_mistakes_of_file_design_and_command_line_are_told_at_once(file):
    text = TEXT.replace('"decay"', '"decai"').replace('"AF"]', '"AFF"]') + "\n[desing]\n"
    lines = refused(file, "lives=0", "lifes=1", text=text)
    for told in (
        "--set: key lives = 0",
        '--set "lifes=1": unknown key',
        'FILE: key mind.physiology = "decai"',
        'FILE: key design.grid."mind.agent"[1] = "AFF"',
        "FILE: key desing: unknown key",
    ):
        assert sum(line.startswith(told) for line in lines) == 1
    assert len(lines) == 5


MISTAKES = {
    "no name": ("seed = 1", "key name: missing key; it must be given"),
    "a path": ('name = "a/b"', 'key name = "a/b": must be up to 80 letters, digits'),
    "dots": ('name = ".."', 'key name = "..": must be up to 80 letters'),
    "a long name": (f'name = "{"a" * 81}"', "must be up to 80 letters"),
    "an empty name": ('name = ""', 'key name = "": must be up to'),
    "no lives": ('name = "x"\nlives = 0', "key lives = 0: must be greater than or equal to 1"),
    "very many": (f'name = "x"\nlives = {MOST_LIVES + 1}', "must be less than or equal to"),
    "a seed": ('name = "x"\nseed = -1', "key seed = -1: must be"),
    "a long seed": (f'name = "x"\nseed = {2**63}', "key seed = 9223372036854775808: must be less"),
    "steps": ('name = "x"\nsteps = 0', "key steps = 0: must be"),
    "a measure": ('name = "x"\nmeasures = ["likelyhoods"]', 'did you mean "likelihoods"?'),
    "a measure twice": (
        'name = "x"\nmeasures = ["likelihoods", "likelihoods"]',
        'key measures: has "likelihoods" twice',
    ),
    "a record": (
        'name = "x"\nrecord = { what = "last" }',
        'key record.what = "last": allowed are "all", "every:N", and "last:N" up to',
    ),
    "more traces than lives": (
        'name = "x"\nlives = 2\nrecord = { what = "all", lives = 3 }',
        "record.lives = 3 exceeds lives = 2",
    ),
    "a world's name": ('name = "x"\n[worlds.scarce]', 'key worlds: "scarce" is taken; give the'),
    "a file's name": ('name = "x"\n[worlds."a.toml"]', '"a.toml" is taken; give the world'),
    "a world of worlds": (
        'name = "x"\n[worlds.a]\nlayout = "b"\n[worlds.b]',
        'key worlds: "a" has layout = "b", itself one of them',
    ),
    "no teacher": ('name = "x"\nteacher = { robots = 0 }', "key teacher.robots = 0: must be"),
    "a teacher nowhere": (
        'name = "x"\nteacher = { world = 3 }',
        "key teacher.world = 3: must be the name of a world, or a table",
    ),
    "networks": ('name = "x"\n[mind]\nnetworks = 3', "networks are those of a life, and given in"),
    "a key that cannot be shown": ('name = "x"\n"a\\u001b" = 1', 'key "a\\u001b": cannot be'),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_is_one_line(file, case):
    text, told = MISTAKES[case]
    (line,) = refused(file, text=text)
    assert line.startswith("FILE: ")
    assert told in line
    assert line.isprintable()


NO_STUDY = {
    "missing": (None, "no such file"),
    "empty": (b"", "is empty"),
    "binary": (bytes(range(256)) * 4, "is not UTF-8 text"),
    "zeros": (bytes(1_000), "is not TOML"),
    "enormous": (b"#" * 2_000_000, "is too large for a settings file"),
    "deep": (b"a = " + b"[" * 5_000 + b"]" * 5_000, "is nested too deeply"),
    "deep in a design": (b"name = 'x'\n[design]\n" + b".".join([b"a"] * 2_000) + b" = 1", "deeply"),
    "cut off": (b"name = 'x'\n[design.grid", "is not TOML"),
    "long number": (b"seed = " + b"9" * 10_000, "too many digits"),
}


@pytest.mark.parametrize("case", NO_STUDY)
def test_what_is_no_study_file_is_refused_in_one_line(file, case):
    content, told = NO_STUDY[case]
    if content is None:
        file.unlink()
    (line,) = refused(file, text=content)
    assert told in line


def test_a_settings_file_is_not_taken_for_a_study_nor_a_study_for_settings(file):
    with pytest.raises(SettingsError, match="key design: unknown key"):
        read_toml(file, LifeSettings)


@given(
    seed=st.integers(0, 2**63 - 1),
    rate=st.floats(1e-300, 1e300),
    name=st.text(st.characters(categories=["L", "N"]), min_size=1, max_size=20),
    why=st.text(min_size=1).filter(str.isprintable),
)
def test_what_is_written_reads_back_to_the_last_bit(tmp_path_factory, seed, rate, name, why):
    design = {
        "grid": {"mind.gate": ["always", "positive"]},
        "exclude": [{"when": {"mind.gate": "always"}, "why": why}],
    }
    mind = {"learning": {"rate": rate}}
    study = validated({"name": name, "seed": seed, "mind": mind, "design": design}, Study)
    file = tmp_path_factory.mktemp("written") / "study.toml"
    file.write_text(study.to_toml(), encoding="utf-8")
    again = read_study(file)
    assert again == study
    assert again.to_toml() == study.to_toml()
    assert again.mind.learning.rate.hex() == float(rate).hex()


def test_a_written_study_has_every_default_in_it(file):
    written = tomllib.loads(read_study(file).to_toml())
    assert written["mind"]["success_effect"] == 0.2
    assert written["mind"]["drives"].keys() == Mind().drives.keys()
    assert written["robot"]["radius"] == 27.5
    assert written["worlds"]["rich"]["gap"] == 70.0
    assert written["teacher"]["robots"] == 100
    assert written["steps"] == 300_000


def test_a_written_study_has_no_default_beside_the_name_of_a_world(file):
    """It would take the place of what that world sets."""
    file.write_text(TEXT.replace("counts", "gap = 80.0\ncounts"))
    study = read_study(file, ["world.layout=rich", "mind.agent=AF", "design.grid={}"])
    file.write_text(study.to_toml())
    for one in (study, read_study(file)):
        (case,) = cases(one)
        assert case.teacher is not None
        assert case.settings.world.gap == case.teacher.world.gap == 80.0


def test_a_study_of_python_is_one_that_can_be_written_down():
    study = Study(name="x", mind=Mind(agent="RANDOM"), teacher=Teacher(robots=2))
    assert study.varied() == {"mind": {"agent": "RANDOM"}, "teacher": {"robots": 2}}
    networks = live(Mind(), World.abundant(), steps=1).networks
    with pytest.raises(ValueError, match="a study has no networks"):
        Study(name="x", mind=Mind(agent="AF", networks=networks))
    with pytest.raises(ValueError, match=r"give it as FILE\.py:NAME"):
        Study(name="x", mind=Mind(selector=math.sin))


def test_what_is_public_is_no_module_of_the_same_name():
    for name in animat.study.__all__:
        value = getattr(animat.study, name)
        home = importlib.import_module(value.__module__)
        assert getattr(home, name) is value
    with pytest.raises(AttributeError, match="no attribute 'studi'"):
        animat.study.studi  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]
