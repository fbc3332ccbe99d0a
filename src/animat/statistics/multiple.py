"""Many tests at once: p values corrected, so that none of all is called by chance alone."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def holm(p: Sequence[float]) -> NDArray[np.float64]:
    """Holm's (1979) correction of the p values of n tests: [n].

    Whoever calls those below a level alike errs in any of the n tests no more often than that.
    The smallest p counts n times, the next n - 1 times, and none less than one before it. It holds
    however the tests depend on each other. NaN, a test that could not be made, stays NaN and does
    not count.
    """
    given = np.asarray(p, dtype=np.float64)
    corrected = np.full(given.shape, np.nan)
    made = np.flatnonzero(~np.isnan(given))
    order = made[np.argsort(given[made], kind="stable")]
    times = np.arange(len(order), 0, -1)
    corrected[order] = np.minimum(1.0, np.maximum.accumulate(times * given[order]))
    return corrected
