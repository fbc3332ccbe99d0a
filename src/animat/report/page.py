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
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined
from matplotlib.figure import Figure

from animat.figures.style import png, svg
from animat.files.atomic import write_whole

NOT_KNOWN, ENDLESS = "–", "∞"

GENERATOR = '<meta name="generator" content="animat">'
"""By this line in its head a page is known for one of ours."""

SMALLEST_P = 1e-300
"""Smaller p values are not told from each other."""

LARGEST_SVG = 400_000
"""A picture whose SVG has more bytes is put into the page as PNG."""


class Badge(str):
    """A verdict as a cell of a table."""

    __slots__ = ()


@dataclass(frozen=True)
class TableBlock:
    """A table: names of the columns, rows of texts or badges, what is said below and above it."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
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


def write_page(path: Path | str, template: str = "page", /, **content: Any) -> None:
    """Write a page to `path`, whole or not at all.

    The template of that name gets `content`; the general one shows `title`, the paragraphs
    `notices` and `lead`, and `sections`. Raises SettingsError if it cannot be written.
    """
    environment = Environment(
        loader=FunctionLoader(_template),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"form": format, "interval": interval, "p": p_value, "badge": Badge}
    environment.tests["badge"] = lambda cell: isinstance(cell, Badge)
    given = {"notices": (), "lead": (), "sections": (), "files": None, "contents": []}
    page = environment.get_template(f"{template}.html.j2")
    text = page.render(given | content, generator=GENERATOR)
    write_whole(Path(path), text.encode())


def _template(name: str) -> str:
    return files("animat.report").joinpath("templates", name).read_text("utf-8")


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


def address_of(path: Path) -> str:
    """A saved SVG or PNG as an address that holds it."""
    kind = {".svg": "svg+xml", ".png": "png"}[path.suffix]
    return Picture(kind, path.read_bytes(), "", "").address


def interval(estimate: Sequence[float], form: str) -> str:
    """Value, low and high as text, such as "2.01 (1.95 to 2.07)"; a dash for what is not known.

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
