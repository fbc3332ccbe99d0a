"""Settings files of studies, and the worlds they choose."""

import pytest

from animat.files.settings import SettingsError, read_toml
from animat.study.file.settings import LifeSettings, WorldChoice, named
from animat.world.arena import Arena
from animat.world.world import World


def test_published_worlds_go_by_name():
    assert named("abundant") == World.abundant()
    assert named("scarce") == World.scarce()
    assert WorldChoice().world() == World.abundant()


def test_a_world_is_read_from_its_file(tmp_path):
    World.scarce().save(tmp_path / "mine.toml")
    assert named(str(tmp_path / "mine.toml")) == World.scarce()
    with pytest.raises(SettingsError, match=r"none\.toml"):
        named(str(tmp_path / "none.toml"))


def test_an_unknown_world_is_told_the_nearest():
    with pytest.raises(SettingsError, match=r'"abundnt": no such world.*did you mean "abundant"'):
        named("abundnt")
    with pytest.raises(SettingsError, match="known: abundant, scarce"):
        named("")


def test_a_random_world_has_its_counts_seed_gap_and_resolution():
    choice = WorldChoice(
        layout="random", counts={"TS": 2, "CL": 1}, seed=4, gap=80.0, spares=1, resolution=4.0
    )
    assert choice.world() == World.random(
        {"TS": 2, "CL": 1}, seed=4, gap=80.0, spares=1, resolution=4.0
    )


def test_a_published_world_may_have_spares_and_another_resolution():
    assert WorldChoice(resolution=4.0).world().resolution == 4.0
    assert WorldChoice(resolution=4.0).world().layout == World.abundant().layout
    assert WorldChoice(layout="scarce", spares=1, seed=3).world() == World.scarce().with_spares(
        1, seed=3
    )


@pytest.mark.parametrize(
    "choice", [{"layout": "random"}, {"counts": {"TS": 1}}, {"layout": "scarce", "counts": {}}]
)
def test_counts_go_with_random_worlds_only(choice):
    with pytest.raises(SettingsError, match="go together"):
        WorldChoice(**choice)


def test_counts_that_do_not_fit_are_refused():
    choice = WorldChoice(layout="random", counts={"TL": 60})
    with pytest.raises(SettingsError, match="do not fit"):
        choice.world()


def test_a_file_gives_world_robot_and_mind(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(
        '[world]\nlayout = "random"\ncounts = { TS = 1 }\n'
        '[robot]\ninfrared = "linear"\n[mind]\nagent = "RANDOM"\n'
    )
    settings = read_toml(path, LifeSettings)
    assert settings.world.counts == {"TS": 1}
    assert settings.robot.infrared == "linear"
    assert settings.mind.agent == "RANDOM"


def test_every_mistake_of_a_file_is_told(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(
        "[world]\ncounts = { TS = -1 }\ngap = -3.0\nresolution = 0.0\n"
        "[mind]\nphysiology = 'exces'\n[mnd]\n"
    )
    with pytest.raises(SettingsError) as refused:
        read_toml(path, LifeSettings)
    found = "\n".join(refused.value.problems)
    for line in (
        "world.counts.TS = -1: must be",
        "world.gap = -3.0: must be",
        "world.resolution = 0.0: must be",
        'mind.physiology = "exces": must be one of',
        'mnd: unknown key; did you mean "mind"?',
    ):
        assert f"{path}: key {line}" in found
    assert len(refused.value.problems) == 5


def test_a_random_world_may_have_an_arena_of_its_own(tmp_path):
    file = tmp_path / "arena.toml"
    file.write_text('[world]\nlayout = "random"\ncounts = { TS = 2 }\narena = { width = 700.0 }\n')
    world = read_toml(file, LifeSettings).world.world()
    assert (world.arena.width, world.arena.height) == (700.0, 1000.0)
    assert world.layout == World.random({"TS": 2}, arena=Arena(width=700.0)).layout


def test_a_published_world_has_its_own_arena(tmp_path):
    file = tmp_path / "arena.toml"
    file.write_text("[world]\narena = { width = 700.0 }\n")
    with pytest.raises(SettingsError, match=r'arena = .* needs layout = "random"'):
        read_toml(file, LifeSettings)
