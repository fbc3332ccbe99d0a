"""The agents of the experiments: what makes one act on the object it meets, and whether it learns.

BLIND acts on whatever it meets. AF asks its trained networks and leaves alone what they speak
against. LEARNING is blind and trains its networks as it lives. ORACLE knows Table 1. RANDOM picks
any behaviour for whatever it meets (how the paper of 2010 remembers the baseline of 2003).
"""

from __future__ import annotations

from typing import NamedTuple

ACCEPT_ALL, ASK_NETWORKS, ASK_TRUTH = range(3)
"""By what an agent judges whether an object suits the behaviour it has chosen."""


class Agent(NamedTuple):
    """How an agent judges, whether it learns, whether it may die, its selector."""

    judge: int
    learns: bool
    mortal: bool
    selector: str


AGENTS = {
    "BLIND": Agent(ACCEPT_ALL, learns=False, mortal=True, selector="winner_take_all"),
    "AF": Agent(ASK_NETWORKS, learns=False, mortal=True, selector="winner_take_all"),
    "LEARNING": Agent(ACCEPT_ALL, learns=True, mortal=False, selector="winner_take_all"),
    "ORACLE": Agent(ASK_TRUTH, learns=False, mortal=True, selector="winner_take_all"),
    "RANDOM": Agent(ACCEPT_ALL, learns=False, mortal=True, selector="random"),
}
