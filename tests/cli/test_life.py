"""What `animat life` takes besides: a line changed, networks, traces as CSV; and the version."""

import pyarrow.csv as pc_csv
import pyarrow.parquet as pq
import pytest

import animat as package
from animat import Networks

FAST = ("life", "--steps", "40")


def test_the_version_is_named(animat):
    said = animat("--version")
    assert (said.code, said.out) == (0, f"animat {package.__version__}\n")


def test_a_line_is_changed_for_one_call(animat, tmp_path):
    (tmp_path / "mine.toml").write_text('[mind]\nagent = "RANDOM"\n')
    said = animat(
        *(*FAST, "--settings", "mine.toml", "--set", "mind.physiology=linear"),
        *("--set", 'world={layout="scarce", name="poor"}', "--seed", "3"),
    )
    assert said.code == 0
    assert said.out.startswith("RANDOM in poor, physiology linear, seed 3, life 0\nlived 40 steps")


WRONG = {
    ("--set", "mind.agnt=AF"): '--set mind.agnt=AF: unknown key; did you mean "mind.agent"?',
    ("--set", "mind.agent=FA"): '--set: key mind.agent = "FA": must be one of',
    ("--set", "mind.agent"): "is not written key=value",
    ("--set", "mind.agent=AF", "--agent", "AF"): "--set mind.agent: --agent sets it, too",
    ("--from", "a.parquet", "--set", "mind.agent=AF"): "--set cannot go with --from",
    ("--from", "a.parquet", "--networks", "a.toml"): "--networks cannot go with --from",
    ("--networks", "none.toml", "--agent", "AF"): "none.toml: no such file",
    ("--save-networks", "a.parquet"): "a.parquet: give a name that ends in .toml",
    ("--trace", "a.txt"): "a.txt: give a name that ends in .parquet or .csv",
}


@pytest.mark.parametrize("options", WRONG)
def test_what_does_not_go_is_refused_in_a_line(animat, options):
    said = animat(*FAST, *options)
    assert said.code == 2
    (line,) = said.err.splitlines()
    assert WRONG[options] in line


def test_networks_go_from_life_to_life(animat, tmp_path):
    learnt = ("--agent", "LEARNING", "--save-networks", "learnt.toml")
    assert animat("life", "--steps", "2000", *learnt).code == 0
    first = Networks.load(tmp_path / "learnt.toml")
    assert first.features == ("shape", "size")
    same = ("--networks", "learnt.toml", "--save-networks", "again.toml")
    said = animat(*FAST, "--agent", "AF", *same)
    assert (said.code, said.err.count("Learning first")) == (0, 0)
    assert Networks.load(tmp_path / "again.toml") == first
    blind = animat(*FAST, "--networks", "learnt.toml")
    assert (
        blind.err == "animat: learnt.toml: the agent BLIND asks no networks; take AF or LEARNING\n"
    )
    other = animat(
        *(*FAST, "--agent", "AF", "--networks", "learnt.toml"),
        *("--set", "mind.learning.hidden_units=3"),
    )
    assert "learnt.toml: networks have 2 hidden units" in other.err


def test_a_trace_is_written_as_csv(animat, tmp_path):
    for name in ("a.csv", "a.parquet"):
        assert animat(*FAST, "--trace", name).code == 0
    read = pc_csv.read_csv(tmp_path / "a.csv")
    wanted = pq.read_table(tmp_path / "a.parquet")
    assert read.column_names == wanted.column_names
    for name in ("step", "x", "nutrition", "behaviour", "infrared_3"):
        assert read[name].to_pylist() == wanted[name].to_pylist()
