"""Tests are the same wherever they are run.

Hypothesis draws the same examples in every run of CI, so that it fails for a change only. And
Ctrl-C is taken as at a terminal, also where a shell has started the tests in the background and had
them pay no heed to it.
"""

import os
import signal

from hypothesis import settings

settings.register_profile("ci", derandomize=True)
if os.environ.get("CI"):
    settings.load_profile("ci")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
