"""Who of the workers of a cluster may live parts: those that have what this process has.

Workers come and go. One that has come is asked what it has. Unless that is what this process has it
gets nothing to do, and the user is told why.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from typing import Any

from distributed import Client

from animat.study.cluster.worker import ClusterError, equipment

AT_FIRST = 10.0
"""Seconds that those who are there from the beginning have to say what they have."""

PATIENCE = 30.0
"""Seconds that a worker has to say what it has; it may be busy compiling."""


class Roster:
    """The workers that may live parts, `accepted`, each with its number of threads.

    `inputs` are the files that the study draws on; `say` tells the user something in a line. For
    the thread of the client's event loop only.
    """

    def __init__(self, client: Client, inputs: Iterable[str], say: Callable[[str], None]) -> None:
        """Begin with nobody."""
        self.accepted: dict[str, int] = {}
        self.someone = asyncio.Event()
        self._client: Any = client  # its methods can be awaited here, which their types do not say
        self._say = say
        self._wanted = equipment(inputs)
        self._fit: set[str] = set()
        self._refused: dict[str, str] = {}
        self._asked: dict[str, asyncio.Task[None]] = {}
        self._waiting = False

    async def look_first(self) -> None:
        """See that the scheduler will do, and who is there.

        Raises ClusterError unless it will, and if all who are there are refused.
        """
        try:
            # It reads the tasks that it passes on, for which it needs animat, of any version.
            await self._client.run_on_scheduler(equipment, ())
        except OSError:
            raise
        except Exception as error:
            raise ClusterError(f"the scheduler has another animat, or none ({error})") from error
        await self.look(AT_FIRST)

    async def look(self, patience: float = 0.0) -> None:
        """See who is there; give new ones so many seconds to say what they have.

        Raises ClusterError if all who are there are refused.
        """
        there = await self._client.nthreads()
        for address in there.keys() - self._fit - self._refused.keys() - self._asked.keys():
            self._asked[address] = asyncio.create_task(self._ask(address))
        if patience and self._asked:
            await asyncio.wait(self._asked.values(), timeout=patience)
        self._fit &= there.keys()
        self._refused = {who: why for who, why in self._refused.items() if who in there}
        self.accepted = {who: there[who] for who in self._fit}
        if there and self._refused.keys() == there.keys():
            raise ClusterError("no worker that is there can live this study")
        self._tell(any_there=bool(there))

    def give_up(self) -> None:
        """Wait for no answer any more."""
        for task in self._asked.values():
            task.cancel()

    async def _ask(self, address: str) -> None:
        """Ask a worker what it has; the next look asks one again that does not answer."""
        paths = list(self._wanted.files)
        asking = self._client.run(equipment, paths, workers=[address], on_error="return")
        try:
            answer = (await asyncio.wait_for(asking, PATIENCE))[address]
            if isinstance(answer, Exception):
                raise answer
            lacks = answer.lacks(self._wanted)
        except OSError:
            return
        except Exception as error:
            self._refuse(address, f"it has another animat, or none ({error})")
        else:
            if lacks:
                self._refuse(address, f"it has {', '.join(lacks)}")
            else:
                self._fit.add(address)
        finally:
            del self._asked[address]

    def _refuse(self, address: str, why: str) -> None:
        self._refused[address] = why
        self._say(f"worker {address} is refused: {why}")

    def _tell(self, *, any_there: bool) -> None:
        if self.accepted:
            self._waiting = False
            self.someone.set()
            return
        self.someone.clear()
        if not self._waiting and not any_there:
            self._waiting = True
            self._say("no worker is there; waiting for one")
