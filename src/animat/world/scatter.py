"""Random layouts: objects dropped one after another where there is still room."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from animat.files.arguments import MOST_64, instance, real, sequence, together, whole
from animat.files.settings import SettingsError, nearest
from animat.files.validation_errors import brief
from animat.numerics.compiled import compiled, kernel
from animat.numerics.elementary import sine_cosine
from animat.numerics.streams import LAYOUT, uniforms
from animat.world.arena import Arena
from animat.world.geometry import Outlines, packed, polygon_gap
from animat.world.layout import MOST_SITES, TOUCHING, Layout, LayoutError, Placement
from animat.world.objects import ObjectType

TRIES = 2_000
"""Places tried for an object before it counts as not fitting."""

RESTARTS = 20
"""How often the whole layout is begun anew before the counts count as not fitting."""

_SPARES = 1 << 20  # spares draw from lives of their own, so that objects do not depend on them
_PER_MM, _PER_RAD = 10.0, 1000.0  # poses are rounded, so that a file shows them whole


def scattered(
    counts: Mapping[str, int],
    seed: int,
    gap: float,
    arena: Arena,
    types: tuple[ObjectType, ...],
) -> Layout:
    """Return a layout with `counts` objects of each type, at least `gap` mm apart.

    A function of seed, counts, gap, arena and types alone; not of the order of the counts.

    Raises:
        LayoutError: unknown types, impossible counts, seed or gap, or counts that do not fit.
    """
    instance("arena", arena, Arena, LayoutError)
    types = sequence("types", types, ObjectType, LayoutError)
    counts, seed, gap = together(
        LayoutError, lambda: _checked_counts(counts, types), *_seed_and_gap(seed, gap)
    )
    empty = Layout(placements=(), types=types, arena=arena, minimum_gap=gap)
    of_each = {kind: counts[kind.name] for kind in types if counts.get(kind.name)}
    _refuse_too_many(arena, of_each, gap, "objects")
    wanted = [kind for kind in types for _ in range(counts.get(kind.name, 0))]
    placed = _dropped(empty, wanted, seed, gap, 0, "objects")
    return Layout(placements=placed, types=types, arena=arena, minimum_gap=gap)


def with_spares(layout: Layout, per_type: int, seed: int, gap: float) -> Layout:
    """Return the layout with `per_type` more spare sites for every type that occurs in it.

    Raises:
        LayoutError: an impossible number, seed or gap, or spares that do not fit.
    """
    seed, gap, per_type = together(
        LayoutError, *_seed_and_gap(seed, gap), lambda: whole("spares", per_type)
    )
    occurring = {site.type for site in layout.placements}
    of_each = {kind: per_type for kind in layout.types if kind.name in occurring}
    _refuse_too_many(layout.arena, of_each, gap, "spare sites")
    wanted = [kind for kind in layout.types if kind.name in occurring for _ in range(per_type)]
    placed = _dropped(layout, wanted, seed, gap, _SPARES, "spare sites")
    return Layout(
        placements=layout.placements,
        types=layout.types,
        spares=layout.spares + placed,
        arena=layout.arena,
        minimum_gap=min(gap, layout.minimum_gap),
    )


def _checked_counts(counts: Any, types: tuple[ObjectType, ...]) -> dict[str, int]:
    names = [kind.name for kind in types]

    def checked(name: Any, count: Any) -> int:
        told = name if isinstance(name, str) else brief(name)
        if name not in names:
            raise SettingsError(f"counts: unknown type {told}{nearest(told, names)}")
        return whole(f"counts: {told}", count)

    given = instance("counts", counts, Mapping)
    values = together(LayoutError, *(partial(checked, *item) for item in given.items()))
    return dict(zip(given, values, strict=True))


def _seed_and_gap(seed: Any, gap: Any) -> tuple[Callable[[], Any], Callable[[], Any]]:
    return lambda: whole("seed", seed, 0, MOST_64), lambda: real("gap", gap, 0.0)


def _refuse_too_many(
    arena: Arena, of_each: Mapping[ObjectType, int], gap: float, what: str
) -> None:
    """Refuse what cannot fit in whatever way it lies; to try so many would take for ever.

    No two of the objects overlap, each with half the gap round it, and all of them lie so in the
    free rectangle, half the gap from its walls. Raises LayoutError.
    """
    left, right, bottom, top = arena.free
    room = max(right - left - gap, 0.0) * max(top - bottom - gap, 0.0)
    areas = {kind: _area(kind, gap / 2.0) for kind in of_each}
    fit = {kind: min(MOST_SITES, room / areas[kind]) for kind in of_each}
    if any(of_each[kind] > fit[kind] for kind in of_each) or (
        sum(of_each[kind] * areas[kind] for kind in of_each) > room
    ):
        shares = ", ".join(f"at most {int(fit[kind]):,} {kind.name}" for kind in of_each)
        raise LayoutError(
            f"the {what} do not fit into {right - left:g} x {top - bottom:g} mm with gaps of "
            f"{gap:g} mm: by their area there is room for {shares} alone; take fewer, a smaller "
            "gap or a larger arena"
        )


def _area(kind: ObjectType, margin: float) -> float:
    """Return a lower bound of the area of an object with a margin round it, mm^2."""
    corners = kind.polygon()
    ahead = np.roll(corners, -1, axis=0)
    own = abs(float((corners[:, 0] * ahead[:, 1] - corners[:, 1] * ahead[:, 0]).sum())) / 2.0
    return own + math.pi * margin * margin


def _dropped(
    layout: Layout, wanted: list[ObjectType], seed: int, gap: float, life: int, what: str
) -> tuple[Placement, ...]:
    """Return places for the wanted objects beside the sites of a layout, in the order wanted."""
    fixed = layout.outlines()
    # Large ones first: they are the hardest to find room for.
    order = sorted(range(len(wanted)), key=lambda i: -_reach(wanted[i]))
    polygons = [wanted[i].polygon() for i in order]
    kinds = np.array([layout.types.index(wanted[i]) for i in order], dtype=np.int64)
    new = packed(polygons, np.zeros((len(order), 3)))
    outlines = Outlines(
        np.concatenate((fixed.outline, new.outline)),
        np.concatenate((fixed.first, fixed.first[-1] + new.first[1:])),
        np.concatenate((fixed.centre, new.centre)),
        np.concatenate((fixed.reach, new.reach)),
    )
    poses = np.empty((len(order), 3), dtype=np.float64)
    placed = np.empty(len(order), dtype=np.uint8)
    best: Counter[str] = Counter()
    for restart in range(RESTARTS):
        drop(
            np.uint64(seed), np.uint64(life + restart), layout.arena.free, float(gap),
            outlines, new.outline, kinds, TRIES, poses, placed,
        )  # fmt: skip
        if placed.all():
            by_number = dict(zip(order, poses.tolist(), strict=True))
            return tuple(
                Placement(type=kind.name, x=pose[0], y=pose[1], angle=pose[2])
                for kind, pose in ((kind, by_number[i]) for i, kind in enumerate(wanted))
            )
        fitted = Counter(wanted[order[k]].name for k in np.flatnonzero(placed))
        best = max(best, fitted, key=lambda counter: counter.total())
    left, right, bottom, top = layout.arena.free
    shares = ", ".join(
        f"{best[name]} of {count} {name}" for name, count in Counter(k.name for k in wanted).items()
    )
    raise LayoutError(
        f"the {what} do not fit into {right - left:g} x {top - bottom:g} mm with gaps of "
        f"{gap:g} mm: room was found for {shares}; take fewer, a smaller gap or a larger arena"
    )


def _reach(kind: ObjectType) -> float:
    return float(np.sqrt((kind.polygon() ** 2).sum(axis=1).max()))


@kernel
def drop(
    seed: np.uint64,
    life: np.uint64,
    free: tuple[float, float, float, float],
    gap: float,
    outlines: Outlines,
    corners: NDArray[np.float64],
    kinds: NDArray[np.int64],
    tries: int,
    poses: NDArray[np.float64],
    placed: NDArray[np.uint8],
) -> None:
    """Place the last len(kinds) polygons of `outlines` one by one, at random where there is room.

    `corners` are theirs at the origin. Once an object finds no room in `tries`, the others of its
    type are not tried any more.
    """
    outline, first, centre, reach = outlines
    fixed = len(reach) - len(kinds)
    index = 0
    for k in range(len(kinds)):
        s = fixed + k
        placed[k] = 0
        given_up = False
        for earlier in range(k):
            if kinds[earlier] == kinds[k] and placed[earlier] == 0:
                given_up = True
        for _ in range(0 if given_up else tries):
            u, v, w, _unused = uniforms(seed, life, LAYOUT, index)
            index += 1
            x = math.floor((free[0] + u * (free[1] - free[0])) * _PER_MM) / _PER_MM
            y = math.floor((free[2] + v * (free[3] - free[2])) * _PER_MM) / _PER_MM
            angle = math.floor(w * 2.0 * math.pi * _PER_RAD) / _PER_RAD
            sine, cosine = sine_cosine(angle)
            for i in range(first[s], first[s + 1]):
                a = corners[i - first[fixed], 0]
                b = corners[i - first[fixed], 1]
                outline[i, 0] = x + (a * cosine - b * sine)
                outline[i, 1] = y + (a * sine + b * cosine)
            centre[s, 0] = x
            centre[s, 1] = y
            if off_walls(s, free, gap, outlines) and off_others(s, fixed, placed, gap, outlines):
                poses[k, 0] = x
                poses[k, 1] = y
                poses[k, 2] = angle
                placed[k] = 1
                break


@compiled
def off_walls(
    s: int, free: tuple[float, float, float, float], gap: float, outlines: Outlines
) -> bool:
    """Tell whether polygon s keeps the gap (mm) from the walls."""
    outline, first, _, _ = outlines
    for i in range(first[s], first[s + 1]):
        x = outline[i, 0]
        y = outline[i, 1]
        if min(x - free[0], free[1] - x, y - free[2], free[3] - y) < gap:
            return False
    return True


@compiled
def off_others(
    s: int, fixed: int, placed: NDArray[np.uint8], gap: float, outlines: Outlines
) -> bool:
    """Tell whether polygon s keeps the gap (mm) from those before it that have been placed."""
    outline, first, centre, reach = outlines
    for other in range(s):
        if other >= fixed and placed[other - fixed] == 0:
            continue
        dx = centre[s, 0] - centre[other, 0]
        dy = centre[s, 1] - centre[other, 1]
        far = reach[s] + reach[other] + gap
        if dx * dx + dy * dy > far * far:
            continue
        between = polygon_gap(outline, first[s], first[s + 1], first[other], first[other + 1])
        if between < gap or between <= TOUCHING:
            return False
    return True
