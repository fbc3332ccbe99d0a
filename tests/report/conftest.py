"""The tables with a known answer that the tests of statistics have, too."""

from ..statistics.tables import *  # noqa: F403
