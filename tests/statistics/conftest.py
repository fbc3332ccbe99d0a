"""The fixtures of the tests of statistics."""

from .multiverses import *  # noqa: F403
from .tables import *  # noqa: F403
