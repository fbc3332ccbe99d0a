"""The command line, a file for each command.

Exit codes: 0 done, 1 failed, 2 wrong usage or input, 130 interrupted. An error is one line for
each mistake; `--debug` shows where it came from.
"""

from animat.cli import life as life
from animat.cli import replay as replay
from animat.cli import reproduce as reproduce
from animat.cli.app import main as main
