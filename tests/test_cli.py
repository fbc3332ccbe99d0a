"""The command line as its users meet it: what it prints, writes, refuses, and leaves behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path
from typing import IO, NamedTuple

import pyarrow.parquet as pq
import pytest

import animat.report.reproduction_page
from animat.cli import main
from animat.life.life import live
from animat.mind.mind import Mind
from animat.mind.parameters import parameters
from animat.world.world import World

PRODUCT = Path(__file__).parents[1] / "docs" / "examples" / "product.py"

SMALL = ("--lives", "2", "--seeds", "1", "--steps", "60")


class Said(NamedTuple):
    code: int
    out: str
    err: str


@pytest.fixture
def animat_says(commanded, monkeypatch, capsys):
    """Run the command line in an empty directory."""

    def run(*arguments: str) -> Said:
        monkeypatch.setattr(sys, "argv", ["animat", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        out, err = capsys.readouterr()
        assert isinstance(end.value.code, int)
        return Said(end.value.code, out, err)

    return run


def names(directory: Path) -> list[str]:
    return sorted(path.name for path in directory.iterdir())


def start(
    *arguments: str,
    cwd: Path,
    stdout: int | IO[str] = subprocess.PIPE,
    by: tuple[str, ...] = ("-m", "animat"),
) -> subprocess.Popen:
    """Start a process whose output waits in a buffer, as it does wherever it is not a terminal."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    environment.pop("PYTHONUNBUFFERED", None)
    return subprocess.Popen(
        [sys.executable, *by, *arguments],
        cwd=cwd,
        env=environment,
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
    )


def briefly(result, directory: Path, tell) -> None:
    """Stand in for publishing where it is not the point, as drawing takes seconds."""
    (directory / "report.html").write_text("new")


class TestLife:
    def test_it_lives_as_from_python(self, animat_says):
        said = animat_says("life")
        life = live(Mind(), World.abundant())
        assert said.code == 0
        lines = said.out.splitlines()
        assert lines[0] == "BLIND in abundant, physiology excess, seed 0, life 0"
        assert lines[1] == f"lived {life.lifespan:,} steps and died of {life.death}"

    def test_every_choice_is_taken(self, animat_says):
        said = animat_says(
            *("life", "--world", "scarce", "--agent", "ORACLE", "--physiology", "decay"),
            *("--seed", "5", "--life", "3", "--steps", "700"),
        )
        mind = Mind(agent="ORACLE", physiology="decay")
        life = live(mind, World.scarce(), seed=5, life=3, steps=700)
        lines = said.out.splitlines()
        assert lines[0] == "ORACLE in scarce, physiology decay, seed 5, life 3"
        assert lines[1].startswith(f"lived {life.lifespan} steps")

    def test_trace_and_figure_are_written(self, animat_says, tmp_path):
        said = animat_says("life", "--steps", "50", "--trace", "ü b.parquet", "--figure", "c.svg")
        assert said.code == 0
        assert names(tmp_path) == ["c.svg", "ü b.parquet"]
        assert pq.read_table(tmp_path / "ü b.parquet").num_rows == 50
        again = animat_says("life", "--steps", "20", "--trace", "ü b.parquet", "--force")
        assert again.code == 0
        assert pq.read_table(tmp_path / "ü b.parquet").num_rows == 20

    def test_settings_come_from_a_file_and_the_command_line_goes_before(
        self, animat_says, tmp_path
    ):
        (tmp_path / "mine.toml").write_text(
            '[world]\nlayout = "random"\ncounts = { TS = 1 }\nseed = 3\n'
            '[mind]\nagent = "RANDOM"\nphysiology = "linear"\n'
        )
        said = animat_says("life", "--settings", "mine.toml", "--steps", "9", "--agent", "ORACLE")
        assert said.out.startswith("ORACLE in random 1 TS, seed 3, physiology linear, seed 0")


UNWRITABLE = {
    "no/a.parquet": "there is no directory no",
    "directory.parquet": "is a directory",
    "there.parquet": "is there already; --force replaces it",
    "a.txt": "give a name that ends in .parquet",
    "there.parquet/a.parquet": "there is no directory there.parquet",
    "/proc/a.parquet": "cannot be written",
    "": "--trace: is empty",
}

WRONG = {
    "life --world abundnt": ['did you mean "abundant"?'],
    "life --world=": ["--world: is empty"],
    "life --settings=": ["--settings: is empty"],
    "life --world none.toml": ["none.toml: no such file"],
    "life --agent FA": ['"FA": must be one of', 'did you mean "AF"?'],
    "life --physiology exces": ['did you mean "excess"?'],
    "life --agent X --physiology Y": ["mind.agent", "mind.physiology"],
    "life --steps 0": ["steps = 0; allowed"],
    "life --steps -5": ["steps = -5; allowed"],
    "life --steps many": ["'--steps'"],
    "life --seed -1": ["'--seed'"],
    "life --seed 99999999999999999999999": ["'--seed'"],
    "life --life -1": ["'--life'"],
    "life --settings none.toml": ["none.toml: no such file"],
    "life --settings .": [".: is a directory, not a settings file"],
    "life --stps 3": ["No such option: --stps", "--steps"],
    "life extra": ["(extra)"],
    "life --record a.csv": ["a.csv: give a name that ends in .parquet"],
    "life --record there.parquet": ["there.parquet: is there already; --force replaces it"],
    "life --record a.parquet --every 0": ["every = 0; allowed"],
    "life --record a.parquet --every many": ["'--every'"],
    "life --every 5": ["--every is of a recording; give --record FILE with it"],
    "life --at 5": ["--at is a step of a recording; give --from FILE with it"],
    "life --from none.parquet": ["none.parquet: no such file"],
    "life --from there.parquet": ["there.parquet: is empty"],
    "life --from world.toml --at 1": ["world.toml: is no recording"],
    "life --from x --seed 0 --agent AF --life 1 --world abundant": [
        "--world cannot go with --from: the recording says it",
        "--agent cannot go with --from",
        "--seed cannot go with --from",
        "--life cannot go with --from",
    ],
    "life --from x --physiology decay --settings world.toml --at x": ["'--at'"],
    "life --from x --physiology decay --settings world.toml": ["--physiology", "--settings"],
    "replay": ["Missing argument 'FILE'"],
    "replay none.parquet": ["none.parquet: no such file"],
    "replay there.parquet --verify": ["there.parquet: is empty"],
    "replay world.toml": ["world.toml: is no recording: it does not begin like one"],
    "replay directory.parquet": ["directory.parquet: is a directory, not a recording"],
    "replay there.parquet more": ["(more)"],
    "replay there.parquet --verfy": ["No such option: --verfy", "--verify"],
    "lif": ["No such command 'lif'"],
    "reproduce --lives 1": ["lives = 1; a comparison needs"],
    "reproduce --lives 1 --seeds 0": ["seeds = 0; Experiment 1 needs", "lives = 1"],
    "reproduce --steps 0": ["steps = 0; allowed"],
    "reproduce --seed -1": ["'--seed'"],
    "reproduce --out there": ["there: is there already; --force replaces it"],
    "reproduce --quick --out there --force": ["there: is no earlier result"],
    "reproduce --out there.parquet": ["there.parquet: is a file"],
    "reproduce --out there.parquet/a": ["cannot be written: Not a directory"],
    "reproduce --out /proc/a": ["/proc/a: cannot be written"],
    "reproduce --out . --force": [".: cannot be replaced as a whole"],
    "reproduce --out / --force": ["/: cannot be replaced as a whole"],
    "reproduce --settings world.toml": ["Worlds 1 and 2"],
    "life --settings world.toml": ["do not fit", "60 TL"],
} | {f"life --steps 9 --trace={path}": [why] for path, why in UNWRITABLE.items()}


@pytest.mark.parametrize("command", WRONG)
def test_what_is_wrong_is_told_in_a_line_and_leaves_nothing_behind(animat_says, tmp_path, command):
    (tmp_path / "directory.parquet").mkdir()
    (tmp_path / "there.parquet").touch()
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "mine").touch()
    (tmp_path / "world.toml").write_text('[world]\nlayout = "random"\ncounts = { TL = 60 }\n')
    before = names(tmp_path)
    said = animat_says(*command.split())
    assert said.code == 2
    assert said.out == ""
    assert all(line.startswith("animat: ") for line in said.err.splitlines())
    assert len(said.err.splitlines()) <= len(WRONG[command])
    for words in WRONG[command]:
        assert words in said.err
    assert "Traceback" not in said.err
    assert names(tmp_path) == before
    assert names(tmp_path / "there") == ["mine"]


def test_every_mistake_of_a_file_is_a_line(animat_says, tmp_path):
    (tmp_path / "mine.toml").write_text(
        "[mind.variables.nutrition]\nrate = -1.0\n[mind]\ngate = 'never'\n"
        "[robot]\nradius = -3.0\n[mnd]\n"
    )
    said = animat_says("life", "--settings", "mine.toml")
    assert said.code == 2
    assert sorted(line.split(":")[2].split()[1] for line in said.err.splitlines()) == [
        "mind.gate",
        "mind.variables.nutrition.rate",
        "mnd",
        "robot.radius",
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[mind.variables.nutrition]\nset_point = 3.0\n", "set_point"),
        ('[mind]\nwander = "none.py:walk"\n', "no such file"),
        ('[mind]\nwander = "mine.py:walk"\n', "has other arguments"),
        ('[mind.behaviours.eat]\nserves = "hunger"\nneeds = "eating"\n', 'needs = "eating"'),
        ("[mind]\nconsumed = true\n", "spare"),
        ("", "is empty"),
    ],
)
def test_what_does_not_go_together_is_wrong_input_too(animat_says, tmp_path, text, words):
    (tmp_path / "mine.toml").write_text(text)
    (tmp_path / "mine.py").write_text("def walk(readings):\n    return 0.0, 0.0\n")
    said = animat_says("life", "--settings", "mine.toml", "--steps", "9")
    assert (said.code, said.out) == (2, "")
    assert words in said.err.splitlines()[-1]
    assert "Traceback" not in said.err


@pytest.mark.parametrize("arguments", [("--debug", "life"), ("life", "--debug")])
def test_debug_shows_where_an_error_came_from(animat_says, arguments):
    assert animat_says(*arguments, "--steps", "9").code == 0
    said = animat_says(*arguments, "--steps", "0")
    assert said.code == 2
    assert said.err.startswith("Traceback")
    assert said.err.endswith("\nanimat: steps = 0; allowed are whole numbers from 1 to 2^50\n")


@pytest.mark.parametrize("error", [ZeroDivisionError("by\nnought"), OSError(5, "broken disk")])
def test_a_mistake_of_ours_is_one_line_and_code_1(animat_says, monkeypatch, error):
    def fails(*_):
        raise error

    monkeypatch.setattr("animat.cli.one_life.live_one", fails)
    said = animat_says("life")
    assert (said.code, said.out) == (1, "")
    (line,) = said.err.splitlines()
    assert line.startswith(f"animat: {type(error).__name__}: ")
    assert line.endswith("(--debug shows where)")


def test_help_names_the_commands_and_their_options(animat_says):
    assert {"reproduce", "life", "replay"} <= set(animat_says("--help").out.split())
    for command, options in {
        "reproduce": "lives seeds steps physiology seed out settings quick force debug",
        "life": "world agent physiology seed life steps settings trace figure record every from at"
        " force debug",
        "replay": "verify debug",
    }.items():
        said = animat_says(command, "--help")
        assert said.code == 0
        for option in options.split():
            assert f"--{option}" in said.out


class TestReplay:
    RECORD = ("life", "--agent", "LEARNING", "--steps", "400", "--every", "150", "--record")

    def test_a_recording_is_shown_and_is_the_same_life(self, animat_says, tmp_path):
        (tmp_path / "mine.toml").write_text("[mind.variables.nutrition]\nset_point = 0.7\n")
        told = animat_says(*self.RECORD, "a.parquet", "--settings", "mine.toml", "--seed", "3")
        assert told.out.startswith("LEARNING in abundant, physiology excess, seed 3, life 0\n")
        said = animat_says("replay", "a.parquet")
        assert (said.code, said.err) == (0, "")
        lines = said.out.splitlines()
        assert lines[0] == "LEARNING in abundant, physiology excess, seed 3, life 0"
        assert lines[1] == "steps 0 to 399 of 400 at most; alive at the end"
        assert lines[2].startswith("4 states, one every 150 steps; digest at the end ")
        for words in (
            "2 TS, 2 TL, 2 CS, 2 CL",
            "by animat life --agent LEARNING",
            "engine 1, python 3.",
            "set_point = 0.7",
        ):
            assert words in said.out
        said = animat_says("replay", "a.parquet", "--verify")
        assert said.code == 0
        assert said.out == "the same life: all 400 steps and 4 states agree\n"
        assert "Life again, steps: 400 of 400" in said.err

    def test_a_death_and_a_function_are_shown(self, animat_says, tmp_path):
        (tmp_path / "mine.toml").write_text(
            '[mind]\nselector = "mine.py:mine"\n[mind.variables.stamina]\nstart = 0.97\n'
        )
        (tmp_path / "mine.py").write_bytes(PRODUCT.read_bytes().replace(b"product", b"mine"))
        told = animat_says("life", "--settings", "mine.toml", "--record", "a.parquet")
        how = told.out.splitlines()[1].partition(" and ")[2]
        for name in ("mine.toml", "mine.py"):
            (tmp_path / name).unlink()
        said = animat_says("replay", "a.parquet")
        assert said.code == 0
        assert said.out.splitlines()[1].endswith(f"of 300,000 at most; {how}")
        assert "\nselector mine.py:mine\n" in said.out
        for command in (("replay", "--verify"), ("life", "--at", "3", "--from")):
            said = animat_says(*command, "a.parquet")
            assert (said.code, said.out) == (2, "")
            assert said.err.startswith('animat: a.parquet: selector = "mine.py:mine": no such')
        mine = PRODUCT.read_bytes().replace(b"product", b"mine")
        (tmp_path / "mine.py").write_bytes(mine.replace(b"here > drives", b"here >= drives"))
        said = animat_says("replay", "--verify", "a.parquet")
        assert said.code == 2
        assert said.err == (
            "animat: a.parquet: selector: mine.py:mine has changed since the life was recorded\n"
        )

    def test_another_life_is_told_field_by_field(self, animat_says, monkeypatch):
        assert animat_says(*self.RECORD, "a.parquet").code == 0

        def otherwise(mind, affordances):
            record = parameters(mind, affordances)
            record.factor *= 1.0 - 1e-7
            return record

        monkeypatch.setattr("animat.life.scenario.parameters", otherwise)
        said = animat_says("replay", "a.parquet", "--verify")
        assert said.code == 1
        lines = said.out.splitlines()
        assert lines[0] == "another life: step 0 is the first that differs"
        assert lines[1].split() == ["recorded", "simulated", "again"]
        names = [line.split()[0] for line in lines[2:]]
        assert names == [*Mind().resolved_variables(), *Mind().drives]
        for line in lines[2:]:
            _, old, new = line.split()
            assert float(old) != float(new)
            assert float(old) == pytest.approx(float(new), abs=1e-5)
        assert "Traceback" not in said.err

    def test_an_altered_recording_is_refused_and_placed(self, animat_says, tmp_path):
        assert animat_says(*self.RECORD, "a.parquet").code == 0
        path = tmp_path / "a.parquet"
        content = bytearray(path.read_bytes())
        content[len(content) // 4] ^= 1
        path.write_bytes(content)
        for command in (("replay",), ("replay", "--verify"), ("life", "--from")):
            said = animat_says(*command, "a.parquet")
            assert (said.code, said.out) == (2, "")
            (line,) = said.err.splitlines()
            assert line.startswith("animat: a.parquet: is altered between bytes 0 and ")
            assert line.endswith(": steps 0 to 399")

    def test_a_recorded_life_goes_on(self, animat_says):
        assert animat_says(*self.RECORD, "a.parquet").code == 0
        whole = animat_says("life", "--agent", "LEARNING", "--steps", "800")
        for at in (("--at", "0"), ("--at", "149"), ()):
            said = animat_says("life", "--from", "a.parquet", *at, "--steps", "800")
            assert (said.code, said.out) == (0, whole.out)
        said = animat_says("life", "--from", "a.parquet")
        assert (said.code, said.out) == (2, "")
        assert said.err == "animat: steps = 400: the life has lived 400 steps already; give more\n"


@pytest.mark.usefixtures("undrawn")
class TestReproduce:
    def test_it_prints_claims_and_cells_and_writes_everything(
        self, animat_says, monkeypatch, tmp_path
    ):
        said = animat_says("reproduce", *SMALL, "--seed", "7", "--physiology", "linear")
        assert said.code == 0
        for words in (*(f"C{n}" for n in range(1, 8)), "abundant", "scarce", "BLIND", "AF"):
            assert words in said.out
        assert "results/reproduction/report.html" in said.out.splitlines()[-1]
        assert "Experiment 2, lives: 8 of 8" in said.err
        assert "Figures and page: 8 of 8" in said.err
        out = tmp_path / "results" / "reproduction"
        made = json.loads((out / "how_made.json").read_text())
        assert made["command"] == "animat reproduce " + " ".join(
            (*SMALL, "--seed", "7", "--physiology", "linear")
        )
        assert (made["seed"], made["lives"], made["robots"], made["steps"]) == (7, 2, 1, 60)
        assert 'physiology = "linear"' in (out / "settings.toml").read_text()

        settings = str(out / "settings.toml")
        command = ("reproduce", *SMALL, "--seed", "7", "--settings", settings)
        assert animat_says(*command, "--out", "again").code == 0
        for name in ("lives.parquet", "claims.json", "settings.toml", "last_steps.parquet"):
            assert (tmp_path / "again" / name).read_bytes() == (out / name).read_bytes()

        monkeypatch.setattr(animat.report.reproduction_page, "publish", briefly)
        assert animat_says("reproduce", *SMALL).code == 2
        assert (out / "lives.parquet").is_file()
        assert animat_says("reproduce", *SMALL, "--force").code == 0
        assert names(out) == ["experiment1", "experiment2", "report.html"]
        assert names(tmp_path / "results") == ["reproduction"]

    def test_quick_is_small_and_may_be_changed(self, animat_says, monkeypatch):
        sizes = []

        def run(settings, *, size, **_):
            sizes.append(size)
            raise KeyboardInterrupt

        monkeypatch.setattr("animat.experiments.reproduction.reproduce", run)
        for options in ((), ("--quick",), ("--quick", "--lives", "7"), ("--seeds", "3")):
            assert animat_says("reproduce", *options).code == 130
        full, quick, changed, seeds = sizes
        assert full == (100, 1_000, 300_000)
        assert quick.lives < 100
        assert changed == quick._replace(lives=7)
        assert seeds == full._replace(robots=3)

    def test_an_interruption_leaves_an_earlier_result_and_what_is_finished(
        self, animat_says, monkeypatch, tmp_path
    ):
        old = tmp_path / "results" / "reproduction"
        old.mkdir(parents=True)
        (old / "how_made.json").write_text("old")

        def interrupted(result, directory, tell):
            (directory / "lives.parquet").touch()
            raise KeyboardInterrupt

        monkeypatch.setattr(animat.report.reproduction_page, "publish", interrupted)
        for options in (("--force",), ("--out", "new/one")):
            said = animat_says("reproduce", *SMALL, *options)
            assert (said.code, said.out) == (130, "")
            assert said.err.endswith("animat: interrupted; nothing is half-written\n")
        assert names(tmp_path / "results") == [".reproduction.partial", "reproduction"]
        assert names(old) == ["how_made.json"]
        assert names(tmp_path / "new") == [".one.partial"]

        monkeypatch.setattr(animat.report.reproduction_page, "publish", briefly)
        said = animat_says("reproduce", *SMALL, "--seed", "1", "--out", "new/one")
        assert said.code == 2
        assert "seed = 0 there and 1 here" in said.err
        assert "--force begins anew" in said.err
        assert animat_says("reproduce", *SMALL, "--out", "new/one").code == 0
        assert names(tmp_path / "new") == ["one"]
        log = (tmp_path / "new" / "one" / "experiment1" / "log.jsonl").read_text()
        assert log.count('"event": "start"') == 2
        assert log.count('"event": "part"') == 1


STOPPED = """
import os, signal, sys
from contextlib import nullcontext
from pathlib import Path
from animat import progress
from animat.cli import main

stop = [getattr(signal, sys.argv.pop(1))]

def tell(*_):
    if stop and any(Path(".out.partial").glob("experiment2/lives/part-*")):
        os.kill(os.getpid(), stop.pop())

signal.signal(signal.SIGINT, signal.default_int_handler)
progress.telling = lambda: nullcontext(tell)
main()
"""
"""The command line, which gets a signal when it has written the first lives of the second
experiment."""


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGKILL])
def test_a_run_that_is_stopped_leaves_nothing_under_the_final_name_and_is_gone_on_with(
    sent, tmp_path, animat_says, monkeypatch
):
    size = ("--lives", "40", "--seeds", "1", "--steps", "60")
    run = start("reproduce", *size, "--out", "out", cwd=tmp_path, by=("-c", STOPPED, sent.name))
    out, err = run.communicate()
    assert out == ""
    assert "Traceback" not in err
    assert names(tmp_path) == [".out.partial"]
    if sent == signal.SIGINT:
        assert run.returncode == 130
        assert "interrupted: finishing the parts that are under way" in err
        kept = tmp_path / ".out.partial"
        assert err.endswith(
            f"animat: finished work is stored in {kept}; the same command resumes it\n"
            "animat: interrupted; nothing is half-written\n"
        )
    log = tmp_path / ".out.partial" / "experiment2" / "log.jsonl"
    assert 0 < log.read_text().count('"event": "part", ') < 20
    monkeypatch.setattr(animat.report.reproduction_page, "publish", briefly)
    assert animat_says("reproduce", *size, "--out", "out").code == 0
    assert names(tmp_path) == ["out"]
    log = tmp_path / "out" / "experiment2" / "log.jsonl"
    parts = [json.loads(line) for line in log.read_text().splitlines() if '"part"' in line]
    assert sorted(part["number"] for part in parts if part["kind"] == "lives") == list(range(20))


@pytest.mark.usefixtures("compiled")
def test_a_reader_that_stops_reading_is_no_error_to_talk_of(tmp_path):
    run = start("life", "--steps", "9", cwd=tmp_path)
    assert run.stdout is not None
    run.stdout.close()
    run.stdout = None
    _, err = run.communicate()
    assert run.returncode == 0
    assert all(line.startswith("Life, steps: ") for line in err.splitlines())
    assert "Life, steps: 9 of 9" in err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device here")
def test_a_full_disk_behind_the_output_is_an_error(tmp_path):
    with Path("/dev/full").open("w") as full:
        run = start("life", "--steps", "9", cwd=tmp_path, stdout=full)
        _, err = run.communicate()
    assert run.returncode == 1
    assert err.splitlines()[-1] == ("animat: the output cannot be written: No space left on device")


def test_signs_that_the_output_cannot_show_are_no_error(animat_says, monkeypatch, tmp_path):
    world = World.random({"TS": 1}, name="Süd")
    world.save(tmp_path / "south.toml")
    output = BytesIO()
    monkeypatch.setattr(sys, "stdout", TextIOWrapper(output, encoding="ascii"))
    assert animat_says("life", "--world", "south.toml", "--steps", "9").code == 0
    assert output.getvalue().startswith(b"BLIND in S?d, physiology excess")
