"""How long tests wait for other processes."""

LONGEST = 90.0
"""Seconds to wait for what comes sooner or later, also where all cores are busy."""
