"""The command line, a file for each command.

Exit codes: 0 done, 1 failed, 2 wrong usage or input, 130 interrupted. An error is one line for
each mistake; `--debug` shows where it came from.
"""

from animat.cli import check as check
from animat.cli import export as export
from animat.cli import life as life
from animat.cli import multiverse as multiverse
from animat.cli import new as new
from animat.cli import replay as replay
from animat.cli import report as report
from animat.cli import reproduce as reproduce
from animat.cli import run as run
from animat.cli import schema as schema
from animat.cli import sensitivity as sensitivity
from animat.cli import status as status
from animat.cli import verify as verify
from animat.cli import world as world
from animat.cli.app import main as main
