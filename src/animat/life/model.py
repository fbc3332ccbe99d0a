"""What a step reads beside the state: the model, and the key of its random numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

from animat.mind.functions import Functions


class Model(NamedTuple):
    """What does not change in a life: the records of mind and robot, and the mind's functions."""

    mind: Any
    robot: Any
    functions: Functions


class Key(NamedTuple):
    """What the random numbers of a life are addressed by, beside stream and number."""

    seed: Any
    life: Any
