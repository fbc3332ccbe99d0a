"""A laboratory for motivated robots: a mind with needs, in a robot, in a world, lives a life.

    world = animat.World.abundant()
    learner = animat.Mind(agent="LEARNING")
    life = animat.live(learner, world, seed=1, record="last:500")

Everything public is named here and loaded when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from animat.cli.one_life import record
    from animat.errors import Error, SettingsError
    from animat.life.life import Life, Moment, live
    from animat.life.lives import Lives, live_many
    from animat.mind.mind import Behaviour, Drive, Learning, Mind, VariableChange
    from animat.mind.networks import Networks
    from animat.recording.recording import Recording
    from animat.robot.khepera import Khepera
    from animat.study_run import StudyRun, run
    from animat.version import __version__ as __version__
    from animat.world.arena import Arena
    from animat.world.layout import Layout, Placement
    from animat.world.objects import TABLE_1, ObjectType
    from animat.world.world import World

_HOMES = {
    "Arena": "animat.world.arena",
    "Behaviour": "animat.mind.mind",
    "Drive": "animat.mind.mind",
    "Error": "animat.errors",
    "Khepera": "animat.robot.khepera",
    "Layout": "animat.world.layout",
    "Learning": "animat.mind.mind",
    "Life": "animat.life.life",
    "Lives": "animat.life.lives",
    "Mind": "animat.mind.mind",
    "Moment": "animat.life.life",
    "Networks": "animat.mind.networks",
    "ObjectType": "animat.world.objects",
    "Placement": "animat.world.layout",
    "Recording": "animat.recording.recording",
    "SettingsError": "animat.errors",
    "StudyRun": "animat.study_run",
    "TABLE_1": "animat.world.objects",
    "VariableChange": "animat.mind.mind",
    "World": "animat.world.world",
    "__version__": "animat.version",
    "live": "animat.life.life",
    "live_many": "animat.life.lives",
    "record": "animat.cli.one_life",
    "run": "animat.study_run",
}

__all__ = [
    "TABLE_1",
    "Arena",
    "Behaviour",
    "Drive",
    "Error",
    "Khepera",
    "Layout",
    "Learning",
    "Life",
    "Lives",
    "Mind",
    "Moment",
    "Networks",
    "ObjectType",
    "Placement",
    "Recording",
    "SettingsError",
    "StudyRun",
    "VariableChange",
    "World",
    "live",
    "live_many",
    "record",
    "run",
]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used, so that importing animat stays fast."""
    if name not in _HOMES:
        raise AttributeError(f"module 'animat' has no attribute '{name}'")
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names."""
    return __all__
