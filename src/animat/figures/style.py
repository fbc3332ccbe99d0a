"""How all figures look, and how they are saved.

Colours are those of Okabe and Ito, which people with any common colour blindness can tell apart;
where two things meet, a pattern or a line style tells them apart as well, for print in black.
"""

import io
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from colorsys import hsv_to_rgb
from functools import wraps
from itertools import count
from pathlib import Path
from typing import Any, ParamSpec

from cycler import cycler
from matplotlib import colormaps, rc_context, rcParamsDefault
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from animat.files.atomic import write_whole

BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
VERMILLION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#8A8A8A"
PALE = "#E6E6E6"

PALETTE = (BLUE, ORANGE, GREEN, VERMILLION, SKY, PURPLE, YELLOW, BLACK)
HATCHES = ("", "////", "...", "xxx", "\\\\\\\\", "+++")
LINES = ("-", "--", ":", "-.")

# Shape is the hue, size the depth: warm triangles, cool circles, pale small and deep large.
_TYPES = {"TS": ORANGE, "TL": VERMILLION, "CS": SKY, "CL": BLUE}
_TYPE_WORDS = {
    "TS": "TS, small triangle",
    "TL": "TL, large triangle",
    "CS": "CS, small circle",
    "CL": "CL, large circle",
}
_AGENTS = {"BLIND": ORANGE, "AF": BLUE}
_NEEDS = {"nutrition": ORANGE, "stamina": BLUE, "restlessness": GREEN}

_OTHER = ("backend", "interactive", "toolbar", "webagg", "keymap", "animation", "date", "tk")

# Built on matplotlib's own defaults, so that a user's matplotlibrc does not show.
STYLE: dict[Any, Any] = {
    **{name: value for name, value in rcParamsDefault.items() if not name.startswith(_OTHER)},
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.labelsize": 9.0,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=PALETTE),
    "axes.axisbelow": True,
    "grid.color": PALE,
    "hatch.linewidth": 0.7,
    "lines.linewidth": 1.4,
    "savefig.facecolor": "white",
    "svg.fonttype": "path",
    "svg.hashsalt": "animat",
}

P = ParamSpec("P")


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Run `draw` under `STYLE`, whatever the user's own matplotlib settings are."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with rc_context(STYLE):
            return draw(*args, **kwargs)

    return drawn


def new_figure(width: float, height: float) -> Figure:
    """An empty figure, sides in inches, that keeps its parts from overlapping."""
    return Figure(figsize=(width, height), layout="constrained")


def colours(
    names: Iterable[str], known: Mapping[str, str], taken: Iterable[str] = ()
) -> dict[str, str]:
    """A colour for each name: its own if it is known, else the next one nobody has.

    Nobody new gets a colour that is `taken`, nor one that two have.
    """
    names = list(dict.fromkeys(names))
    others = _hues({*taken, *(known[name] for name in names if name in known)})
    return {name: known[name] if name in known else next(others) for name in names}


def _hues(taken: set[str]) -> Iterator[str]:
    """The colours of the palette, then, without end, others, but for those that are taken."""
    yield from (colour for colour in PALETTE if colour not in taken)
    for number in count(1):
        colour = to_hex(hsv_to_rgb(0.618034 * number % 1.0, 0.75, (0.9, 0.55)[number % 2]))
        if colour.upper() not in taken:
            yield colour.upper()


def type_colours(types: Iterable[str]) -> dict[str, str]:
    """A colour for each object type, Table 1's first; those always have the same.

    None is black, white or the green of what sensors reach, in which figures mark other things.
    """
    types = list(types)
    listed = [name for name in _TYPES if name in types]
    return colours([*listed, *types], _TYPES, taken=(*_TYPES.values(), GREEN, BLACK))


def need_colours(variables: Iterable[str]) -> dict[str, str]:
    """A colour for each variable, its drive and what serves it; in any order they are the same."""
    return colours(sorted(set(variables)), _NEEDS, taken=(*_NEEDS.values(), BLACK))


def agent_colours(agents: Iterable[str]) -> dict[str, str]:
    """A colour for each agent; BLIND and AF always have the same."""
    return colours(agents, _AGENTS)


def shades(names: Sequence[str]) -> dict[str, str]:
    """A colour for each of `names` in their order: darker is earlier, in print and in grey too."""
    scale = colormaps["cividis"]
    last = max(len(names) - 1, 1)
    return {name: to_hex(scale(0.75 * place / last)) for place, name in enumerate(names)}


def legend_columns(labels: Sequence[str]) -> int:
    """How many columns a legend below a figure of 6.4 inches has room for."""
    return max(1, min(3, 90 // (max(map(len, labels), default=1) + 8)))


def spread_out(values: Sequence[float]) -> bool:
    """Do positive numbers differ so much that only a logarithmic axis shows them all?"""
    return len(values) > 0 and min(values) > 0 and max(values) > 20 * min(values)


def type_words(name: str) -> str:
    """An object type as a legend says it."""
    return _TYPE_WORDS.get(name, name)


def svg(fig: Figure) -> bytes:
    """The figure as SVG; the same figure gives the same bytes on any day."""
    return _render(fig, "svg", {"Date": None})


def png(fig: Figure, dpi: int = 200) -> bytes:
    """The figure as PNG at `dpi` dots per inch."""
    return _render(fig, "png", {"Software": None}, dpi=dpi)


def save(fig: Figure, stem: Path | str) -> tuple[Path, Path]:
    """Write `stem`.svg and `stem`.png and return their paths. Raises SettingsError if it cannot."""
    stem = Path(stem)
    paths = stem.with_name(stem.name + ".svg"), stem.with_name(stem.name + ".png")
    for path, content in zip(paths, (svg(fig), png(fig)), strict=True):
        write_whole(path, content)
    return paths


def _render(fig: Figure, kind: str, metadata: dict, **settings) -> bytes:
    buffer = io.BytesIO()
    engine = fig.get_layout_engine()
    with rc_context(STYLE):
        fig.draw_without_rendering()
        fig.set_layout_engine("none")
        _settle(fig)
        fig.savefig(buffer, format=kind, metadata=metadata, **settings)
    fig.set_layout_engine(engine)
    return buffer.getvalue()


def _settle(fig: Figure) -> None:
    """Round where the layout put the parts of `fig`.

    Its solver's last digits differ from run to run, and SVG names clip paths after them.
    """
    for part in fig.subfigs:
        part.bbox_relative.set_points(part.bbox_relative.get_points().round(6))
    for ax in fig.axes:
        points = ax.get_position(original=True).get_points().round(6)
        ax.set_position(Bbox(points))
        ax.set_in_layout(True)
