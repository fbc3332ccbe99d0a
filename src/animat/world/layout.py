"""Where the objects of a world stand, and everything that can be wrong with it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from animat.files.arguments import instance, real, sequence
from animat.files.settings import Settings, SettingsError, nearest
from animat.numerics.compiled import kernel
from animat.world.arena import Arena
from animat.world.geometry import Outlines, packed, polygon_gap, signed_distance
from animat.world.objects import TABLE_1, ObjectType

MINIMUM_GAP = 70.0
"""mm between neighbours: the robot's collision ring is 60 mm across, and it has to turn."""

START_FROM_EDGE, START_ROOM = 50.0, 30.0
"""mm a robot's start keeps from the edge of the playground, and from whatever is solid."""

MOST_TURN = 1e6  # rad; the sine is not a number beyond
MOST_SITES = 32_000  # the raster numbers sites with 16 bits
_MOST_PAIRS = 50
TOUCHING = 1e-6  # mm; closer than this is touching
_START_GRID = 2.0  # mm between the places tried


class LayoutError(SettingsError):
    """A layout that cannot be: it overlaps, leaves the arena, leaves no room, or does not fit."""


class Placement(Settings):
    """A site: an object of a type at x, y (mm, its centroid), turned by `angle` (rad).

    Raises SettingsError for an angle of more than a million radians either way, of which no sine
    is known.
    """

    type: str
    x: float
    y: float
    angle: float = Field(default=0.0, ge=-MOST_TURN, le=MOST_TURN)


@dataclass(frozen=True)
class Layout:
    """Object types, and the sites where they stand at the start or, spare, may come to stand.

    Sites are numbered from 0, those of `placements` first, those of `spares` after them. No two
    sites, and no site and a wall, may be closer than `minimum_gap` (mm).

    Raises:
        LayoutError: with a line for every problem there is.
    """

    placements: tuple[Placement, ...]
    types: tuple[ObjectType, ...] = TABLE_1
    spares: tuple[Placement, ...] = ()
    arena: Arena = field(default_factory=Arena)
    minimum_gap: float = MINIMUM_GAP

    def __post_init__(self) -> None:
        """Refuse a layout that cannot be."""
        for name, kind in (("placements", Placement), ("types", ObjectType), ("spares", Placement)):
            given = sequence(name, getattr(self, name), kind, LayoutError)
            object.__setattr__(self, name, given)
        instance("arena", self.arena, Arena, LayoutError)
        gap = real("minimum_gap", self.minimum_gap, 0.0, error=LayoutError)
        object.__setattr__(self, "minimum_gap", gap)
        found = type_problems(self.types)
        if not found:
            found = [*_unknown_types(self), *_place_problems(self)]
        if found:
            raise LayoutError(*found)

    @property
    def sites(self) -> tuple[Placement, ...]:
        """Every site: the objects of the start, then the spares."""
        return self.placements + self.spares

    def site_types(self) -> NDArray[np.int64]:
        """Return the type [S] of every site, as an index into `types`."""
        index = {kind.name: i for i, kind in enumerate(self.types)}
        return np.array([index[site.type] for site in self.sites], dtype=np.int64)

    def outlines(self) -> Outlines:
        """Return the outline of every site in arena coordinates."""
        return _outlines(self, range(len(self.sites)))


def type_problems(types: tuple[ObjectType, ...]) -> list[str]:
    """Return what keeps types from living in one world: they share feature and affordance names."""
    if not types:
        return ["types: there are none; a world needs at least one object type"]
    found = []
    for name, times in Counter(kind.name for kind in types).items():
        if times > 1:
            found.append(f"type {name}: defined {times} times; every type needs its own name")
    for kind in types[1:]:
        for what in ("features", "affords"):
            own, shared = set(getattr(kind, what)), set(getattr(types[0], what))
            if own != shared:
                found.append(
                    f"type {kind.name}: {what} are {_listed(own)}, but those of {types[0].name} "
                    f"are {_listed(shared)}; all types of a world have the same"
                )
    return found


def _unknown_types(layout: Layout) -> list[str]:
    known = [kind.name for kind in layout.types]
    return [
        f"{site_name(number, site, len(layout.placements))}: unknown type"
        f"{nearest(site.type, known)}"
        for number, site in enumerate(layout.sites)
        if site.type not in known
    ]


def site_name(number: int, site: Placement, objects: int) -> str:
    """Return how messages call a site: 'object 3 (CL at 500, 520)'."""
    kind = "object" if number < objects else "spare site"
    return f"{kind} {number} ({site.type} at {site.x:g}, {site.y:g})"


def _listed(names: set[str]) -> str:
    return ", ".join(sorted(names))


def _outlines(layout: Layout, numbers: range | list[int]) -> Outlines:
    polygons = {kind.name: kind.polygon() for kind in layout.types}
    sites = [layout.sites[number] for number in numbers]
    poses = np.array([(s.x, s.y, s.angle) for s in sites], dtype=np.float64).reshape(-1, 3)
    return packed([polygons[site.type] for site in sites], poses)


def _place_problems(layout: Layout) -> list[str]:
    sites, objects = layout.sites, len(layout.placements)
    if len(sites) > MOST_SITES:
        return [f"{len(sites)} sites; a world holds at most {MOST_SITES}"]
    known = {kind.name for kind in layout.types}
    numbers = [number for number, site in enumerate(sites) if site.type in known]
    names = [site_name(number, sites[number], objects) for number in numbers]
    outlines = _outlines(layout, numbers)
    found = _wall_problems(layout, names, outlines)
    pairs = np.empty((_MOST_PAIRS, 2), dtype=np.int64)
    gaps = np.empty(_MOST_PAIRS, dtype=np.float64)
    narrow = narrow_pairs(outlines, float(layout.minimum_gap), pairs, gaps)
    for (a, b), gap in zip(pairs[:narrow].tolist(), gaps.tolist(), strict=False):
        if gap <= TOUCHING:
            found.append(f"{names[a]} overlaps {names[b]}; move one of them")
        else:
            found.append(
                f"{names[a]} is {gap:.1f} mm from {names[b]}; the robot needs "
                f"{layout.minimum_gap:g} mm between them"
            )
    if narrow > _MOST_PAIRS:
        found.append(f"and {narrow - _MOST_PAIRS} more pairs of sites are too close")
    arena = layout.arena
    if not room_to_start(outlines, arena.free, arena.width, arena.height):
        found.append(
            f"no room to start: nowhere at least {START_FROM_EDGE:g} mm from the edge of the arena "
            f"is {START_ROOM:g} mm clear of walls and objects; take fewer objects or more arena"
        )
    return found


def _wall_problems(layout: Layout, names: list[str], outlines: Outlines) -> list[str]:
    left, right, bottom, top = layout.arena.free
    found = []
    for i, name in enumerate(names):
        corners = outlines.outline[outlines.first[i] : outlines.first[i + 1]]
        (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
        gap = float(min(x0 - left, right - x1, y0 - bottom, top - y1))
        if gap <= -TOUCHING:
            found.append(
                f"{name} leaves the free part of the arena "
                f"(x {left:g} to {right:g}, y {bottom:g} to {top:g} mm)"
            )
        elif gap < layout.minimum_gap - TOUCHING:
            found.append(
                f"{name} is {max(gap, 0.0):.1f} mm from the wall; the robot needs "
                f"{layout.minimum_gap:g} mm between them"
            )
    return found


@kernel
def narrow_pairs(
    outlines: Outlines, minimum: float, pairs: NDArray[np.int64], gaps: NDArray[np.float64]
) -> int:
    """Count the pairs of polygons that touch or are closer than `minimum` mm; list the first."""
    outline, first, centre, reach = outlines
    count = 0
    for a in range(len(reach)):
        for b in range(a + 1, len(reach)):
            dx = centre[a, 0] - centre[b, 0]
            dy = centre[a, 1] - centre[b, 1]
            far = reach[a] + reach[b] + minimum + TOUCHING
            if dx * dx + dy * dy > far * far:
                continue
            gap = polygon_gap(outline, first[a], first[a + 1], first[b], first[b + 1])
            if gap <= TOUCHING or gap < minimum - TOUCHING:
                if count < len(gaps):
                    pairs[count, 0] = a
                    pairs[count, 1] = b
                    gaps[count] = gap
                count += 1
    return count


@kernel
def room_to_start(
    outlines: Outlines,
    free: tuple[float, float, float, float],
    width: float,
    height: float,
) -> bool:
    """Tell whether a robot can start anywhere, trying places on a grid."""
    outline, first, centre, reach = outlines
    x_from = max(START_FROM_EDGE, free[0] + START_ROOM)
    y_from = max(START_FROM_EDGE, free[2] + START_ROOM)
    x_to = min(width - START_FROM_EDGE, free[1] - START_ROOM)
    y_to = min(height - START_FROM_EDGE, free[3] - START_ROOM)
    if x_from > x_to or y_from > y_to:
        return False
    for row in range(int((y_to - y_from) / _START_GRID) + 1):
        y = y_from + row * _START_GRID
        for column in range(int((x_to - x_from) / _START_GRID) + 1):
            x = x_from + column * _START_GRID
            clear = True
            for s in range(len(reach)):
                far = reach[s] + START_ROOM
                if (x - centre[s, 0]) ** 2 + (y - centre[s, 1]) ** 2 > far * far:
                    continue
                if signed_distance(x, y, outline, first[s], first[s + 1]) < START_ROOM:
                    clear = False
                    break
            if clear:
                return True
    return False
