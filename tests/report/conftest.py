"""The fixtures of the tests of reports: tables with a known answer, and a multiverse."""

from ..experiments.conftest import lived, small  # noqa: F401
from ..statistics.tables import likelihoods_table, lives_table, paper_table  # noqa: F401
