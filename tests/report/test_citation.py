"""The citation is that of CITATION.cff."""

import re
from pathlib import Path

from animat.report.citation import bibtex

CFF = (Path(__file__).parents[2] / "CITATION.cff").read_text("utf-8")


def plain(text):
    """A text without what BibTeX needs, on one line."""
    return " ".join(text.replace(r"{\~n}", "ñ").replace("{", "").replace("}", "").split())


def test_it_says_what_citation_cff_says():
    (version,) = re.findall(r"^version: (.*)$", CFF, re.M)
    cited = plain(bibtex(version))
    (title,) = re.findall(r'^title: "(.*)"$', CFF, re.M)
    (author,) = re.findall(r"^  - name: (.*)$", CFF, re.M)
    (licence,) = re.findall(r"^license: (.*)$", CFF, re.M)
    for value in (title, author, licence, version):
        assert f"= {value}" in cited
    (paper,) = re.findall(r"^    title: >-\n((?:      .*\n)+)", CFF, re.M)
    assert f"title = {plain(paper)}," in cited
    family = re.findall(r"family-names: (.*)", CFF)
    given = re.findall(r"given-names: (.*)", CFF)
    names = " and ".join(f"{f}, {g}" for f, g in zip(family, given, strict=True))
    assert f"author = {names}," in cited
    (year,) = re.findall(r"^    year: (.*)$", CFF, re.M)
    assert f"year = {year}" in cited


def test_braces_are_closed():
    cited = bibtex("1.2.3")
    assert cited.count("{") == cited.count("}")
    assert "version = {1.2.3}" in cited
