"""Networks looked into: what each says of objects, and its weights."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from animat.figures.style import BLACK, GREY, new_figure, styled, type_colours

SURFACE = np.linspace(0.0, 1.0, 41)
"""The values of either feature at which a surface is drawn."""

Layers = tuple[NDArray[np.float64], NDArray[np.float64]]
Said = tuple[NDArray[np.float64], Sequence[float]]


@styled
def networks_figure(
    behaviours: Sequence[str],
    features: Sequence[str],
    layers: Sequence[Layers],
    surfaces: NDArray[np.float64] | None,
    objects: Mapping[str, Said],
) -> Figure:
    """A column for each of B networks: what it says of objects, and below that its weights.

    `layers` are the weights of hidden units [H, 1 + F] and output [1 + H] of each, biases first;
    `surfaces` [B, N, N] the likelihoods at `SURFACE` of two features, [second, first], or None;
    `objects` each one's features [F] and its likelihoods [B].
    """
    speaks = surfaces is not None or bool(objects)
    fig = new_figure(0.9 + 2.6 * len(behaviours), 4.9 if speaks else 2.3)
    axes = fig.subplots(
        1 + speaks, len(behaviours), squeeze=False, height_ratios=[3, 2] if speaks else [1]
    )
    for b, name in enumerate(behaviours):
        top = axes[0, b]
        if surfaces is not None:
            _surface(top, surfaces[b], features, objects)
        elif objects:
            _bars(top, {kind: said[b] for kind, (_, said) in objects.items()})
        top.set_title(name)
    _share_weights(fig, axes[-1], layers, features)
    if surfaces is not None:
        bar = fig.colorbar(axes[0, 0].images[0], ax=axes[0].tolist())
        bar.set_label("likelihood (line: 0.5)")
    elif objects:
        axes[0, 0].set_ylabel("likelihood")
    return fig


def _surface(
    ax: Axes, said: NDArray[np.float64], features: Sequence[str], objects: Mapping[str, Said]
) -> None:
    ax.imshow(said, origin="lower", extent=(0, 1, 0, 1), vmin=0, vmax=1, cmap="cividis")
    if said.min() < 0.5 < said.max():
        ax.contour(SURFACE, SURFACE, said, [0.5], colors="white", linewidths=1.2)
    colours = type_colours(objects)
    for kind, ((x, y), _) in objects.items():
        ax.plot(x, y, "o", color=colours[kind], mec=BLACK, ms=8, clip_on=False, zorder=3)
        ax.annotate(
            kind, (x, y), (0, 7), textcoords="offset points", ha="center", annotation_clip=False
        )
    ax.set_xlabel(features[0])
    ax.set_ylabel(features[1])


def _bars(ax: Axes, said: Mapping[str, float]) -> None:
    colours = type_colours(said)
    ax.bar([*said], [*said.values()], color=[colours[kind] for kind in said], edgecolor=BLACK)
    ax.axhline(0.5, color=GREY, lw=0.8)
    ax.set_ylim(0, 1)


def _share_weights(
    fig: Figure, row: Sequence[Axes], layers: Sequence[Layers], features: Sequence[str]
) -> None:
    """Draw the weights of all networks in one scale, a row for each unit."""
    hidden, inputs = len(layers[0][0]), len(features)
    most = max(float(np.abs(np.concatenate([u.ravel(), o])).max()) for u, o in layers) or 1.0
    image: Any = None
    for ax, (units, output) in zip(row, layers, strict=True):
        shown = np.full((hidden + 1, 1 + max(inputs, hidden)), np.nan)
        shown[:hidden, : 1 + inputs] = units
        shown[hidden, : 1 + hidden] = output
        image = ax.imshow(shown, vmin=-most, vmax=most, cmap="PuOr", aspect="auto")
        if shown.size <= 60:
            for (r, c), value in np.ndenumerate(shown):
                if np.isfinite(value):
                    dark = abs(value) > 0.6 * most
                    ink = "white" if dark else BLACK
                    ax.text(c, r, f"{value:.2g}", ha="center", va="center", color=ink, fontsize=8)
        ax.set_yticks(range(hidden + 1), [*(f"unit {h + 1}" for h in range(hidden)), "output"])
        named = [f"{name}\n" for name in features] + [""] * max(0, hidden - inputs)
        units_named = [f"unit {h + 1}" for h in range(hidden)] + [""] * max(0, inputs - hidden)
        both = [a + b for a, b in zip(named, units_named, strict=True)]
        ax.set_xticks(range(1 + max(inputs, hidden)), ["bias", *both])
        ax.tick_params(length=0, labelsize=8)
    fig.colorbar(image, ax=list(row)).set_label("weight")
