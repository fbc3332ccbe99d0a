"""A selector that multiplies drive and likelihood, as the built-in `affordance_times_drive` does.

animat life --agent ORACLE --settings docs/examples/product.toml
"""


def product(drives, likelihoods, serves, u, memory):
    """Return the behaviour with the largest product; of equal ones, the first."""
    best = 0
    for behaviour in range(1, len(serves)):
        here = drives[serves[behaviour]] * likelihoods[behaviour]
        if here > drives[serves[best]] * likelihoods[best]:
            best = behaviour
    return best
