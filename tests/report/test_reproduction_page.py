"""A reproduction as a directory: everything is there, and is what came out."""

import json
import re

import pyarrow.parquet as pq
import pytest

from animat.files.settings import read_toml
from animat.report.reproduction_page import FIGURES, publish
from animat.study.file.settings import LifeSettings
from animat.world.world import World

TABLES = ["lives", "likelihoods", "learning_curve", "last_steps"]


def test_everything_is_there_and_nothing_else(published):
    wanted = {f"{name}.parquet" for name in TABLES}
    wanted |= {f"{name}.{end}" for name in FIGURES for end in ("svg", "png")}
    wanted |= {"claims.json", "settings.toml", "how_made.json", "report.html"}
    wanted |= {"world_abundant.toml", "world_scarce.toml", "experiment1", "experiment2"}
    assert {path.name for path in published.directory.iterdir()} == wanted


def test_the_tables_are_read_back_as_they_were(published):
    learnt = published.result.learnt
    for name, table in zip(
        TABLES, (published.result.lives, learnt.final, learnt.curve, learnt.trace), strict=True
    ):
        assert pq.read_table(published.directory / f"{name}.parquet").equals(table)


def test_the_claims_are_read_back_as_they_were(published):
    written = json.loads((published.directory / "claims.json").read_text("utf-8"))
    text = json.dumps(written)
    for claim in published.result.claims:
        assert f'"{claim.id}"' in text
        assert json.dumps(claim.ours) in text
        assert f'"{claim.verdict}"' in text


def test_settings_and_worlds_make_the_same_again(published):
    directory, result = published.directory, published.result
    assert read_toml(directory / "settings.toml", LifeSettings) == result.settings
    for world in result.worlds:
        assert World.load(directory / f"world_{world.name}.toml") == world
    made = json.loads((directory / "how_made.json").read_text("utf-8"))
    assert (made["seed"], made["robots"], made["lives"], made["steps"]) == (1, 4, 24, 3_000)
    assert made["versions"]["numpy"]
    page = (directory / "report.html").read_text("utf-8")
    assert "--settings settings.toml --seed 1 --lives 24 --seeds 4 --steps 3000" in page


def test_the_page_stands_alone_and_shows_it_all(published):
    page = (published.directory / "report.html").read_text("utf-8")
    sources = re.findall(r"""(?:src|href)\s*=\s*["']([^"']*)["']""", page)
    assert not [each for each in sources if not each.startswith(("data:", "#"))]
    assert page.count("<figure>") == len(FIGURES)
    for number in (2, 3, 4, 5):
        assert f"<figcaption>Figure {number}. " in page
    for claim in published.result.claims:
        assert claim.text in page
    for heading in ("The worlds", "The readings taken", "wrong or leaves out", "How this was made"):
        assert heading in page
    assert "Nothing else was fitted" in page
    assert "The first 20 lives of each cell" in page


def test_the_lead_counts_the_verdicts(published):
    page = (published.directory / "report.html").read_text("utf-8")
    verdicts = [claim.verdict for claim in published.result.claims]
    held, failed, undecided = (verdicts.count(each) for each in ("holds", "fails", "undecided"))
    hold, fail = "holds" if held == 1 else "hold", "fails" if failed == 1 else "fail"
    are = "is" if undecided == 1 else "are"
    assert f"{held} {hold}, {failed} {fail}, and {undecided} {are} undecided" in page
    assert "4 robots that learn, then 24 lives in each of the four cells, up to 3,000 steps" in page


def test_figures_are_drawings(published):
    for name in FIGURES:
        assert (published.directory / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert "<svg" in (published.directory / f"{name}.svg").read_text("utf-8")[:1000]


def test_what_cannot_be_written_is_told(published, tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        publish(published.result, tmp_path / "nowhere", lambda: None)
