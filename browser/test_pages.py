"""The pages that animat writes, in a real browser: `make test ARGS=browser`.

Needs Chromium, and so stands apart from the other tests. It is never left out for want of it: where
there is none, these tests fail and say so.
"""

import subprocess
import sys
from pathlib import Path

import pytest

LOOK = Path(__file__).parents[1] / "tools" / "look.py"

STUDY = """
name = "pages"
lives = 25
steps = 3_000
measures = ["likelihoods", "learning_curve"]
[teacher]
robots = 3
steps = 1_500
[design.grid]
"world.layout" = ["abundant", "scarce"]
"mind.agent" = ["BLIND", "AF"]
[design.sample]
method = "sobol"
points = 16
[design.sample.over]
"mind.success_effect" = { low = 0.1, high = 0.3 }
"""

REPRODUCTION = "reproduce --lives 24 --seeds 4 --steps 3000 --out reproduction"


def animat(directory, command):
    subprocess.run([sys.executable, "-m", "animat", *command.split()], cwd=directory, check=True)


def look(*pages):
    ran = subprocess.run(
        [sys.executable, LOOK, *pages], capture_output=True, text=True, check=False
    )
    return ran.returncode, ran.stdout + ran.stderr


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    directory = tmp_path_factory.mktemp("pages")
    (directory / "pages.toml").write_text(STUDY)
    animat(directory, "run pages.toml --out study")
    animat(directory, "report study")
    animat(directory, REPRODUCTION)
    return [directory / "study/report.html", directory / "reproduction/report.html"]


def test_nobody_has_anything_to_complain_of(pages):
    code, said = look(*pages)
    assert code == 0, said
    assert said.count(": good") == len(pages)


GOOD = '<img alt="a dot" src="data:image/gif;base64,R0lGODlhAQABAAAAACwAAAAAAQABAAACAkQBADs=">'

BAD = {
    "<script>console.log('hello')</script>": "the console says ['hello']",
    "<script>throw Error('no')</script>": "a script fails",
    "<script>fetch('http://example.org/x')</script>": "it asks for http://example.org/x",
    '<link rel="stylesheet" href="http://example.org/a.css">': "it asks for http://example.org/a.css",
    "<style>body { background: url(https://example.org/b.png) }</style>":
        "it asks for https://example.org/b.png",
    '<img alt="a picture" src="missing.png">': "picture 1 is not shown",
    GOOD.replace("a dot", ""): "picture 1 has no words in its place",
    '<div style="width: 3000px">wide</div>': "pixels wider than the window",
}  # fmt: skip


@pytest.mark.parametrize(("body", "complaint"), [*BAD.items(), (GOOD, ": good")])
def test_what_a_reader_would_complain_of_is_seen(tmp_path, body, complaint):
    page = tmp_path / "page.html"
    page.write_text(f"<!DOCTYPE html><title>page</title><p>Some text.{body}")
    code, said = look(page)
    assert complaint in said
    assert code == (complaint != ": good")


def test_without_a_browser_it_says_so(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CHROMIUM", raising=False)
    code, said = look(tmp_path / "page.html")
    assert code == 1
    assert "apt-get install chromium" in said
