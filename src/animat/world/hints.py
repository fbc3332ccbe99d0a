"""What in a world looks like a slip: it is allowed, and is hardly what its author meant."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from animat.world.files import WorldFile
from animat.world.layout import START_FROM_EDGE, START_ROOM, Placement, site_name
from animat.world.raster import FREE, Raster
from animat.world.world import World

IN_REACH = 37.5
"""mm from an object at which the centre of a Khepera is when it acts on it: radius and contact."""

MOST_TOLD = 10
"""Objects of which the same is told."""


class Room(NamedTuple):
    """How much of a world is free: all of it, and where the centre of a robot can be, in m²."""

    free: float
    roomy: float


def hints_of_file(file: WorldFile) -> Iterator[str]:
    """Yield what is odd about a world as it is written, whether it can be or not."""
    sites = (*file.objects, *file.spares)
    numbered = [(site_name(n, site, len(file.objects)), site) for n, site in enumerate(sites)]
    for name, site in _first([each for each in numbered if abs(each[1].angle) > 2.0 * math.pi]):
        yield (
            f"{name}: angle = {site.angle:g} rad is more than a turn; if it is in degrees, write"
            f" {math.radians(site.angle):.4f}"
        )
    for kind in file.types:
        across = float(np.ptp(kind.polygon(), axis=0).min())
        if across < file.resolution:
            yield (
                f"type {kind.name}: is {across:g} mm wide, less than a cell of the map"
                f" (resolution = {file.resolution:g} mm): a robot may not notice it; are these mm?"
            )
    standing = {site.type for site in file.objects}
    for kind in file.types:
        if kind.name not in {site.type for site in sites}:
            yield f"type {kind.name}: no object is of this type"
    here = [kind for kind in file.types if kind.name in standing]
    for one, other in combinations(here, 2):
        if one.features == other.features and one.affords != other.affords:
            yield (
                f"types {one.name} and {other.name} have the same features and afford different"
                " things: no network can tell them apart"
            )
    for name in file.types[0].affords if here else ():
        if not any(kind.affords.get(name) for kind in here):
            yield f"no object affords {name}: every act that needs it fails"


def hints_of_world(world: World, raster: Raster) -> Iterator[str]:
    """Yield what a robot cannot reach in a world, by its raster of at least `IN_REACH` mm."""
    from scipy.ndimage import label

    parts = np.zeros(raster.clearance.shape, np.int32)
    label(raster.clearance >= START_ROOM, output=parts)
    startable = _startable(world, raster)
    from_starts = [part for part in np.unique(parts[startable]) if part > 0]
    if len(from_starts) > 1:
        yield (
            f"robots can start in {len(from_starts)} parts of the world that no way of"
            f" {2 * START_ROOM:g} mm joins: what a life meets depends on where it starts"
        )
    near = (raster.near_distance <= IN_REACH) & np.isin(parts, from_starts)[..., np.newaxis]
    reached = set(np.unique(raster.near_site[near]).tolist())
    objects = [
        (site_name(n, site, world.n_objects), site)
        for n, site in enumerate(world.layout.placements)
        if n not in reached
    ]
    for name, _ in _first(objects):
        yield f"{name}: is out of reach: no way of {2 * START_ROOM:g} mm leads there"


def room(raster: Raster) -> Room:
    """Return how much of a world is free."""
    cell = (raster.resolution / 1000.0) ** 2
    return Room(
        float((raster.solid == FREE).sum()) * cell,
        float((raster.clearance >= START_ROOM).sum()) * cell,
    )


def _startable(world: World, raster: Raster) -> NDArray[np.bool_]:
    """Return where [R, C] a life may start."""
    rows, columns = raster.clearance.shape
    x = (np.arange(columns) - raster.border + 0.5) * raster.resolution
    y = (np.arange(rows) - raster.border + 0.5) * raster.resolution
    arena = world.arena
    across = (x >= START_FROM_EDGE) & (x <= arena.width - START_FROM_EDGE)
    along = (y >= START_FROM_EDGE) & (y <= arena.height - START_FROM_EDGE)
    return (raster.clearance >= START_ROOM) & along[:, np.newaxis] & across


def _first(found: list[tuple[str, Placement]]) -> Iterator[tuple[str, Placement]]:
    """Yield the first of many."""
    yield from found[:MOST_TOLD]
    if len(found) > MOST_TOLD:
        name, site = found[MOST_TOLD]
        yield f"{name} and {len(found) - MOST_TOLD - 1} more", site
