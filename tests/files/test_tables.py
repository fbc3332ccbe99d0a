"""Traces and tables of lives for other programs."""

import builtins

import pyarrow.csv as pc_csv
import pytest

from animat.files.settings import SettingsError
from animat.life.life import live
from animat.life.lives import live_many
from animat.life.scenario import LifeError
from animat.mind.mind import Mind
from animat.world.world import World


@pytest.fixture(scope="module")
def life():
    return live(Mind(), World.abundant(), steps=60, record="all")


@pytest.fixture(scope="module")
def lives():
    return live_many(Mind(), World.abundant(), lives=3, steps=60)


def test_they_are_tables_of_pandas(life, lives):
    assert life.to_pandas()["nutrition"].tolist() == life.trace["nutrition"].to_pylist()
    assert lives.to_pandas()["lifespan"].tolist() == lives.table["lifespan"].to_pylist()


def test_they_are_written_as_csv(life, lives, tmp_path):
    life.to_csv(tmp_path / "life.csv")
    lives.to_csv(str(tmp_path / "lives.csv"))
    read = pc_csv.read_csv(tmp_path / "life.csv")
    assert read["heading"].to_pylist() == life.trace["heading"].to_pylist()
    assert pc_csv.read_csv(tmp_path / "lives.csv").num_rows == 3
    with pytest.raises(SettingsError, match="cannot be written"):
        life.to_csv(tmp_path / "none" / "life.csv")


def test_without_pandas_it_is_said_how_to_get_it(life, lives, monkeypatch):
    real = builtins.__import__

    def without(name, *rest):
        if name == "pandas":
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    for one in (life, lives):
        with pytest.raises(SettingsError, match=r"pip install animat\[pandas\]"):
            one.to_pandas()


def test_a_life_without_a_trace_says_how_to_record_one():
    bare = live(Mind(), World.abundant(), steps=5)
    for use in (bare.to_pandas, bare.figure, lambda: bare.to_csv("x.csv")):
        with pytest.raises(LifeError, match='record="all"'):
            use()
