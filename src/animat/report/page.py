"""One self-contained page: what was asked, what came out, and how it was made.

The page is a single HTML file: style and pictures are inside it, nothing runs in it, and it
fetches nothing.
"""

import base64
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, StrictUndefined
from matplotlib.figure import Figure

from animat.figures.style import png, svg
from animat.files.atomic import write_whole
from animat.statistics.claims import Verdict
from animat.statistics.estimates import LEVEL, Estimate
from animat.statistics.paper_claims import Claim, Part
from animat.statistics.survival import CellSummary

PAPER = (
    "Cos-Aguilera, I., Cañamero, L. and Hayes, G. M. (2003). Motivation-Driven Learning of "
    "Object Affordances: First Experiments Using a Simulated Khepera Robot."
)

NOT_KNOWN, ENDLESS = "–", "∞"

GENERATOR = '<meta name="generator" content="animat">'
"""By this line in its head a page is known for one of ours."""

SMALLEST_P = 1e-300
"""Smaller p values are not told from each other."""

LARGEST_SVG = 400_000
"""A picture whose SVG has more bytes is put into the page as PNG."""


@dataclass(frozen=True)
class Badge:
    """A verdict as a cell of a table."""

    verdict: Verdict


@dataclass(frozen=True)
class TableBlock:
    """A table: names of the columns, rows of texts or badges, what is said below and above it."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str | Badge]]
    note: str = ""
    title: str = ""


@dataclass(frozen=True)
class Picture:
    """A picture: its kind ("svg+xml" or "png"), its bytes, a caption, and words in its place."""

    kind: str
    content: bytes
    caption: str
    alternative: str

    @property
    def address(self) -> str:
        """The picture as an address that holds it."""
        return f"data:image/{self.kind};base64,{base64.b64encode(self.content).decode()}"


@dataclass(frozen=True)
class Section:
    """A part of the page. Its blocks come in the order of the fields; all are optional.

    `terms` are names with their values; `code` is shown as it is typed; `notices`, warnings that
    nobody should miss, come before all else.
    """

    title: str
    paragraphs: Sequence[str] = ()
    items: Sequence[str] = ()
    terms: Mapping[str, str] | None = None
    tables: Sequence[TableBlock] = ()
    pictures: Sequence[Picture] = ()
    code: str = ""
    notices: Sequence[str] = ()


def write_page(
    path: Path | str,
    title: str,
    sections: Sequence[Section],
    *,
    lead: Sequence[str] = (),
    notices: Sequence[str] = (),
) -> None:
    """Write the page to `path`, whole or not at all.

    `notices` and then `lead` are paragraphs before all sections. Raises SettingsError if it cannot
    be written.
    """
    source = files("animat.report").joinpath("templates/report.html.j2").read_text("utf-8")
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    text = environment.from_string(source).render(
        title=title,
        notices=notices,
        lead=lead,
        sections=sections,
        paper=PAPER,
        generator=GENERATOR,
        is_badge=_is_badge,
    )
    write_whole(Path(path), text.encode())


def is_page(path: Path) -> bool:
    """Whether a file is a page that was written here. Raises OSError if it cannot be read."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return GENERATOR.encode() in file.read(1_000)


def picture(fig: Figure, caption: str, alternative: str) -> Picture:
    """A figure as a picture of the page."""
    content = svg(fig)
    if len(content) <= LARGEST_SVG:
        return Picture("svg+xml", content, caption, alternative)
    return Picture("png", png(fig), caption, alternative)


def picture_file(path: Path | str, caption: str, alternative: str) -> Picture:
    """A saved SVG or PNG as a picture of the page."""
    path = Path(path)
    kind = {".svg": "svg+xml", ".png": "png"}[path.suffix]
    return Picture(kind, path.read_bytes(), caption, alternative)


def claims_section(claims: Sequence[Claim], title: str = "The paper's claims") -> Section:
    """The claims with the paper's figure, ours, and the verdict; their parts in a second table."""
    tables = [
        TableBlock(
            ("", "Claim", "The paper", "Here", "Verdict", "How"),
            [
                (claim.id, claim.text, claim.paper, _of(claim), Badge(claim.verdict), claim.how)
                for claim in claims
            ],
            f"Intervals at {LEVEL:.0%}. A claim holds if the whole interval agrees with it, fails "
            "if the whole interval contradicts it, and is undecided otherwise.",
        )
    ]
    parts = [(claim.id, part) for claim in claims for part in claim.parts]
    if parts:
        tables.append(
            TableBlock(
                ("", "Part", "Here", "Verdict"),
                [(name, part.label, _of(part), Badge(part.verdict)) for name, part in parts],
                "The numbers behind the claims that have several. C3: ratio of mean lifespans "
                "with its interval; C7: mean likelihood over robots with its interval.",
            )
        )
    return Section(title, tables=tables)


def cells_section(summaries: Sequence[CellSummary], title: str = "The cells") -> Section:
    """Lifespans, acts and stability of each cell, and how its lives ended."""
    lives = TableBlock(
        ("Cell", "Lives", "Alive at the cap", "Mean lifespan (steps)", "Median lifespan (steps)",
         "Acts that succeed", "Mean drive"),
        [
            (
                ", ".join(map(str, cell.cell)),
                f"{cell.lives:,}",
                f"{cell.alive:,}",
                interval(cell.mean, ",.0f"),
                interval(cell.median, ",.0f"),
                interval(cell.success_rate, ".1%"),
                interval(cell.stability, ".3f"),
            )
            for cell in summaries
        ],
        f"Intervals at {LEVEL:.0%}. Means are restricted: a life still going on at the cap counts "
        "as ending there. Mean drive is physiological stability; lower is better.",
    )  # fmt: skip
    deaths = TableBlock(
        ("Cell", "How it ended", "Lives", "Share"),
        [
            (", ".join(map(str, cell.cell)), way.label, f"{way.count:,}",
             interval(way.share, ".1%"))
            for cell in summaries
            for way in cell.deaths
        ],
    )  # fmt: skip
    return Section(title, tables=(lives, deaths))


def interval(estimate: Estimate, form: str) -> str:
    """An estimate as text, such as "2.01 (1.95 to 2.07)"; a dash for what is not known.

    A value whose interval is not known, or has no width, stands alone.
    """
    value, low, high = (_number(number, form) for number in estimate)
    if {low, high} in ({NOT_KNOWN}, {value}):
        return value
    # Spaces that do not break keep the interval on one line of a narrow column.
    return f"{value} ({low}\u00a0to\u00a0{high})"


def p_value(p: float) -> str:
    """A p value as text; a dash for a test that could not be made."""
    if math.isnan(p):
        return NOT_KNOWN
    return f"{p:.2g}" if p > SMALLEST_P else f"< {SMALLEST_P:g}"


def _number(number: float, form: str) -> str:
    if math.isnan(number):
        return NOT_KNOWN
    return ENDLESS if math.isinf(number) else format(number, form)


def _of(number: Claim | Part) -> str:
    return interval(Estimate(number.ours, number.low, number.high), ".2f")


def _is_badge(value: object) -> bool:
    return isinstance(value, Badge)
