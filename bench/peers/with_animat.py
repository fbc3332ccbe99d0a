"""The work in animat: wandering with the sensors of Webots or of Michel, and a life with needs.

`wander_*` have no need that ever asks for an object, so that all they do is wander; their variables
and drives run all the same. `live` is what the package is for: BLIND with its needs, which goes to
objects and acts on them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import work

import animat
from animat.life.batch import advance
from animat.life.scenario import Setting, bring_together

POST = animat.ObjectType(
    name="post",
    shape=8,
    size_mm=2 * work.OBSTACLE_RADIUS,
    features={"shape": 1.0, "size": 0.0},
    affords={"grasp": 1.0, "shelter": 1.0, "interact": 1.0},
)
CONTENT = animat.Mind(
    death=False,
    variables={
        "nutrition": {"set_point": 0.0},
        "stamina": {"set_point": 1.0},
        "restlessness": {"set_point": 1.0},
    },
)
"""A mind whose drives are never positive."""


class Robots:
    """Lives of one setting, lived on in slices."""

    def __init__(self, setting: Setting, robots: int, seed: int) -> None:
        self.setting, self.seed, self.until = setting, seed, 0
        self.lives = np.arange(robots, dtype=np.uint64)
        self.states, self.present = setting.begin(seed, self.lives)

    def step(self, steps: int) -> None:
        """Live on for so many steps."""
        self.until += steps
        advance(self.setting, self.seed, self.lives, self.states, self.present, self.until)

    def turning(self) -> float:
        """Return the share of robots that are turning away now."""
        return float((self.states["memory"][:, 0] != 0.0).mean())


def world(obstacles: Sequence[tuple[float, float]]) -> animat.World:
    """Return the walled square with these obstacles, drawn as octagons."""
    return animat.World(
        animat.Layout(
            tuple(animat.Placement(type="post", x=x, y=y) for x, y in obstacles),
            types=(POST,),
            arena=animat.Arena(
                width=work.SIDE, height=work.SIDE, left=0.0, right=0.0, bottom=0.0, top=0.0
            ),
            minimum_gap=work.GAP - 5.0,
        ),
        name=f"{len(obstacles)} obstacles",
    )


def wander_linear(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Wander with one ray to a sensor, as the peers have it."""
    robot = animat.Khepera(infrared="linear")
    return Robots(bring_together(CONTENT, world(obstacles), robot), robots, seed)


def wander_michel1996(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Wander with the default sensors, fifteen probes each."""
    return Robots(bring_together(CONTENT, world(obstacles)), robots, seed)


def live(obstacles: Sequence[tuple[float, float]], robots: int, seed: int) -> Robots:
    """Live with needs, and act on what is met."""
    mind = animat.Mind(death=False)
    return Robots(bring_together(mind, world(obstacles)), robots, seed)
