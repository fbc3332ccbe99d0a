"""One life: lived, told, and what is left of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.files.arguments import MOST_63, MOST_64, callback, instance, whole
from animat.files.tables import to_pandas, write_csv
from animat.files.validation_errors import brief
from animat.life.batch import Progress, advance, failure
from animat.life.digest import digest
from animat.life.failure import FailedLifeError
from animat.life.kernels import advance_recorded
from animat.life.scenario import LifeError, Setting, bring_together
from animat.life.summary import death_of, summary
from animat.life.trace import ROW, table
from animat.mind.affordance import ESTIMATORS
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.numerics.layout import raw
from animat.numerics.threads import attempt
from animat.robot.khepera import Khepera
from animat.world.world import World

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

SLICE = 100_000
"""Steps lived between two looks at the outside: progress, Ctrl-C, and the rows to hand on."""

LONGEST = 1 << 50


@dataclass(frozen=True)
class Life:
    """A life that was lived: its setting, seed and index, its state at the end, and its trace.

    `trace` is a table with a row for each recorded step (columns in docs/tables.md), or None.
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
        """What was counted in this life, by the names of the columns of a table of lives.

        Its `error` is None: a life that fails is not returned.
        """
        states = np.array([self.state], self.state.dtype)
        columns = summary(self.setting, self.seed, np.array([self.index]), states)
        return {**{name: column[0].as_py() for name, column in columns.items()}, "error": None}

    @property
    def networks(self) -> Networks:
        """The affordance networks as they were at the end."""
        return Networks(
            tuple(self.mind.behaviours),
            self.world.feature_names,
            self.mind.learning.hidden_units,
            np.array(self.state.weights),
            self.mind.learning.estimator not in ESTIMATORS,
        )

    def to_pandas(self) -> pd.DataFrame:
        """Return the trace as a pandas table; needs pandas (`pip install animat[pandas]`).

        Raises LifeError if the life was not recorded, SettingsError without pandas.
        """
        return to_pandas(self._recorded())

    def to_csv(self, path: str | Path) -> None:
        """Write the trace as a CSV file, replacing what was there.

        Raises LifeError if the life was not recorded, SettingsError for what cannot be written.
        """
        write_csv(self._recorded(), path)

    def _recorded(self) -> pa.Table:
        if self.trace is None:
            raise LifeError('this life was not recorded: live it with record="all"')
        return self.trace

    def figure(self) -> Figure:
        """Draw the trace: variables, drives, behaviours, rewards and the path.

        Raises LifeError if no step of the life was recorded.
        """
        if self.trace is None or not self.trace.num_rows:
            raise LifeError('no step of this life was recorded: live it with record="all"')
        return drawn(self, self.trace)


def drawn(
    life: Life, trace: pa.Table | Iterable[pa.Table], span: tuple[int, int] | None = None
) -> Figure:
    """Draw a trace of a life that it need not hold itself.

    Of a trace in parts, `span` is its first step and the one after its last.
    """
    from animat.life.drawing import draw_life

    title = f"{life.mind.agent}, {life.world.name}, seed {life.seed}: {life.lifespan:,} steps"
    if life.death is not None:
        title += f", died of {life.death}"
    return draw_life(trace, life.mind, life.world, title, span)


class Moment(NamedTuple):
    """A life after one of its steps: everything its future depends on.

    Its setting, seed and index, and, as the kernel takes them, its state (`states` [1]) and which
    sites hold an object (`present` [1, S]).
    """

    setting: Setting
    seed: int
    index: int
    states: NDArray[np.void]
    present: NDArray[np.uint8]

    @property
    def state(self) -> np.record:
        """The state, which changes as the life is lived on."""
        return self.states[0]

    @property
    def step(self) -> int:
        """Steps lived so far."""
        return int(self.state.step)

    @property
    def digest(self) -> str:
        """What the life is here, in 32 hexadecimal digits."""
        return digest(self.state, self.present[0])

    def copy(self) -> Moment:
        """Return the same moment, of which a life can be lived on while this one stays."""
        return self._replace(states=self.states.copy(), present=self.present.copy())

    def live(self, steps: int, record: str | None = None, progress: Progress | None = None) -> Life:
        """Live the life on from here, until it has lived `steps` steps in all, and return it.

        Its trace begins here; this moment stays as it is. See `live`. Raises LifeError, and
        FailedLifeError.
        """
        choice = TraceChoice.parse(record)
        _, _, steps = check(self.seed, self.index, steps)
        return _live_on(self.copy(), steps, choice, callback("progress", progress, LifeError))


@dataclass(frozen=True)
class TraceChoice:
    """Which steps the trace of a life holds: every `every`-th, or only the `last` ones."""

    every: int = 1
    last: int | None = None

    @classmethod
    def parse(cls, text: str | None) -> TraceChoice | None:
        """Read "all", "every:N", "last:N" or None. Raises LifeError."""
        if text is None:
            return None
        word, _, number = instance("record", text, str, LifeError).partition(":")
        is_count = number.isascii() and number.isdigit() and len(number) <= len(str(LONGEST))
        count = min(int(number), LONGEST) if is_count else 0
        if word == "all" and not number:
            return cls()
        if word == "every" and count > 0:
            return cls(every=count)
        if word == "last" and 0 < count <= SLICE:
            return cls(last=count)
        raise LifeError(
            f"record = {brief(text)};"
            f' allowed are "all", "every:N", and "last:N" up to {SLICE} steps'
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
    check_functions: bool = False,
) -> Life:
    """Live one life until death or for `steps` steps, and return it.

    The life is a pure function of the settings, `seed` and the index `life`. `record` is "all",
    "every:N", "last:N" (steps) or None. With `check_functions`, custom functions check every index
    they use. Raises LifeError for what cannot be lived, and FailedLifeError where a custom function
    raises or gives what no life can go on with.
    """
    setting = bring_together(mind, world, robot, check_functions=check_functions)
    choice = TraceChoice.parse(record)
    seed, life, steps = check(seed, life, steps)
    callback("progress", progress, LifeError)
    return _live_on(birth(setting, seed, life), steps, choice, progress)


def birth(setting: Setting, seed: int, life: int) -> Moment:
    """Return the beginning of a life. Raises LifeError where it has no room to start."""
    return Moment(setting, seed, life, *setting.begin(seed, np.array([life], np.uint64)))


def _live_on(
    moment: Moment, steps: int, choice: TraceChoice | None, progress: Progress | None
) -> Life:
    mind, world = moment.setting.mind, moment.setting.world
    rows = [table(part, mind, world) for part in lived(moment, steps, choice, progress)]
    trace = pa.concat_tables(rows).unify_dictionaries() if choice else None
    return Life(moment.setting, moment.seed, moment.index, moment.state, trace)


def lived(
    moment: Moment, steps: int, choice: TraceChoice | None, progress: Progress | None = None
) -> Iterator[NDArray[np.void]]:
    """Live the life on up to `steps`, in place, and yield its rows as they come.

    Raises FailedLifeError.
    """
    tell = progress or (lambda _: None)
    start = moment.step
    ring = choice is not None and choice.last is not None
    length = 0 if choice is None else choice.last or SLICE // 4
    rows = np.zeros(length, ROW.dtype(moment.setting.counts._asdict()))
    while moment.step < steps and not moment.state.dead:
        before = moment.step
        until = min(before + SLICE, steps)
        if choice is None:
            live_unrecorded(moment, until)
        else:
            written = live_rows(moment, until, rows, choice.every, ring)
            if not ring:
                yield rows[:written].copy()
        tell(moment.step - before)
    if choice is not None and ring:
        count = min(len(rows), moment.step - start)
        yield rows[np.arange(moment.step - count, moment.step) % len(rows)]
    elif choice is not None and moment.step == start:
        yield rows[:0]


def live_unrecorded(moment: Moment, until: int) -> None:
    """Live the life on, in place, until it has lived `until` steps or is dead.

    Raises FailedLifeError.
    """
    lives = np.array([moment.index], np.uint64)
    rest = moment.states, moment.present, until
    _unfailing(moment, until, lambda: advance(moment.setting, moment.seed, lives, *rest))


def live_rows(
    moment: Moment, until: int, rows: NDArray[np.void], every: int = 1, ring: bool = False
) -> int:
    """Live the life on, in place, and fill `rows` [N]; see `advance_recorded`. Return how many.

    Raises FailedLifeError.
    """
    setting = moment.setting
    life = raw(moment.states), moment.present, np.array([moment.index], np.uint64)
    asked = moment.seed, until, raw(rows), len(rows), every, ring
    call = advance_recorded.of(setting.counts, setting.functions)
    return _unfailing(moment, until, lambda: call(*life, *setting.constants, *asked))


def _unfailing(moment: Moment, until: int, call: Callable[[], Any]) -> Any:
    """Call what lives a life on up to `until`, in place. Raises FailedLifeError where it fails."""
    before = moment.copy()
    result, error = attempt(call)
    setting, seed, lives = moment.setting, moment.seed, np.array([moment.index], np.uint64)
    why = failure(
        setting, seed, lives, moment.states, until, error, lambda: (before.states, before.present)
    )
    if why is not None:
        told = f"life {moment.index} of seed {seed} failed: {why}"
        raise FailedLifeError(told) from error
    return result


def check(seed: int, life: int, steps: int) -> tuple[int, int, int]:
    """Return a seed, an index and a length as ints. Raises LifeError for what is none."""
    return (
        whole("seed", seed, 0, MOST_64, LifeError),
        whole("life", life, 0, MOST_63, LifeError),
        whole("steps", steps, 1, LONGEST, LifeError),
    )
