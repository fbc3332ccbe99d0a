"""How long tests wait where a number of seconds has to be given."""

LONGEST = 600.0
"""Seconds; a test that hangs for longer is ended by pytest's `faulthandler_timeout`."""

PATIENT = f"""
from animat.cli import main
from animat.study.cluster import cluster
cluster.CONNECTING = {LONGEST}
main()
"""
"""The command line, on a machine where a scheduler may be slow to answer."""
