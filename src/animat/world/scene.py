"""A scene: what stands about a robot."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from animat.world.raster import Raster


class Scene(NamedTuple):
    """A world as drawn, and which of its sites hold an object: `present` [S]."""

    raster: Raster
    present: NDArray[np.uint8]
