"""Lives lived so that one that fails does not stop the others.

A life fails where a function of the user's raises, or where a number it carries on is not finite
any more. Lives are looked at every so many steps, the same in every run; a life that was found not
finite is lived again, step by step, to say since when. Where one raises, its whole company is
lived again one by one.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from threading import Event

import numpy as np
from numpy.typing import NDArray

from animat.errors import Error
from animat.life.likelihoods import likelihoods
from animat.life.lives import live_on
from animat.life.setting import Setting

LOOK_EVERY = 10_000
"""Steps between two looks at lives."""

CURVE_EVERY = 500
"""Steps between two looks at networks, for a learning curve; an act takes 20 and more."""

EPISODES = 100
"""How many episodes of each network a learning curve shows; an episode is an act."""

CARRIED = (
    *("x", "y", "heading"),
    *("values", "drives", "drive_sum"),
    *("estimates", "likelihoods", "weights"),
)
"""What of a state must be finite. The memory of a wander controller is its own affair."""

Snapshot = tuple[NDArray[np.void], NDArray[np.uint8]]
"""States [L] of lives and the objects [L, S] present in them, at one time."""


class StoppedError(Error):
    """Lives were stopped before their end."""


@dataclass(frozen=True)
class Watched:
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
class Company:
    """Lives of one setting and seed, up to `steps` steps each.

    `curve`: whether to note what the networks say after each of the first episodes. `back`: keep
    snapshots from which so many last steps can be lived again sooner than from birth. Once `stop`
    is set, no life goes on.
    """

    setting: Setting
    seed: int
    steps: int
    curve: bool = False
    back: int = 0
    stop: Event | None = None

    def live(
        self, lives: NDArray[np.uint64], weights: NDArray[np.float64] | None = None
    ) -> Watched:
        """Live the lives of the given indices [L], born with the networks `weights` [L, B, W].

        Raises StoppedError.
        """
        try:
            return self._live_together(lives, weights)
        except (StoppedError, MemoryError):
            raise
        except Exception as error:
            if len(lives) == 1:
                return self._failed(lives, weights, error)
        each = [slice(n, n + 1) for n in range(len(lives))]
        alone = [self.live(lives[n], None if weights is None else weights[n]) for n in each]
        return Watched(
            np.concatenate([one.states for one in alone]),
            [error for one in alone for error in one.errors],
            np.concatenate([one.curve for one in alone if one.curve is not None])
            if self.curve
            else None,
        )

    def _live_together(
        self, lives: NDArray[np.uint64], weights: NDArray[np.float64] | None
    ) -> Watched:
        states, present = self.setting.begin(self.seed, lives, weights)
        errors: list[str | None] = [None] * len(lives)
        every = CURVE_EVERY if self.curve else LOOK_EVERY
        curve = self._untaught(states) if self.curve else None
        earlier = deque(maxlen=1 + math.ceil(self.back / every) if self.back else 0)
        before = 0
        for until in _looks(self.steps, every):
            if self.stop is not None and self.stop.is_set():
                raise StoppedError
            if states["dead"].all():
                break
            if self.back:
                earlier.append((states.copy(), present.copy()))
            acts = states["acts_by_behaviour"].copy() if self.curve else None
            live_on(self.setting, self.seed, lives, states, present, until)
            for n in np.flatnonzero(_not_finite(states)):
                if errors[n] is None:
                    own = None if weights is None else weights[n : n + 1]
                    errors[n] = self._since_when(lives[n : n + 1], own, before, until)
                    states["dead"][n] = True  # so that it does not go on
            if curve is not None and acts is not None:
                _note_episodes(curve, acts, states, likelihoods(self.setting, states))
            before = until
        if any(errors):
            states["dead"] &= [error is None for error in errors]
        return Watched(states, errors, curve, list(earlier))

    def _since_when(
        self,
        life: NDArray[np.uint64],
        weights: NDArray[np.float64] | None,
        before: int,
        until: int,
    ) -> str:
        """Live a life again, from step `before` on step by step, and say since when what fails."""
        states, present = self.setting.begin(self.seed, life, weights)
        live_on(self.setting, self.seed, life, states, present, before)
        for step in range(before, until):
            live_on(self.setting, self.seed, life, states, present, step + 1)
            if _not_finite(states)[0]:
                break
        names = [name for name in CARRIED if not np.isfinite(states[name]).all()]
        return f"{', '.join(names)} not finite since step {int(states['step'][0]) - 1}"

    def _failed(
        self,
        life: NDArray[np.uint64],
        weights: NDArray[np.float64] | None,
        error: Exception,
    ) -> Watched:
        """Return a single life that raised `error`, with the step if it was in one."""
        told = " ".join(f"{type(error).__name__}: {error}".split())
        states, present = self.setting.begin(self.seed, life[:0])
        try:
            states, present = self.setting.begin(self.seed, life, weights)
            live_on(self.setting, self.seed, life, states, present, self.steps)
        except Exception:
            if len(states):
                told += f", in step {int(states['step'][0])}"
        shape = (1, EPISODES + 1, len(self.setting.mind.behaviours), len(self.setting.world.types))
        none = np.full(shape, np.nan) if self.curve else None
        return Watched(np.resize(states, 1), [told], none)

    def _untaught(self, states: NDArray[np.void]) -> NDArray[np.float64]:
        return np.repeat(likelihoods(self.setting, states)[:, None], EPISODES + 1, axis=1)


def _looks(steps: int, every: int) -> Iterator[int]:
    yield from range(every, steps, every)
    yield steps


def _not_finite(states: NDArray[np.void]) -> NDArray[np.bool_]:
    """Tell which of L lives carry a number that is not finite."""
    found = np.zeros(len(states), bool)
    for name in CARRIED:
        # A sum costs a fraction of a look at each, and is not finite if one of them is not.
        with np.errstate(over="ignore", invalid="ignore"):
            total = np.add.reduce(states[name], axis=None)
        if not math.isfinite(total):
            finite = np.isfinite(states[name])
            found |= ~finite.all(axis=tuple(range(1, finite.ndim)))
    return found


def _note_episodes(
    curve: NDArray[np.float64],
    acts: NDArray[np.int64],
    states: NDArray[np.void],
    known: NDArray[np.float64],
) -> None:
    """Note what networks say from the episode on that came after `acts` [L, B] of them."""
    for row, behaviour in zip(*np.nonzero(states["acts_by_behaviour"] - acts), strict=True):
        curve[row, acts[row, behaviour] + 1 :, behaviour] = known[row, behaviour]
