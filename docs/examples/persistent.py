"""A selector that persists: what a robot has set out to do it goes on with for a while.

animat life --settings docs/examples/persistent.toml
"""

PATIENCE = 3
"""How many objects in a row are used for one drive before another may take over."""


def persistent(drives, likelihoods, serves, u, memory):
    """Serve the drive of the last choice again, up to PATIENCE times; else the strongest.

    `memory` holds the drive served last, counted from 1, and how often in a row.
    """
    served = int(memory[0]) - 1
    if served < 0 or memory[1] >= PATIENCE or drives[served] <= 0.0:
        served = 0
        for d in range(1, len(drives)):
            if drives[d] > drives[served]:
                served = d
        memory[1] = 0.0
    memory[0] = served + 1.0
    memory[1] += 1.0
    for behaviour in range(len(serves)):
        if serves[behaviour] == served:
            return behaviour
    return -1
