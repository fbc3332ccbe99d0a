"""The fixtures of the tests of statistics: tables with a known answer, and made-up multiverses."""

from .multiverses import (  # noqa: F401
    combinations,
    make_likelihoods,
    make_lives,
    make_universes,
    planted,
    readings,
)
from .tables import likelihoods_table, lives_table, paper_table  # noqa: F401
