"""Lives advanced together so that one that fails does not stop the others.

This is the engine under everything that simulates more than one life. Lives are advanced by so many
steps at a time, the same in every run, and looked at in between. A life fails where a custom
function raises or gives what no life can go on with, or where a number is not finite any more.
Where one raises, the others are advanced one by one from a copy, and end as they would have alone.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from threading import Event

import numpy as np
from numpy.typing import NDArray

from animat.errors import Error
from animat.life import kernels
from animat.life.failure import carried_not_finite, failure_of, not_finite, raised, unknown
from animat.life.likelihoods import likelihoods
from animat.life.scenario import LifeError, Setting
from animat.numerics.layout import raw
from animat.numerics.threads import attempt

LOOK_EVERY = 10_000
"""Steps between two looks at lives."""

CURVE_EVERY = 500
"""Steps between two looks at networks, for a learning curve; an act takes 20 and more."""

EPISODES = 100
"""How many episodes of each network a learning curve shows; an episode is an act."""

Snapshot = tuple[NDArray[np.void], NDArray[np.uint8]]
"""States [L] of lives and the objects [L, S] present in them, at one time."""

Progress = Callable[[int], None]
"""Called with the steps simulated since the last call."""


class StoppedError(Error):
    """Lives were stopped before their end."""


@dataclass(frozen=True)
class BatchResult:
    """L lives as they ended.

    `states` [L] at the end; `errors` [L], None for a life that did not fail; `curve`
    [L, EPISODES + 1, B, T], likelihoods by episode, behaviour and object type, if it was wanted;
    `earlier`, snapshots from some time before the end, the latest last.
    """

    states: NDArray[np.void]
    errors: list[str | None]
    curve: NDArray[np.float64] | None = None
    earlier: list[Snapshot] = field(default_factory=list)

    @property
    def failed(self) -> int:
        """How many of them failed."""
        return len(self.errors) - self.errors.count(None)


@dataclass(frozen=True)
class Batch:
    """Lives of one setting and seed, up to `steps` steps each.

    `curve`: whether to note what the networks say after each of the first episodes. `back`: keep
    snapshots from which so many last steps can be simulated again sooner than from birth. Once
    `stop` is set, no life goes on. `progress` is called with the steps since its last call.
    """

    setting: Setting
    seed: int
    steps: int
    curve: bool = False
    back: int = 0
    stop: Event | None = None
    progress: Progress | None = None

    def run(
        self, lives: NDArray[np.uint64], weights: NDArray[np.float64] | None = None
    ) -> BatchResult:
        """Simulate the lives of the given indices [L], born with the networks `weights` [L, B, W].

        Raises StoppedError.
        """
        states, present, errors = self._begin(lives, weights)
        every = CURVE_EVERY if self.curve else LOOK_EVERY
        curve = self._untaught(states) if self.curve else None
        earlier = deque(maxlen=1 + math.ceil(self.back / every) if self.back else 0)
        steps = 0
        for until in _looks(self.steps, every):
            if self.stop is not None and self.stop.is_set():
                raise StoppedError
            if states["dead"].all():
                break
            # At birth a copy is as soon made anew, and lives may be many and short.
            before = (states.copy(), present.copy()) if steps or self.back else None
            if self.back and before:
                earlier.append(before)
            acts = states["acts_by_behaviour"].copy() if self.curve else None
            self._advance(lives, weights, states, present, until, errors, before)
            if curve is not None and acts is not None:
                known = likelihoods(self.setting, states)
                for n in np.flatnonzero(~np.isfinite(known).all(axis=(1, 2))):
                    errors[n] = errors[n] or unknown(self.setting, states[n])
                    states["dead"][n] = True
                _note_episodes(curve, acts, states, known)
            now = int(states["step"].sum())
            if self.progress:
                self.progress(now - steps)
            steps = now
        if any(errors):
            states["dead"] &= [error is None for error in errors]
        return BatchResult(states, errors, curve, list(earlier))

    def _begin(
        self, lives: NDArray[np.uint64], weights: NDArray[np.float64] | None
    ) -> tuple[NDArray[np.void], NDArray[np.uint8], list[str | None]]:
        """Return lives at birth; those that find no place to start fail."""
        errors: list[str | None] = [None] * len(lives)
        try:
            return *self.setting.begin(self.seed, lives, weights), errors
        except LifeError as error:
            if len(lives) == 1:
                states, present = self.setting.begin(self.seed, lives[:0])
                states, present = np.resize(states, 1), np.resize(present, (1, present.shape[1]))
                states["dead"] = True
                return states, present, [str(error)]
        own = [None if weights is None else weights[n : n + 1] for n in range(len(lives))]
        each = [self._begin(lives[n : n + 1], own[n]) for n in range(len(lives))]
        return (
            np.concatenate([one for one, _, _ in each]),
            np.concatenate([one for _, one, _ in each]),
            [error for *_, (error,) in each],
        )

    def _advance(
        self,
        lives: NDArray[np.uint64],
        weights: NDArray[np.float64] | None,
        states: NDArray[np.void],
        present: NDArray[np.uint8],
        until: int,
        errors: list[str | None],
        before: Snapshot | None,
    ) -> None:
        """Advance lives, in place, and note which of them failed; those are `dead` afterwards."""

        def earlier(n: int) -> Snapshot:
            if before is not None:
                return before[0][n : n + 1].copy(), before[1][n : n + 1].copy()
            own = None if weights is None else weights[n : n + 1]
            return self.setting.begin(self.seed, lives[n : n + 1], own)

        setting, seed = self.setting, self.seed
        _, error = attempt(lambda: advance(setting, seed, lives, states, present, until))
        if error is None:
            suspects = np.flatnonzero((states["failure"] != 0) | not_finite(states))
        else:
            suspects = np.arange(len(lives))
        for n in map(int, suspects):
            if errors[n] is not None:
                continue
            one = lives[n : n + 1], states[n : n + 1], present[n : n + 1]
            why = None
            if error is not None:
                one[1][:], one[2][:] = earlier(n)
                _, why = attempt(lambda one=one: advance(setting, seed, *one, until))
            errors[n] = failure(setting, seed, one[0], one[1], until, why, lambda n=n: earlier(n))
            states["dead"][n] |= errors[n] is not None

    def _untaught(self, states: NDArray[np.void]) -> NDArray[np.float64]:
        return np.repeat(likelihoods(self.setting, states)[:, None], EPISODES + 1, axis=1)


def advance(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    states: NDArray[np.void],
    present: NDArray[np.uint8],
    until: int,
) -> None:
    """Advance L lives, in place, until each has `until` steps or is dead."""
    call = kernels.advance.of(setting.counts, setting.functions)
    call(raw(states), present, lives, *setting.constants, seed, until)


def failure(
    setting: Setting,
    seed: int,
    life: NDArray[np.uint64],
    states: NDArray[np.void],
    until: int,
    error: Exception | None,
    earlier: Callable[[], Snapshot],
) -> str | None:
    """Return why a life (`life` [1], `states` [1]) failed while it was advanced, or None.

    `error` is what the kernel raised; `earlier` returns the life as it was before, from which it is
    advanced again, step by step, where only that can tell since when a number is not finite.
    """
    if error is not None:
        return raised(setting, states[0], error)
    if (why := failure_of(setting, states[0])) is not None or not not_finite(states)[0]:
        return why
    states, present = earlier()
    for step in range(int(states["step"][0]), until):
        advance(setting, seed, life, states, present, step + 1)
        if not_finite(states)[0]:
            break
    return f"{carried_not_finite(states)} not finite since step {int(states['step'][0]) - 1}"


def _looks(steps: int, every: int) -> Iterator[int]:
    yield from range(every, steps, every)
    yield steps


def _note_episodes(
    curve: NDArray[np.float64],
    acts: NDArray[np.int64],
    states: NDArray[np.void],
    known: NDArray[np.float64],
) -> None:
    """Note what networks say from the episode on that came after `acts` [L, B] of them."""
    for row, behaviour in zip(*np.nonzero(states["acts_by_behaviour"] - acts), strict=True):
        curve[row, acts[row, behaviour] + 1 :, behaviour] = known[row, behaviour]
