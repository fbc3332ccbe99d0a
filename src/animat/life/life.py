"""One life: lived, told, and what is left of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.life.setting import LifeError, Setting, bring_together
from animat.life.slices import live_recorded, live_slice
from animat.life.summary import death_of, summary
from animat.life.trace import row_dtype, table
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera
from animat.world.world import World

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SLICE = 100_000
"""Steps lived between two looks at the outside: progress, Ctrl-C, and the rows to hand on."""

LONGEST = 1 << 50

Progress = Callable[[int], None]
"""Called with the steps lived since the last call."""


@dataclass(frozen=True)
class Life:
    """A life that was lived: its setting, seed and index, its state at the end, and its trace.

    `trace` is a table with a row for each recorded step (columns in docs/trace.md), or None.
    """

    setting: Setting
    seed: int
    index: int
    state: np.record
    trace: pa.Table | None

    @property
    def mind(self) -> Mind:
        """The mind as it was born."""
        return self.setting.mind

    @property
    def world(self) -> World:
        """The world it was lived in."""
        return self.setting.world

    @property
    def lifespan(self) -> int:
        """Steps lived."""
        return int(self.state.step)

    @property
    def dead(self) -> bool:
        """Whether it ended by death, not by the cap."""
        return bool(self.state.dead)

    @property
    def death(self) -> str | None:
        """What it died of, as "nutrition low, failure", or None."""
        return death_of(self.state, self.mind)

    @property
    def summary(self) -> dict[str, object]:
        """What was counted in this life, by the names of the columns of a table of lives."""
        states = np.array([self.state], self.state.dtype)
        columns = summary(self.setting, self.seed, np.array([self.index]), states)
        return {name: column[0].as_py() for name, column in columns.items()}

    @property
    def networks(self) -> Networks:
        """The affordance networks as they were at the end."""
        return Networks(
            tuple(self.mind.behaviours),
            self.world.feature_names,
            self.mind.learning.hidden_units,
            np.array(self.state.weights),
        )

    def figure(self) -> Figure:
        """Draw the trace: variables, drives, behaviours, rewards and the path.

        Raises LifeError if the life was not recorded.
        """
        if self.trace is None:
            raise LifeError('this life was not recorded: live it with record="all"')
        from animat.life.drawing import draw_life

        return draw_life(self)


@dataclass(frozen=True)
class Recording:
    """What of a life to record: every `every`-th step, or only the `last` ones."""

    every: int = 1
    last: int | None = None

    @classmethod
    def parse(cls, text: str | None) -> Recording | None:
        """Read "all", "every:N", "last:N" or None. Raises LifeError."""
        if text is None:
            return None
        word, _, number = text.partition(":")
        count = int(number) if number.isascii() and number.isdigit() else 0
        if word == "all" and not number:
            return cls()
        if word == "every" and count > 0:
            return cls(every=count)
        if word == "last" and 0 < count <= SLICE:
            return cls(last=count)
        raise LifeError(
            f'record = "{text}"; allowed are "all", "every:N", and "last:N" up to {SLICE} steps'
        )


def live(
    mind: Mind,
    world: World,
    *,
    robot: Khepera | None = None,
    seed: int = 0,
    life: int = 0,
    steps: int = 300_000,
    record: str | None = None,
    progress: Progress | None = None,
) -> Life:
    """Live one life until death or for `steps` steps, and return it.

    The life is a pure function of the settings, `seed` and the index `life`. `record` is "all",
    "every:N", "last:N" (steps) or None. Raises LifeError for what cannot be lived.
    """
    setting = bring_together(mind, world, robot)
    recording = Recording.parse(record)
    check(seed, life, steps)
    states, present = setting.begin(seed, np.array([life], np.uint64))
    rows = [
        table(part, mind, world)
        for part in lived(setting, states, present, seed, life, steps, recording, progress)
    ]
    trace = pa.concat_tables(rows).unify_dictionaries() if recording else None
    return Life(setting, seed, life, states[0], trace)


def lived(
    setting: Setting,
    states: NDArray[np.void],
    present: NDArray[np.uint8],
    seed: int,
    life: int,
    steps: int,
    recording: Recording | None,
    progress: Progress | None = None,
) -> Iterator[NDArray[np.void]]:
    """Live the one life of `states` [1] on up to `steps`, and yield its rows as they come."""
    tell = progress or (lambda _: None)
    rest = (
        setting.mind_parameters,
        setting.robot_parameters,
        setting.raster,
        setting.functions,
        np.uint64(seed),
    )
    state = states[0]
    ring = recording is not None and recording.last is not None
    rows = np.zeros(
        0 if recording is None else recording.last or SLICE // 4, row_dtype(states.dtype)
    )
    while state.step < steps and not state.dead:
        before = int(state.step)
        until = min(before + SLICE, steps)
        if recording is None:
            live_slice(states, present, np.array([life], np.uint64), *rest, until)
        else:
            written = live_recorded(
                state, present[0], np.uint64(life), *rest, until, rows, recording.every, ring
            )
            if not ring:
                yield rows[:written].copy()
        tell(int(state.step) - before)
    if recording is not None and ring:
        count = min(len(rows), int(state.step))
        yield rows[np.arange(int(state.step) - count, int(state.step)) % len(rows)]
    elif recording is not None and state.step == 0:
        yield rows[:0]


def check(seed: int, life: int, steps: int) -> None:
    """Refuse a seed, an index or a length that is none. Raises LifeError."""
    if not 0 <= seed < 1 << 64:
        raise LifeError(f"seed = {seed}; allowed are whole numbers from 0 to 2^64 - 1")
    if not 0 <= life < 1 << 64:
        raise LifeError(f"life = {life}; allowed are whole numbers from 0 to 2^64 - 1")
    if not 0 < steps <= LONGEST:
        raise LifeError(f"steps = {steps}; allowed are whole numbers from 1 to 2^50")
