import base64
from html.parser import HTMLParser

import pytest
from matplotlib.figure import Figure

from animat.report import page
from animat.report.page import (
    Badge,
    Picture,
    Section,
    TableBlock,
    address_of,
    interval,
    is_page,
    p_value,
    picture,
    write_page,
)
from animat.statistics.estimates import UNKNOWN, Estimate


class Reader(HTMLParser):
    """What a browser would find: tags that are open, addresses it would load, and text."""

    def __init__(self):
        super().__init__()
        self.open, self.tags, self.loads, self.text, self.links = [], [], [], [], []

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.tags.append((tag, given))
        self.loads += [given[name] for name in ("src", "srcset", "data") if name in given]
        if tag == "link":
            self.loads.append(given["href"])
        if tag == "a":
            self.links.append(given["href"])
        if tag not in ("meta", "link", "img", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


def read(path):
    reader = Reader()
    reader.feed(path.read_text("utf-8"))
    reader.close()
    assert reader.open == []
    return reader


@pytest.fixture
def figure():
    fig = Figure()
    fig.subplots().plot([1, 2], [3, 4])
    return fig


@pytest.fixture
def whole(tmp_path, figure):
    path = tmp_path / "report.html"
    sections = [
        Section("A table", tables=[TableBlock(("", "a"), [("b", "2.0")], "below")]),
        Section("Figures", pictures=[picture(figure, "Figure 1. A line.", "a line")]),
        Section(
            "How it was made",
            paragraphs=["Once."],
            items=["calibrated: nothing"],
            terms={"seed": "1"},
            code="animat reproduce",
        ),
    ]
    write_page(path, title="A report", sections=sections, lead=["What was asked."])
    return path


def test_the_page_is_well_formed_and_fetches_nothing(whole):
    reader = read(whole)
    assert "script" not in {tag for tag, _ in reader.tags}
    assert reader.loads
    assert all(address.startswith("data:") for address in reader.loads)
    assert all(not any(name.startswith("on") for name in given) for _, given in reader.tags)
    text = whole.read_text("utf-8")
    assert "url(" not in text
    assert "@import" not in text


def test_the_contents_lead_to_every_section(whole):
    reader = read(whole)
    there = {given["id"] for tag, given in reader.tags if tag == "section"}
    assert [link for link in reader.links if link.startswith("#")] == [
        f"#part-{k}" for k in (1, 2, 3)
    ]
    assert {link[1:] for link in reader.links} == there


def test_everything_that_is_given_is_on_the_page(whole):
    text = " ".join(read(whole).text)
    for word in ("A report", "What was asked.", "Figure 1. A line.", "Once.", "below", "seed",
                 "calibrated: nothing", "animat reproduce", "Cañamero", "2003"):  # fmt: skip
        assert word in text


def test_verdicts_are_marked_as_what_they_are(tmp_path):
    path = tmp_path / "page.html"
    rows = [(Badge("holds"),), (Badge("fails"),), (Badge("undecided"),), ("holds",)]
    write_page(path, title="t", sections=[Section("s", tables=[TableBlock(("v",), rows)])])
    badges = [given["class"] for tag, given in read(path).tags if tag == "span"]
    assert badges == ["badge holds", "badge fails", "badge undecided"]


def test_warnings_come_first_and_a_table_has_its_title(tmp_path):
    path = tmp_path / "page.html"
    table = TableBlock(("a",), [("b",)], title="Its title")
    section = Section("s", ["said"], tables=[table], notices=["Not finished."])
    write_page(path, title="t", sections=[section], lead=["lead"], notices=["Still running."])
    reader = read(path)
    text = [each.strip() for each in reader.text if each.strip()]
    assert text.index("Still running.") < text.index("lead") < text.index("Not finished.")
    assert text.index("Not finished.") < text.index("said") < text.index("Its title")
    assert sum(given.get("class") == "notice" for _, given in reader.tags) == 2
    assert "caption" in {tag for tag, _ in reader.tags}


def test_a_page_of_ours_is_known_for_one(whole, tmp_path):
    assert is_page(whole)
    (tmp_path / "other.html").write_text("<html>")
    assert not is_page(tmp_path / "other.html")


def test_every_picture_has_words_in_its_place(whole):
    words = [given["alt"] for tag, given in read(whole).tags if tag == "img"]
    assert words == ["a line"]


def test_what_a_user_wrote_cannot_become_markup(tmp_path):
    path = tmp_path / "page.html"
    evil = '"><script>alert(1)</script>'
    section = Section(evil, (evil,), (evil,), {evil: evil},
                      (TableBlock((evil,), ((evil,),), evil),),
                      (Picture("png", b"x", evil, evil),), evil)  # fmt: skip
    write_page(path, title=evil, sections=[section], lead=[evil])
    reader = read(path)
    assert "script" not in {tag for tag, _ in reader.tags}
    assert "".join(reader.text).count("<script>") == 14


def test_a_picture_holds_the_figure(figure, tmp_path):
    made = picture(figure, "c", "a")
    head, content = made.address.split(",")
    assert head == "data:image/svg+xml;base64"
    assert base64.b64decode(content) == made.content
    assert b"<svg" in made.content
    (tmp_path / "f.png").write_bytes(b"png")
    assert address_of(tmp_path / "f.png") == "data:image/png;base64,cG5n"


def test_a_heavy_figure_goes_in_as_png(figure, monkeypatch):
    monkeypatch.setattr(page, "LARGEST_SVG", 10)
    made = picture(figure, "c", "a")
    assert made.kind == "png"
    assert made.content.startswith(b"\x89PNG")


def test_intervals_in_words():
    assert interval(Estimate(2.0, 1.9, 2.126), ".2f") == "2.00 (1.90\u00a0to\u00a02.13)"
    assert interval(Estimate(120.0, 100.0, float("inf")), ",.0f") == "120 (100\u00a0to\u00a0∞)"
    assert interval(UNKNOWN, ".2f") == "–"
    assert interval(Estimate(2.0, float("nan"), float("nan")), ".1f") == "2.0"
    assert interval(Estimate(*[float("inf")] * 3), ".1f") == "∞"
    assert interval(Estimate(0.9999, 0.9998, 0.9999), ".0%") == "100%"


def test_p_values_in_words():
    assert p_value(0.04321) == "0.043"
    assert p_value(1e-310) == "< 1e-300"
    assert p_value(float("nan")) == "–"


def test_the_same_content_gives_the_same_page(whole, tmp_path, figure):
    for name in ("one", "two"):
        sections = [Section("s", pictures=[picture(figure, "c", "a")])]
        write_page(tmp_path / name, title="t", sections=sections)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()
